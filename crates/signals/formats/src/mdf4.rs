//! MDF 4 (ASAM): channels of whole bytes in sorted groups, in plain, listed or deflated blocks. Read only.
//!
//! Each channel has its name; the rate is that of its group's master, stored or virtual. A sample whose
//! invalidation bit is set is no number. Channels of bits, of texts and with conversions to texts are left
//! out with a note. Samples stay in the file; deflated blocks are unpacked one by one.

mod channel;

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use channel::{Described, describe};

use crate::mdf4_records::{Packing, Stretch};
use crate::recording::left_out;
use crate::{Channel, Error, Recording, Result};

pub(crate) const FORMAT: &str = "MDF";
/// Bytes before the links of a block.
const HEAD: u64 = 24;
/// Links of a block and blocks of a chain; a forged file may point in circles.
const MOST_LINKS: u64 = 1 << 20;
/// Largest block that describes something.
const LARGEST: u64 = 1 << 24;
/// Most bytes that one block unpacks to; the standard asks for 4 MiB.
const UNPACKED: u64 = 1 << 28;

/// Opens a file of version 4.
///
/// # Errors
/// [`Error::Damaged`], [`Error::Unsupported`] for version 3, [`Error::Io`].
pub fn open(path: &Path) -> Result<Recording> {
    let io = |e| Error::read(path, e);
    let mut file = BufReader::new(File::open(path).map_err(io)?);
    let size = file.get_ref().metadata().map_err(io)?.len();
    let mut source = Source { path: path.to_owned(), file: &mut file, size, unfinished: false };
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
    if head.starts_with(b"UnFin") {
        source.unfinished = true;
        found.notes.push(
            "the recorder did not finish the file: its samples are counted, and the last may be missing"
                .to_owned(),
        );
    }
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
pub(crate) struct Source<'a> {
    pub(crate) path: PathBuf,
    file: &'a mut BufReader<File>,
    size: u64,
    /// Whether counts and lengths may not be up to date.
    unfinished: bool,
}

/// A block without its data.
pub(crate) struct Block {
    pub(crate) links: Vec<u64>,
    pub(crate) data: Vec<u8>,
}

impl Block {
    pub(crate) fn float(&self, at: usize) -> f64 {
        f64::from_bits(self.long(at))
    }

    /// Address, 0 for none.
    pub(crate) fn link(&self, n: usize) -> u64 {
        self.links.get(n).copied().unwrap_or(0)
    }

    pub(crate) fn byte(&self, at: usize) -> u8 {
        self.data.get(at).copied().unwrap_or(0)
    }

    pub(crate) fn word(&self, at: usize) -> u32 {
        u32::from_le_bytes([0, 1, 2, 3].map(|n| self.byte(at + n)))
    }

    pub(crate) fn long(&self, at: usize) -> u64 {
        u64::from(self.word(at)) | u64::from(self.word(at + 4)) << 32
    }
}

impl Source<'_> {
    pub(crate) fn damaged(&self, what: impl Into<String>) -> Error {
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
    pub(crate) fn block(&mut self, at: u64, sort: &[u8; 4]) -> Result<Block> {
        let (found, length, links) = self.head(at)?;
        if found != *sort || links > MOST_LINKS || !(HEAD + 8 * links..=LARGEST).contains(&length) {
            return Err(self.damaged(format!("no {} block at {at}", String::from_utf8_lossy(sort))));
        }
        let body = Block { links: Vec::new(), data: self.bytes(at + HEAD, length - HEAD)? };
        let all = (0..links as usize).map(|n| body.long(8 * n)).collect();
        Ok(Block { links: all, data: body.data[8 * links as usize..].to_vec() })
    }

    /// Text of a TX block, or that in the TX element of an MD block.
    pub(crate) fn text(&mut self, at: u64) -> Result<Option<String>> {
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
                // The length of the last one is written when the file is closed.
                let to_end = self.size - at.min(self.size);
                let length =
                    if self.unfinished && (length == HEAD || length > to_end) { to_end } else { length };
                let count = length - HEAD.min(length);
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
        let (mut cycles, data_bytes) = (of.long(8), of.word(24) as usize);
        let width = data_bytes + of.word(28) as usize;
        if source.unfinished {
            // Counts are written when the file is closed.
            cycles = u64::MAX;
        }
        if cycles == 0 {
            return Ok(());
        }
        if width == 0 {
            self.notes.push("a group whose records hold no bytes is left out".to_owned());
            return Ok(());
        }
        let mut described: Vec<Described> = Vec::new();
        let (mut at, mut seen) = (of.link(1), 0);
        while at != 0 {
            let channel = source.block(at, b"##CN")?;
            match describe(source, &channel, data_bytes)? {
                Ok(channel) if channel.end() <= width => described.push(channel),
                Ok(channel) => {
                    return Err(source.damaged(format!("`{}` lies behind its record", channel.name)));
                }
                Err((name, why)) => self.notes.push(left_out(&name, &why)),
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
        if there < cycles && !source.unfinished {
            self.notes.push(format!("a group promises {cycles} samples, and {there} are there"));
        }
        // Groups of one name keep apart.
        let clock = format!("#{}", self.channels.len());
        for of in &described {
            let mut channel = of.channel(&source.path, &data, width, there).of_group(&clock);
            channel.is_time = of.master;
            if of.master && channel.unit.is_none() {
                channel.unit = Some("s".to_owned());
            }
            if self.channels.iter().any(|c| c.name == channel.name) {
                channel.name = format!("{} ({})", channel.name, self.channels.len() + 1);
            }
            self.channels.push(channel);
        }
        Ok(())
    }
}
