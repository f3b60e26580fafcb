//! Files of a run, written whole and removed by name.

use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::{FILES, FOLDERS, LOCK, PARTIAL};
use crate::ensemble::{folder_name, number_of};
use crate::error::Error;
use crate::run_info::RunInfo;

/// `run.json` holds a page of text and at most some thousand warnings.
const MAX_INFO_BYTES: u64 = 1 << 24;

/// Replaces the file at `path` by `bytes`, whole or not at all.
///
/// # Errors
///
/// [`Error::Io`] when the disk refuses; the earlier file, if any, is then still there.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    const KEPT: &str =
        "What was there before is still there; check the free space and the permissions of the folder";
    let mut partial = path.as_os_str().to_owned();
    partial.push(PARTIAL);
    let partial = PathBuf::from(partial);
    let written = File::create(&partial).and_then(|mut file| {
        file.write_all(bytes)?;
        // The name must not reach the disk before the content.
        file.sync_data()
    });
    written.and_then(|()| std::fs::rename(&partial, path)).map_err(|e| {
        std::fs::remove_file(&partial).ok();
        cannot("write", path, KEPT, e)
    })
}

pub(super) fn cannot(action: &'static str, path: &Path, kept: &str, source: std::io::Error) -> Error {
    Error::Io { action, path: path.to_owned(), kept: kept.to_owned(), source }
}

/// Removes every file that a run or its report writes into `folder`, and no other.
pub(super) fn remove_run(folder: &Path) -> Result<(), Error> {
    for name in FILES {
        remove(&folder.join(name))?;
    }
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
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => {
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
