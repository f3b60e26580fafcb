//! Errors of files of signals, whatever their format.

use std::path::{Path, PathBuf};

use super::memory;

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a file cannot be read or written. Each message names the file and a remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error("`{}` cannot be {action}: {source}", .path.display())]
    Io {
        /// `read` or `written`.
        action: &'static str,
        path: PathBuf,
        source: std::io::Error,
    },
    #[error(
        "`{}` is no signal that can be read: {seen}. Known are CSV, .npy, .npz, .mat (versions 4, 5 and \
         7.3), .uff/.unv (dataset 58), .tdms, .mf4, .parquet, .wav and .flac; export it as one of these", .path.display()
    )]
    Unknown { path: PathBuf, seen: String },
    #[error("`{}` is damaged or cut off ({format}): {what}. Copy it again, or export it once \
        more", .path.display())]
    Damaged { path: PathBuf, format: &'static str, what: String },
    #[error("`{}` holds {what}, which is not read from {format}: {advice}", .path.display())]
    Unsupported { path: PathBuf, format: &'static str, what: String, advice: &'static str },
    #[error(
        "`{}`, row {row}, column {column} (`{channel}`): `{text}` is no number; mend the row, or cut the \
         file before it", .path.display()
    )]
    Number { path: PathBuf, row: u64, column: usize, channel: String, text: String },
    #[error("`{}` is not read: {what} would take {}, and {} are allowed. `--max-memory` allows more; or cut the \
        file", .path.display(), memory::in_words(.bytes), memory::in_words(.most))]
    TooLarge {
        path: PathBuf,
        what: String,
        /// Memory that it takes [bytes].
        bytes: u64,
        /// The limit [bytes].
        most: u64,
    },
    #[error("`{}` has no channel `{asked}`; it has {has}", .path.display())]
    NoChannel { path: PathBuf, asked: String, has: String },
    #[error("`{}` cannot be written as {format}: {what}", .path.display())]
    DoesNotFit { path: PathBuf, format: &'static str, what: String },
}

impl Error {
    /// The system refuses to read a file.
    pub fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Io { action: "read", path: path.to_owned(), source }
    }

    /// The system refuses to write a file.
    pub fn write(path: &Path, source: std::io::Error) -> Self {
        Self::Io { action: "written", path: path.to_owned(), source }
    }

    /// A file contradicts its format.
    pub fn damaged(path: &Path, format: &'static str, what: impl Into<String>) -> Self {
        Self::Damaged { path: path.to_owned(), format, what: what.into() }
    }
}
