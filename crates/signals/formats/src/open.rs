//! Opening a file: its format is recognised by its first bytes, and then by its name.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use stribeck_dsp::channel::memory;

use crate::recording::LEFT_OUT;
use crate::{
    Error, Recording, Result, clock_columns, csv, flac, mat4, mat5, mat73, mdf4, npy, npz, parquet, tdms,
    time, uff58, wav,
};

impl Recording {
    /// Opens a file, by its first bytes and then by its name. Samples of plain numbers stay in the file.
    /// Times are distinguished from signals, and define the sample rate where the file does not state it.
    ///
    /// # Errors
    /// [`Error::Unknown`] for a file of another kind, [`Error::Damaged`] for one that contradicts its format,
    /// [`Error::Unsupported`], [`Error::Number`], [`Error::Io`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let mut start = Vec::new();
        let kind = std::fs::metadata(path).map_err(|e| Error::read(path, e))?.file_type();
        if !kind.is_file() && !kind.is_dir() {
            // A pipe may never end, and is read more than once.
            let seen = "it is a pipe or a device, and no file: save it first".to_owned();
            return Err(Error::Unknown { path: path.to_owned(), seen });
        }
        let file = File::open(path).map_err(|e| Error::read(path, e))?;
        file.take(4096).read_to_end(&mut start).map_err(|e| Error::read(path, e))?;
        let begins = |magic: &[u8]| start.starts_with(magic);
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let unknown = |seen: &str| Err(Error::Unknown { path: path.to_owned(), seen: seen.to_owned() });
        if start.is_empty() {
            return unknown("it is empty");
        }
        if let Some((_, what)) = FOREIGN.iter().find(|(magic, _)| begins(magic)) {
            return unknown(what);
        }
        let opened = if begins(npy::MAGIC) {
            npy::open(path)
        } else if begins(b"PK") {
            npz::open(path)
        } else if begins(b"RIFF") || begins(b"RF64") || begins(b"BW64") {
            wav::open(path)
        } else if hdf5_begins(&start) || (begins(b"MATLAB 7.3") && start.len() > 512) {
            mat73::open(path)
        } else if mat5::recognise(&start) {
            mat5::open(path)
        } else if mat4::recognise(&start) {
            mat4::open(path)
        } else if begins(b"PAR1") {
            parquet::open(path)
        } else if begins(b"TDSm") {
            tdms::open(path)
        } else if begins(b"TDSh") {
            let partner = path.with_extension("tdms");
            return unknown(&format!(
                "it is the index of `{}`, and holds no sample: open that",
                partner.display()
            ));
        } else if begins(b"MDF") || begins(b"UnFinMF") {
            mdf4::open(path)
        } else if begins(b"fLaC") || flac::behind_tag(path)?.is_some() {
            flac::open(path)
        } else if uff58::recognise(&start) || matches!(extension.as_str(), "uff" | "unv" | "u58") {
            uff58::open(path)
        } else if start.contains(&0) && !csv::is_wide(&start) {
            unknown("its first bytes belong to no known format, and it is no text")
        } else {
            csv::open(path)
        }?;
        within_memory(&opened)?;
        let mut told = time::told(clock_columns::joined(opened)?)?.told_apart();
        told.notes = few(told.notes);
        Ok(told)
    }
}

/// At most ten of the notes on what is left out, and twenty others, and how many more there are.
fn few(notes: Vec<String>) -> Vec<String> {
    const SHOWN: [usize; 2] = [20, 10];
    let (out, rest): (Vec<String>, Vec<String>) = notes.into_iter().partition(|note| note.contains(LEFT_OUT));
    let more = |all: &[String], shown: usize, what: &str| {
        let more = all.len().saturating_sub(shown);
        (more > 0).then(|| format!("and {more} more {what}"))
    };
    let (of_rest, of_out) = (more(&rest, SHOWN[0], "notes"), more(&out, SHOWN[1], "are left out"));
    let rest = rest.into_iter().take(SHOWN[0]).chain(of_rest);
    rest.chain(out.into_iter().take(SHOWN[1])).chain(of_out).collect()
}

/// Whether HDF5 begins, behind a block of the user's at most.
fn hdf5_begins(start: &[u8]) -> bool {
    let signature = |at: usize| start.get(at..).is_some_and(|rest| rest.starts_with(b"\x89HDF\r\n\x1a\n"));
    [0, 512, 1024, 2048].into_iter().any(signature)
}

/// First bytes of files that are recognised and not read.
const FOREIGN: [(&[u8], &str); 7] = [
    (b"\x1f\x8b", "it is packed with gzip: unpack it first, with `gunzip`"),
    (b"BZh", "it is packed with bzip2: unpack it first, with `bunzip2`"),
    (b"\xfd7zXZ", "it is packed with xz: unpack it first, with `unxz`"),
    (b"\x28\xb5\x2f\xfd", "it is packed with zstd: unpack it first, with `unzstd`"),
    (b"CDF\x01", "it is NetCDF 3: turn it into version 4, with `nccopy -k nc4`"),
    (b"CDF\x02", "it is NetCDF 3: turn it into version 4, with `nccopy -k nc4`"),
    (b"OggS", "it is Ogg, which leaves out what ears do not miss: take the WAV or FLAC that it was made of"),
];

/// How many times its size on disk a record takes in memory that was packed as records are.
const PACKED: u64 = 64;

/// Refuses a small file that unpacks to more than memory may hold: a record of that length is no record, and
/// reading it would take as long as if it were one.
fn within_memory(recording: &Recording) -> Result<()> {
    let path = &recording.path;
    let size = std::fs::metadata(path).map_err(|e| Error::read(path, e))?.len();
    let longest = recording.channels.iter().max_by_key(|channel| channel.len);
    let bytes = longest.map_or(0, |channel| channel.len.saturating_mul(8));
    match longest.filter(|_| bytes / size.max(1) > PACKED) {
        Some(channel) => memory::ask(path, &format!("channel `{}`", channel.name), bytes),
        None => Ok(()),
    }
}
