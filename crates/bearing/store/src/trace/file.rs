//! A trace that stays on disk: channels are read on demand, also those of a run that was killed.

use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::archive::{self, Archive};
use super::{Trace, header};
use crate::error::Error;

/// Size of a block that is read at once [bytes]: it stays in a core's cache while channels are picked from
/// it.
const BLOCK_BYTES: usize = 1 << 18;
/// The same where channel lies after channel: enough of each that reading it is worth a seek.
const WIDE_BLOCK_BYTES: usize = 1 << 24;

/// An open trace. Its memory does not depend on how long it is.
#[derive(Debug)]
pub struct TraceFile {
    path: PathBuf,
    names: Vec<String>,
    /// Whole rows, by the size of the file when it was opened.
    rows: usize,
    layout: Layout,
    file: Mutex<File>,
}

/// How the values lie in the file.
#[derive(Debug)]
enum Layout {
    /// Row after row, from this byte on.
    Rows(u64),
    /// Channel after channel, each from its byte on.
    Columns(Vec<u64>),
}

impl TraceFile {
    /// Opens the trace at `path`.
    ///
    /// The number of rows comes from the file's size, because a killed run leaves a stale number in the
    /// header; a last row that was not finished is left out.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the file cannot be read; [`Error::Trace`] when its header is cut off or belongs to
    /// other data.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        let io = |source| cannot_read(&path, source);
        let bad = |message: String| Error::Trace {
            path: path.clone(),
            message: format!("{message}. Repeat the run, or check the path"),
        };
        let file = File::open(&path).map_err(io)?;
        let about = file.metadata().map_err(io)?;
        if !about.is_file() {
            return Err(bad("it is not a regular file".to_owned()));
        }
        let mut source = BufReader::new(file);
        if source.fill_buf().map_err(io)?.starts_with(archive::MAGIC) {
            let file = source.into_inner();
            let Archive { names, starts, rows } = Archive::of(&file).map_err(bad)?;
            return Ok(Self { path, names, rows, layout: Layout::Columns(starts), file: Mutex::new(file) });
        }
        let mut first = Vec::with_capacity(12);
        source.by_ref().take(10).read_to_end(&mut first).map_err(io)?;
        if first.get(6).is_some_and(|version| *version > 1) {
            source.by_ref().take(2).read_to_end(&mut first).map_err(io)?;
        }
        let (prefix, length) = header::extent(&first).map_err(bad)?;
        let mut text = Vec::with_capacity(length);
        source.by_ref().take(length as u64).read_to_end(&mut text).map_err(io)?;
        if text.len() < length {
            return Err(bad("it ends inside its header".to_owned()));
        }
        let names = header::decode(&text).map_err(bad)?;
        let start = (prefix + length) as u64;
        let rows = about.len().saturating_sub(start) / (8 * names.len() as u64);
        let rows = usize::try_from(rows).unwrap_or(usize::MAX);
        let layout = Layout::Rows(start);
        Ok(Self { path, names, rows, layout, file: Mutex::new(source.into_inner()) })
    }

    /// Channel names, in file order; the first is `time_s`.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// True when nothing was sampled.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Every channel, over all samples.
    pub fn read_all(&self) -> Result<Trace, Error> {
        self.read(0..self.rows, |_| true)
    }

    /// The channel called `name`, over all samples; `None` when it was not sampled.
    pub fn channel(&self, name: &str) -> Result<Option<Vec<f64>>, Error> {
        if !self.names.iter().any(|n| n == name) {
            return Ok(None);
        }
        Ok(self.read(0..self.rows, |n| n == name)?.columns.pop())
    }

    /// The last value of the channel called `name`; `None` when it was not sampled.
    pub fn last(&self, name: &str) -> Result<Option<f64>, Error> {
        let last = self.read(self.rows.saturating_sub(1)..self.rows, |n| n == name)?;
        Ok(last.get(name).and_then(|column| column.first().copied()))
    }

    /// The channels that are `wanted`, in file order, over the samples `rows` as far as they are there. One
    /// pass over these rows, however many channels.
    pub fn read(&self, rows: Range<usize>, wanted: impl Fn(&str) -> bool) -> Result<Trace, Error> {
        let mut part = Part::of(self, rows.len().min(self.rows), wanted);
        if let Layout::Columns(starts) = &self.layout {
            return self.read_columns(rows, starts, part);
        }
        self.each_block(rows, |block| {
            part.take(block);
            true
        })?;
        Ok(part.trace)
    }

    /// Of an archive only the wanted channels are read.
    fn read_columns(&self, rows: Range<usize>, starts: &[u64], mut part: Part) -> Result<Trace, Error> {
        let rows = rows.start.min(self.rows)..rows.end.min(self.rows);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let mut bytes = vec![0; 8 * rows.len()];
        for (column, &at) in part.trace.columns.iter_mut().zip(&part.places) {
            archive::read_column(&mut file, starts[at], rows.start, &mut bytes)
                .map_err(|source| cannot_read(&self.path, source))?;
            column.extend(bytes.as_chunks().0.iter().map(|value| f64::from_le_bytes(*value)));
        }
        Ok(part.trace)
    }

    /// As [`TraceFile::read`], up to the last sample before any channel, wanted or not, stops being a number.
    pub fn read_finite(&self, rows: Range<usize>, wanted: impl Fn(&str) -> bool) -> Result<Trace, Error> {
        let mut part = Part::of(self, rows.len().min(self.rows), wanted);
        let finite = |value: &[u8; 8]| f64::from_le_bytes(*value).is_finite();
        self.each_block(rows, |block| {
            // Without a branch a value: nearly every block is whole.
            let whole = block.iter().fold(true, |whole, value| whole & finite(value));
            let end = if whole { None } else { block.iter().position(|value| !finite(value)) };
            part.take(&block[..end.map_or(block.len(), |at| at - at % self.names.len())]);
            whole
        })?;
        Ok(part.trace)
    }

    /// Every channel, decimated to at most this many samples: all of them, or every second one, or every
    /// third …
    pub fn read_thinned(&self, most: usize) -> Result<Trace, Error> {
        let every = self.rows.div_ceil(most.max(1)).max(1);
        if every == 1 {
            return self.read_all();
        }
        let mut part = Part::of(self, self.rows / every + 1, |_| true);
        for row in (0..self.rows).step_by(every) {
            self.each_block(row..row + 1, |block| {
                part.take(block);
                true
            })?;
        }
        Ok(part.trace)
    }

    /// Whether the rows begin where a writer of these channels puts them, so that it can append to them.
    pub(super) fn can_grow(&self, header_length: usize) -> bool {
        matches!(self.layout, Layout::Rows(start) if start == header_length as u64)
    }

    /// Passes blocks of whole rows to `take` until it returns false.
    fn each_block(&self, rows: Range<usize>, mut take: impl FnMut(&[[u8; 8]]) -> bool) -> Result<(), Error> {
        let rows = rows.start..rows.end.min(self.rows);
        let row = 8 * self.names.len();
        let wide = matches!(self.layout, Layout::Columns(_));
        let at_once = (if wide { WIDE_BLOCK_BYTES } else { BLOCK_BYTES } / row).max(1);
        let mut block = vec![0; row * at_once.min(rows.len())];
        let io = |source| cannot_read(&self.path, source);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        if let Layout::Rows(start) = self.layout {
            file.seek(SeekFrom::Start(start + (row * rows.start) as u64)).map_err(io)?;
        }
        let mut column = Vec::new();
        for first in rows.clone().step_by(at_once) {
            let block = &mut block[..row * at_once.min(rows.end - first)];
            match &self.layout {
                Layout::Rows(_) => file.read_exact(block).map_err(io)?,
                Layout::Columns(starts) => {
                    column.resize(block.len() / self.names.len(), 0);
                    for (channel, &start) in starts.iter().enumerate() {
                        archive::read_column(&mut file, start, first, &mut column).map_err(io)?;
                        let places = block.as_chunks_mut::<8>().0.iter_mut().skip(channel);
                        for (place, value) in places.step_by(self.names.len()).zip(column.as_chunks().0) {
                            *place = *value;
                        }
                    }
                }
            }
            if !take(block.as_chunks().0) {
                break;
            }
        }
        Ok(())
    }
}

