//! Writing a trace so that it is readable at every moment.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::{TraceFile, archive, header};
use crate::error::Error;

/// Rows that a killed run may lose: one millisecond at 100 kHz.
const ROWS_PER_FLUSH: u64 = 100;
/// Memory for a trace while it is copied [bytes].
const COPIED_BYTES: usize = 1 << 24;

/// Appends rows to a `.npy` file.
///
/// Rows go to disk every hundred, first the data and then the number of rows in the header, so that a run
/// which is killed leaves a file that NumPy opens. Where the names of the channels are too long for a header
/// that `numpy.load` reads, [`TraceWriter::finish`] makes an archive of the rows; before that they open with
/// a larger `max_header_size`.
///
/// # Examples
///
/// ```
/// use stribeck_store::trace::{Trace, TraceWriter};
///
/// let path = std::env::temp_dir().join(format!("example-{}.npy", std::process::id()));
/// let mut trace = TraceWriter::create(&path, &["time_s", "ay_m_s2"])?;
/// trace.push(&[0.0, 9.81])?;
/// trace.finish()?;
/// assert_eq!(Trace::read(&path)?.get("ay_m_s2"), Some(&[9.81][..]));
/// # std::fs::remove_file(&path).ok();
/// # Ok::<(), stribeck_store::Error>(())
/// ```
#[derive(Debug)]
pub struct TraceWriter {
    path: PathBuf,
    file: File,
    names: Vec<String>,
    /// Rows pushed but not yet on disk.
    pending: Vec<u8>,
    rows: u64,
    rows_on_disk: u64,
    header_length: u64,
    /// A write failed; the file on disk stays as it is.
    failed: bool,
}

impl TraceWriter {
    /// Creates the file at `path`, or empties it, with one channel per name.
    ///
    /// # Errors
    ///
    /// [`Error::Trace`] for names that are empty, equal or not printable ASCII; [`Error::Io`] when the file
    /// cannot be written.
    pub fn create<S: AsRef<str>>(path: impl AsRef<Path>, names: &[S]) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        let bad = |message| Error::Trace { path: path.clone(), message };
        header::check_names(names).map_err(bad)?;
        let first = header::encode(names, 0).map_err(bad)?;
        let io = |source| Error::Io {
            action: "create",
            path: path.clone(),
            kept: "Nothing was written; choose a folder that can be written with --out".to_owned(),
            source,
        };
        let mut file = File::create(&path).map_err(io)?;
        file.write_all(&first).map_err(io)?;
        Ok(Self {
            file,
            names: names.iter().map(|name| name.as_ref().to_owned()).collect(),
            pending: Vec::with_capacity(names.len() * 8 * ROWS_PER_FLUSH as usize),
            rows: 0,
            rows_on_disk: 0,
            header_length: first.len() as u64,
            failed: false,
            path,
        })
    }

    /// Opens the file of an earlier writer, to go on after its first `rows` rows; later rows are cut off.
    ///
    /// # Errors
    ///
    /// [`Error::Trace`] when the file has other channels or fewer rows, and it is then left alone;
    /// [`Error::Io`] when it cannot be read or written.
    pub fn resume<S: AsRef<str>>(path: impl AsRef<Path>, names: &[S], rows: u64) -> Result<Self, Error> {
        let path = path.as_ref().to_owned();
        let bad = |message| Error::Trace { path: path.clone(), message };
        let io = |source| Error::Io {
            action: "continue",
            path: path.clone(),
            kept: "What it holds stays readable; check the file and the free space".to_owned(),
            source,
        };
        let header = header::encode(names, rows).map_err(bad)?;
        rows_again(&path, names, header.len())?;
        let mut file = File::options().read(true).write(true).open(&path).map_err(io)?;
        // Its own number of rows may be any: a killed run leaves a stale one.
        let mut start = Vec::with_capacity(header.len());
        Read::by_ref(&mut file).take(header.len() as u64).read_to_end(&mut start).map_err(io)?;
        let channels = |bytes: &[u8]| {
            let (prefix, length) = header::extent(bytes)?;
            header::decode(bytes.get(prefix..prefix + length).unwrap_or_default())
        };
        let found = channels(&start).map_err(bad)?;
        if start.len() < header.len() || !found.iter().map(String::as_str).eq(names.iter().map(AsRef::as_ref))
        {
            return Err(bad("it has other channels than the run to continue. Start the run anew".to_owned()));
        }
        let record = 8 * names.len() as u64;
        let held = file.metadata().map_err(io)?.len().saturating_sub(header.len() as u64) / record;
        if held < rows {
            return Err(bad(format!(
                "it holds {held} samples and the checkpoint counts {rows}: it was cut off. Restore it, or \
                 start the run anew"
            )));
        }
        file.set_len(header.len() as u64 + rows * record).map_err(io)?;
        file.seek(SeekFrom::Start(0)).map_err(io)?;
        file.write_all(&header).map_err(io)?;
        Ok(Self {
            file,
            names: found,
            pending: Vec::with_capacity((record * ROWS_PER_FLUSH) as usize),
            rows,
            rows_on_disk: rows,
            header_length: header.len() as u64,
            failed: false,
            path,
        })
    }

    /// Rows pushed so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Channel names, in the order of [`TraceWriter::push`].
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Adds one sample, one value a channel.
    ///
    /// # Errors
    ///
    /// [`Error::Trace`] when the number of values is not that of the channels; [`Error::Io`] when the disk
    /// refuses, with the number of rows that are safe.
    #[inline] // compiled where it is called: this package is not optimised in `release`
    pub fn push(&mut self, row: &[f64]) -> Result<(), Error> {
        if row.len() != self.names.len() {
            let message =
                format!("a row of {} values was pushed into {} channels", row.len(), self.names.len());
            return Err(Error::Trace { path: self.path.clone(), message });
        }
        let first = self.pending.len();
        self.pending.resize(first + 8 * row.len(), 0);
        for (bytes, value) in self.pending[first..].as_chunks_mut().0.iter_mut().zip(row) {
            *bytes = value.to_le_bytes();
        }
        self.rows += 1;
        if self.rows - self.rows_on_disk >= ROWS_PER_FLUSH { self.flush() } else { Ok(()) }
    }

    /// Brings every pushed row to the file.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the disk refuses, with the number of rows that are safe. After a failure nothing
    /// more is written.
    pub fn flush(&mut self) -> Result<(), Error> {
        let written = self.write_pending();
        self.told(written)
    }

    /// After a failure nothing more is written; the error gives the number of samples on disk.
    fn told(&mut self, done: std::io::Result<()>) -> Result<(), Error> {
        self.failed |= done.is_err();
        done.map_err(|source| Error::Io {
            action: "write",
            path: self.path.clone(),
            kept: format!(
                "The first {} rows stay readable; free some space, then continue the run from its checkpoint \
                 or repeat it",
                self.rows_on_disk
            ),
            source,
        })
    }

    /// Flushes, and waits until the disk has it: a power cut then loses no row that was pushed before.
    pub fn sync(&mut self) -> Result<(), Error> {
        self.flush()?;
        let synced = self.file.sync_data();
        self.told(synced)
    }

    /// Flushes and closes the file, in the form in which `numpy.load` opens it.
    pub fn finish(mut self) -> Result<(), Error> {
        self.flush()?;
        if header::opens_in_numpy(&self.names) {
            return Ok(());
        }
        let beside = beside(&self.path);
        let rows = TraceFile::open(&self.path)?;
        let columns = |wanted: &[String]| {
            let part = rows.read(0..rows.len(), |name| wanted.iter().any(|wanted| wanted == name))?;
            Ok(part.columns)
        };
        archive::write(&beside, rows.names(), rows.len(), columns)
            .and_then(|()| renamed(&beside, &self.path))
            .inspect_err(|_| drop(std::fs::remove_file(&beside)))
    }

    fn write_pending(&mut self) -> std::io::Result<()> {
        if self.failed {
            return Err(std::io::Error::other("an earlier write to this file failed"));
        }
        if self.pending.is_empty() {
            return Ok(());
        }
        // Data first: a header that promises too few rows is harmless, one that promises too many is not.
        let end = self.header_length + self.rows_on_disk * 8 * self.names.len() as u64;
        self.file.seek(SeekFrom::Start(end))?;
        self.file.write_all(&self.pending)?;
        let header = header::encode(&self.names, self.rows).map_err(std::io::Error::other)?;
        self.file.seek(SeekFrom::Start(0))?;
        self.file.write_all(&header)?;
        self.rows_on_disk = self.rows;
        self.pending.clear();
        Ok(())
    }
}

