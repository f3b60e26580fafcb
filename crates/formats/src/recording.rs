//! A file of signals: its channels, and their samples in blocks.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::curve::Curve;
use crate::number::Number;
use crate::{Error, Result, csv, flac, hdf5_chunks, mdf4_records, parquet};

/// Channels of one file.
#[derive(Debug, Clone)]
pub struct Recording {
    /// The file.
    pub path: PathBuf,
    /// Its format, in words.
    pub format: &'static str,
    /// Its channels, in the order of the file. Numbers that stand alone (a speed, a sensitivity) are channels
    /// of one sample.
    pub channels: Vec<Channel>,
    /// Irregularities of the file.
    pub notes: Vec<String>,
}

/// One sampled quantity.
#[derive(Debug, Clone)]
pub struct Channel {
    /// Its name in the file.
    pub name: String,
    /// Its unit, where the file states it.
    pub unit: Option<String>,
    /// Sample rate [Hz], where the file states it.
    pub rate_hz: Option<f64>,
    /// Number of samples.
    pub len: u64,
    /// Whether it is the time, or rises as evenly (a count, an angle), and so is no signal.
    pub is_time: bool,
    /// Channels of one group have one clock; empty where the format has no groups.
    pub(crate) group: String,
    /// Conversion of stored samples to values, where they differ.
    pub(crate) curve: Option<Arc<Curve>>,
    /// Factor of values.
    scale: f64,
    source: Source,
}

/// Where samples are.
#[derive(Debug, Clone)]
enum Source {
    Held(Arc<Vec<f64>>),
    /// The number of each sample, from 0.
    Count,
    Strided(Strided),
    /// One after the other, with the number of samples in each.
    Pieces(Arc<Vec<(Strided, u64)>>),
    Text(csv::Column),
    Flac(flac::Stream),
    Chunks(hdf5_chunks::Column),
    Records(mdf4_records::Field),
    Stored(parquet::Stored),
}

/// Numbers at equal distances in a file.
#[derive(Debug, Clone)]
pub(crate) struct Strided {
    pub(crate) path: PathBuf,
    /// First byte of the first number.
    pub(crate) start: u64,
    /// Bytes from one number to the next.
    pub(crate) stride: usize,
    pub(crate) number: Number,
    /// Factor of a stored number.
    pub(crate) factor: f64,
}

/// Bytes read at a time.
const PIECE: usize = 1 << 18;

impl Recording {
    /// The channel called `name`, that of the n-th column of a text for `column n`, or the only one whose
    /// name contains it.
    ///
    /// # Errors
    /// [`Error::NoChannel`] with the names that there are.
    pub fn channel(&self, name: &str) -> Result<&Channel> {
        if let Some(channel) = self.channels.iter().find(|c| c.name == name) {
            return Ok(channel);
        }
        // The headings of a table may be counts from 0, or names that are hard to type.
        let number = name.strip_prefix("column ").and_then(|n| n.trim().parse::<usize>().ok());
        let is_column = |c: &&Channel| matches!(&c.source, Source::Text(of) if Some(of.number()) == number);
        if let Some(channel) = self.channels.iter().find(is_column) {
            return Ok(channel);
        }
        let mut like = self.channels.iter().filter(|c| c.name.contains(name));
        match (like.next(), like.next()) {
            (Some(channel), None) => Ok(channel),
            _ => Err(Error::NoChannel { path: self.path.clone(), asked: name.to_owned(), has: self.names() }),
        }
    }

    /// Names and lengths of the channels, for messages.
    pub fn names(&self) -> String {
        const SHOWN: usize = 12;
        let mut all: Vec<String> =
            self.channels.iter().take(SHOWN).map(|c| format!("`{}` ({} samples)", c.name, c.len)).collect();
        if self.channels.len() > SHOWN {
            all.push(format!("{} more", self.channels.len() - SHOWN));
        }
        if all.is_empty() { "none".to_owned() } else { all.join(", ") }
    }
}

impl Channel {
    fn new(name: impl Into<String>, len: u64, source: Source) -> Self {
        Self {
            name: name.into(),
            unit: None,
            rate_hz: None,
            len,
            is_time: false,
            group: String::new(),
            curve: None,
            scale: 1.0,
            source,
        }
    }

    /// A channel whose samples are in memory.
    pub fn held(name: impl Into<String>, samples: Vec<f64>) -> Self {
        Self::new(name, samples.len() as u64, Source::Held(Arc::new(samples)))
    }

    /// A channel whose samples count from 0.
    pub(crate) fn counted(name: impl Into<String>, len: u64) -> Self {
        Self::new(name, len, Source::Count)
    }

    pub(crate) fn strided(name: impl Into<String>, len: u64, strided: Strided) -> Self {
        Self::new(name, len, Source::Strided(strided))
    }

    pub(crate) fn pieces(name: impl Into<String>, pieces: Vec<(Strided, u64)>) -> Self {
        let len = pieces.iter().fold(0_u64, |sum, piece| sum.saturating_add(piece.1));
        Self::new(name, len, Source::Pieces(Arc::new(pieces)))
    }

    pub(crate) fn text(name: impl Into<String>, len: u64, column: csv::Column) -> Self {
        Self::new(name, len, Source::Text(column))
    }

    pub(crate) fn flac(name: impl Into<String>, len: u64, stream: flac::Stream) -> Self {
        Self::new(name, len, Source::Flac(stream))
    }

    pub(crate) fn chunks(name: impl Into<String>, len: u64, column: hdf5_chunks::Column) -> Self {
        Self::new(name, len, Source::Chunks(column))
    }

    pub(crate) fn records(name: impl Into<String>, len: u64, field: mdf4_records::Field) -> Self {
        Self::new(name, len, Source::Records(field))
    }

