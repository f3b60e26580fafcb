//! Names in old groups of HDF5, in which a link to another object spoils the list that hdf5-pure makes.
//!
//! Source: HDF5 File Format Specification 3.0, §II.A (superblock 0 and 1), §III.A.1, §III.B to D.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Groups within groups, entries of one file, and bytes of its names, at most.
const DEEPEST: usize = 16;
const MOST: usize = 100_000;
const NAMES: u64 = 1 << 24;

/// Members of a group.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Links {
    /// Objects of the file; groups with their own members, where they are old ones.
    pub(crate) hard: Vec<(String, Option<Links>)>,
    /// Links to objects by their path.
    pub(crate) soft: Vec<String>,
}

/// The members of the root; `None` for files of another form, and for damaged ones.
pub(crate) fn of_file(path: &Path) -> Option<Links> {
    let mut file = File::open(path).ok()?;
    // A superblock stands at 0 or 512 (MATLAB).
    [0_u64, 512].into_iter().find_map(|base| {
        let head = bytes(&mut file, base, 104)?;
        if !head.starts_with(b"\x89HDF\r\n\x1a\n") || head[8] > 1 || head[13] != 8 || head[14] != 8 {
            return None;
        }
        // The root entry follows four addresses; its cache holds those of its tree and its names.
        let root = if head[8] == 0 { 56 } else { 60 };
        let (tree, heap) = (long(&head, root + 24), long(&head, root + 32));
        let kind = u32::from_le_bytes(head.get(root + 16..root + 20)?.try_into().ok()?);
        let mut source = Source { file: &mut file, base: long(&head, 24), left: MOST };
        (kind == 1).then(|| source.group(tree, heap, 0)).flatten()
    })
}

struct Source<'a> {
    file: &'a mut File,
    base: u64,
    /// Entries that may still be read.
    left: usize,
}

impl Source<'_> {
    fn at(&mut self, address: u64, count: u64) -> Option<Vec<u8>> {
        bytes(self.file, self.base.checked_add(address)?, count)
    }

    fn group(&mut self, tree: u64, heap: u64, depth: usize) -> Option<Links> {
        if depth > DEEPEST {
            return None;
        }
        let head = self.at(heap, 32)?;
        if !head.starts_with(b"HEAP") {
            return None;
        }
        let names = self.at(long(&head, 24), long(&head, 8).min(NAMES))?;
        let mut links = Links::default();
        self.node(tree, &names, &mut links, depth, 0)?;
        Some(links)
    }

    fn node(&mut self, at: u64, names: &[u8], links: &mut Links, depth: usize, level: usize) -> Option<()> {
        let head = self.at(at, 24)?;
        self.left = self.left.checked_sub(1)?;
        if !head.starts_with(b"TREE") || level > DEEPEST {
            return None;
        }
        let count = usize::from(u16::from_le_bytes([head[6], head[7]]));
        let body = self.at(at + 24, 8 * (2 * count as u64 + 1))?;
        for n in 0..count {
            let child = long(&body, 16 * n + 8);
            if head[5] > 0 {
                self.node(child, names, links, depth, level + 1)?;
            } else {
                self.entries(child, names, links, depth)?;
            }
        }
        Some(())
    }

    fn entries(&mut self, at: u64, names: &[u8], links: &mut Links, depth: usize) -> Option<()> {
        const ENTRY: usize = 40;
        let head = self.at(at, 8)?;
        if !head.starts_with(b"SNOD") {
            return None;
        }
        let count = usize::from(u16::from_le_bytes([head[6], head[7]]));
        let body = self.at(at + 8, (ENTRY * count) as u64)?;
        for entry in body.chunks_exact(ENTRY) {
            self.left = self.left.checked_sub(1)?;
            let name = names.get(usize::try_from(long(entry, 0)).ok()?..)?;
            let name = String::from_utf8_lossy(name.split(|b| *b == 0).next()?).into_owned();
            match entry[16] {
                2 => links.soft.push(name),
                1 => {
                    let inner = self.group(long(entry, 24), long(entry, 32), depth + 1);
                    links.hard.push((name, inner));
                }
                _ => links.hard.push((name, None)),
            }
        }
        Some(())
    }
}

fn bytes(file: &mut File, at: u64, count: u64) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(at)).ok()?;
    file.take(count).read_to_end(&mut bytes).ok()?;
    (bytes.len() as u64 == count).then_some(bytes)
}

/// Eight bytes as a number; zero where they are missing.
fn long(bytes: &[u8], at: usize) -> u64 {
    bytes.get(at..at + 8).and_then(|b| b.try_into().ok()).map_or(0, u64::from_le_bytes)
}
