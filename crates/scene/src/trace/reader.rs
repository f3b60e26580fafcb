//! Reading a trace, also that of a run that was killed.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

use super::{Trace, header};
use crate::error::Error;

impl Trace {
    /// Reads the trace at `path`.
    ///
    /// The number of rows comes from the file's size, because a killed run leaves a stale number in the header; a last
    /// row that was not finished is dropped. Memory is bounded by the size of the file.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the file cannot be read; [`Error::Trace`] when its header is cut off or belongs to other data.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let mut opened = Opened::new(path)?;
        let columns = read_rows(&mut opened.rows, opened.names.len(), opened.bytes);
        Ok(Self { names: opened.names, columns: columns.map_err(|e| cannot_read(path, e))? })
    }

    /// Whole rows in the trace at `path`, by the size of the file.
    ///
    /// # Errors
    ///
    /// As [`Trace::read`].
    pub fn count(path: impl AsRef<Path>) -> Result<u64, Error> {
        let opened = Opened::new(path.as_ref())?;
        Ok(opened.bytes / (8 * opened.names.len() as u64))
    }
}

/// A trace behind its header.
struct Opened {
    names: Vec<String>,
    rows: BufReader<File>,
    /// What the file's size promises of rows.
    bytes: u64,
}

impl Opened {
    fn new(path: &Path) -> Result<Self, Error> {
        let io = |source| cannot_read(path, source);
        let bad = |message: String| Error::Trace {
            path: path.to_owned(),
            message: format!("{message}. Repeat the run, or check the path"),
        };
        let file = File::open(path).map_err(io)?;
        let about = file.metadata().map_err(io)?;
        if !about.is_file() {
            return Err(bad("it is not a regular file".to_owned()));
        }
        let mut source = BufReader::new(file);
        let mut start = Vec::with_capacity(12);
        source.by_ref().take(10).read_to_end(&mut start).map_err(io)?;
        if start.get(6).is_some_and(|version| *version > 1) {
            source.by_ref().take(2).read_to_end(&mut start).map_err(io)?;
        }
        let (prefix, length) = header::extent(&start).map_err(bad)?;
        let mut text = Vec::with_capacity(length);
        source.by_ref().take(length as u64).read_to_end(&mut text).map_err(io)?;
        if text.len() < length {
            return Err(bad("it ends inside its header".to_owned()));
        }
        let names = header::decode(&text).map_err(bad)?;
        let data = about.len().saturating_sub((prefix + length) as u64);
        Ok(Self { names, rows: source, bytes: data })
    }
}

fn cannot_read(path: &Path, source: std::io::Error) -> Error {
    let kept = match source.kind() {
        ErrorKind::NotFound => "Check the path; `stribeck simulate` writes traces",
        ErrorKind::PermissionDenied => {
            "The file is there, and you may not read it: ask its owner, or `chmod +r` it"
        }
        _ => "Check the disk and the file",
    };
    Error::Io { action: "read", path: path.to_owned(), kept: kept.to_owned(), source }
}

/// Reads whole rows of `channels` doubles until the data end; `bytes` is what the file's size promises.
fn read_rows(source: &mut impl Read, channels: usize, bytes: u64) -> std::io::Result<Vec<Vec<f64>>> {
    let promised = usize::try_from(bytes / (8 * channels as u64)).unwrap_or(0);
    let mut columns = vec![Vec::with_capacity(promised); channels];
    let mut row = vec![0_u8; 8 * channels];
    loop {
        match source.read_exact(&mut row) {
            Ok(()) => {}
            Err(e) if e.kind() == ErrorKind::UnexpectedEof => return Ok(columns),
            Err(e) => return Err(e),
        }
        for (column, value) in columns.iter_mut().zip(row.as_chunks::<8>().0) {
            column.push(f64::from_le_bytes(*value));
        }
    }
}
