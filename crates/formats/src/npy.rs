//! NumPy arrays (`.npy`, NumPy Enhancement Proposal 1): vectors, tables and records of numbers.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::number::{Kind, Number};
use crate::recording::Strided;
use crate::{Channel, Error, Recording, Result};

/// First bytes of every file.
pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";
const FORMAT: &str = "NumPy .npy";
/// Longest header that is read.
const MAX_HEADER: usize = 1 << 20;

/// What a header says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    /// Names, places in a record and kinds; a plain array has one without a name.
    fields: Vec<(String, usize, Number)>,
    record: usize,
    shape: Vec<u64>,
    fortran: bool,
    /// Bytes before the data.
    pub(crate) start: usize,
}

/// Why a header is not followed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Refusal {
    /// It cannot be understood, and why.
    Damaged(String),
    /// It promises what is no table of real numbers.
    Foreign(String),
}

impl Refusal {
    fn of_file(self, path: &Path) -> Error {
        match self {
            Self::Damaged(what) => Error::damaged(path, FORMAT, what),
            Self::Foreign(what) => {
                Error::Unsupported { path: path.to_owned(), format: FORMAT, what, advice: ADVICE }
            }
        }
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Damaged(what) => f.write_str(what),
            Self::Foreign(what) => write!(f, "it holds {what}, and {ADVICE}"),
        }
    }
}

/// What to save instead of what is not read.
const ADVICE: &str = "vectors, tables and records of real numbers are read: bool, int8 to uint64, float32 and float64; save it as one of them";

/// Opens an array; a vector takes the name of the file.
///
/// # Errors
/// [`Error::Damaged`] for a header that cannot be understood or data that end early, [`Error::Unsupported`] for what is no table of real
/// numbers, [`Error::Io`].
pub fn open(path: &Path) -> Result<Recording> {
    let mut file = File::open(path).map_err(|e| Error::read(path, e))?;
    let mut head = Vec::new();
    file.by_ref().take(MAX_HEADER as u64).read_to_end(&mut head).map_err(|e| Error::read(path, e))?;
    let layout = Layout::of(&head).map_err(|why| why.of_file(path))?;
    let size = file.metadata().map_err(|e| Error::read(path, e))?.len();
    let held = size.saturating_sub(layout.start as u64);
    let name = path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let channels = layout
        .channels(&name, path, layout.start as u64, held)
        .map_err(|what| Error::damaged(path, FORMAT, what))?;
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes: Vec::new() })
}

