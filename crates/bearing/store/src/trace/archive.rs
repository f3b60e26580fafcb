//! Traces of very many channels, whose names alone are longer than the header that `numpy.load` reads: the
//! same channels as a NumPy archive, one array each.
//!
//! The file keeps its name, `trace.npy`. `numpy.load` recognises an archive by its first bytes, not by its
//! name, so that `numpy.load("trace.npy")["roller.50.outer_fy_n"]` is a time history here, too. A run writes
//! rows, as always, and makes the archive of them when it ends; one that goes on makes rows of it first.
//! Arrays are stored without compression, channel after channel, and channels are read from where they lie.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::header;
use crate::error::Error;

/// First bytes of an archive.
pub(super) const MAGIC: &[u8; 4] = b"PK\x03\x04";
/// Most memory for channels while an archive is made [bytes].
const AT_ONCE: usize = 1 << 28;
/// Longest header of one array.
const MAX_HEADER: usize = 4096;

pub(super) struct Archive {
    pub(super) names: Vec<String>,
    /// Where the values of each channel begin [bytes].
    pub(super) starts: Vec<u64>,
    pub(super) rows: usize,
}

impl Archive {
    /// Of an open file.
    pub(super) fn of(file: &File) -> Result<Self, String> {
        let mut archive = ZipArchive::new(BufReader::new(file))
            .map_err(|why| format!("it is no complete NumPy archive ({why})"))?;
        let (mut names, mut starts, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
        for at in 0..archive.len() {
            let mut entry = archive.by_index(at).map_err(|why| format!("its channel {at}: {why}"))?;
            let name = entry.name().strip_suffix(".npy").unwrap_or(entry.name()).to_owned();
            let bad = |why: &str| format!("its channel `{name}` {why}");
            if entry.compression() != CompressionMethod::Stored {
                return Err(bad("is compressed; a run stores it as it is"));
            }
            let start = entry.data_start().ok_or_else(|| bad("lies nowhere"))?;
            let mut first = Vec::with_capacity(12);
            entry.by_ref().take(12).read_to_end(&mut first).map_err(|why| bad(&why.to_string()))?;
            let (prefix, length) = header::extent(&first).map_err(|why| bad(&why))?;
            if length > MAX_HEADER {
                return Err(bad("has a header that no run writes"));
            }
            let mut text = first[prefix.min(first.len())..].to_vec();
            let missing = (length as u64).saturating_sub(text.len() as u64);
            entry.by_ref().take(missing).read_to_end(&mut text).map_err(|why| bad(&why.to_string()))?;
            header::check_column(&text).map_err(|why| bad(&why))?;
            let skipped = (prefix + length) as u64;
            lengths.push(entry.size().saturating_sub(skipped) / 8);
            starts.push(start + skipped);
            names.push(name);
        }
        header::check_names(&names)?;
        let rows = lengths[0];
        if lengths.iter().any(|length| *length != rows) {
            return Err("its channels are not equally long".to_owned());
        }
        let held = file.metadata().map_err(|why| why.to_string())?.len();
        if starts.iter().any(|start| start.saturating_add(8 * rows) > held) {
            return Err("it ends before its channels do".to_owned());
        }
        Ok(Self { names, starts, rows: usize::try_from(rows).unwrap_or(usize::MAX) })
    }
}

/// Writes channels as an archive at `path`, as many at a time as need little memory: `columns` reads the
/// values of some of them.
pub(super) fn write(
    path: &Path,
    names: &[String],
    rows: usize,
    columns: impl Fn(&[String]) -> Result<Vec<Vec<f64>>, Error>,
) -> Result<(), Error> {
    let io = |source| Error::Io {
        action: "write",
        path: path.to_owned(),
        kept:
            "The samples stay readable in the rows that they were written in; free some space and continue \
            or repeat the run"
                .to_owned(),
        source,
    };
    let zipped = |why: zip::result::ZipError| io(why.into());
    let mut archive = ZipWriter::new(BufWriter::new(File::create(path).map_err(io)?));
    // A fixed time: equal runs write equal bytes.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(zip::DateTime::default())
        .large_file(true);
    let head = header::encode_column(rows);
    let at_once = (AT_ONCE / (8 * rows.max(1))).max(1);
    for group in names.chunks(at_once) {
        for (name, column) in group.iter().zip(columns(group)?) {
            archive.start_file(format!("{name}.npy"), options).map_err(zipped)?;
            archive.write_all(&head).map_err(io)?;
            let bytes: Vec<u8> = column.iter().flat_map(|value| value.to_le_bytes()).collect();
            archive.write_all(&bytes).map_err(io)?;
        }
    }
    let file = archive.finish().map_err(zipped)?.into_inner().map_err(|e| io(e.into_error()))?;
    file.sync_data().map_err(io)
}

/// Fills `bytes` with the values of a channel that begins at `start`, from the sample `first` on.
pub(super) fn read_column(
    file: &mut File,
    start: u64,
    first: usize,
    bytes: &mut [u8],
) -> std::io::Result<()> {
    file.seek(SeekFrom::Start(start + 8 * first as u64))?;
    file.read_exact(bytes)
}
