//! MDF 4 (ASAM): channels of whole bytes in sorted groups, with or without a linear conversion, in plain, listed or deflated
//! blocks. Read only.
//!
//! Each channel is called by its name; the rate is that of its group's master. Channels of bits, texts and other conversions
//! are left out with a note. Samples stay in the file; deflated blocks are unpacked one by one.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::mdf4_records::{Field, Packing, Stretch};
use crate::number::{Kind, Number};
use crate::recording::Strided;
use crate::{Channel, Error, Recording, Result};

const FORMAT: &str = "MDF";
/// Bytes before the links of a block.
const HEAD: u64 = 24;
/// Links of a block and blocks of a chain; a forged file may point in circles.
const MOST_LINKS: u64 = 1 << 20;
/// Largest block that describes something.
const LARGEST: u64 = 1 << 24;
/// Most bytes that one block unpacks to; the standard asks for 4 MiB.
const UNPACKED: u64 = 1 << 28;
/// Part of a step by which the times of a master may be off the grid.
const UNEVEN: f64 = 0.01;

/// Opens a file of version 4.
///
/// # Errors
/// [`Error::Damaged`], [`Error::Unsupported`] for version 3, [`Error::Io`].
pub fn open(path: &Path) -> Result<Recording> {
    let io = |e| Error::read(path, e);
    let mut file = BufReader::new(File::open(path).map_err(io)?);
    let size = file.get_ref().metadata().map_err(io)?.len();
    let mut source = Source { path: path.to_owned(), file: &mut file, size };
    let head = source.bytes(0, 64)?;
    let version = u16::from_le_bytes([head[28], head[29]]);
    if version < 400 {
        return Err(Error::Unsupported {
            path: path.to_owned(),
            format: FORMAT,
            what: format!("version {}.{:02}", version / 100, version % 100),
            advice: "save it as version 4",
        });
    }
    let mut found = Found { channels: Vec::new(), notes: Vec::new() };
    let mut at = source.block(64, b"##HD")?.link(0);
    let mut seen = 0;
    while at != 0 {
        let group = source.block(at, b"##DG")?;
        found.data_group(&mut source, &group)?;
        at = group.link(0);
        seen += 1;
        if seen > MOST_LINKS {
            return Err(Error::damaged(path, FORMAT, "its groups point in a circle"));
        }
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels: found.channels, notes: found.notes })
}

/// The file and how long it is.
struct Source<'a> {
    path: PathBuf,
    file: &'a mut BufReader<File>,
    size: u64,
}

/// A block without its data.
struct Block {
    links: Vec<u64>,
    data: Vec<u8>,
}

impl Block {
    /// Address, 0 for none.
    fn link(&self, n: usize) -> u64 {
        self.links.get(n).copied().unwrap_or(0)
    }

    fn byte(&self, at: usize) -> u8 {
        self.data.get(at).copied().unwrap_or(0)
    }

    fn word(&self, at: usize) -> u32 {
        u32::from_le_bytes([0, 1, 2, 3].map(|n| self.byte(at + n)))
    }

    fn long(&self, at: usize) -> u64 {
        u64::from(self.word(at)) | u64::from(self.word(at + 4)) << 32
    }
}

