//! Names in a group of HDF5, where one member spoils the list that hdf5-pure makes of all: a link to another
//! object in an old group, an object whose header is damaged in any. Each of the others can be opened by its
//! name.
//!
//! Source: HDF5 File Format Specification 3.0, §II (superblocks 0 to 3), §III.A.1, §III.B to D, §IV.A.1, and
//! the messages of §IV.A.2.c, g, q and r.

mod dense;

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Blocks of one header or tree, and bytes of the names of a group, at most.
const MOST: usize = 100_000;
const NAMES: u64 = 1 << 24;
/// Largest block of a header.
const BLOCK: u64 = 1 << 22;
/// Trees within trees.
const DEEPEST: usize = 16;

/// Kinds of messages in a header.
const LINK_INFO: u16 = 2;
const LINK: u16 = 6;
const CONTINUATION: u16 = 16;
const SYMBOL_TABLE: u16 = 17;

/// One name in a group.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Member {
    pub(crate) name: String,
    /// Where the header of the object is; none for a link to another name or file.
    at: Option<u64>,
}

impl Member {
    /// Whether it is the object itself, and not a link to another name or file.
    pub(crate) fn is_object(&self) -> bool {
        self.at.is_some()
    }
}

/// The members of the group that these names lead to from the root; `None` where that group itself is damaged
/// or of another form.
pub(crate) fn members(path: &Path, trail: &[String]) -> Option<Vec<Member>> {
    let mut file = File::open(path).ok()?;
    // A superblock stands at 0 or 512 (MATLAB).
    [0_u64, 512].into_iter().find_map(|begin| {
        let head = bytes(&mut file, begin, 96)?;
        if !head.starts_with(b"\x89HDF\r\n\x1a\n") {
            return None;
        }
        // Sizes of addresses and lengths, the base of addresses, and the header of the root.
        let (sizes, base, root) = match head[8] {
            0 => (&head[13..15], 24, 64),
            1 => (&head[13..15], 28, 68),
            2 | 3 => (&head[9..11], 12, 36),
            _ => return None,
        };
        if sizes != [8, 8] {
            return None;
        }
        let mut source = Source { file: &mut file, base: long(&head, base), left: MOST };
        let mut found = source.group(long(&head, root))?;
        for name in trail {
            let at = found.iter().find(|member| member.name == *name)?.at?;
            found = source.group(at)?;
        }
        Some(found)
    })
}

struct Source<'a> {
    file: &'a mut File,
    base: u64,
    /// Blocks that may still be read.
    left: usize,
}

