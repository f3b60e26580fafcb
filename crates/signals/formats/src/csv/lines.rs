//! Lines of a text in any of the usual encodings: UTF-8, UTF-16 and, where it is neither, Latin-1 as Windows
//! has it.

use std::borrow::Cow;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use stribeck_dsp::channel::memory;

use crate::{Error, Result};

/// Parts of the memory that a line may take: its bytes, its text and its numbers are held at once.
const PARTS: u64 = 4;

/// What stands for 0x80 to 0x9f in Windows-1252; all other bytes are the characters of their number.
const WINDOWS_1252: [char; 32] = [
    '€', '\u{81}', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', '\u{8d}', 'Ž', '\u{8f}', '\u{90}',
    '‘', '’', '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', '\u{9d}', 'ž', 'Ÿ',
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Utf8,
    Utf16Le,
    Utf16Be,
    Windows1252,
}

impl Encoding {
    /// The text of some bytes; what is no character becomes U+FFFD.
    fn decode(self, bytes: &[u8]) -> Cow<'_, str> {
        let wide = |unit: fn([u8; 2]) -> u16| {
            let (pairs, rest) = bytes.as_chunks();
            let units: Vec<u16> = pairs.iter().map(|pair| unit(*pair)).collect();
            let mut text = String::from_utf16_lossy(&units);
            text.extend(rest.iter().map(|_| char::REPLACEMENT_CHARACTER));
            Cow::Owned(text)
        };
        match self {
            Self::Utf8 => String::from_utf8_lossy(bytes),
            Self::Utf16Le => wide(u16::from_le_bytes),
            Self::Utf16Be => wide(u16::from_be_bytes),
            Self::Windows1252 => bytes
                .iter()
                .map(|byte| match byte {
                    0x80..=0x9f => WINDOWS_1252[usize::from(byte - 0x80)],
                    _ => char::from(*byte),
                })
                .collect(),
        }
    }
}

/// How the bytes of a text become lines.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coding {
    encoding: Encoding,
    /// End of a line; `\r` alone is that of old Macintoshes.
    end: u8,
}

/// The 16-bit encoding that the first bytes of a file show, by its mark or by its zeros.
fn wide(start: &[u8]) -> Option<Encoding> {
    if start.starts_with(b"\xff\xfe") {
        return Some(Encoding::Utf16Le);
    }
    if start.starts_with(b"\xfe\xff") {
        return Some(Encoding::Utf16Be);
    }
    let zeros = |at: usize| start.iter().skip(at).step_by(2).filter(|b| **b == 0).count();
    let (pairs, even, odd) = (start.len() / 2, zeros(0), zeros(1));
    if pairs < 8 {
        return None;
    }
    // Digits and separators have one byte that is zero and one that is not.
    match (even == 0 && odd > pairs * 9 / 10, odd == 0 && even > pairs * 9 / 10) {
        (true, _) => Some(Encoding::Utf16Le),
        (_, true) => Some(Encoding::Utf16Be),
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
            Ok(_) => Encoding::Utf8,
            // The last character may be cut.
            Err(why) if why.error_len().is_none() => Encoding::Utf8,
            Err(_) => Encoding::Windows1252,
        });
        // Few lines may end otherwise than most.
        let plain: Vec<u8> = start.into_iter().filter(|b| *b != 0).collect();
        let lone = plain.windows(2).filter(|w| w[0] == b'\r' && w[1] != b'\n').count();
        let lines = plain.iter().filter(|b| **b == b'\n').count();
        let end = if lone > lines { b'\r' } else { b'\n' };
        Ok(Self { encoding, end })
    }

    fn is_wide(self) -> bool {
        matches!(self.encoding, Encoding::Utf16Le | Encoding::Utf16Be)
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
            if self.coding.encoding == Encoding::Utf16Le {
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
        let text = self.coding.encoding.decode(&self.bytes);
        let text = text.trim_start_matches(['\u{feff}', '\n']).trim_end_matches(['\r', '\n']);
        Ok(Some(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::Encoding;

    /// Code points from the table of Windows-1252 and from RFC 2781; a lone byte is no character.
    #[test]
    fn by_hand_bytes_of_each_encoding_become_text() {
        assert_eq!(Encoding::Utf8.decode(b"5 \xc2\xb5m\xff"), "5 µm\u{fffd}");
        assert_eq!(Encoding::Windows1252.decode(b"\x80 \x8e \x9f \xb5 \xff"), "€ Ž Ÿ µ ÿ");
        assert_eq!(Encoding::Utf16Le.decode(&[0x08, 0xd8, 0x45, 0xdf, 0xb5, 0]), "\u{12345}µ");
        assert_eq!(Encoding::Utf16Be.decode(&[0, 0xb5, 0x31]), "µ\u{fffd}");
    }
}