impl Source<'_> {
    fn damaged(&self, what: impl Into<String>) -> Error {
        Error::damaged(&self.path, FORMAT, what)
    }

    fn bytes(&mut self, at: u64, count: u64) -> Result<Vec<u8>> {
        if at.checked_add(count).is_none_or(|end| end > self.size) {
            return Err(self.damaged(format!("{count} bytes at {at} lie behind its end")));
        }
        let mut bytes = vec![0; count as usize];
        let io = |e| Error::read(&self.path, e);
        self.file.seek(SeekFrom::Start(at)).map_err(io)?;
        self.file.read_exact(&mut bytes).map_err(io)?;
        Ok(bytes)
    }

    /// Its sort, its length and its number of links.
    fn head(&mut self, at: u64) -> Result<([u8; 4], u64, u64)> {
        let head = Block { links: Vec::new(), data: self.bytes(at, HEAD)? };
        let [a, b, c, d] = [0, 1, 2, 3].map(|n| head.byte(n));
        Ok(([a, b, c, d], head.long(8), head.long(16)))
    }

    /// A block that describes something, of the sort that must stand there.
    fn block(&mut self, at: u64, sort: &[u8; 4]) -> Result<Block> {
        let (found, length, links) = self.head(at)?;
        if found != *sort || links > MOST_LINKS || !(HEAD + 8 * links..=LARGEST).contains(&length) {
            return Err(self.damaged(format!("no {} block at {at}", String::from_utf8_lossy(sort))));
        }
        let body = Block { links: Vec::new(), data: self.bytes(at + HEAD, length - HEAD)? };
        let all = (0..links as usize).map(|n| body.long(8 * n)).collect();
        Ok(Block { links: all, data: body.data[8 * links as usize..].to_vec() })
    }

    /// Text of a TX block, or that in the TX element of an MD block.
    fn text(&mut self, at: u64) -> Result<Option<String>> {
        if at == 0 {
            return Ok(None);
        }
        let (sort, _, _) = self.head(at)?;
        let block = self.block(at, if &sort == b"##MD" { b"##MD" } else { b"##TX" })?;
        let text = String::from_utf8_lossy(&block.data).trim_end_matches('\0').trim().to_owned();
        let inner = |text: &str| Some(text.split_once("<TX>")?.1.split_once("</TX>")?.0.to_owned());
        let text = if &sort == b"##MD" { inner(&text).unwrap_or_default() } else { text };
        Ok(Some(text).filter(|t| !t.is_empty()))
    }

    /// Where the records of a group are.
    fn data(&mut self, at: u64) -> Result<Vec<Stretch>> {
        let mut data = Vec::new();
        if at != 0 {
            self.collect(at, &mut data, 0)?;
        }
        Ok(data)
    }

    fn collect(&mut self, at: u64, data: &mut Vec<Stretch>, depth: u32) -> Result<()> {
        let (sort, length, links) = self.head(at)?;
        match &sort {
            b"##DT" if length >= HEAD && links == 0 => {
                let count = length - HEAD;
                if at.saturating_add(length) > self.size {
                    return Err(self.damaged(format!("the samples at {at} end behind the file")));
                }
                data.push(Stretch { at: at + HEAD, stored: count, full: count, packing: Packing::Plain });
            }
            b"##DZ" => {
                let packed = self.bytes(at, HEAD + 24)?;
                let head = Block { links: Vec::new(), data: packed[HEAD as usize..].to_vec() };
                let (kind, parameter) = (head.byte(2), head.word(4) as usize);
                let (full, stored) = (head.long(8), head.long(16));
                let start = at + HEAD + 24;
                if full > UNPACKED || kind > 1 || start.saturating_add(stored) > self.size {
                    return Err(self.damaged(format!("the packed samples at {at} cannot be unpacked")));
                }
                let packing = if kind == 1 { Packing::Transposed(parameter) } else { Packing::Deflated };
                data.push(Stretch { at: start, stored, full, packing });
            }
            b"##HL" if depth < 2 => {
                let list = self.block(at, b"##HL")?.link(0);
                self.collect(list, data, depth + 1)?;
            }
            b"##DL" if depth < 3 => {
                let (mut at, mut seen) = (at, 0);
                while at != 0 {
                    let list = self.block(at, b"##DL")?;
                    for part in list.links.iter().skip(1).filter(|part| **part != 0) {
                        self.collect(*part, data, 3)?;
                    }
                    at = list.link(0);
                    seen += 1;
                    if seen > MOST_LINKS || data.len() as u64 > MOST_LINKS {
                        return Err(self.damaged("its lists of samples point in a circle"));
                    }
                }
            }
            other => {
                let what = format!("samples in a `{}` block", String::from_utf8_lossy(other));
                let advice = "save it with plain or deflated data blocks";
                return Err(Error::Unsupported { path: self.path.clone(), format: FORMAT, what, advice });
            }
        }
        Ok(())
    }
}

struct Found {
    channels: Vec<Channel>,
    notes: Vec<String>,
}

/// What is known of one channel.
struct Described {
    name: String,
    unit: Option<String>,
    /// Whether it is the time of its group.
    master: bool,
    place: usize,
    number: Number,
    /// `offset + factor · stored`.
    linear: (f64, f64),
}

impl Found {
    fn data_group(&mut self, source: &mut Source, group: &Block) -> Result<()> {
        let first = group.link(1);
        if first == 0 {
            return Ok(());
        }
        let of = source.block(first, b"##CG")?;
        if of.link(0) != 0 || group.byte(0) != 0 {
            self.notes.push("a group of mixed records is left out: sort the file first".to_owned());
            return Ok(());
        }
        let (cycles, width) = (of.long(8), of.word(24) as usize + of.word(28) as usize);
        if width == 0 || cycles == 0 {
            return Ok(());
        }
        let mut described = Vec::new();
        let (mut at, mut seen) = (of.link(1), 0);
        while at != 0 {
            let channel = source.block(at, b"##CN")?;
            match describe(source, &channel)? {
                Ok(channel) if channel.place + channel.number.kind.bytes() <= width => {
                    described.push(channel)
                }
                Ok(channel) => {
                    return Err(source.damaged(format!("`{}` lies behind its record", channel.name)));
                }
                Err(left_out) => self.notes.push(left_out),
            }
            at = channel.link(0);
            seen += 1;
            if seen > MOST_LINKS {
                return Err(source.damaged("its channels point in a circle"));
            }
        }
        let data = Arc::new(source.data(group.link(2))?);
        let bytes = data.iter().fold(0_u64, |sum, s| sum.saturating_add(s.full));
        let there = (bytes / width as u64).min(cycles);
        if there < cycles {
            self.notes.push(format!("a group promises {cycles} samples, and {there} are there"));
        }
        let channels: Vec<Channel> =
            described.iter().map(|of| of.channel(&source.path, &data, width, there)).collect();
        let rate_hz = match described.iter().position(|of| of.master) {
            Some(n) => rate(&channels[n], &mut self.notes)?,
            None => None,
        };
        // Groups of one name keep apart.
        for (mut channel, of) in channels.into_iter().zip(&described) {
            channel.is_time = of.master;
            if self.channels.iter().any(|c| c.name == channel.name) {
                channel.name = format!("{} ({})", channel.name, self.channels.len() + 1);
            }
            self.channels.push(channel.at_rate(rate_hz));
        }
        Ok(())
    }
}

