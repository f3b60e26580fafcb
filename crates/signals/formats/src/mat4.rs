//! MATLAB files of version 4: full matrices of real numbers, in either byte order. Read only.
//!
//! Source: *MAT-File Format*, The MathWorks, appendix on version 4.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use crate::mat5::Plain;
use crate::number::{Kind, Number};
use crate::recording::left_out;
use crate::{Error, Recording, Result};

const FORMAT: &str = "MATLAB 4";
/// Bytes before the name of a matrix.
const HEADER: u64 = 20;
/// Longest name.
const NAME: u32 = 64;

struct Header {
    big_endian: bool,
    /// Storage of numbers, and the kind of matrix: 0 numbers, 1 text, 2 sparse.
    stored: u32,
    sort: u32,
    rows: u32,
    columns: u32,
    complex: bool,
    name: u32,
}

impl Header {
    /// `None` for bytes that begin no matrix.
    fn of(bytes: &[u8]) -> Option<Self> {
        let five = |big_endian: bool| -> Option<[u32; 5]> {
            let word = |n: usize| {
                let four = bytes.get(4 * n..4 * n + 4)?.try_into().ok()?;
                Some(if big_endian { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) })
            };
            Some([word(0)?, word(1)?, word(2)?, word(3)?, word(4)?])
        };
        // The thousands digit of the type is the byte order.
        [false, true].into_iter().find_map(|big_endian| {
            let [kind, rows, columns, imaginary, name] = five(big_endian)?;
            let fits = kind / 1000 == u32::from(big_endian)
                && kind / 100 % 10 == 0
                && kind / 10 % 10 <= 5
                && kind % 10 <= 2
                && imaginary <= 1
                && (2..=NAME).contains(&name);
            let complex = imaginary == 1;
            let (stored, sort) = (kind / 10 % 10, kind % 10);
            fits.then_some(Self { big_endian, stored, sort, rows, columns, complex, name })
        })
    }

    fn number(&self) -> Number {
        let kind = match self.stored {
            0 => Kind::F64,
            1 => Kind::F32,
            2 => Kind::I32,
            3 => Kind::I16,
            4 => Kind::U16,
            _ => Kind::U8,
        };
        Number { kind, big_endian: self.big_endian }
    }
}

/// Whether a file begins like one of version 4: with a matrix whose name is a name.
pub(crate) fn recognise(start: &[u8]) -> bool {
    let Some(header) = Header::of(start) else { return false };
    let name = start.get(HEADER as usize..HEADER as usize + header.name as usize);
    name.is_some_and(|name| {
        let (last, name) = name.split_last().unwrap_or((&1, &[]));
        *last == 0
            && name.iter().all(|b| b.is_ascii_alphanumeric() || *b == b'_')
            && name.first().is_some_and(u8::is_ascii_alphabetic)
    })
}

/// Opens a file. Samples stay in it.
pub fn open(path: &Path) -> Result<Recording> {
    let io = |e| Error::read(path, e);
    let mut file = BufReader::new(File::open(path).map_err(io)?);
    let size = file.get_ref().metadata().map_err(io)?.len();
    let (mut channels, mut notes, mut at) = (Vec::new(), Vec::new(), 0);
    while at + HEADER <= size {
        let damaged = |what: &str| Error::damaged(path, FORMAT, format!("matrix at byte {at}: {what}"));
        file.seek(SeekFrom::Start(at)).map_err(io)?;
        let mut bytes = [0; HEADER as usize];
        file.read_exact(&mut bytes).map_err(io)?;
        let header = Header::of(&bytes).ok_or_else(|| damaged("it does not begin like one"))?;
        let mut name = Vec::new();
        (&mut file).take(u64::from(header.name)).read_to_end(&mut name).map_err(io)?;
        let name = String::from_utf8_lossy(&name).trim_end_matches('\0').to_owned();
        let number = header.number();
        let (rows, columns) = (u64::from(header.rows), u64::from(header.columns));
        let parts = if header.complex { 2 } else { 1 };
        let length =
            rows.checked_mul(columns).and_then(|n| n.checked_mul(parts * number.kind.bytes() as u64));
        let start = at + HEADER + u64::from(header.name);
        let end = length.and_then(|length| start.checked_add(length));
        let end = end.filter(|end| *end <= size).ok_or_else(|| damaged("it ends behind the file"))?;
        match (header.sort, header.complex) {
            (0, false) if rows * columns > 0 => match crate::shape::table(&[rows, columns]) {
                Ok((rows, columns)) => {
                    let plain = Plain { name, rows, columns, number, start };
                    channels.extend(plain.channels(path, 0));
                }
                Err(why) => notes.push(left_out(&name, &why)),
            },
            (0 | 2, _) => notes.push(left_out(&name, "it is complex, sparse or empty")),
            _ => {}
        }
        at = end;
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes })
}