impl TraceFile {
    /// Writes the channels that are `wanted` to a trace at `path`, as many samples at a time as need little
    /// memory.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] when the file cannot be read or the disk refuses; [`Error::Trace`] when no channel is
    /// wanted.
    pub fn copy(&self, path: impl AsRef<Path>, wanted: impl Fn(&str) -> bool) -> Result<(), Error> {
        self.rows_to(path, wanted)?.finish()
    }

    /// Writes all channels to `path`, row after row.
    fn copy_rows(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        self.rows_to(path, |_| true).map(drop)
    }

    /// A writer that holds the channels that are `wanted`, on disk.
    fn rows_to(&self, path: impl AsRef<Path>, wanted: impl Fn(&str) -> bool) -> Result<TraceWriter, Error> {
        let at_once = (COPIED_BYTES / (8 * self.names().len())).max(1);
        let names: Vec<&String> = self.names().iter().filter(|name| wanted(name)).collect();
        let mut writer = TraceWriter::create(path, &names)?;
        for first in (0..self.len()).step_by(at_once) {
            let part = self.read(first..first + at_once, &wanted)?;
            for n in 0..part.len() {
                let row: Vec<f64> = part.columns.iter().map(|column| column[n]).collect();
                writer.push(&row)?;
            }
        }
        writer.sync()?;
        Ok(writer)
    }
}

/// Where a file is written before it takes the place of `path`.
fn beside(path: &Path) -> PathBuf {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    beside.into()
}

fn renamed(from: &Path, to: &Path) -> Result<(), Error> {
    std::fs::rename(from, to).map_err(|source| Error::Io {
        action: "write",
        path: to.to_owned(),
        kept: "What it held before is still there; check the permissions of its folder".to_owned(),
        source,
    })
}

/// Makes rows of an archive of these channels, and of rows that stand after a header of another length, so
/// that they can be appended to. Other files are left alone.
fn rows_again<S: AsRef<str>>(path: &Path, names: &[S], header_length: usize) -> Result<(), Error> {
    let Ok(found) = TraceFile::open(path) else { return Ok(()) };
    let same = found.names().iter().map(String::as_str).eq(names.iter().map(AsRef::as_ref));
    if !same || found.can_grow(header_length) {
        return Ok(());
    }
    let beside = beside(path);
    let copied = found.copy_rows(&beside).and_then(|()| renamed(&beside, path));
    copied.inspect_err(|_| drop(std::fs::remove_file(&beside)))
}

impl Drop for TraceWriter {
    /// Saves the last rows of a run that ends early; an error cannot be reported here.
    fn drop(&mut self) {
        if !self.failed {
            self.write_pending().ok();
        }
    }
}