/// A channel, or why it is left out.
fn describe(source: &mut Source, block: &Block) -> Result<std::result::Result<Described, String>> {
    let name = source.text(block.link(2))?.unwrap_or_else(|| "channel".to_owned());
    let unit = source.text(block.link(6))?;
    let (sort, sync, data_type, bit) = (block.byte(0), block.byte(1), block.byte(2), block.byte(3));
    let (place, bits) = (block.word(4) as usize, block.word(8));
    let left_out = |why: &str| Ok(Err(format!("`{name}` is left out: {why}")));
    let kind = match (data_type, bits) {
        (0 | 1, 8) => Kind::U8,
        (0 | 1, 16) => Kind::U16,
        (0 | 1, 32) => Kind::U32,
        (0 | 1, 64) => Kind::U64,
        (2 | 3, 8) => Kind::I8,
        (2 | 3, 16) => Kind::I16,
        (2 | 3, 24) => Kind::I24,
        (2 | 3, 32) => Kind::I32,
        (2 | 3, 64) => Kind::I64,
        (4 | 5, 32) => Kind::F32,
        (4 | 5, 64) => Kind::F64,
        _ => {
            let what = if data_type > 5 { "it is no number" } else { "its numbers are no whole bytes" };
            return left_out(what);
        }
    };
    if bit != 0 || block.link(1) != 0 {
        return left_out("it is made of parts");
    }
    if !matches!(sort, 0 | 2) {
        return left_out(if sort == 3 {
            "it is counted, not stored"
        } else {
            "its values are of varying length"
        });
    }
    let linear = match block.link(4) {
        0 => (0.0, 1.0),
        at => {
            let conversion = source.block(at, b"##CC")?;
            let value = |n: usize| f64::from_bits(conversion.long(24 + 8 * n));
            match conversion.byte(0) {
                0 => (0.0, 1.0),
                1 => (value(0), value(1)),
                _ => return left_out("its conversion is not linear"),
            }
        }
    };
    let number = Number { kind, big_endian: matches!(data_type, 1 | 3 | 5) };
    let unit = match unit {
        Some(unit) => Some(unit),
        None if block.link(4) != 0 => {
            let at = source.block(block.link(4), b"##CC")?.link(1);
            source.text(at)?
        }
        None => None,
    };
    let master = sort == 2 && sync == 1;
    Ok(Ok(Described { name, unit, master, place, number, linear }))
}

impl Described {
    fn channel(&self, path: &Path, data: &Arc<Vec<Stretch>>, width: usize, len: u64) -> Channel {
        let (offset, factor) = self.linear;
        let whole = |s: &Stretch| s.packing == Packing::Plain && s.full.is_multiple_of(width as u64);
        let channel = if data.iter().all(whole) && offset == 0.0 {
            let mut left = len;
            let pieces = data.iter().map(|stretch| {
                let records = (stretch.full / width as u64).min(left);
                left -= records;
                let start = stretch.at + self.place as u64;
                let path = path.to_owned();
                (Strided { path, start, stride: width, number: self.number, factor }, records)
            });
            Channel::pieces(&self.name, pieces.collect())
        } else {
            let field = Field {
                path: path.to_owned(),
                format: FORMAT,
                stretches: data.clone(),
                width,
                place: self.place,
                number: self.number,
                linear: self.linear,
            };
            Channel::records(&self.name, len, field)
        };
        channel.in_unit(self.unit.clone())
    }
}

/// The rate of evenly spaced times; none for others, with a note.
fn rate(master: &Channel, notes: &mut Vec<String>) -> Result<Option<f64>> {
    let (mut first, mut last, mut count) = (f64::NAN, f64::NAN, 0_u64);
    master.for_each_block(|block| {
        if count == 0 {
            first = block.first().copied().unwrap_or(f64::NAN);
        }
        last = block.last().copied().unwrap_or(last);
        count += block.len() as u64;
        true
    })?;
    let step = (last - first) / (count.max(2) - 1) as f64;
    if count < 2 || !step.is_finite() || step <= 0.0 {
        return Ok(None);
    }
    let (mut n, mut off) = (0_u64, 0.0_f64);
    master.for_each_block(|block| {
        for t in block {
            off = off.max((t - first - step * n as f64).abs());
            n += 1;
        }
        true
    })?;
    if off > UNEVEN * step {
        notes.push(format!(
            "the times of `{}` are uneven: give the rate by hand if that is meant",
            master.name
        ));
        return Ok(None);
    }
    // Times in seconds have fifteen digits; a rate of a whole number of hertz was meant as one.
    let rate = 1.0 / step;
    Ok(Some(if (rate - rate.round()).abs() < 1e-6 * rate { rate.round() } else { rate }))
}
