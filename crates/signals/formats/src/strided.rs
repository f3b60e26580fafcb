//! Numbers at equal distances in a file, and where they are counted instead.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::PathBuf;

use stribeck_dsp::channel::Samples;

use crate::number::Number;
use crate::{Channel, Error, Result};

/// Bytes read at a time.
const PIECE: usize = 1 << 18;

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

/// Runs of them, one after the other, with the number of samples in each.
#[derive(Debug, Clone)]
pub(crate) struct Pieces(pub(crate) Vec<(Strided, u64)>);

/// The number of each sample, from 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Count;

impl Strided {
    /// A channel of them.
    pub(crate) fn channel(self, name: impl Into<String>, len: u64) -> Channel {
        Channel::new(name, len, self)
    }
}

impl Pieces {
    /// A channel of all of them.
    pub(crate) fn channel(self, name: impl Into<String>) -> Channel {
        let len = self.0.iter().fold(0_u64, |sum, piece| sum.saturating_add(piece.1));
        Channel::new(name, len, self)
    }
}

/// `channel` with its samples taken from `bytes`, the content of the file, where they lie at equal distances.
pub(crate) fn held_from(channel: &Channel, bytes: &[u8]) -> Channel {
    let Some(s) = channel.samples_as::<Strided>() else { return channel.clone() };
    let first = usize::try_from(s.start).unwrap_or(usize::MAX).min(bytes.len());
    let samples = bytes[first..].chunks(s.stride.max(1)).take(channel.len as usize);
    let samples: Vec<f64> = samples.map(|at| s.factor * s.number.decode(at)).collect();
    let mut held = channel.clone();
    held.len = samples.len() as u64;
    held.through(|_| samples)
}

impl Samples for Strided {
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

impl Samples for Pieces {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let (mut left, mut going) = (len, true);
        for (strided, len) in &self.0 {
            let len = left.min(*len);
            left -= len;
            if going && len > 0 {
                strided.for_each_block(len, &mut |block| {
                    going = take(block);
                    going
                })?;
            }
        }
        Ok(())
    }
}

impl Samples for Count {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let step = (PIECE / 8) as u64;
        let mut from = 0;
        while from < len {
            let until = len.min(from + step);
            let block: Vec<f64> = (from..until).map(|n| n as f64).collect();
            if !take(&block) {
                break;
            }
            from = until;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use stribeck_testing::Scratch;

    use super::*;
    use crate::number::Kind;

    #[test]
    fn issue_a_channel_of_pieces_that_is_cut_short_ends_where_it_says() {
        let folder = Scratch::create("pieces");
        let path = folder.join("numbers");
        let bytes: Vec<u8> = (0..6).flat_map(|n| f64::from(n).to_le_bytes()).collect();
        std::fs::write(&path, bytes).unwrap();
        let from = |n: u64| {
            let (path, number) = (path.clone(), Number::little(Kind::F64));
            Strided { path, start: 8 * n, stride: 8, number, factor: 1.0 }
        };
        let mut channel = Pieces(vec![(from(4), 2), (from(0), 3)]).channel("a");
        assert_eq!(channel.read().unwrap(), [4.0, 5.0, 0.0, 1.0, 2.0]);
        channel.len = 3;
        assert_eq!(channel.read().unwrap(), [4.0, 5.0, 0.0]);
        channel.len = 2;
        assert_eq!(channel.read().unwrap(), [4.0, 5.0]);
    }
}
