//! Text tables: one row a sample, one column a channel.
//!
//! Columns are split by semicolons, tabs, commas or spaces, whichever the first rows of numbers agree with; beside
//! semicolons and tabs a comma is a decimal point. Lines before the first row of numbers are a preamble, and the last of
//! them gives the names when it has as many columns, or the units when it looks like them and the one above has as many, too.

use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::recording::equal_lengths;
use crate::{Channel, Error, Recording, Result, time};

/// Lines before the first row of numbers, at most.
const PREAMBLE: usize = 200;
/// Samples handed on at a time.
const BLOCK: usize = 1 << 14;

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Dialect {
    /// What splits columns; a space stands for any run of white space.
    separator: char,
    decimal_comma: bool,
}

/// One column of a table in a file.
#[derive(Debug, Clone)]
pub(crate) struct Column {
    path: PathBuf,
    name: String,
    /// From 0.
    at: usize,
    /// Lines before the first row of numbers.
    preamble: usize,
    dialect: Dialect,
}

/// Opens a table: its columns, their names and units.
///
/// # Errors
/// [`Error::Unknown`] for a text without a row of numbers, [`Error::Io`].
pub fn open(path: &Path) -> Result<Recording> {
    let mut lines = lines(path)?;
    let mut head: Vec<String> = Vec::new();
    let mut found = None;
    while head.len() <= PREAMBLE && found.is_none() {
        let Some(line) = lines.next(path)? else { break };
        found = Dialect::of(&line);
        head.push(line);
    }
    let Some(dialect) = found else {
        let seen = "it is text without a row of numbers".to_owned();
        return Err(Error::Unknown { path: path.to_owned(), seen });
    };
    let first = head.pop().unwrap_or_default();
    let columns = dialect.split(&first).count();
    let words = |line: &String| -> Option<Vec<String>> {
        let words: Vec<String> = dialect.split(line).map(|word| word.trim_matches('"').to_owned()).collect();
        (words.len() == columns).then_some(words)
    };
    let mut told = head.iter().rev().filter(|line| !line.trim().is_empty());
    let (last, above) = (told.next().and_then(words), told.next().and_then(words));
    let (names, units) = match (above, last) {
        (Some(names), Some(units)) if units.iter().all(|unit| time::is_unit(unit)) => (names, units),
        (_, Some(names)) => (names, Vec::new()),
        (_, None) => ((1..=columns).map(|n| format!("column {n}")).collect(), Vec::new()),
    };
    let mut rows: u64 = 1;
    while let Some(line) = lines.next(path)? {
        rows += u64::from(!line.trim().is_empty());
    }
    let channel = |(at, name): (usize, &String)| {
        let column = Column { path: path.to_owned(), name: name.clone(), at, preamble: head.len(), dialect };
        let unit = units.get(at).map(|unit| unit.trim_matches(['[', ']', '(', ')', ' ']).to_owned());
        Channel::text(name.clone(), rows, column).in_unit(unit)
    };
    Ok(Recording {
        path: path.to_owned(),
        format: "CSV",
        channels: names.iter().enumerate().map(channel).collect(),
        notes: Vec::new(),
    })
}