impl Layout {
    /// Reads a header from the first bytes of a file.
    pub(crate) fn of(head: &[u8]) -> std::result::Result<Self, Refusal> {
        let damaged = |what: &str| Refusal::Damaged(what.to_owned());
        let cut = || damaged("it ends inside its header");
        if !head.starts_with(MAGIC) {
            return Err(damaged("it does not begin like a `.npy` file"));
        }
        let (prefix, length) = match *head.get(6).ok_or_else(cut)? {
            1 => (10, head.get(8..10).ok_or_else(cut)?.iter().rev().fold(0, |n, b| n << 8 | usize::from(*b))),
            2 | 3 => {
                (12, head.get(8..12).ok_or_else(cut)?.iter().rev().fold(0, |n, b| n << 8 | usize::from(*b)))
            }
            other => return Err(Refusal::Damaged(format!("its version is {other}; 1 to 3 are known"))),
        };
        let text = head.get(prefix..prefix + length).ok_or_else(cut)?;
        let text = std::str::from_utf8(text).map_err(|_| damaged("its header is no text"))?;
        let after = |key: &str| text.split_once(key).map(|(_, rest)| rest.trim_start());
        let shape = after("'shape':").and_then(|s| s.strip_prefix('(')).and_then(|s| s.split_once(')'));
        let shape = shape.ok_or_else(|| damaged("its header has no shape"))?.0;
        let sizes = shape.split(',').map(str::trim).filter(|s| !s.is_empty()).map(str::parse);
        let shape = sizes
            .collect::<std::result::Result<Vec<u64>, _>>()
            .map_err(|_| damaged("its shape is no list of sizes"))?;
        let fortran = after("'fortran_order':").is_some_and(|s| s.starts_with("True"));
        let descr = after("'descr':").ok_or_else(|| damaged("its header has no `descr`"))?;
        let mut fields = Vec::new();
        let mut record = 0;
        if let Some(mut rest) = descr.strip_prefix('[') {
            while let Some((field, behind)) =
                rest.split_once(')').filter(|_| !rest.trim_start().starts_with(']'))
            {
                let mut quoted = field.split('\'');
                let (name, kind) = (quoted.nth(1), quoted.nth(1));
                let (Some(name), Some(kind)) = (name, kind) else {
                    return Err(Refusal::Damaged(format!("its record `{field})` is no name with a type")));
                };
                let number = number(kind)
                    .ok_or_else(|| Refusal::Foreign(format!("{} in its field `{name}`", spoken(kind))))?;
                fields.push((name.to_owned(), record, number));
                record += number.kind.bytes();
                rest = behind.trim_start_matches([',', ' ']);
            }
        } else if let Some(names) = short_form(descr) {
            let double = Number { kind: Kind::F64, big_endian: false };
            fields = (0..).step_by(8).zip(names).map(|(at, name)| (name.to_owned(), at, double)).collect();
            record = 8 * fields.len();
        } else {
            let kind = descr.split('\'').nth(1).unwrap_or_default();
            let number = number(kind).ok_or_else(|| Refusal::Foreign(spoken(kind)))?;
            fields.push((String::new(), 0, number));
            record = number.kind.bytes();
        }
        if fields.is_empty() {
            return Err(damaged("its header names no field"));
        }
        if shape.len() > 2 {
            return Err(Refusal::Foreign(format!("an array of {} dimensions", shape.len())));
        }
        Ok(Self { fields, record, shape, fortran, start: prefix + length })
    }

    /// The channels of data that begin at byte `start` of `path` and take `held` bytes.
    pub(crate) fn channels(
        &self,
        name: &str,
        path: &Path,
        start: u64,
        held: u64,
    ) -> std::result::Result<Vec<Channel>, String> {
        let (rows, columns) = match self.shape[..] {
            [] => (1, 1),
            [rows] => (rows, 1),
            [rows, columns, ..] => (rows, columns),
        };
        let needed = rows.checked_mul(columns).and_then(|n| n.checked_mul(self.record as u64));
        if needed.is_none_or(|needed| needed > held) {
            return Err(format!(
                "its header promises {rows} × {columns} numbers of {} bytes, and {held} bytes follow",
                self.record
            ));
        }
        // Samples run along the longer side.
        let (len, count) = if rows >= columns { (rows, columns) } else { (columns, rows) };
        let along_rows = (rows >= columns) != self.fortran;
        let record = self.record as u64;
        let mut channels = Vec::new();
        for (field, offset, number) in &self.fields {
            for k in 0..count.min(100_000) {
                // The samples of a channel lie `count` records apart when the file runs across them.
                let (first, stride) =
                    if along_rows { (k * record, count * record) } else { (k * len * record, record) };
                let strided = Strided {
                    path: path.to_owned(),
                    start: start + first + *offset as u64,
                    stride: usize::try_from(stride).map_err(|_| "its rows are too long".to_owned())?,
                    number: *number,
                    factor: 1.0,
                };
                let called = match (field.is_empty(), count) {
                    (false, 1) => field.clone(),
                    (true, 1) => name.to_owned(),
                    (false, _) => format!("{field}[{k}]"),
                    (true, _) => format!("{name}[{k}]"),
                };
                channels.push(Channel::strided(called, len, strided));
            }
        }
        Ok(channels)
    }
}

