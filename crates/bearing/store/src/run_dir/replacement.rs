//! A run that replaces another one once it is complete. Until then it lies beside it, in `NAME.new`.

use std::path::{Path, PathBuf};

use super::files::{cannot, remove_run};
use super::reservation::lock;
use crate::error::Error;

/// Names the run that is to be replaced, in the folder of the new one.
const MARK: &str = ".replaces";

/// Where the new run lies meanwhile.
pub(super) fn beside(path: &Path) -> PathBuf {
    sibling(path, ".new")
}

fn sibling(path: &Path, end: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(end);
    path.with_file_name(name)
}

/// Notes in the new folder which run it replaces.
pub(super) fn mark(new: &Path, replaces: &Path) -> Result<(), Error> {
    let name = replaces.file_name().unwrap_or_default().to_string_lossy().into_owned();
    super::write_atomic(&new.join(MARK), name.as_bytes())
}

/// The run that the one in `new` replaces.
pub(super) fn marked(new: &Path) -> Option<PathBuf> {
    let name = std::fs::read_to_string(new.join(MARK)).ok()?;
    // A name and no path: it stays beside the run, wherever both were moved.
    let plain = Path::new(&name).components().count() == 1 && !name.starts_with('.');
    // A kill may have left the mark in the folder that has taken the place.
    plain.then(|| new.with_file_name(name)).filter(|old| old != new)
}

/// Puts the complete run in `new` at `old`. Files that the owner added to the old folder are moved along.
pub(super) fn swap(new: &Path, old: &Path) -> Result<(), Error> {
    const KEPT: &str = "Both runs are still there";
    let away = sibling(old, &format!(".old-{}", std::process::id()));
    if old.exists() {
        // No other process may be writing it; the lock moves with the folder.
        let _held = lock(old)?;
        std::fs::rename(old, &away).map_err(|e| cannot("replace", old, KEPT, e))?;
    }
    if let Err(e) = std::fs::rename(new, old) {
        std::fs::rename(&away, old).ok();
        return Err(cannot("replace", old, KEPT, e));
    }
    std::fs::remove_file(old.join(MARK)).ok();
    if away.exists() {
        remove_run(&away)?;
        // The innermost first, so that folders are empty in the end.
        for folder in super::FOLDERS.map(|(name, _)| name).into_iter().chain([""]) {
            bring_along(&away.join(folder), &old.join(folder));
        }
    }
    Ok(())
}

/// Moves files that the owner added to a folder of the earlier run; a file that cannot be moved stays where
/// it is.
fn bring_along(from: &Path, to: &Path) {
    for name in std::fs::read_dir(from).into_iter().flatten().flatten().map(|entry| entry.file_name()) {
        let target = to.join(&name);
        if name == super::LOCK {
            std::fs::remove_file(from.join(name)).ok();
        } else if !target.exists() {
            std::fs::create_dir_all(to).ok();
            std::fs::rename(from.join(name), target).ok();
        }
    }
    std::fs::remove_dir(from).ok();
}
