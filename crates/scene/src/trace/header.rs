//! The header of a structured `.npy` file (NumPy Enhancement Proposal 1, versions 1.0 and 2.0).
//!
//! ```text
//! \x93NUMPY 1 0 <length> {'descr': [('time_s', '<f8'), …], 'fortran_order': False, 'shape': (12,), }   …\n
//! ```

use std::collections::HashSet;

/// First bytes of every `.npy` file.
pub(crate) const MAGIC: &[u8; 6] = b"\x93NUMPY";
/// Longest header that is read or written: some 20 000 channels.
const MAX_LENGTH: usize = 1 << 20;
/// Digits kept free for the number of rows, so that the header can be rewritten in place.
const ROW_DIGITS: usize = 20;
/// The data start at a multiple of this, so that NumPy can map the file.
const ALIGNMENT: usize = 64;

/// Checks that `names` can be fields of a record: not empty, unique, printable ASCII without quotes.
pub(crate) fn check_names<S: AsRef<str>>(names: &[S]) -> Result<(), String> {
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

/// The complete header for `rows` records, of the same length for every number of rows.
pub(crate) fn encode<S: AsRef<str>>(names: &[S], rows: u64) -> Result<Vec<u8>, String> {
    let fields: Vec<String> = names.iter().map(|name| format!("('{}', '<f8')", name.as_ref())).collect();
    let head = format!("{{'descr': [{}], 'fortran_order': False, 'shape': (", fields.join(", "));
    let tail = format!("{rows},), }}");
    // The longest tail decides the length; shorter ones are filled with spaces.
    let longest = head.len() + ROW_DIGITS + ",), }".len() + 1;
    // Version 1.0 counts the header in two bytes, version 2.0 in four.
    let short = longest + ALIGNMENT + 10 <= usize::from(u16::MAX);
    let prefix = if short { 10 } else { 12 };
    let total = (prefix + longest).next_multiple_of(ALIGNMENT);
    let length = total - prefix;
    if length > MAX_LENGTH {
        return Err(format!(
            "{} channels make a header of {length} bytes; the limit is {MAX_LENGTH}",
            names.len()
        ));
    }
    let mut bytes = Vec::with_capacity(total);
    bytes.extend_from_slice(MAGIC);
    match u16::try_from(length) {
        Ok(length) if short => {
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

/// Bytes before the header text, and its length, from the first 12 bytes of a file.
pub(crate) fn extent(start: &[u8]) -> Result<(usize, usize), String> {
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

/// Channel names of a header text. The number of rows is not read: the file's size tells it more reliably.
pub(crate) fn decode(text: &[u8]) -> Result<Vec<String>, String> {
    let text = std::str::from_utf8(text).map_err(|_| "its header is not text".to_owned())?;
    if !text.contains("'fortran_order': False") {
        return Err("its header does not say `'fortran_order': False`".to_owned());
    }
    if !text.contains("'shape': (") {
        return Err("its header has no `'shape'`".to_owned());
    }
    let foreign = "its records are not named little-endian doubles (`[('name', '<f8'), …]`)".to_owned();
    let Some((_, rest)) = text.split_once("'descr':") else { return Err(foreign) };
    let Some(mut rest) = rest.trim_start().strip_prefix('[') else { return Err(foreign) };
    let mut names = Vec::new();
    loop {
        rest = rest.trim_start_matches([',', ' ']);
        if rest.starts_with(']') {
            break;
        }
        let field = rest.strip_prefix("('").and_then(|rest| rest.split_once('\''));
        let Some((name, after)) = field else { return Err(foreign) };
        let Some(after) = after.trim_start_matches([',', ' ']).strip_prefix("'<f8')") else {
            return Err(format!("its channel `{name}` is not a little-endian double (`'<f8'`)"));
        };
        names.push(name.to_owned());
        rest = after;
    }
    check_names(&names)?;
    Ok(names)
}
