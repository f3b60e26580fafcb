//! NumPy arrays (`.npy`, NumPy Enhancement Proposal 1): vectors, tables and records of numbers.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::literal::{self, Literal};
use crate::number::{Kind, Number};
use crate::recording::left_out;
use crate::strided::Strided;
use crate::{Channel, Error, Recording, Result, shape};

/// First bytes of every file.
pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";
const FORMAT: &str = "NumPy .npy";
/// Longest header that is read.
const MAX_HEADER: usize = 1 << 20;

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    /// Fields of a record that are read; a plain array has one without a name.
    fields: Vec<Field>,
    record: usize,
    shape: Vec<u64>,
    fortran: bool,
    /// Bytes before the data.
    pub(crate) start: usize,
    /// Fields that are left out, with the reason.
    pub(crate) notes: Vec<String>,
}

#[derive(Debug, Clone, PartialEq)]
struct Field {
    name: String,
    /// Its place in the record [bytes].
    place: usize,
    number: Number,
    /// That of times.
    unit: Option<String>,
}

/// Why a header is not followed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Refusal {
    /// It cannot be understood, and why.
    Damaged(String),
    /// It describes something other than a table of real numbers.
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

/// Advice for arrays that are not read.
const ADVICE: &str = "vectors, tables and records of real numbers are read: bool, int8 to uint64, float32 \
    and float64; save it as one of them";

/// Opens an array; a vector takes the name of the file.
///
/// # Errors
/// [`Error::Damaged`] for a header that cannot be understood or data that end early, [`Error::Unsupported`]
/// for anything but a table of real numbers, [`Error::Io`].
pub fn open(path: &Path) -> Result<Recording> {
    let mut file = File::open(path).map_err(|e| Error::read(path, e))?;
    let mut head = Vec::new();
    file.by_ref().take(MAX_HEADER as u64).read_to_end(&mut head).map_err(|e| Error::read(path, e))?;
    let layout = Layout::of(&head).map_err(|why| why.of_file(path))?;
    let size = file.metadata().map_err(|e| Error::read(path, e))?.len();
    let held = size.saturating_sub(layout.start as u64);
    let name = path.file_stem().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let channels =
        layout.channels(&name, path, layout.start as u64, held).map_err(|why| why.of_file(path))?;
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes: layout.notes })
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
        // Only version 3 is UTF-8.
        let text = match std::str::from_utf8(text) {
            Ok(text) => text.to_owned(),
            Err(_) => text.iter().map(|b| char::from(*b)).collect(),
        };
        let header = literal::parse(&text).ok_or_else(|| damaged("its header is no Python dictionary"))?;
        let shape = header.get("shape").ok_or_else(|| damaged("its header has no shape"))?;
        let shape: Option<Vec<u64>> = shape.items().iter().map(Literal::count).collect();
        let shape = shape.ok_or_else(|| damaged("its shape is no list of sizes"))?;
        let fortran = header.get("fortran_order") == Some(&Literal::Word("True".to_owned()));
        let descr = header.get("descr").ok_or_else(|| damaged("its header has no `descr`"))?;
        let (mut fields, mut notes, mut record) = (Vec::new(), Vec::new(), 0_usize);
        if let Literal::Text(kind) = descr {
            let (number, unit) = number(kind).ok_or_else(|| Refusal::Foreign(spoken(kind)))?;
            fields.push(Field { name: String::new(), place: 0, number, unit });
            record = number.kind.bytes();
        }
        let double = Number { kind: Kind::F64, big_endian: false };
        let doubles = short_form(descr);
        for name in doubles.iter().flatten() {
            fields.push(Field { name: (*name).to_owned(), place: record, number: double, unit: None });
            record += double.kind.bytes();
        }
        let records = if doubles.is_some() { &[] } else { descr.items() };
        for field in records {
            let unclear = || Refusal::Damaged(format!("its record `{field:?}` is no name with a type"));
            let [name, kind, rest @ ..] = field.items() else { return Err(unclear()) };
            // A name may come with a title: (title, name).
            let name = match name {
                Literal::Text(name) => name.clone(),
                other => other.items().last().and_then(Literal::text).ok_or_else(unclear)?.to_owned(),
            };
            let Some(kind) = kind.text() else {
                return Err(Refusal::Foreign(format!("records in its field `{name}`")));
            };
            let width = width(kind)
                .ok_or_else(|| Refusal::Foreign(format!("{} in its field `{name}`", spoken(kind))))?;
            let repeats = rest.first().map_or(&[][..], Literal::items).iter().map(Literal::count);
            let repeats: Option<Vec<u64>> = repeats.collect();
            let count = repeats.ok_or_else(unclear)?.iter().try_fold(1_u64, |n, by| n.checked_mul(*by));
            match number(kind) {
                // Padding that aligns the next field.
                _ if name.is_empty() => {}
                Some((number, unit)) if count == Some(1) => {
                    fields.push(Field { name, place: record, number, unit });
                }
                Some(_) => notes.push(left_out(&name, "each record holds an array of it")),
                None => notes.push(left_out(&name, &format!("it holds {}", spoken(kind)))),
            }
            let size = count.and_then(|n| usize::try_from(n).ok()).and_then(|n| n.checked_mul(width));
            record = size.and_then(|size| record.checked_add(size)).ok_or_else(unclear)?;
        }
        if fields.is_empty() {
            let why =
                if notes.is_empty() { "no field that is a number".to_owned() } else { notes.join("; ") };
            return Err(Refusal::Foreign(why));
        }
        Ok(Self { fields, record, shape, fortran, start: prefix + length, notes })
    }

    /// The channels of data that begin at byte `start` of `path` and take `held` bytes.
    pub(crate) fn channels(
        &self,
        name: &str,
        path: &Path,
        start: u64,
        held: u64,
    ) -> std::result::Result<Vec<Channel>, Refusal> {
        let (rows, columns) = shape::table(&self.shape).map_err(Refusal::Foreign)?;
        let damaged = |what: String| Refusal::Damaged(what);
        let needed = rows.checked_mul(columns).and_then(|n| n.checked_mul(self.record as u64));
        if needed.is_none_or(|needed| needed > held) {
            return Err(damaged(format!(
                "its header promises {rows} × {columns} numbers of {} bytes, and {held} bytes follow",
                self.record
            )));
        }
        // Samples run along the longer side.
        let (len, count) = if rows >= columns { (rows, columns) } else { (columns, rows) };
        let along_rows = (rows >= columns) != self.fortran;
        let record = self.record as u64;
        let mut channels = Vec::new();
        for Field { name: field, place, number, unit } in &self.fields {
            for k in 0..count {
                // The samples of a channel lie `count` records apart when the file runs across them.
                let (first, stride) =
                    if along_rows { (k * record, count * record) } else { (k * len * record, record) };
                let strided = Strided {
                    path: path.to_owned(),
                    start: start + first + *place as u64,
                    stride: usize::try_from(stride)
                        .map_err(|_| damaged("its rows are too long".to_owned()))?,
                    number: *number,
                    factor: 1.0,
                };
                let called = match (field.is_empty(), count) {
                    (false, 1) => field.clone(),
                    (true, 1) => name.to_owned(),
                    (false, _) => format!("{field}[{k}]"),
                    (true, _) => format!("{name}[{k}]"),
                };
                channels.push(strided.channel(called, len).in_unit(unit.clone()));
            }
        }
        Ok(channels)
    }
}

