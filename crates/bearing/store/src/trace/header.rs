//! The header of a structured `.npy` file (NumPy Enhancement Proposal 1, versions 1.0 and 2.0).
//!
//! ```text
//! \x93NUMPY 1 0 <length> {'descr': [('time_s', '<f8'), …], 'fortran_order': False, 'shape': (12,), }   …\n
//! ```
//!
//! `numpy.load` refuses headers of more than 10 000 characters. Where the list of pairs is longer, the same
//! record type is described in its short form, which takes four characters a channel beside the name instead
//! of thirteen:
//!
//! ```text
//! {'descr': ('V24', {'names':['time_s','x','y'],'formats':'ddd'}), 'fortran_order': False, 'shape': (12,), }
//! ```
//!
//! `numpy.dtype` takes both (*NumPy Reference*, Data type objects: a base type with a new type, and a
//! dictionary of names and formats, here a sequence of one-letter type codes). Of names that are too long for
//! that, too, no header can be short enough: see [`archive`](super::archive).

use std::collections::HashSet;

/// First bytes of every `.npy` file.
pub(super) const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// Longest header that is read or written: some 20 000 channels.
const MAX_LENGTH: usize = 1 << 20;
/// Longest header that `numpy.load` reads with its default `max_header_size` [characters].
const NUMPY_LIMIT: usize = 10_000;
/// Digits kept free for the number of rows, so that the header can be rewritten in place.
const ROW_DIGITS: usize = 20;
/// The data start at a multiple of this, so that NumPy can map the file.
const ALIGNMENT: usize = 64;

/// Checks that `names` can be fields of a record: not empty, unique, printable ASCII without quotes.
pub(super) fn check_names<S: AsRef<str>>(names: &[S]) -> Result<(), String> {
    if names.is_empty() {
        return Err("a trace needs one channel at least".to_owned());
    }
    let mut seen = HashSet::with_capacity(names.len());
    for (i, name) in names.iter().map(AsRef::as_ref).enumerate() {
        let printable = name.bytes().all(|b| (b' '..=b'~').contains(&b) && b != b'\'' && b != b'\\');
        if name.is_empty() || !printable {
            return Err(format!("channel {i} is called {name:?}; names are printable ASCII without quotes"));
        }
        if !seen.insert(name) {
            return Err(format!("two channels are called `{name}`; names must differ"));
        }
    }
    Ok(())
}

/// The record type as a list of names and types.
fn pairs<S: AsRef<str>>(names: &[S]) -> String {
    let fields: Vec<String> = names.iter().map(|name| format!("('{}', '<f8')", name.as_ref())).collect();
    format!("[{}]", fields.join(", "))
}

/// The record type in its short form. The letter `d` is the machine's own double, which is little-endian
/// wherever this program is built.
fn short_form<S: AsRef<str>>(names: &[S]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("'{}'", name.as_ref())).collect();
    let (size, formats) = (8 * names.len(), "d".repeat(names.len()));
    format!("('V{size}', {{'names':[{}],'formats':'{formats}'}})", quoted.join(","))
}

/// Header text before the number of rows; the prefix of the file [bytes], and the length of the header after
/// it.
fn layout(descr: &str) -> (String, usize, usize) {
    let head = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': (");
    // The longest tail decides the length; shorter ones are filled with spaces.
    let longest = head.len() + ROW_DIGITS + ",), }".len() + 1;
    // Version 1.0 counts the header in two bytes, version 2.0 in four.
    let prefix = if longest + ALIGNMENT + 10 <= usize::from(u16::MAX) { 10 } else { 12 };
    let length = (prefix + longest).next_multiple_of(ALIGNMENT) - prefix;
    (head, prefix, length)
}

/// Whether `numpy.load` reads the header of these channels with its default limit.
pub(super) fn opens_in_numpy<S: AsRef<str>>(names: &[S]) -> bool {
    layout(&short_form(names)).2 <= NUMPY_LIMIT || layout(&pairs(names)).2 <= NUMPY_LIMIT
}

/// The complete header for `rows` records, of the same length for every number of rows.
pub(super) fn encode<S: AsRef<str>>(names: &[S], rows: u64) -> Result<Vec<u8>, String> {
    let (mut head, mut prefix, mut length) = layout(&pairs(names));
    if length > NUMPY_LIMIT {
        let short = layout(&short_form(names));
        // Where neither is short enough, pairs are used, which more programs understand.
        if short.2 <= NUMPY_LIMIT {
            (head, prefix, length) = short;
        }
    }
    let tail = format!("{rows},), }}");
    if length > MAX_LENGTH {
        return Err(format!(
            "{} channels make a header of {length} bytes; the limit is {MAX_LENGTH}",
            names.len()
        ));
    }
    let total = prefix + length;
    let mut bytes = Vec::with_capacity(total);
    bytes.extend_from_slice(MAGIC);
    match u16::try_from(length) {
        Ok(length) if prefix == 10 => {
            bytes.extend_from_slice(&[1, 0]);
            bytes.extend_from_slice(&length.to_le_bytes());
        }
        _ => {
            bytes.extend_from_slice(&[2, 0]);
            bytes.extend_from_slice(&(length as u32).to_le_bytes());
        }
    }
    bytes.extend_from_slice(head.as_bytes());
    bytes.extend_from_slice(tail.as_bytes());
    bytes.resize(total - 1, b' ');
    bytes.push(b'\n');
    Ok(bytes)
}

