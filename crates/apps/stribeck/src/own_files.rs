//! Which files of a folder Stribeck wrote: those that `rm` removes. All others are somebody's own, and stay.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::place::shown;
use crate::shelf::Kind;

/// Files of all kinds of folders, by name.
const FILES: [&str; 35] = [
    // A run, an ensemble and their reports.
    "run.json",
    "ensemble.json",
    "report.html",
    "report.pdf",
    "lab.html",
    "summary.json",
    "trace.npy",
    "signals.npy",
    "energy.npy",
    "mesh.vtu",
    "checkpoint",
    "scene.ron",
    ".lock",
    // A campaign.
    "runs.parquet",
    "events.parquet",
    "signals.parquet",
    "campaign.ron",
    "scenes.txt",
    "index.html",
    ".turn",
    // A validation, a comparison, a stiffness.
    "validation.json",
    "compare.json",
    "stiffness.json",
    "detect.json",
    "machine.npy",
    "DATASHEET.md",
    "CARD.md",
    "SHA256SUMS",
    // Records.
    "findings.json",
    "verdict.html",
    "verdict.pdf",
    "trend.json",
    "trend.html",
    "joint.json",
    "joint.html",
];

/// Folders whose files all have one of some endings.
const FILLED: [(&str, &[&str]); 5] = [
    ("records", &["parquet"]),
    ("figures", &["svg", "png", "gif"]),
    ("frames", &["npy"]),
    ("failed", &["txt"]),
    (".reduced", &["modes"]),
];

/// Folders that hold further ones of ours; a folder of ours may also lie in another by any name.
const HOLDERS: [&str; 4] = ["runs", "full", "reduced", "simulated"];

/// Folder of links to runs.
const LINKS: &str = "by_name";

#[derive(Debug, Default, Clone)]
pub(crate) struct Contents {
    pub(crate) own: Vec<PathBuf>,
    /// Folders that held ours alone, the innermost first.
    folders: Vec<PathBuf>,
    /// Files and folders of others: a folder without any file of ours stands for all that it holds.
    pub(crate) others: Vec<PathBuf>,
}

impl Contents {
    /// Of a folder that is one of ours.
    pub(crate) fn of(folder: &Path) -> Self {
        let mut contents = Self::default();
        contents.add(folder);
        contents
    }

    fn add(&mut self, folder: &Path) {
        let mut entries: Vec<_> = fs::read_dir(folder).into_iter().flatten().flatten().collect();
        entries.sort_by_key(fs::DirEntry::file_name);
        for entry in entries {
            let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            let filled = FILLED.iter().find(|(of, _)| *of == name && is_folder);
            if let Some((_, endings)) = filled {
                self.add_files(&path, |file| {
                    let name = file.file_name().and_then(|name| name.to_str()).unwrap_or_default();
                    let end = Path::new(half_written(name).unwrap_or(name)).extension();
                    end.and_then(|e| e.to_str()).is_some_and(|e| endings.contains(&e))
                });
            } else if is_folder && name == LINKS {
                self.add_files(&path, Path::is_symlink);
            } else if is_folder && (HOLDERS.contains(&name.as_str()) || Kind::of(&path).is_some()) {
                self.add(&path);
            } else if !is_folder && !path.is_symlink() && is_own(&name) {
                self.own.push(path);
            } else {
                self.others.push(path);
            }
        }
        self.folders.push(folder.to_owned());
    }

    /// Those files of a folder that are ours.
    fn add_files(&mut self, folder: &Path, is_own: impl Fn(&Path) -> bool) {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let (own, others): (Vec<_>, Vec<_>) = entries.partition(|path| {
            is_own(path) || path.file_name().is_some_and(|name| is_half_written(&name.to_string_lossy()))
        });
        self.own.extend(own);
        self.others.extend(others);
        self.folders.push(folder.to_owned());
    }

    /// Removes the files of ours, and the folders that are then empty.
    ///
    /// # Errors
    /// When the system refuses; what was not removed by then is still there.
    pub(crate) fn remove(&self) -> Result<()> {
        for file in &self.own {
            fs::remove_file(file).with_context(|| format!("`{}` could not be removed", shown(file)))?;
        }
        // One that holds files of others stays.
        self.folders.iter().for_each(|folder| drop(fs::remove_dir(folder)));
        Ok(())
    }
}

fn is_own(name: &str) -> bool {
    FILES.contains(&name) || is_half_written(name)
}

/// Whether a name is that of a file that a killed process left: `.run.json.123-4.part`, `runs.parquet.123.new`.
fn is_half_written(name: &str) -> bool {
    let known = |file: &str| FILES.iter().any(|of| *of == file || of.split('.').next() == Some(file));
    let beside = name.strip_suffix(".new").or_else(|| name.strip_suffix(".part"));
    let base = |name| written_by(name).is_some_and(known);
    half_written(name).is_some_and(known) || beside.is_some_and(|name| base(name) || FILES.contains(&name))
}

/// The file that a hidden one of a killed process was to become.
fn half_written(name: &str) -> Option<&str> {
    written_by(name.strip_prefix('.')?.strip_suffix(".part")?)
}

/// A name without the number of the process that writes it.
fn written_by(name: &str) -> Option<&str> {
    let (file, writer) = name.rsplit_once('.')?;
    writer.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-').then_some(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn issue_files_of_others_in_a_run_stay() {
        let scratch = stribeck_testing::Scratch::create("own-files");
        let run = scratch.join("x");
        for folder in ["figures", "photos", "start-001/frames", "notes"] {
            fs::create_dir_all(run.join(folder)).expect("room");
        }
        for file in [
            "run.json",
            "scene.ron",
            ".run.json.12-3.part",
            "figures/a.svg",
            "figures/mine.xcf",
            "photos/a.jpg",
            "start-001/run.json",
            "start-001/frames/1.npy",
            "thesis.docx",
            "trace.npy.bak",
        ] {
            fs::write(run.join(file), "x").expect("room");
        }
        let contents = Contents::of(&run);
        let named = |all: &[PathBuf]| {
            let mut names: Vec<String> = all
                .iter()
                .map(|path| path.strip_prefix(&run).expect("below").display().to_string())
                .collect();
            names.sort();
            names
        };
        assert_eq!(
            named(&contents.others),
            ["figures/mine.xcf", "notes", "photos", "thesis.docx", "trace.npy.bak"]
        );
        contents.remove().expect("removed");
        assert!(run.join("photos/a.jpg").exists() && run.join("thesis.docx").exists());
        assert!(!run.join("run.json").exists() && !run.join("start-001").exists());
        // Without files of others nothing stays.
        let alone = scratch.join("y");
        fs::create_dir_all(alone.join("figures")).expect("room");
        fs::write(alone.join("run.json"), "x").expect("room");
        Contents::of(&alone).remove().expect("removed");
        assert!(!alone.exists());
    }
}
