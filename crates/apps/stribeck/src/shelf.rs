//! The folder `runs/`: runs, ensembles, campaigns and results made from them.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Result, bail};
use stribeck_store::run_dir::{RunDir, Stage};
use stribeck_store::run_info::{RunInfo, Status};

use crate::place::{Place, shown};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Run,
    Ensemble,
    Campaign,
    Validation,
    Comparison,
    Detection,
    Analysis,
}

/// A kind of folder: the files that mark it, its page, and a word for it.
const KINDS: [(Kind, &[&str], &str, &str); 7] = [
    (Kind::Ensemble, &["ensemble.json"], "report.html", "ensemble"),
    (Kind::Run, &["run.json"], "report.html", "run"),
    (Kind::Campaign, &["runs.parquet", "campaign.ron"], "index.html", "campaign"),
    (
        Kind::Validation,
        &["validation.json", "full/start-001", "reduced/start-001"],
        "report.html",
        "validation",
    ),
    (Kind::Comparison, &["compare.json"], "report.html", "comparison"),
    (Kind::Detection, &["detect.json"], "report.html", "detection"),
    (Kind::Analysis, &["findings.json"], "report.html", "record"),
];

impl Kind {
    /// Of a folder; `None` where nothing of ours lies in it.
    pub(crate) fn of(folder: &Path) -> Option<Self> {
        let is =
            |(_, marks, ..): &&(Self, &[&str], &str, &str)| marks.iter().any(|m| folder.join(m).exists());
        KINDS.iter().find(is).map(|(kind, ..)| *kind)
    }

    /// The file that is opened in a browser.
    pub(crate) fn page(self) -> &'static str {
        KINDS.iter().find(|(kind, ..)| *kind == self).map_or("report.html", |(_, _, page, _)| page)
    }

    /// In a word.
    pub(crate) fn word(self) -> &'static str {
        KINDS.iter().find(|(kind, ..)| *kind == self).map_or("run", |(.., word)| word)
    }
}

#[derive(Debug)]
pub(crate) struct Item {
    pub(crate) name: String,
    pub(crate) path: PathBuf,
    pub(crate) kind: Kind,
    /// How it stands, in words.
    pub(crate) state: String,
    /// How far a run or an ensemble has come.
    pub(crate) stage: Option<Stage>,
    /// When its newest file was written.
    pub(crate) written: Option<SystemTime>,
    pub(crate) bytes: u64,
}

impl Item {
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let kind = Kind::of(path)?;
        let (bytes, written) = size(path);
        let name = path.file_name().map_or_else(|| shown(path), |n| n.to_string_lossy().into_owned());
        let stage = matches!(kind, Kind::Run | Kind::Ensemble).then(|| Stage::of(path));
        Some(Self {
            name,
            path: path.to_owned(),
            kind,
            state: state(path, kind, stage),
            stage,
            written,
            bytes,
        })
    }

    /// Arguments of the program that bring it to its next state; none while another program does.
    pub(crate) fn next(&self) -> Option<String> {
        let next = self.stage?.next(Path::new(&shown(&self.path)));
        next.filter(|_| !is_held(&self.path))
    }

    pub(crate) fn page(&self) -> Option<PathBuf> {
        Some(self.path.join(self.kind.page())).filter(|page| page.exists())
    }
}

/// Everything of ours in `folder`, the newest first.
pub(crate) fn items(folder: &Path) -> Vec<Item> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut items: Vec<Item> = entries
        .filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()))
        .filter_map(|entry| Item::of(&entry.path()))
        .collect();
    items.sort_by(|a, b| b.written.cmp(&a.written).then_with(|| a.name.cmp(&b.name)));
    items
}

