//! Elements of the sections of a Gmsh file: lines of words, and numbers that are words or bytes.

use crate::decks::{DeckError, fault};

/// More numbers than any mesh has that fits in the memory; a count beyond it is damage.
const MOST: i64 = 1 << 32;

/// A file that is read from its beginning on.
pub(super) struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Numbers of nodes and elements are bytes.
    pub(super) binary: bool,
    /// The highest byte of a number comes first.
    pub(super) big_endian: bool,
    /// Bytes of a count.
    pub(super) size: usize,
    /// A place in the file, and the ends of lines before it.
    counted: (usize, usize),
}

impl<'a> Source<'a> {
    pub(super) fn of(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, binary: false, big_endian: false, size: 8, counted: (0, 0) }
    }

    /// The line that is being read, from 1.
    pub(super) fn line(&self) -> usize {
        1 + ends_of_lines(&self.bytes[..self.at])
    }

    /// The line of the next word. Asked again and again, it counts on from where it has counted.
    pub(super) fn line_ahead(&mut self) -> usize {
        let blank = self.bytes[self.at..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let ahead = if self.binary { self.at } else { self.at + blank };
        self.counted = (ahead, self.counted.1 + ends_of_lines(&self.bytes[self.counted.0..ahead]));
        1 + self.counted.1
    }

    pub(super) fn fault(&self, what: impl Into<String>) -> DeckError {
        let what = what.into();
        if self.binary {
            fault(self.line(), format!("byte {}: {what}", self.at))
        } else {
            fault(self.line(), what)
        }
    }

    fn ends(&self) -> DeckError {
        let line = 1 + ends_of_lines(self.bytes[..self.at].trim_ascii_end());
        fault(line, "the file ends in the middle of a section")
    }

    /// The next line that is not empty, with its number; none at the end.
    pub(super) fn next_line(&mut self) -> Option<(usize, String)> {
        while self.at < self.bytes.len() {
            let rest = &self.bytes[self.at..];
            let length = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
            let line = self.line();
            let words = String::from_utf8_lossy(&rest[..length]).trim().to_owned();
            self.at = (self.at + length + 1).min(self.bytes.len());
            if !words.is_empty() {
                return Some((line, words));
            }
        }
        None
    }

    /// The same where a line must follow.
    pub(super) fn must_line(&mut self) -> Result<(usize, String), DeckError> {
        self.next_line().ok_or_else(|| self.ends())
    }

    /// Goes behind the end of a section, whatever stands before it.
    pub(super) fn skip_section(&mut self, name: &str) -> Result<(), DeckError> {
        let mark = format!("$End{name}");
        let rest = &self.bytes[self.at..];
        let found = rest.windows(mark.len()).position(|window| window == mark.as_bytes());
        let Some(found) = found else {
            self.at = self.bytes.len();
            return Err(self.ends());
        };
        self.at += found + mark.len();
        let rest = &self.bytes[self.at..];
        self.at += rest.iter().position(|byte| *byte == b'\n').map_or(rest.len(), |end| end + 1);
        Ok(())
    }

    fn word(&mut self) -> Result<&'a str, DeckError> {
        let rest = &self.bytes[self.at..];
        let blank = |byte: &u8| byte.is_ascii_whitespace();
        let begin = rest.iter().position(|byte| !blank(byte)).unwrap_or(rest.len());
        let length = rest[begin..].iter().position(blank).unwrap_or(rest.len() - begin);
        if length == 0 {
            self.at = self.bytes.len();
            return Err(self.ends());
        }
        let word = &rest[begin..begin + length];
        self.at += begin;
        let word = std::str::from_utf8(word)
            .map_err(|_| self.fault("a number belongs here, and there is no text"))?;
        if word.starts_with('$') {
            return Err(self.fault(format!("`{word}` stands in the middle of a section")));
        }
        self.at += length;
        Ok(word)
    }

    /// Bytes of a number, the lowest first.
    fn take<const N: usize>(&mut self) -> Result<[u8; N], DeckError> {
        let Some(&(mut bytes)) = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>()) else {
            self.at = self.bytes.len();
            return Err(self.ends());
        };
        self.at += N;
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    pub(super) fn number(&mut self) -> Result<i64, DeckError> {
        let word = self.word()?;
        word.parse().map_err(|_| self.fault(format!("`{word}` is no whole number")))
    }

    /// A whole number; of four bytes in a binary file.
    pub(super) fn int(&mut self) -> Result<i64, DeckError> {
        if !self.binary {
            return self.number();
        }
        Ok(i64::from(i32::from_le_bytes(self.take()?)))
    }

    /// A count or a tag of a node or element; as wide as the head of a binary file says.
    pub(super) fn count(&mut self) -> Result<i64, DeckError> {
        let number = match (self.binary, self.size) {
            (false, _) => self.number()?,
            (true, 4) => self.int()?,
            (true, _) => i64::from_le_bytes(self.take()?),
        };
        if (0..MOST).contains(&number) {
            return Ok(number);
        }
        Err(self.fault(format!("{number} is no count, nor the number of a node or element")))
    }

    pub(super) fn real(&mut self) -> Result<f64, DeckError> {
        if self.binary {
            return Ok(f64::from_le_bytes(self.take()?));
        }
        let word = self.word()?;
        word.replace(['d', 'D'], "e").parse().map_err(|_| self.fault(format!("`{word}` is no number")))
    }

    /// `many` counts; memory is reserved only for as many as the file can hold.
    pub(super) fn counts(&mut self, many: i64) -> Result<Vec<u64>, DeckError> {
        let mut all = Vec::new();
        for _ in 0..many {
            all.push(self.count()? as u64);
        }
        Ok(all)
    }
}

fn ends_of_lines(bytes: &[u8]) -> usize {
    bytes.iter().filter(|byte| **byte == b'\n').count()
}
