//! Samples of an MDF group whose records are deflated, or begin in one block and end in the next: one block
//! at a time.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::PathBuf;
use std::sync::Arc;

use flate2::read::ZlibDecoder;
use stribeck_dsp::channel::Samples;

use crate::number::Number;
use crate::{Error, Result};

/// Bytes read at a time where they are plain.
const PIECE: u64 = 1 << 18;

/// A stretch of the file with records, or with parts of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    /// First byte.
    pub(crate) at: u64,
    /// Bytes in the file.
    pub(crate) stored: u64,
    /// Bytes of records.
    pub(crate) full: u64,
    pub(crate) packing: Packing,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Packing {
    Plain,
    Deflated,
    /// Rows of this many bytes were written column by column before they were deflated.
    Transposed(usize),
}

/// One channel of the records.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pub(crate) path: PathBuf,
    pub(crate) format: &'static str,
    pub(crate) stretches: Arc<Vec<Stretch>>,
    /// Bytes of a record, and where in it the number stands.
    pub(crate) width: usize,
    pub(crate) place: usize,
    pub(crate) number: Number,
    /// Byte and bit of a record that mark its sample as invalid.
    pub(crate) invalid: Option<(usize, u8)>,
}

impl Field {
    /// Puts `count` bytes of records behind `bytes`: the next ones of a plain stretch, all of a packed one.
    fn append(
        &self,
        file: &mut BufReader<File>,
        stretch: &Stretch,
        count: u64,
        bytes: &mut Vec<u8>,
    ) -> Result<()> {
        let io = |e| Error::read(&self.path, e);
        let before = bytes.len();
        let read = match stretch.packing {
            Packing::Plain => file.take(count).read_to_end(bytes).map_err(io),
            Packing::Deflated | Packing::Transposed(_) => {
                let broken = |_| self.damaged(stretch, "do not unpack");
                ZlibDecoder::new(file.take(stretch.stored)).take(count).read_to_end(bytes).map_err(broken)
            }
        }?;
        if read as u64 != count {
            return Err(self.damaged(stretch, "end early"));
        }
        if let Packing::Transposed(columns) = stretch.packing {
            let rows = transposed(&bytes[before..], columns);
            bytes.truncate(before);
            bytes.extend(rows);
        }
        Ok(())
    }

    fn damaged(&self, stretch: &Stretch, what: &str) -> Error {
        Error::damaged(&self.path, self.format, format!("the samples at {} {what}", stretch.at))
    }
}

impl Samples for Field {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let io = |e| Error::read(&self.path, e);
        let mut file = BufReader::new(File::open(&self.path).map_err(io)?);
        let sample = |record: &[u8]| match self.invalid {
            Some((byte, bit)) if record[byte] >> bit & 1 == 1 => f64::NAN,
            _ => self.number.decode(&record[self.place..]),
        };
        // The beginning of a record whose end stands in the next stretch.
        let (mut bytes, mut block): (Vec<u8>, Vec<f64>) = (Vec::new(), Vec::new());
        let mut left = len;
        for stretch in self.stretches.iter() {
            file.seek(SeekFrom::Start(stretch.at)).map_err(io)?;
            let mut unread = stretch.full;
            while unread > 0 {
                let count = if stretch.packing == Packing::Plain { unread.min(PIECE) } else { unread };
                self.append(&mut file, stretch, count, &mut bytes)?;
                unread -= count;
                block.clear();
                let whole = (bytes.len() / self.width).min(usize::try_from(left).unwrap_or(usize::MAX));
                let records = bytes.chunks_exact(self.width).take(whole);
                block.extend(records.map(sample));
                bytes.drain(..whole * self.width);
                left -= whole as u64;
                if !block.is_empty() && !take(&block) || left == 0 {
                    return Ok(());
                }
            }
        }
        Ok(())
    }
}

/// Rows of `columns` bytes, whose columns were stored one after the other; a remainder that fills no row
/// stays at the end.
fn transposed(bytes: &[u8], columns: usize) -> Vec<u8> {
    let rows = bytes.len().checked_div(columns).unwrap_or(0);
    let mut out = Vec::with_capacity(bytes.len());
    for row in 0..rows {
        out.extend((0..columns).map(|column| bytes[column * rows + row]));
    }
    out.extend(&bytes[rows * columns..]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Kind;
    use std::io::Write;

    #[test]
    fn by_hand_records_go_on_in_the_next_block() {
        // Records of six bytes with a number of 16 bits at byte 4; a plain block of 20 bytes, and two packed
        // ones.
        let records: Vec<u8> =
            (0..40_u16).flat_map(|n| [if n == 7 { 8 } else { 4 }, 9, 9, 9, (3 * n) as u8, 0]).collect();
        let deflated = |bytes: &[u8]| {
            let mut to = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
            to.write_all(bytes).unwrap();
            to.finish().unwrap()
        };
        let (a, b, c) = (&records[..20], &records[20..100], &records[100..]);
        // 80 bytes as columns of 6: 13 rows and 2 bytes that fill none.
        let columns: Vec<u8> =
            (0..78).map(|n| b[n % 13 * 6 + n / 13]).chain(b[78..].iter().copied()).collect();
        let stored = [a.to_vec(), deflated(&columns), deflated(c)];
        let path = std::env::temp_dir().join(format!("stribeck-mdf-{}.bin", std::process::id()));
        std::fs::write(&path, stored.concat()).unwrap();
        let packings = [Packing::Plain, Packing::Transposed(6), Packing::Deflated];
        let mut at = 0;
        let stretches = stored.iter().zip([a, b, c]).zip(packings).map(|((bytes, full), packing)| {
            let stretch = Stretch { at, stored: bytes.len() as u64, full: full.len() as u64, packing };
            at += stretch.stored;
            stretch
        });
        let field = Field {
            path: path.clone(),
            format: "MDF",
            stretches: Arc::new(stretches.collect()),
            width: 6,
            place: 4,
            number: Number::little(Kind::U16),
            invalid: Some((0, 3)),
        };
        let read = |field: &Field| {
            let mut all = Vec::new();
            field.for_each_block(39, &mut |block| {
                all.extend_from_slice(block);
                true
            })?;
            Ok::<_, Error>(all)
        };
        let all = read(&field).unwrap();
        let expected = |n: i32| if n == 7 { f64::NAN } else { 3.0 * f64::from(n) };
        assert_eq!(format!("{all:?}"), format!("{:?}", (0..39).map(expected).collect::<Vec<_>>()));
        // A block that is shorter than its header states.
        let mut short = field.stretches.to_vec();
        short[1].full += 1;
        let why = read(&Field { stretches: Arc::new(short), ..field }).unwrap_err();
        assert!(why.to_string().contains("end early"), "{why}");
        std::fs::remove_file(path).unwrap();
    }
}
