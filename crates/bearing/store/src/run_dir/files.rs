//! Files of a run, written whole and removed by name.

use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use serde::de::DeserializeOwned;

use super::{DERIVED, FIGURES, FILES, FOLDERS, LOCK, PARTIAL, REPORT, SUMMARY};
use crate::error::Error;
use crate::run_info::RunInfo;
use stribeck_scene::ensemble::{folder_name, number_of};

/// `run.json` holds a page of text and at most some thousand warnings.
const MAX_INFO_BYTES: u64 = 1 << 24;

/// Replaces the file at `path` by `bytes`, whole or not at all. Several processes may write the same file at
/// the same time: that of the last one stays.
///
/// # Errors
///
/// [`Error::Io`] when the disk refuses; the earlier file, if any, is then still there.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    // The name must not reach the disk before the content.
    replace(path, bytes, File::sync_data)
}

/// The same without waiting for the disk: whole after a kill, not after a loss of power.
///
/// # Errors
///
/// As [`write_atomic`].
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    replace(path, bytes, |_| Ok(()))
}

fn replace(path: &Path, bytes: &[u8], settle: fn(&File) -> std::io::Result<()>) -> Result<(), Error> {
    const KEPT: &str =
        "What was there before is still there; check the free space and the permissions of the folder";
    let failed = |e| cannot("write", path, KEPT, e);
    let (partial, mut file) = partial(path).map_err(failed)?;
    let written = file.write_all(bytes).and_then(|()| settle(&file));
    drop(file);
    written.and_then(|()| std::fs::rename(&partial, path)).map_err(|e| {
        std::fs::remove_file(&partial).ok();
        failed(e)
    })
}

/// A new file beside `path` that no other writer has. It is hidden, so that what a killed process leaves
/// makes no foreign folder; [`remove_partial`] takes that away.
fn partial(path: &Path) -> std::io::Result<(PathBuf, File)> {
    /// Files that this process has begun.
    static BEGUN: AtomicU64 = AtomicU64::new(0);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    loop {
        let number = BEGUN.fetch_add(1, Ordering::Relaxed);
        let beside = path.with_file_name(format!(".{name}.{}-{number}{PARTIAL}", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&beside) {
            // One that a killed process left, or of a process with this number on another machine.
            Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
            opened => return opened.map(|file| (beside, file)),
        }
    }
}

/// Removes what killed processes have left of the files of a run or its report in `folder`.
pub(super) fn remove_partial(folder: &Path) -> Result<(), Error> {
    remove_partial_of(folder, |file| FILES.contains(&file))?;
    remove_partial_report(folder)
}

/// The same of the files of a report; the run may still be writing its own.
pub(super) fn remove_partial_report(folder: &Path) -> Result<(), Error> {
    remove_partial_of(folder, |file| [REPORT, SUMMARY].contains(&file))?;
    remove_partial_of(&folder.join(FIGURES), |_| true)
}

fn remove_partial_of(folder: &Path, is_ours: impl Fn(&str) -> bool) -> Result<(), Error> {
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    for name in names.filter(|name| name.to_str().and_then(target).is_some_and(&is_ours)) {
        remove(&folder.join(name))?;
    }
    Ok(())
}

/// The file that one of [`partial`] was to become, by its name.
fn target(name: &str) -> Option<&str> {
    let own = name.strip_prefix('.')?.strip_suffix(PARTIAL)?;
    let (file, writer) = own.rsplit_once('.')?;
    writer.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-').then_some(file)
}

pub(super) fn cannot(action: &'static str, path: &Path, kept: &str, source: std::io::Error) -> Error {
    Error::Io { action, path: path.to_owned(), kept: kept.to_owned(), source }
}

/// Removes every file that a run or its report writes into `folder`, and no other.
pub(super) fn remove_run(folder: &Path) -> Result<(), Error> {
    for name in FILES {
        remove(&folder.join(name))?;
    }
    remove_partial(folder)?;
    for (name, _) in FOLDERS {
        remove_filled(folder, name)?;
    }
    for start in start_folders(folder) {
        remove_run(&start)?;
        remove(&start.join(LOCK))?;
        // Files that the owner added stay, and so do their folders.
        FOLDERS.iter().for_each(|(name, _)| drop(std::fs::remove_dir(start.join(name))));
        std::fs::remove_dir(&start).ok();
    }
    Ok(())
}

/// Removes what was made from the samples of a run.
pub(super) fn remove_derived(run: &Path) -> Result<(), Error> {
    DERIVED.iter().try_for_each(|name| remove(&run.join(name)))?;
    remove_filled(run, FIGURES)
}

/// Removes the files that a run or its report wrote into the folder `name` of `run`, and no others.
fn remove_filled(run: &Path, name: &str) -> Result<(), Error> {
    let extensions =
        FOLDERS.iter().find(|(folder, _)| *folder == name).map_or(&[][..], |(_, extensions)| extensions);
    for path in std::fs::read_dir(run.join(name)).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if path.extension().and_then(|e| e.to_str()).is_some_and(|e| extensions.contains(&e)) {
            remove(&path)?;
        }
    }
    Ok(())
}

/// The same, and the folder itself where nothing of its owner lies in it.
pub(super) fn remove_folder(run: &Path, name: &str) -> Result<(), Error> {
    remove_filled(run, name)?;
    std::fs::remove_dir(run.join(name)).ok();
    Ok(())
}

/// Renames a complete file to its final name.
pub(super) fn rename(from: &Path, to: &Path) -> Result<(), Error> {
    std::fs::rename(from, to).map_err(|e| cannot("write", to, "What it was made from is still there", e))
}

/// Folders of all starts in the folder of an ensemble, by number.
pub(super) fn start_folders(folder: &Path) -> Vec<PathBuf> {
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    let mut numbers: Vec<usize> = names.filter_map(|name| number_of(name.to_str()?)).collect();
    numbers.sort_unstable();
    numbers.into_iter().map(|number| folder.join(folder_name(number))).collect()
}

pub(super) fn remove(path: &Path) -> Result<(), Error> {
    match std::fs::remove_file(path) {
        Err(e) if e.kind() != ErrorKind::NotFound => {
            Err(cannot("remove", path, "The other files of the earlier run may already be gone", e))
        }
        _ => Ok(()),
    }
}

/// Whether a run, its report or its lock has a file or folder of this name.
pub(super) fn is_ours(name: &str) -> bool {
    let name = name.trim_end_matches(PARTIAL);
    let known = FILES.contains(&name) || FOLDERS.iter().any(|(folder, _)| *folder == name) || name == LOCK;
    known || number_of(name).is_some()
}

pub(super) fn read_info(path: &Path) -> Result<RunInfo, Error> {
    read_json(path)
}

pub(super) fn read_json<T: DeserializeOwned>(path: &Path) -> Result<T, Error> {
    let io = |e| cannot("read", path, "Nothing was changed", e);
    let mut text = Vec::new();
    File::open(path).map_err(io)?.take(MAX_INFO_BYTES).read_to_end(&mut text).map_err(io)?;
    serde_json::from_slice(&text).map_err(|source| Error::RunInfo { path: path.to_owned(), source })
}