/// Everything of ours below `runs/` and in the folders beside it, where `--out` may have put it, the newest first.
pub(crate) fn all_items(place: &Place) -> Vec<Item> {
    let runs = place.runs();
    let beside = runs.parent().filter(|beside| !beside.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut all = items(&runs);
    all.extend(items(beside).into_iter().map(|item| Item {
        path: item.path.strip_prefix("./").map_or(item.path.clone(), Path::to_owned),
        ..item
    }));
    all.sort_by(|a, b| b.written.cmp(&a.written).then_with(|| a.name.cmp(&b.name)));
    all
}

/// The path of something that is there, whatever it is; a missing one is answered with the likeliest name.
pub(crate) fn existing(asked: &Path, place: &Place) -> Result<PathBuf> {
    let path = place.locate_run(asked);
    if path.exists() { Ok(path) } else { find(asked, place).map(|item| item.path) }
}

/// The folder that somebody means by a path or a name below `runs/`.
pub(crate) fn find(asked: &Path, place: &Place) -> Result<Item> {
    let path = place.locate_run(asked);
    if let Some(item) = Item::of(&path) {
        return Ok(item);
    }
    if path.exists() {
        bail!(
            "`{}` holds no run, and nothing that was made of runs. `{} list` shows what there is",
            shown(&path),
            place.program
        );
    }
    let all = all_items(place);
    let asked = asked.display().to_string();
    let distance = |item: &&Item| strsim::levenshtein(&item.name, &asked);
    let meant = all.iter().min_by_key(distance).filter(|item| distance(item) <= 3);
    let hint = match meant {
        Some(item) => format!("did you mean `{}`?", item.name),
        None if all.is_empty() => {
            format!("there are no runs in `{}`; `{} simulate` makes one", shown(&place.runs()), place.program)
        }
        None => format!("`{} list` shows the {} that there are", place.program, all.len()),
    };
    bail!("there is no `{asked}`, as a path or below `{}`: {hint}", shown(&place.runs()));
}

fn state(path: &Path, kind: Kind, stage: Option<Stage>) -> String {
    let word = stage.map_or("", Stage::word);
    match kind {
        Kind::Run => match RunDir::open(path).and_then(|dir| dir.read_info()) {
            Ok(info) => of_run(&info, stage, is_held(path)),
            Err(_) => "its run.json cannot be read".to_owned(),
        },
        Kind::Ensemble => match RunDir::open_ensemble(path).and_then(|dir| dir.read_ensemble()) {
            Ok((scene, ensemble)) => {
                format!("{word}, {} starts of {} ms", ensemble.starts, scene.solver.duration_ms)
            }
            Err(_) => "its ensemble.json cannot be read".to_owned(),
        },
        Kind::Campaign => {
            let runs = fs::read_dir(path.join("runs")).into_iter().flatten().flatten();
            let complete = if path.join("runs.parquet").exists() { "complete" } else { "not at its end" };
            format!(
                "{} runs, {complete}",
                runs.filter(|entry| entry.path().join("run.json").exists()).count()
            )
        }
        _ if path.join(kind.page()).exists() => "complete".to_owned(),
        _ => "not at its end".to_owned(),
    }
}

fn of_run(info: &RunInfo, stage: Option<Stage>, held: bool) -> String {
    let ms = (1e6 * info.simulated_s).round() / 1e3;
    match info.status {
        Status::Complete if stage == Some(Stage::Reported) => format!("reported, {ms} ms"),
        Status::Complete => format!("complete, {ms} ms"),
        Status::Diverged => format!("diverged after {ms} ms"),
        Status::Interrupted => format!("interrupted after {ms} ms"),
        Status::Running if stage == Some(Stage::Planned) && !held => {
            "planned, killed before its first step".to_owned()
        }
        Status::Running if held => format!("running, {ms} ms so far"),
        Status::Running if ms == 0.0 => "killed before the first sample".to_owned(),
        Status::Running => format!("killed after {ms} ms"),
    }
}

/// Whether a program holds the folder of a run, or one below it.
pub(crate) fn is_held(path: &Path) -> bool {
    let locks = |path: &Path| {
        File::open(path.join(".lock"))
            .is_ok_and(|file| matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)))
    };
    locks(path)
        || fs::read_dir(path)
            .into_iter()
            .flatten()
            .flatten()
            .any(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()) && is_held(&entry.path()))
}

/// Bytes of all files below a folder, and when the newest was written. Links are not followed.
pub(crate) fn size(path: &Path) -> (u64, Option<SystemTime>) {
    let (mut bytes, mut newest) = (0, None);
    for entry in fs::read_dir(path).into_iter().flatten().flatten() {
        let Ok(kind) = entry.file_type() else { continue };
        let (more, written) = if kind.is_dir() {
            size(&entry.path())
        } else {
            entry.metadata().map_or((0, None), |data| (data.len(), data.modified().ok()))
        };
        bytes += more;
        newest = newest.max(written);
    }
    (bytes, newest)
}

pub(crate) fn in_words(bytes: u64) -> String {
    let units = [("GB", 1e9), ("MB", 1e6), ("kB", 1e3)];
    let bytes = bytes as f64;
    match units.into_iter().find(|(_, unit)| bytes >= 0.95 * unit) {
        Some((name, unit)) if bytes >= 10.0 * unit => format!("{:.0} {name}", bytes / unit),
        Some((name, unit)) => format!("{:.1} {name}", bytes / unit),
        None => format!("{bytes} bytes"),
    }
}

/// How long ago a moment was.
pub(crate) fn ago(moment: SystemTime, now: SystemTime) -> String {
    let s = now.duration_since(moment).map_or(0, |since| since.as_secs());
    match s {
        0..60 => "just now".to_owned(),
        60..3600 => format!("{} min ago", s / 60),
        3600..86_400 => format!("{} h ago", s / 3600),
        86_400..172_800 => "yesterday".to_owned(),
        _ => format!("{} days ago", s / 86_400),
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn by_hand_sizes_and_ages_in_words() {
        assert_eq!(
            [12, 980, 123_456, 1_900_000_000].map(in_words),
            ["12 bytes", "1.0 kB", "123 kB", "1.9 GB"]
        );
        let now = SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000);
        let before = |s: u64| ago(now - Duration::from_secs(s), now);
        assert_eq!(
            [5, 90, 7_300, 90_000, 400_000].map(before),
            ["just now", "1 min ago", "2 h ago", "yesterday", "4 days ago"]
        );
    }

    #[test]
    fn behaves_a_folder_is_known_by_what_lies_in_it() {
        let folder = stribeck_testing::Scratch::create("kinds");
        assert_eq!(Kind::of(folder.path()), None);
        fs::write(folder.join("compare.json"), "{}").expect("writable");
        assert_eq!(Kind::of(folder.path()), Some(Kind::Comparison));
        fs::write(folder.join("run.json"), "{}").expect("writable");
        assert_eq!(Kind::of(folder.path()), Some(Kind::Run));
        assert_eq!(size(folder.path()).0, 4);
    }
}