    pub(crate) fn stored(name: impl Into<String>, len: u64, column: parquet::Stored) -> Self {
        Self::new(name, len, Source::Stored(column))
    }

    /// The same channel with its samples taken from `bytes`, the content of a file.
    pub(crate) fn held_from(&self, bytes: &[u8]) -> Self {
        let Source::Strided(s) = &self.source else { return self.clone() };
        let first = usize::try_from(s.start).unwrap_or(usize::MAX).min(bytes.len());
        let samples = bytes[first..].chunks(s.stride.max(1)).take(self.len as usize);
        let samples: Vec<f64> = samples.map(|at| s.factor * s.number.decode(at)).collect();
        Self { len: samples.len() as u64, source: Source::Held(Arc::new(samples)), ..self.clone() }
    }

    /// The same channel with a sample rate [Hz].
    pub fn at_rate(mut self, rate_hz: Option<f64>) -> Self {
        self.rate_hz = rate_hz;
        self
    }

    /// The same channel with every sample multiplied.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { scale: self.scale * factor, ..self.clone() }
    }

    /// The same channel with the law of its stored numbers.
    pub(crate) fn along(mut self, curve: Option<Curve>) -> Self {
        self.curve = curve.map(Arc::new);
        self
    }

    /// The same channel in a group with a clock of its own.
    pub(crate) fn of_group(mut self, group: &str) -> Self {
        group.clone_into(&mut self.group);
        self
    }

    /// The same channel in a unit.
    pub fn in_unit(mut self, unit: Option<String>) -> Self {
        self.unit = unit;
        self
    }

    /// Passes all samples to `take`, a block at a time, in order; `take` returns false to stop.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Number`], [`Error::Damaged`] for a file that ends early.
    pub fn for_each_block(&self, mut take: impl FnMut(&[f64]) -> bool) -> Result<()> {
        if self.scale != 1.0 || self.curve.is_some() {
            let mut scaled = Vec::new();
            let value = |x: &f64| self.scale * self.curve.as_ref().map_or(*x, |curve| curve.at(*x));
            return self.for_each_stored(&mut |block| {
                scaled.clear();
                scaled.extend(block.iter().map(value));
                take(&scaled)
            });
        }
        self.for_each_stored(&mut take)
    }

    fn for_each_stored(&self, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        match &self.source {
            Source::Held(samples) => {
                for block in samples.chunks(PIECE / 8) {
                    if !take(block) {
                        break;
                    }
                }
                Ok(())
            }
            Source::Count => {
                let step = (PIECE / 8) as u64;
                let mut from = 0;
                while from < self.len {
                    let until = self.len.min(from + step);
                    let block: Vec<f64> = (from..until).map(|n| n as f64).collect();
                    if !take(&block) {
                        break;
                    }
                    from = until;
                }
                Ok(())
            }
            Source::Strided(strided) => strided.for_each_block(self.len, take),
            Source::Pieces(pieces) => {
                let mut going = true;
                for (strided, len) in pieces.iter() {
                    if going {
                        strided.for_each_block(*len, &mut |block| {
                            going = take(block);
                            going
                        })?;
                    }
                }
                Ok(())
            }
            Source::Text(column) => column.for_each_block(self.len, take),
            Source::Flac(stream) => stream.for_each_block(self.len, take),
            Source::Chunks(column) => column.for_each_block(self.len, take),
            Source::Records(field) => field.for_each_block(self.len, take),
            Source::Stored(column) => column.for_each_block(self.len, take),
        }
    }

    /// All samples.
    ///
    /// # Errors
    /// As [`Channel::for_each_block`].
    pub fn read(&self) -> Result<Vec<f64>> {
        let mut all = Vec::with_capacity(usize::try_from(self.len).unwrap_or(0).min(1 << 28));
        self.for_each_block(|block| {
            all.extend_from_slice(block);
            true
        })?;
        Ok(all)
    }
}

impl Strided {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let io = |e| Error::read(&self.path, e);
        let mut file = BufReader::new(File::open(&self.path).map_err(io)?);
        file.seek(SeekFrom::Start(self.start)).map_err(io)?;
        let width = self.number.kind.bytes();
        let rows = (PIECE / self.stride.max(1)).max(1) as u64;
        let mut bytes = Vec::new();
        let mut block = Vec::new();
        let mut done = 0;
        while done < len {
            let count = rows.min(len - done) as usize;
            // The last number of a block needs no bytes behind it.
            bytes.resize((count - 1) * self.stride + width, 0);
            file.read_exact(&mut bytes).map_err(io)?;
            block.clear();
            block.extend(bytes.chunks(self.stride).map(|at| self.factor * self.number.decode(at)));
            if !take(&block) {
                return Ok(());
            }
            done += count as u64;
            file.seek_relative((self.stride - width) as i64).map_err(io)?;
        }
        Ok(())
    }
}

/// Why a channel is none, in the words that all formats use.
pub(crate) fn left_out(name: &str, why: &str) -> String {
    format!("`{name}` is left out: {why}")
}

/// Refuses channels of different lengths, which a table cannot hold; returns that length.
pub(crate) fn equal_lengths(path: &Path, format: &'static str, channels: &[Channel]) -> Result<u64> {
    let len = channels.first().map_or(0, |c| c.len);
    match channels.iter().find(|c| c.len != len) {
        None => Ok(len),
        Some(other) => Err(Error::DoesNotFit {
            path: path.to_owned(),
            format,
            what: format!(
                "`{}` has {len} samples and `{}` has {}; write them to a file each",
                channels[0].name, other.name, other.len
            ),
        }),
    }
}