/// The header of an array of `rows` doubles.
pub(super) fn encode_column(rows: usize) -> Vec<u8> {
    let head = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows},), }}");
    let total = (10 + head.len() + 1).next_multiple_of(ALIGNMENT);
    let mut bytes = [&MAGIC[..], &[1, 0], &((total - 10) as u16).to_le_bytes(), head.as_bytes()].concat();
    bytes.resize(total - 1, b' ');
    bytes.push(b'\n');
    bytes
}

/// Whether a header text is that of an array of doubles.
pub(super) fn check_column(text: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(text).map_err(|_| "has a header that is not text".to_owned())?;
    let doubles = text.contains("'descr': '<f8'") && text.contains("'fortran_order': False");
    if doubles { Ok(()) } else { Err("is no array of little-endian doubles".to_owned()) }
}

/// Bytes before the header text, and its length, from the first 12 bytes of a file.
pub(super) fn extent(start: &[u8]) -> Result<(usize, usize), String> {
    if start.len() < MAGIC.len() || &start[..MAGIC.len()] != MAGIC {
        return Err("it does not begin like a `.npy` file".to_owned());
    }
    let cut = || "it ends inside its header".to_owned();
    let version = *start.get(6).ok_or_else(cut)?;
    let (prefix, length) = match version {
        1 => {
            let bytes: [u8; 2] = start.get(8..10).and_then(|b| b.try_into().ok()).ok_or_else(cut)?;
            (10, usize::from(u16::from_le_bytes(bytes)))
        }
        2 | 3 => {
            let bytes: [u8; 4] = start.get(8..12).and_then(|b| b.try_into().ok()).ok_or_else(cut)?;
            (12, u32::from_le_bytes(bytes) as usize)
        }
        other => return Err(format!("it has the `.npy` version {other}; 1 to 3 are known")),
    };
    if length > MAX_LENGTH {
        return Err(format!("its header claims {length} bytes; the limit is {MAX_LENGTH}"));
    }
    Ok((prefix, length))
}

/// Channel names of a header text. The number of rows is not read: the file's size is more reliable.
pub(super) fn decode(text: &[u8]) -> Result<Vec<String>, String> {
    let text = std::str::from_utf8(text).map_err(|_| "its header is not text".to_owned())?;
    if !text.contains("'fortran_order': False") {
        return Err("its header does not say `'fortran_order': False`".to_owned());
    }
    if !text.contains("'shape': (") {
        return Err("its header has no `'shape'`".to_owned());
    }
    let (_, rest) = text.split_once("'descr':").ok_or(FOREIGN)?;
    let rest = rest.trim_start();
    let names = if rest.starts_with('(') { of_short_form(rest) } else { of_pairs(rest) }?;
    check_names(&names)?;
    Ok(names)
}

const FOREIGN: &str = "its records are not named little-endian doubles (`[('name', '<f8'), …]`)";

/// Channel names of a list of names and types.
fn of_pairs(text: &str) -> Result<Vec<String>, String> {
    let mut rest = text.strip_prefix('[').ok_or(FOREIGN)?;
    let mut names = Vec::new();
    loop {
        rest = rest.trim_start_matches([',', ' ']);
        if rest.starts_with(']') {
            return Ok(names);
        }
        let field = rest.strip_prefix("('").and_then(|rest| rest.split_once('\''));
        let (name, after) = field.ok_or(FOREIGN)?;
        let Some(after) = after.trim_start_matches([',', ' ']).strip_prefix("'<f8')") else {
            return Err(format!("its channel `{name}` is not a little-endian double (`'<f8'`)"));
        };
        names.push(name.to_owned());
        rest = after;
    }
}

/// Channel names of the short form, as [`short_form`] writes it.
fn of_short_form(text: &str) -> Result<Vec<String>, String> {
    let (_, rest) = text.split_once("{'names':[").ok_or(FOREIGN)?;
    let (list, rest) = rest.split_once("],'formats':'").ok_or(FOREIGN)?;
    let (formats, _) = rest.split_once("'})").ok_or(FOREIGN)?;
    let inner = list.strip_prefix('\'').and_then(|list| list.strip_suffix('\'')).ok_or(FOREIGN)?;
    let names: Vec<String> = inner.split("','").map(str::to_owned).collect();
    if formats.len() != names.len() || formats.bytes().any(|letter| letter != b'd') {
        return Err("its channels are not all doubles (`'d'`)".to_owned());
    }
    Ok(names)
}
