//! How much memory the samples of one file may take.
//!
//! A small file may unpack to more than a machine has. What must be held as a whole is asked for here before it
//! is taken; the program sets the limit once, before it reads the first file.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{Error, Result};

/// Limit of a program that sets none [bytes].
pub const USUAL: u64 = 4 << 30;

static MOST: AtomicU64 = AtomicU64::new(USUAL);

/// The limit [bytes].
pub fn most_bytes() -> u64 {
    MOST.load(Ordering::Relaxed)
}

/// Sets the limit [bytes] for all files that are opened and channels that are read from now on.
pub fn set_most_bytes(bytes: u64) {
    MOST.store(bytes, Ordering::Relaxed);
}

/// Refuses `bytes` for `what` of a file where that is more than the limit.
pub fn ask(path: &Path, what: &str, bytes: u64) -> Result<()> {
    let most = most_bytes();
    if bytes <= most {
        return Ok(());
    }
    Err(Error::TooLarge { path: path.to_owned(), what: what.to_owned(), bytes, most })
}

pub(super) fn in_words(bytes: &u64) -> String {
    let bytes = *bytes as f64;
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    match units.into_iter().find(|(unit, _)| bytes >= *unit) {
        Some((unit, name)) => format!("{:.1} {name}", bytes / unit),
        None => format!("{bytes} bytes"),
    }
}
