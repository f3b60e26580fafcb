//! Chunked sets as HDF5 2.0 writes them to its newest format, in the form of version 1.14, which hdf5-pure reads.
//!
//! The layout message of version 5 has the fields of version 4, under another number. What differs are the
//! sizes of packed chunks in an index: they take eight bytes, and the head of the index says so. Source:
//! `H5Olayout.c` and `H5Dfarray.c`, HDF5 2.0.0; the checksum is `H5checksum.c`, Jenkins' lookup3.

use std::num::Wrapping;

use crate::hdf5_links::number;

/// Kind of the message that says how a set lies in the file.
const LAYOUT: u8 = 8;
/// Begin of such a message: version and chunks.
const CHUNKED: [u8; 2] = [5, 2];

/// The bytes of a file with its layouts of version 5 numbered 4.
pub(crate) fn as_version_4(mut bytes: Vec<u8>) -> Vec<u8> {
    const NAME: &[u8] = b"OHDR\x02";
    let heads: Vec<usize> =
        bytes.windows(NAME.len()).enumerate().filter(|(_, w)| *w == NAME).map(|(n, _)| n).collect();
    for at in heads {
        renumber(&mut bytes, at);
    }
    bytes
}

/// Does that in the header at a place, where its checksum says that it is one.
fn renumber(bytes: &mut [u8], at: usize) -> Option<()> {
    let flags = *bytes.get(at + 5)?;
    let start = at + 6 + if flags & 0x20 == 0 { 0 } else { 16 } + if flags & 0x10 == 0 { 0 } else { 4 };
    let width = 1 << (flags & 3);
    let size = usize::try_from(number(bytes.get(start..start + width)?)).ok()?;
    let mut message = start + width;
    let end = message.checked_add(size)?;
    let sum = bytes.get(end..end.checked_add(4)?)?;
    if sum != lookup3(&bytes[at..end]).to_le_bytes() {
        return None;
    }
    let prefix = if flags & 4 == 0 { 4 } else { 6 };
    while let Some(&[kind, low, high]) = bytes[..end].get(message..message + 3) {
        let body = message + prefix;
        if kind == LAYOUT && bytes[..end].get(body..body + 2) == Some(&CHUNKED) {
            bytes[body] = 4;
        }
        message = body + usize::from(u16::from_le_bytes([low, high]));
    }
    let sum = lookup3(&bytes[at..end]).to_le_bytes();
    bytes[end..end + 4].copy_from_slice(&sum);
    Some(())
}

fn lookup3(key: &[u8]) -> u32 {
    let begin = Wrapping(0xdead_beef) + Wrapping(key.len() as u32);
    let [mut a, mut b, mut c] = [begin; 3];
    let turned = |x: Wrapping<u32>, by| Wrapping(x.0.rotate_left(by));
    let mut blocks = key.chunks(12).peekable();
    while let Some(block) = blocks.next() {
        let mut words = block.chunks(4).map(|word| Wrapping(number(word) as u32));
        let mut word = || words.next().unwrap_or_default();
        (a, b, c) = (a + word(), b + word(), c + word());
        if blocks.peek().is_some() {
            for (first, second) in [(4, 6), (16, 19)] {
                a = (a - c) ^ turned(c, first);
                c += b;
                b = (b - a) ^ turned(a, second);
                a += c;
                c = (c - b) ^ turned(b, if first == 4 { 8 } else { 4 });
                b += a;
            }
        } else {
            c = (c ^ b) - turned(b, 14);
            a = (a ^ c) - turned(c, 11);
            b = (b ^ a) - turned(a, 25);
            c = (c ^ b) - turned(b, 16);
            a = (a ^ c) - turned(c, 4);
            b = (b ^ a) - turned(a, 14);
            c = (c ^ b) - turned(b, 24);
        }
    }
    c.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers are those of the comment in Bob Jenkins' lookup3.c (2006), `driver5`.
    #[test]
    fn peer_the_checksum_of_known_texts() {
        assert_eq!(lookup3(b""), 0xdead_beef);
        assert_eq!(lookup3(b"Four score and seven years ago"), 0x1777_0551);
    }
}