/// Names of records of doubles in the short form in which runs of many channels describe them:
/// `('V16', {'names':['t','x'],'formats':'dd'})`.
fn short_form(descr: &str) -> Option<std::str::Split<'_, &'static str>> {
    let (names, rest) = descr.strip_prefix('(')?.split_once("{'names':['")?.1.split_once("'],'formats':'")?;
    let formats = rest.split_once("'})")?.0;
    let names = names.split("','");
    (formats.len() == names.clone().count() && formats.bytes().all(|letter| letter == b'd')).then_some(names)
}

fn number(descr: &str) -> Option<Number> {
    let (order, kind) = descr.split_at_checked(1)?;
    let kind = match kind {
        "f8" => Kind::F64,
        "f4" => Kind::F32,
        "i1" => Kind::I8,
        "i2" => Kind::I16,
        "i4" => Kind::I32,
        "i8" => Kind::I64,
        "u1" | "b1" => Kind::U8,
        "u2" => Kind::U16,
        "u4" => Kind::U32,
        "u8" => Kind::U64,
        _ => return None,
    };
    Some(Number { kind, big_endian: order == ">" })
}

/// A type that is no real number, in words.
fn spoken(descr: &str) -> String {
    let what = match descr.trim_start_matches(['<', '>', '|', '=']).chars().next() {
        Some('c') => "complex numbers",
        Some('U' | 'S') => "text",
        Some('M' | 'm') => "dates or times",
        Some('O') => "objects of Python",
        _ => "values",
    };
    format!("{what} (`{descr}`)")
}

/// A vector of doubles as the bytes of a `.npy` file.
pub(crate) fn encode(samples: &[f64]) -> Vec<u8> {
    const ALIGNMENT: usize = 64;
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", samples.len());
    let total = (10 + text.len() + 1).next_multiple_of(ALIGNMENT);
    let mut bytes = MAGIC.to_vec();
    bytes.extend([1, 0]);
    bytes.extend(((total - 10) as u16).to_le_bytes());
    bytes.extend(text.as_bytes());
    bytes.resize(total - 1, b' ');
    bytes.push(b'\n');
    bytes.extend(samples.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str) -> Vec<u8> {
        [MAGIC, &[1, 0], &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat()
    }

    #[test]
    fn refuses_what_is_no_real_number_and_does_not_call_it_damaged() {
        let path = Path::new("a.npy");
        let why = |descr: &str, shape: &str| {
            let header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}");
            Layout::of(&file(&header)).expect_err("refused").of_file(path).to_string()
        };
        for (descr, shape, words) in [
            ("'<c16'", "(9,)", "holds complex numbers (`<c16`)"),
            ("'<U7'", "(9,)", "holds text (`<U7`)"),
            (
                "[('t', '<f8'), ('when', '<M8[ns]')]",
                "(9,)",
                "holds dates or times (`<M8[ns]`) in its field `when`",
            ),
            ("'<f8'", "(2, 3, 4)", "holds an array of 3 dimensions"),
        ] {
            let said = why(descr, shape);
            assert!(said.contains(words) && said.contains("float64") && !said.contains("damaged"), "{said}");
        }
        assert!(why("'<f8'", "(x,)").contains("damaged"));
    }

    #[test]
    fn example_records_in_their_short_form() {
        let header = |formats: &str| {
            format!(
                "{{'descr': ('V24', {{'names':['time_s','a','b c'],'formats':'{formats}'}}), 'fortran_order': False, 'shape': (2,), }}"
            )
        };
        let layout = Layout::of(&file(&header("ddd"))).expect("a layout");
        let fields: Vec<(&str, usize)> =
            layout.fields.iter().map(|(name, at, _)| (name.as_str(), *at)).collect();
        assert_eq!((fields, layout.record), (vec![("time_s", 0), ("a", 8), ("b c", 16)], 24));
        assert!(Layout::of(&file(&header("dfd"))).is_err());
    }
}