impl Source<'_> {
    /// So many bytes at an address.
    fn at(&mut self, address: u64, count: u64) -> Option<Vec<u8>> {
        self.left = self.left.checked_sub(1)?;
        bytes(self.file, self.base.checked_add(address)?, count)
    }

    /// Members of the group whose header is there; `None` for other objects.
    fn group(&mut self, header: u64) -> Option<Vec<Member>> {
        let messages = self.messages(header)?;
        let of =
            |kind: u16| messages.iter().filter(move |(of, _)| *of == kind).map(|(_, body)| body.as_slice());
        if let Some(table) = of(SYMBOL_TABLE).next() {
            return self.old(long(table, 0), long(table, 8));
        }
        let mut members: Vec<Member> = of(LINK).filter_map(link).collect();
        match of(LINK_INFO).next() {
            None if members.is_empty() => return None,
            // A creation order stands before the addresses of the heap and of the tree by names.
            Some(&[_, flags, ref rest @ ..]) => {
                let skip = if flags & 1 == 1 { 8 } else { 0 };
                let (heap, tree) = (long(rest, skip), long(rest, skip + 8));
                if heap != u64::MAX {
                    members.extend(self.dense(heap, tree)?);
                }
            }
            _ => {}
        }
        Some(members)
    }

    fn messages(&mut self, at: u64) -> Option<Vec<(u16, Vec<u8>)>> {
        let head = self.at(at, 16)?;
        let is_new = head.starts_with(b"OHDR");
        // Flags say how large the head and the prefixes of messages are.
        let (flags, mut block) = if is_new {
            let flags = head[5];
            let times = if flags & 0x20 == 0 { 0 } else { 16 };
            let start = 6 + times + if flags & 0x10 == 0 { 0 } else { 4 };
            let width = 1_u64 << (flags & 3);
            let size = number(&self.at(at + start, width)?);
            (flags, (at + start + width, size))
        } else if head[0] == 1 {
            (0, (at + 16, u64::from(u32::from_le_bytes(head.get(8..12)?.try_into().ok()?))))
        } else {
            return None;
        };
        let prefix = if !is_new {
            8
        } else if flags & 4 == 0 {
            4
        } else {
            6
        };
        let mut messages = Vec::new();
        let mut further = Vec::new();
        loop {
            let body = self.at(block.0, block.1.min(BLOCK))?;
            let mut rest = body.as_slice();
            while rest.len() >= prefix {
                let (kind, size) = if is_new {
                    (u16::from(rest[0]), u16::from_le_bytes([rest[1], rest[2]]))
                } else {
                    (u16::from_le_bytes([rest[0], rest[1]]), u16::from_le_bytes([rest[2], rest[3]]))
                };
                let Some(message) = rest.get(prefix..prefix + usize::from(size)) else { break };
                if kind == CONTINUATION {
                    further.push((long(message, 0), long(message, 8)));
                }
                messages.push((kind, message.to_vec()));
                rest = &rest[prefix + usize::from(size)..];
            }
            let Some((at, size)) = further.pop() else { return Some(messages) };
            // Between a name of the block and a checksum.
            block = if is_new { (at.checked_add(4)?, size.checked_sub(8)?) } else { (at, size) };
        }
    }

    /// Members of a group with a tree and a heap of names.
    fn old(&mut self, tree: u64, heap: u64) -> Option<Vec<Member>> {
        let head = self.at(heap, 32)?;
        if !head.starts_with(b"HEAP") {
            return None;
        }
        let names = self.at(long(&head, 24), long(&head, 8).min(NAMES))?;
        let mut members = Vec::new();
        self.node(tree, &names, &mut members, 0)?;
        Some(members)
    }

    fn node(&mut self, at: u64, names: &[u8], members: &mut Vec<Member>, level: usize) -> Option<()> {
        let head = self.at(at, 24)?;
        if !head.starts_with(b"TREE") || level > DEEPEST {
            return None;
        }
        let count = usize::from(u16::from_le_bytes([head[6], head[7]]));
        let body = self.at(at + 24, 8 * (2 * count as u64 + 1))?;
        for n in 0..count {
            let child = long(&body, 16 * n + 8);
            if head[5] > 0 {
                self.node(child, names, members, level + 1)?;
            } else {
                self.entries(child, names, members)?;
            }
        }
        Some(())
    }

    fn entries(&mut self, at: u64, names: &[u8], members: &mut Vec<Member>) -> Option<()> {
        const ENTRY: usize = 40;
        /// The entry is a link to another name.
        const SOFT: u8 = 2;
        let head = self.at(at, 8)?;
        if !head.starts_with(b"SNOD") {
            return None;
        }
        let count = usize::from(u16::from_le_bytes([head[6], head[7]]));
        let body = self.at(at + 8, (ENTRY * count) as u64)?;
        for entry in body.chunks_exact(ENTRY) {
            let name = names.get(usize::try_from(long(entry, 0)).ok()?..)?;
            let name = String::from_utf8_lossy(name.split(|b| *b == 0).next()?).into_owned();
            members.push(Member { name, at: (entry[16] != SOFT).then(|| long(entry, 8)) });
        }
        Some(())
    }
}

/// The member that a link message says.
fn link(body: &[u8]) -> Option<Member> {
    let &[1, flags, ref rest @ ..] = body else { return None };
    let (kind, rest) = if flags & 8 == 0 { (0, rest) } else { (*rest.first()?, rest.get(1..)?) };
    let skip = if flags & 4 == 0 { 0 } else { 8 } + if flags & 16 == 0 { 0 } else { 1 };
    let rest = rest.get(skip..)?;
    let width = 1_usize << (flags & 3);
    let (length, rest) = (number(rest.get(..width)?), rest.get(width..)?);
    let length = usize::try_from(length).ok()?;
    let name = String::from_utf8_lossy(rest.get(..length)?).into_owned();
    let at = match kind {
        0 => Some(number(rest.get(length..length.checked_add(8)?)?)),
        _ => None,
    };
    Some(Member { name, at })
}

fn bytes(file: &mut File, at: u64, count: u64) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(at)).ok()?;
    file.take(count).read_to_end(&mut bytes).ok()?;
    (bytes.len() as u64 == count).then_some(bytes)
}

/// Up to eight bytes as a number.
pub(crate) fn number(bytes: &[u8]) -> u64 {
    bytes.iter().take(8).rev().fold(0, |sum, byte| sum << 8 | u64::from(*byte))
}

/// Eight bytes as a number; zero where they are missing.
fn long(bytes: &[u8], at: usize) -> u64 {
    bytes.get(at..at + 8).map_or(0, number)
}
