//! FLAC: whole numbers of up to 24 bits, scaled to ±1 as those of WAV. Read only: FLAC holds no
//! floating-point numbers, and WAV does.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use claxon::FlacReader;
use stribeck_dsp::channel::Samples;

use crate::{Channel, Error, Recording, Result};

const FORMAT: &str = "FLAC";

/// One channel of a file, decoded anew each time it is read.
#[derive(Debug, Clone)]
pub(crate) struct Stream {
    path: PathBuf,
    channel: u32,
    factor: f64,
}

/// Opens a file; channels are called `1`, `2`, … and their samples stay in the file.
///
/// # Errors
/// [`Error::Damaged`], [`Error::Io`].
pub fn open(path: &Path) -> Result<Recording> {
    let info = reader(path)?.streaminfo();
    if info.sample_rate == 0 || info.channels == 0 || info.bits_per_sample == 0 {
        return Err(Error::damaged(path, FORMAT, "it has no sample rate, no channels or no bits"));
    }
    let factor = 0.5_f64.powi(info.bits_per_sample as i32 - 1);
    let mut notes = Vec::new();
    let len = match info.samples {
        Some(len) => len,
        None => {
            notes.push("its length is not said in its head, and was counted".to_owned());
            let mut len = 0;
            blocks(path, |block| {
                len += u64::from(block.duration());
                true
            })?;
            len
        }
    };
    let channel = |n: u32| {
        let stream = Stream { path: path.to_owned(), channel: n, factor };
        Channel::new((n + 1).to_string(), len, stream).at_rate(Some(f64::from(info.sample_rate)))
    };
    Ok(Recording {
        path: path.to_owned(),
        format: FORMAT,
        channels: (0..info.channels).map(channel).collect(),
        notes,
    })
}

impl Samples for Stream {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let (mut left, mut going) = (len, true);
        let mut samples = Vec::new();
        blocks(&self.path, |block| {
            samples.clear();
            let of = if self.channel < block.channels() { block.channel(self.channel) } else { &[] };
            let count = (of.len() as u64).min(left) as usize;
            samples.extend(of[..count].iter().map(|x| self.factor * f64::from(*x)));
            left -= count as u64;
            going = take(&samples);
            going && left > 0
        })?;
        if going && left > 0 {
            let what = format!("it promises {len} samples, and ends {left} before that");
            return Err(Error::damaged(&self.path, FORMAT, what));
        }
        Ok(())
    }
}

fn reader(path: &Path) -> Result<FlacReader<BufReader<File>>> {
    let file = File::open(path).map_err(|e| Error::read(path, e))?;
    FlacReader::new(BufReader::new(file)).map_err(|why| broken(path, why))
}

/// Passes every block to `take` until it returns false.
fn blocks(path: &Path, mut take: impl FnMut(&claxon::Block) -> bool) -> Result<()> {
    let mut reader = reader(path)?;
    let mut blocks = reader.blocks();
    let mut buffer = Vec::new();
    while let Some(block) = blocks.read_next_or_eof(buffer).map_err(|why| broken(path, why))? {
        if !take(&block) {
            break;
        }
        buffer = block.into_buffer();
    }
    Ok(())
}

fn broken(path: &Path, why: claxon::Error) -> Error {
    match why {
        claxon::Error::IoError(source) if source.kind() != std::io::ErrorKind::UnexpectedEof => {
            Error::read(path, source)
        }
        other => Error::damaged(path, FORMAT, other.to_string()),
    }
}