/// Some channels of a trace, picked from its rows.
struct Part {
    trace: Trace,
    /// Where in a row each of them stands.
    places: Vec<usize>,
    channels: usize,
}

impl Part {
    /// With room for `rows` rows.
    fn of(file: &TraceFile, rows: usize, wanted: impl Fn(&str) -> bool) -> Self {
        let places: Vec<usize> = (0..file.names.len()).filter(|&at| wanted(&file.names[at])).collect();
        let names = places.iter().map(|&at| file.names[at].clone()).collect();
        let trace = Trace { names, columns: places.iter().map(|_| Vec::with_capacity(rows)).collect() };
        Self { trace, places, channels: file.names.len() }
    }

    fn take(&mut self, rows: &[[u8; 8]]) {
        for (column, &at) in self.trace.columns.iter_mut().zip(&self.places) {
            column
                .extend(rows.iter().skip(at).step_by(self.channels).map(|value| f64::from_le_bytes(*value)));
        }
    }
}

fn cannot_read(path: &Path, source: std::io::Error) -> Error {
    let kept = match source.kind() {
        ErrorKind::NotFound => {
            "Check the path; `stribeck simulate` writes traces, and a campaign with `keep` may have removed \
             them"
        }
        ErrorKind::PermissionDenied => {
            "The file is there, and you may not read it: ask its owner, or `chmod +r` it"
        }
        _ => "Check the disk and the file",
    };
    Error::Io { action: "read", path: path.to_owned(), kept: kept.to_owned(), source }
}
