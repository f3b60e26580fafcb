//! Errors of files of signals, whatever their format.

use std::path::{Path, PathBuf};

use super::memory;

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a file cannot be read or written. Each message names the file and a remedy.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The system refuses the file.
    #[error("`{}` cannot be {action}: {source}", .path.display())]
    Io {
        /// `read` or `written`.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The file has none of the known formats.
    #[error(
        "`{}` is no signal that can be read: {seen}. Known are CSV, .npy, .npz, .mat (versions 4, 5 and \
         7.3), .uff/.unv (dataset 58), .tdms, .mf4, .parquet, .wav and .flac; export it as one of these", .path.display()
    )]
    Unknown {
        /// The file.
        path: PathBuf,
        /// Likely kind of file.
        seen: String,
    },
    /// The file contradicts its format.
    #[error("`{}` is damaged or cut off ({format}): {what}. Copy it again, or export it once \
        more", .path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: &'static str,
        /// Problem, with its place.
        what: String,
    },
    /// The file holds something that its format allows and that is not read.
    #[error("`{}` holds {what}, which is not read from {format}: {advice}", .path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: &'static str,
        /// Content that is not supported.
        what: String,
        /// Remedy.
        advice: &'static str,
    },
    /// A text that should be a number.
    #[error(
        "`{}`, row {row}, column {column} (`{channel}`): `{text}` is no number; mend the row, or cut the \
         file before it", .path.display()
    )]
    Number {
        /// The file.
        path: PathBuf,
        /// Line of the file, from 1.
        row: u64,
        /// Column, from 1.
        column: usize,
        /// Channel in that column.
        channel: String,
        /// The text at that place.
        text: String,
    },
    /// It would take more memory than is allowed.
    #[error("`{}` is not read: {what} would take {}, and {} are allowed. `--max-memory` allows more; or cut the \
        file", .path.display(), memory::in_words(.bytes), memory::in_words(.most))]
    TooLarge {
        /// The file, or the channel.
        path: PathBuf,
        /// The part of it that is too large.
        what: String,
        /// Memory that it takes [bytes].
        bytes: u64,
        /// The limit [bytes].
        most: u64,
    },
    /// There is no such channel.
    #[error("`{}` has no channel `{asked}`; it has {has}", .path.display())]
    NoChannel {
        /// The file.
        path: PathBuf,
        /// The requested name.
        asked: String,
        /// The existing names.
        has: String,
    },
    /// The data do not fit the format.
    #[error("`{}` cannot be written as {format}: {what}", .path.display())]
    DoesNotFit {
        /// The file.
        path: PathBuf,
        /// The format.
        format: &'static str,
        /// Problem and remedy.
        what: String,
    },
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
