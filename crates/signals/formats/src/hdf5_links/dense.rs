//! Links of a group with many members: in a fractal heap, whose places a version 2 B-tree lists by name.
//!
//! Source: HDF5 File Format Specification 3.0, §III.A.2, §III.G.

use super::{DEEPEST, Member, Source, link, long, number};

struct Heap {
    /// Bits of a place in it, and bytes of a place and of a length.
    bits: u32,
    widths: [usize; 2],
    /// Blocks in a row, and the bytes of those of the first row and of the largest that hold links.
    width: u64,
    first: u64,
    largest: u64,
    root: u64,
    /// Rows of the root; zero where it is itself a block of links.
    rows: u64,
}

impl Heap {
    fn of(head: &[u8]) -> Option<Self> {
        if !head.starts_with(b"FRHP") || head.get(7..9)? != [0, 0] {
            return None;
        }
        let bits = u32::from(u16::from_le_bytes([head[128], head[129]]));
        let [first, largest] = [long(head, 112), long(head, 120)];
        let width = u64::from(u16::from_le_bytes([head[110], head[111]]));
        if first == 0 || width == 0 || largest < first || bits > 64 {
            return None;
        }
        // A length goes up to the largest block, or the largest object.
        let most = largest.min(number(&head[10..14]));
        let bytes = |bits: u32| bits.div_ceil(8) as usize;
        Some(Self {
            bits,
            widths: [bytes(bits), bytes(u64::BITS - most.leading_zeros())],
            width,
            first,
            largest,
            root: long(head, 132),
            rows: number(&head[140..142]),
        })
    }

    /// Bytes of a block in a row: the first two rows have the smallest, each further one twice as much.
    fn block(&self, row: u64) -> u64 {
        self.first.checked_shl(u32::try_from(row.saturating_sub(1)).unwrap_or(u32::MAX)).unwrap_or(u64::MAX)
    }

    /// Bytes of the heap before a row.
    fn before(&self, row: u64) -> u64 {
        (0..row).fold(0, |sum: u64, row| sum.saturating_add(self.width.saturating_mul(self.block(row))))
    }
}

impl Source<'_> {
    /// The members whose links are in a heap.
    pub(super) fn dense(&mut self, heap: u64, tree: u64) -> Option<Vec<Member>> {
        let heap = Heap::of(&self.at(heap, 142)?)?;
        let head = self.at(tree, 34)?;
        if !head.starts_with(b"BTHD") || head[5] != 5 {
            return None;
        }
        let (node, record) = (number(&head[6..10]), number(&head[10..12]));
        let depth = number(&head[12..14]);
        if depth as usize > DEEPEST || record < 4 + 1 + heap.widths.iter().sum::<usize>() as u64 {
            return None;
        }
        let tree = Tree { node, record };
        let mut ids = Vec::new();
        self.records(&tree, (long(&head, 16), number(&head[24..26])), depth, &mut ids)?;
        // A link that cannot be read is left out, as an object that cannot be would be.
        Some(ids.iter().filter_map(|id| self.in_heap(&heap, id)).filter_map(|body| link(&body)).collect())
    }

    /// Identifiers of all links below a node at a depth; those of nodes that are damaged are left out.
    fn records(
        &mut self,
        tree: &Tree,
        (at, count): (u64, u64),
        depth: u64,
        ids: &mut Vec<Vec<u8>>,
    ) -> Option<()> {
        let node = self.at(at, tree.node)?;
        let is_leaf = depth == 0;
        if !node.starts_with(if is_leaf { b"BTLF" } else { b"BTIN" }) {
            return None;
        }
        let size = usize::try_from(tree.record).ok()?;
        let records = node.get(6..)?.get(..size.checked_mul(usize::try_from(count).ok()?)?)?;
        ids.extend(records.chunks_exact(size).map(|record| record[4..].to_vec()));
        if is_leaf {
            return Some(());
        }
        let [own, all] = tree.pointer(depth);
        let pointers = node.get(6 + records.len()..)?;
        for pointer in pointers.chunks_exact(8 + own + all).take(usize::try_from(count).ok()? + 1) {
            self.records(tree, (long(pointer, 0), number(&pointer[8..8 + own])), depth - 1, ids);
        }
        Some(())
    }

    fn in_heap(&mut self, heap: &Heap, id: &[u8]) -> Option<Vec<u8>> {
        // The first byte is 0 for one within the blocks.
        if *id.first()? != 0 {
            return None;
        }
        let [place, length] = heap.widths;
        let place_of = number(id.get(1..1 + place)?);
        let length = number(id.get(1 + place..1 + place + length)?);
        let (at, begin) = self.block(heap, place_of)?;
        self.at(at.checked_add(place_of.checked_sub(begin)?)?, length)
    }

    /// The block of links that holds a place: its address, and the place of its beginning.
    fn block(&mut self, heap: &Heap, place: u64) -> Option<(u64, u64)> {
        let (mut at, mut begin) = (heap.root, 0);
        let mut rows = heap.rows;
        for _ in 0..DEEPEST {
            if rows == 0 {
                return Some((at, begin));
            }
            // A block of blocks: a head, then its rows of addresses.
            let row = (0..rows).rev().find(|row| heap.before(*row) <= place - begin)?;
            let size = heap.block(row);
            let column = (place - begin - heap.before(row)) / size;
            if column >= heap.width {
                return None;
            }
            let head = 13 + u64::from(heap.bits.div_ceil(8));
            at = number(&self.at(at.checked_add(head + 8 * (row * heap.width + column))?, 8)?);
            begin += heap.before(row) + column * size;
            // One that is larger than the largest block of links has rows of its own.
            let inner = size / heap.first / heap.width;
            rows = if size > heap.largest { u64::from(u64::BITS - inner.leading_zeros()) } else { 0 };
        }
        None
    }
}

/// Sizes of a version 2 B-tree.
struct Tree {
    node: u64,
    record: u64,
}

impl Tree {
    /// Bytes of the two numbers behind an address in a node at a depth: its records, and all below it.
    fn pointer(&self, depth: u64) -> [usize; 2] {
        /// Name, version, type, and a checksum.
        const FRAME: u64 = 10;
        let bytes = |most: u64| (u64::BITS - most.max(1).leading_zeros()).div_ceil(8) as usize;
        let leaf = self.node.saturating_sub(FRAME) / self.record;
        let own = bytes(leaf);
        // All below a node at each depth; leaves have no second number.
        let (mut all, mut width) = (leaf, 0);
        for _ in 1..depth {
            let pointer = (8 + own + width) as u64;
            let here = self.node.saturating_sub(FRAME + pointer) / (self.record + pointer);
            all = (here + 1).saturating_mul(all).saturating_add(here);
            width = bytes(all);
        }
        [own, width]
    }
}