/// Writes channels of one length as columns, after a comment line for each of `notes` and a time column when the first
/// channel has a rate. Numbers have all their digits.
///
/// # Errors
/// [`Error::DoesNotFit`] for channels of different lengths, [`Error::Io`].
pub fn write(path: &Path, channels: &[Channel], notes: &[String]) -> Result<()> {
    let rows = equal_lengths(path, "CSV", channels)?;
    let columns: Vec<Vec<f64>> = channels.iter().map(Channel::read).collect::<Result<_>>()?;
    let io = |e| Error::write(path, e);
    let mut file = BufWriter::new(File::create(path).map_err(io)?);
    let rate = channels
        .first()
        .and_then(|c| c.rate_hz)
        .filter(|_| channels.iter().all(|c| !c.name.starts_with("time")));
    let mut text = String::new();
    notes.iter().for_each(|note| text += &format!("# {}\n", note.replace('\n', " ")));
    let time = rate.map(|_| "time_s".to_owned());
    let names: Vec<String> =
        time.into_iter().chain(channels.iter().map(|c| c.name.replace(',', ";"))).collect();
    text += &(names.join(",") + "\n");
    for row in 0..rows as usize {
        let time = rate.map(|hz| format!("{:?}", row as f64 / hz));
        let values = time.into_iter().chain(columns.iter().map(|c| format!("{:?}", c[row])));
        text += &values.collect::<Vec<_>>().join(",");
        text.push('\n');
        if text.len() > 1 << 16 {
            file.write_all(text.as_bytes()).map_err(io)?;
            text.clear();
        }
    }
    file.write_all(text.as_bytes()).map_err(io)?;
    file.flush().map_err(io)
}

impl Dialect {
    /// The dialect in which a line is a row of numbers.
    fn of(line: &str) -> Option<Self> {
        let all =
            [(';', true), (';', false), ('\t', true), ('\t', false), (',', false), (' ', false), (' ', true)];
        let dialect = |(separator, decimal_comma)| Self { separator, decimal_comma };
        all.into_iter().map(dialect).find(|d| {
            let separated = d.separator == ' ' || line.contains(d.separator);
            let mut fields = d.split(line).peekable();
            separated && fields.peek().is_some() && fields.all(|field| d.number(field).is_some())
        })
    }

    fn split<'a>(&self, line: &'a str) -> Box<dyn Iterator<Item = &'a str> + 'a> {
        match self.separator {
            ' ' => Box::new(line.split_whitespace()),
            // A separator at the end of every row makes no column.
            other => Box::new(line.trim().trim_end_matches(other).split(other).map(str::trim)),
        }
    }

    /// A number; an empty field is one that is missing.
    fn number(&self, field: &str) -> Option<f64> {
        if field.is_empty() {
            return Some(f64::NAN);
        }
        if self.decimal_comma { field.replace(',', ".").parse().ok() } else { field.parse().ok() }
    }
}

impl Column {
    pub(crate) fn for_each_block(&self, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let mut lines = lines(&self.path)?;
        let mut block = Vec::with_capacity(BLOCK);
        while let Some(line) = lines.next(&self.path)? {
            if lines.read as usize <= self.preamble || line.trim().is_empty() {
                continue;
            }
            let field = self.dialect.split(&line).nth(self.at).unwrap_or_default();
            block.push(self.dialect.number(field).ok_or_else(|| Error::Number {
                path: self.path.clone(),
                row: lines.read,
                column: self.at + 1,
                channel: self.name.clone(),
                text: field.chars().take(40).collect(),
            })?);
            if block.len() == BLOCK {
                if !take(&block) {
                    return Ok(());
                }
                block.clear();
            }
        }
        take(&block);
        Ok(())
    }
}

struct Lines {
    file: BufReader<File>,
    bytes: Vec<u8>,
    /// Lines read so far.
    read: u64,
}

fn lines(path: &Path) -> Result<Lines> {
    let file = File::open(path).map_err(|e| Error::read(path, e))?;
    Ok(Lines { file: BufReader::new(file), bytes: Vec::new(), read: 0 })
}

impl Lines {
    /// The next line, whatever its encoding, without the mark of one at its beginning.
    fn next(&mut self, path: &Path) -> Result<Option<String>> {
        self.bytes.clear();
        let count = self.file.read_until(b'\n', &mut self.bytes).map_err(|e| Error::read(path, e))?;
        self.read += 1;
        let mark: &[u8] = if self.read == 1 { b"\xef\xbb\xbf" } else { b"" };
        let line = self.bytes.strip_prefix(mark).unwrap_or(&self.bytes);
        Ok((count > 0).then(|| String::from_utf8_lossy(line).trim_end_matches(['\r', '\n']).to_owned()))
    }
}
