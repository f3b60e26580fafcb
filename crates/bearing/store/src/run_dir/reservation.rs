//! A folder reserved for one run: made when it is missing, locked against other processes, and removed when
//! the run never starts.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::files::cannot;
use super::{INFO, LOCK, UNTOUCHED, files};
use crate::error::Error;

/// Tries to make a folder while another process takes away the one above it.
const ATTEMPTS: usize = 100;

/// The place of a run that may not have begun. Copies stand for the same place.
#[derive(Debug, Clone)]
pub struct Reservation(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    path: PathBuf,
    /// Folders that were made for it, the deepest first.
    made: Vec<PathBuf>,
    /// Held by the writer of the run, `None` for readers.
    lock: Option<File>,
    started: bool,
}

impl Reservation {
    /// Makes the folder, if need be, and locks it.
    pub(super) fn new(path: &Path) -> Result<Self, Error> {
        let mut made = Vec::new();
        let locked = make_and_lock(path, &mut made);
        if locked.is_err() {
            take_away(&made);
        }
        Ok(Self::with(State { path: path.to_owned(), made, lock: Some(locked?), started: false }))
    }

    /// Locks the folder of a run that is there.
    pub(super) fn of_run(path: &Path) -> Result<Self, Error> {
        let lock = Some(lock(path)?);
        Ok(Self::with(State { path: path.to_owned(), made: Vec::new(), lock, started: false }))
    }

    /// Of a run that is only read.
    pub(super) fn of_reader(path: &Path) -> Self {
        Self::with(State { path: path.to_owned(), made: Vec::new(), lock: None, started: true })
    }

    fn with(state: State) -> Self {
        Self(Arc::new(Mutex::new(state)))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes the number of this process into the lock, for the message of a second one.
    pub(super) fn sign(&self) -> Result<(), Error> {
        let state = self.state();
        let name = state.path.join(LOCK);
        let sign = |mut file: &File| -> std::io::Result<()> {
            file.set_len(0)?;
            file.seek(SeekFrom::Start(0))?;
            writeln!(file, "{}", std::process::id())
        };
        state.lock.as_ref().map_or(Ok(()), sign).map_err(|e| cannot("write", &name, UNTOUCHED, e))
    }

    /// From now on the files in the folder are those of this run.
    pub(super) fn start(&self) {
        self.state().started = true;
    }

    pub(super) fn has_started(&self) -> bool {
        self.state().started
    }

    /// When the run has not begun, removes the folders made for it and calls `end`; the run cannot begin
    /// meanwhile.
    pub fn unless_started(&self, end: impl FnOnce()) {
        let mut state = self.state();
        if !state.started {
            state.take_away();
            end();
        }
    }
}

impl State {
    fn take_away(&mut self) {
        if !self.made.is_empty() {
            std::fs::remove_file(self.path.join(LOCK)).ok();
            take_away(&std::mem::take(&mut self.made));
        }
    }
}

impl Drop for State {
    /// A folder made for a run that never started is removed.
    fn drop(&mut self) {
        if !self.started {
            self.take_away();
        }
    }
}

/// Folders that hold something by now stay.
fn take_away(made: &[PathBuf]) {
    for folder in made {
        std::fs::remove_dir(folder).ok();
    }
}

fn make_and_lock(path: &Path, made: &mut Vec<PathBuf>) -> Result<File, Error> {
    let mut attempt = 0;
    loop {
        attempt += 1;
        let found = make(path, made).and_then(|()| foreign_file(path));
        if let Ok(Some(found)) = found {
            return Err(Error::ForeignFolder { path: path.to_owned(), found });
        }
        match found.and_then(|_| open_lock(path)) {
            // Another process removed the folder, or one above it, because its own run never started.
            Err(e) if e.kind() == ErrorKind::NotFound && attempt < ATTEMPTS => {}
            Err(e) => return Err(cannot("create", path, UNTOUCHED, e)),
            Ok(file) => {
                take_lock(path, &file)?;
                // It may have been taken away before it was locked.
                if is_at(&file, &path.join(LOCK)) || attempt >= ATTEMPTS {
                    return Ok(file);
                }
            }
        }
    }
}

/// Makes `path` and the folders above it; notes which were missing.
fn make(path: &Path, made: &mut Vec<PathBuf>) -> std::io::Result<()> {
    let missing = path.ancestors().take_while(|p| !p.as_os_str().is_empty() && !p.exists());
    for folder in missing.collect::<Vec<_>>().into_iter().rev() {
        match std::fs::create_dir(folder) {
            Ok(()) => made.insert(0, folder.to_owned()),
            Err(e) if e.kind() == ErrorKind::AlreadyExists && folder.is_dir() => {}
            Err(e) => return Err(e),
        }
    }
    Ok(())
}

/// A file in the folder that no run writes; hidden files do not count.
fn foreign_file(path: &Path) -> std::io::Result<Option<String>> {
    // A folder with run.json is a run, and files that its owner added do not matter.
    if [INFO, LOCK].iter().any(|name| path.join(name).exists()) {
        return Ok(None);
    }
    Ok(visible(path)?.into_iter().find(|name| !files::is_ours(name)))
}

/// Names in a folder, in their order, without hidden ones.
pub(super) fn visible(path: &Path) -> std::io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(path)? {
        names.push(entry?.file_name().to_string_lossy().into_owned());
    }
    names.retain(|name| !name.starts_with('.'));
    names.sort();
    Ok(names)
}

/// Locks the folder of a run.
pub(super) fn lock(path: &Path) -> Result<File, Error> {
    let file = open_lock(path).map_err(|e| cannot("write", &path.join(LOCK), UNTOUCHED, e))?;
    take_lock(path, &file)?;
    Ok(file)
}

fn open_lock(path: &Path) -> std::io::Result<File> {
    OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path.join(LOCK))
}

fn take_lock(path: &Path, mut file: &File) -> Result<(), Error> {
    match file.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => {
            let mut owner = String::new();
            Read::by_ref(&mut file).take(20).read_to_string(&mut owner).ok();
            Err(Error::FolderInUse { path: path.to_owned(), owner: owner.trim().to_owned() })
        }
        // Some network file systems have no locks; a run there is unprotected rather than impossible.
        Err(TryLockError::Error(e)) if e.kind() == ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(e)) => Err(cannot("write", &path.join(LOCK), UNTOUCHED, e)),
    }
}

/// Whether `file` is still the file at `path`.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |about: std::fs::Metadata| (about.dev(), about.ino());
    file.metadata().ok().map(place) == path.metadata().ok().map(place)
}

/// Elsewhere an open file cannot be removed.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}