/// Names of records of doubles in the short form in which runs of many channels describe them:
/// `('V16', {'names':['t','x'],'formats':'dd'})`.
fn short_form(descr: &Literal) -> Option<Vec<&str>> {
    let [_, dictionary] = descr.items() else { return None };
    let names: Option<Vec<&str>> = dictionary.get("names")?.items().iter().map(Literal::text).collect();
    let formats = dictionary.get("formats")?.text()?;
    names.filter(|names| formats.len() == names.len() && formats.bytes().all(|letter| letter == b'd'))
}

/// How a type of NumPy is stored; times come with their unit.
fn number(descr: &str) -> Option<(Number, Option<String>)> {
    let (order, kind) = descr.split_at_checked(1)?;
    let mut unit = None;
    let kind = match kind {
        "f8" => Kind::F64,
        "f4" => Kind::F32,
        "f2" => Kind::F16,
        "i1" => Kind::I8,
        "i2" => Kind::I16,
        "i4" => Kind::I32,
        "i8" => Kind::I64,
        "u1" | "b1" => Kind::U8,
        "u2" => Kind::U16,
        "u4" => Kind::U32,
        "u8" => Kind::U64,
        times => {
            unit =
                Some(times.strip_prefix("M8[").or(times.strip_prefix("m8["))?.strip_suffix(']')?.to_owned());
            Kind::I64
        }
    };
    Some((Number { kind, big_endian: order == ">" }, unit))
}

/// Bytes of a type of NumPy, read or not.
fn width(descr: &str) -> Option<usize> {
    if let Some((number, _)) = number(descr) {
        return Some(number.kind.bytes());
    }
    let kind = descr.get(1..)?;
    let count = kind.get(1..)?.parse::<usize>().ok()?;
    match kind.chars().next()? {
        'U' => count.checked_mul(4),
        'S' | 'V' | 'c' | 'f' | 'a' => Some(count),
        _ => None,
    }
}

/// A type that is no real number, in words.
fn spoken(descr: &str) -> String {
    let what = match descr.trim_start_matches(['<', '>', '|', '=']).chars().next() {
        Some('c') => "complex numbers",
        Some('U' | 'S') => "text",
        Some('M' | 'm') => "dates without a unit",
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
    use stribeck_testing::assert_refused;

    #[test]
    fn refuses_an_array_of_three_dimensions_with_its_shape() {
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3, 4), }";
        let layout = Layout::of(&file(header)).unwrap();
        assert_refused(layout.channels("a", Path::new("a.npy"), 0, 192), "3 dimensions, 2 × 3 × 4");
    }

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
            ("[('t', '<c8'), ('when', '<U3')]", "(9,)", "`when` is left out: it holds text (`<U3`)"),
        ] {
            let said = why(descr, shape);
            assert!(said.contains(words) && said.contains("float64") && !said.contains("damaged"), "{said}");
        }
        assert!(why("'<f8'", "(x,)").contains("damaged"));
    }

    #[test]
    fn by_hand_records_in_their_short_form() {
        let header = |formats: &str| {
            format!(
                "{{'descr': ('V24', {{'names':['time_s','a','b c'],'formats':'{formats}'}}), \
                 'fortran_order': False, 'shape': (2,), }}"
            )
        };
        let layout = Layout::of(&file(&header("ddd"))).expect("a layout");
        let fields: Vec<(&str, usize)> =
            layout.fields.iter().map(|field| (field.name.as_str(), field.place)).collect();
        assert_eq!((fields, layout.record), (vec![("time_s", 0), ("a", 8), ("b c", 16)], 24));
        assert_refused(Layout::of(&file(&header("dfd"))), "is no name with a type");
    }
}
