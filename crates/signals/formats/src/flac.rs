//! FLAC: whole numbers of up to 24 bits, scaled to ±1 as those of WAV. Read only: FLAC holds no
//! floating-point numbers, and WAV does.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use claxon::FlacReader;
use stribeck_dsp::channel::{Samples, memory};

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
pub fn open(path: &Path) -> Result<Recording> {
    let info = reader(path)?.streaminfo();
    let mut most = memory::most_bytes() / 8;
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
                // What is longer is refused, and need not be counted to its end.
                most = most.saturating_sub(u64::from(block.duration()));
                most > 0
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

/// Where FLAC begins behind a tag ID3, which players of music put before it; `None` for a file without one.
pub(crate) fn behind_tag(path: &Path) -> Result<Option<u64>> {
    let io = |e| Error::read(path, e);
    let mut file = File::open(path).map_err(io)?;
    let mut at = 0;
    loop {
        let mut head = Vec::new();
        file.seek(SeekFrom::Start(at)).map_err(io)?;
        file.by_ref().take(10).read_to_end(&mut head).map_err(io)?;
        if head.starts_with(b"fLaC") && at > 0 {
            return Ok(Some(at));
        }
        if !head.starts_with(b"ID3") || head.len() < 10 {
            return Ok(None);
        }
        // Seven bits a byte (ID3v2.4, §3.1); a footer is as long as the head.
        let length = head[6..10].iter().fold(0_u64, |n, byte| n << 7 | u64::from(byte & 0x7f));
        at += 10 + length + if head[5] & 0x10 == 0 { 0 } else { 10 };
    }
}

fn reader(path: &Path) -> Result<FlacReader<BufReader<File>>> {
    let mut file = File::open(path).map_err(|e| Error::read(path, e))?;
    file.seek(SeekFrom::Start(behind_tag(path)?.unwrap_or(0))).map_err(|e| Error::read(path, e))?;
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
