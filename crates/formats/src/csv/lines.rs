//! Lines of a text in any of the usual encodings: UTF-8, UTF-16 and, where it is neither, Latin-1 as Windows
//! has it.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};
use stribeck_dsp::channel::memory;

use crate::{Error, Result};

/// Parts of the memory that a line may take: its bytes, its text and its numbers are held at once.
const PARTS: u64 = 4;

/// How the bytes of a text become lines.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coding {
    encoding: &'static Encoding,
    /// End of a line; `\r` alone is that of old Macintoshes.
    end: u8,
}

/// The 16-bit encoding that the first bytes of a file show, by its mark or by its zeros.
fn wide(start: &[u8]) -> Option<&'static Encoding> {
    if start.starts_with(b"\xff\xfe") {
        return Some(UTF_16LE);
    }
    if start.starts_with(b"\xfe\xff") {
        return Some(UTF_16BE);
    }
    let zeros = |at: usize| start.iter().skip(at).step_by(2).filter(|b| **b == 0).count();
    let (pairs, even, odd) = (start.len() / 2, zeros(0), zeros(1));
    if pairs < 8 {
        return None;
    }
    // Digits and separators have one byte that is zero and one that is not.
    match (even == 0 && odd > pairs * 9 / 10, odd == 0 && even > pairs * 9 / 10) {
        (true, _) => Some(UTF_16LE),
        (_, true) => Some(UTF_16BE),
        _ => None,
    }
}

/// Whether a file begins like a text of 16-bit characters.
pub(crate) fn is_wide(start: &[u8]) -> bool {
    wide(start).is_some()
}

impl Coding {
    /// That of a file, by its first bytes.
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let mut start = Vec::new();
        let file = File::open(path).map_err(|e| Error::read(path, e))?;
        file.take(1 << 16).read_to_end(&mut start).map_err(|e| Error::read(path, e))?;
        let encoding = wide(&start).unwrap_or_else(|| match std::str::from_utf8(&start) {
            Ok(_) => UTF_8,
            // The last character may be cut.
            Err(why) if why.error_len().is_none() => UTF_8,
            Err(_) => WINDOWS_1252,
        });
        // Few lines may end otherwise than most.
        let plain: Vec<u8> = start.into_iter().filter(|b| *b != 0).collect();
        let lone = plain.windows(2).filter(|w| w[0] == b'\r' && w[1] != b'\n').count();
        let lines = plain.iter().filter(|b| **b == b'\n').count();
        let end = if lone > lines { b'\r' } else { b'\n' };
        Ok(Self { encoding, end })
    }

    fn is_wide(self) -> bool {
        self.encoding == UTF_16LE || self.encoding == UTF_16BE
    }
}

pub(crate) struct Lines {
    file: BufReader<File>,
    coding: Coding,
    bytes: Vec<u8>,
    /// Lines read so far.
    pub(crate) read: u64,
    /// Whether the last line had its end.
    pub(crate) ended: bool,
}

impl Lines {
    pub(crate) fn open(path: &Path, coding: Coding) -> Result<Self> {
        let file = File::open(path).map_err(|e| Error::read(path, e))?;
        Ok(Self { file: BufReader::new(file), coding, bytes: Vec::new(), read: 0, ended: false })
    }

    /// The next line without its end and without the mark of an encoding.
    pub(crate) fn next(&mut self, path: &Path) -> Result<Option<String>> {
        self.bytes.clear();
        let io = |e| Error::read(path, e);
        let end = self.coding.end;
        let wide = self.coding.is_wide();
        let longest = memory::most_bytes() / PARTS;
        loop {
            let before = self.bytes.len() as u64;
            if before >= longest {
                let what = format!("line {}", self.read + 1);
                return memory::ask(path, &what, PARTS * (before + 1)).map(|()| None);
            }
            let left = longest - before;
            let count = (&mut self.file).take(left).read_until(end, &mut self.bytes).map_err(io)?;
            self.ended = self.bytes.last() == Some(&end);
            if !wide && !self.ended && self.bytes.len() as u64 >= longest {
                continue;
            }
            if count == 0 || !wide {
                break;
            }
            // The end of a line is a character, not a byte of one.
            let at = self.bytes.len() - 1;
            if self.coding.encoding == UTF_16LE {
                let mut zero = Vec::new();
                if self.bytes.len() % 2 == 1 {
                    (&mut self.file).take(1).read_to_end(&mut zero).map_err(io)?;
                }
                self.bytes.extend(&zero);
                if self.ended && zero == [0] {
                    break;
                }
            } else if self.ended && at % 2 == 1 && self.bytes[at - 1] == 0 {
                break;
            }
        }
        if self.bytes.is_empty() {
            return Ok(None);
        }
        self.read += 1;
        let (text, _) = self.coding.encoding.decode_without_bom_handling(&self.bytes);
        let text = text.trim_start_matches(['\u{feff}', '\n']).trim_end_matches(['\r', '\n']);
        Ok(Some(text.to_owned()))
    }
}
