//! Numbers that HDF5 keeps in chunks, one chunk at a time: plain, deflated, shuffled, with checksums.
//!
//! hdf5-pure says where the chunks are; its own windows run along the first extent, and the samples of a
//! MATLAB vector lie along the last. Source: HDF5 File Format Specification 3.0, §IV.A.2.l (filters); the
//! checksum is that of `H5checksum.c`.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use flate2::read::ZlibDecoder;
use hdf5_pure::Dataset;
use stribeck_dsp::channel::Samples;

use crate::number::Number;
use crate::{Error, Result};

/// Largest chunk [bytes]; one is held at a time.
const LARGEST: u64 = 1 << 28;
/// Samples handed on at a time.
const BLOCK: usize = 1 << 16;
/// Most filters of a set: a chunk says in 32 bits which of them it went without.
const MOST_FILTERS: usize = 32;
/// Numbers of the filters.
const DEFLATE: u16 = 1;
const SHUFFLE: u16 = 2;
const FLETCHER: u16 = 3;

/// Properties that all channels of a set share.
#[derive(Debug)]
struct Set {
    path: PathBuf,
    format: &'static str,
    number: Number,
    /// Filters of each chunk, in the order of writing: number, and element size of the shuffle filter.
    filters: Vec<(u16, usize)>,
    /// Bytes of a whole chunk.
    bytes: usize,
}

#[derive(Debug, Clone, Copy)]
struct Chunk {
    place: u64,
    at: u64,
    size: u64,
    /// Filters that were left out, a bit each.
    skipped: u32,
}

/// A channel: the numbers along one extent, at one place of the others.
#[derive(Debug, Clone)]
pub(crate) struct Column {
    set: Arc<Set>,
    /// Those that were written, and how many there should be.
    chunks: Arc<Vec<Chunk>>,
    whole: u64,
    /// Samples in a chunk, and where they are: the first one and the distance of two [numbers].
    samples: u64,
    first: usize,
    stride: usize,
}

/// Channels along the extent `along`, one for each place on the extent `across`; `None` for chunks that are
/// packed in other ways, are larger than what is held, or of which few were written at some place across. Samples of
/// chunks that were never written are missing.
pub(crate) fn columns(
    path: &Path,
    format: &'static str,
    dataset: &Dataset,
    number: Number,
    along: usize,
    across: Option<usize>,
) -> std::result::Result<Option<Vec<Column>>, hdf5_pure::Error> {
    let (shape, Some(chunk)) = (dataset.shape()?, dataset.chunk_shape()?) else { return Ok(None) };
    let width = number.kind.bytes();
    let numbers = chunk.iter().try_fold(1_u64, |product, n| product.checked_mul(*n)).unwrap_or(u64::MAX);
    let known = |id| matches!(id, DEFLATE | SHUFFLE | FLETCHER);
    let filters = dataset.filter_pipeline();
    if numbers == 0
        || numbers.saturating_mul(width as u64) > LARGEST
        || filters.len() != dataset.filters().len()
        || filters.len() > MOST_FILTERS
        || !filters.iter().all(|f| known(f.id))
    {
        return Ok(None);
    }
    let element = |data: &[u32]| data.first().map_or(width, |n| *n as usize);
    let set = Arc::new(Set {
        path: path.to_owned(),
        format,
        number,
        filters: filters.iter().map(|f| (f.id, element(&f.client_data))).collect(),
        bytes: numbers as usize * width,
    });
    // Chunks by their place across.
    let mut rows: BTreeMap<u64, Vec<Chunk>> = BTreeMap::new();
    for stored in dataset.chunks()? {
        let place = |axis: usize| stored.offset.get(axis).map_or(0, |n| n / chunk[axis]);
        rows.entry(across.map_or(0, place)).or_default().push(Chunk {
            place: place(along),
            at: stored.address,
            size: stored.storage_size,
            skipped: stored.filter_mask,
        });
    }
    let whole = |axis: usize| shape[axis].div_ceil(chunk[axis]);
    rows.values_mut().for_each(|chunks| chunks.sort_by_key(|c| c.place));
    // Whichever is taken, the other one's place stays empty.
    if rows.values().any(|chunks| chunks.windows(2).any(|pair| pair[0].place == pair[1].place)) {
        return Err(hdf5_pure::Error::Shape("two of its chunks have the same place".to_owned()));
    }
    // A shape that is damaged promises more than any file holds.
    let is_empty = |chunks: &Vec<Chunk>| 16 * (chunks.len() as u64) < whole(along);
    if rows.len() as u64 != across.map_or(1, whole) || rows.values().any(is_empty) {
        return Ok(None);
    }
    let rows: Vec<Arc<Vec<Chunk>>> = rows.into_values().map(Arc::new).collect();
    let stride = |axis: usize| chunk[axis + 1..].iter().product::<u64>() as usize;
    let column = |n: u64| {
        let (row, within) = across.map_or((0, 0), |a| (n / chunk[a], (n % chunk[a]) as usize * stride(a)));
        Column {
            set: set.clone(),
            chunks: rows[row as usize].clone(),
            whole: whole(along),
            samples: chunk[along],
            first: within,
            stride: stride(along),
        }
    };
    Ok(Some((0..across.map_or(1, |a| shape[a])).map(column).collect()))
}

impl Column {
    /// How many samples from the beginning on no chunk holds, and where the first of these are.
    pub(crate) fn missing(&self, len: u64) -> Option<(u64, u64)> {
        let holds = |place: &u64| self.chunks.binary_search_by_key(place, |chunk| chunk.place).is_ok();
        let of = |place: u64| self.samples.min(len.saturating_sub(place * self.samples));
        let first = (0..self.whole).find(|place| !holds(place))?;
        Some(((first..self.whole).filter(|place| !holds(place)).map(of).sum(), first * self.samples))
    }
}

impl Samples for Column {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let set = &*self.set;
        let mut file = File::open(&set.path).map_err(|e| Error::read(&set.path, e))?;
        let mut block = Vec::new();
        let mut written = self.chunks.iter().peekable();
        for place in 0..self.whole {
            let chunk = written.next_if(|chunk| chunk.place == place);
            let bytes = chunk.map_or_else(|| Ok(Vec::new()), |chunk| set.unpacked(&mut file, chunk))?;
            let width = set.number.kind.bytes();
            let count = self.samples.min(len.saturating_sub(place * self.samples)) as usize;
            let numbers =
                bytes.get(self.first * width..).unwrap_or(&[]).chunks_exact(width).step_by(self.stride);
            let missing = std::iter::repeat_n(f64::NAN, if chunk.is_none() { count } else { 0 });
            let mut numbers = numbers.take(count).map(|at| set.number.decode(at)).chain(missing);
            // A set may be one chunk.
            loop {
                block.clear();
                block.extend(numbers.by_ref().take(BLOCK));
                if block.is_empty() {
                    break;
                }
                if !take(&block) {
                    return Ok(());
                }
            }
        }
        Ok(())
    }
}

impl Set {
    fn damaged(&self, chunk: &Chunk, what: &str) -> Error {
        Error::damaged(&self.path, self.format, format!("the chunk at byte {} {what}", chunk.at))
    }

    /// The numbers of a chunk as they were before they were packed.
    fn unpacked(&self, file: &mut File, chunk: &Chunk) -> Result<Vec<u8>> {
        let io = |e| Error::read(&self.path, e);
        file.seek(SeekFrom::Start(chunk.at)).map_err(io)?;
        let mut bytes = Vec::new();
        file.take(chunk.size).read_to_end(&mut bytes).map_err(io)?;
        if (bytes.len() as u64) < chunk.size {
            return Err(self.damaged(chunk, "ends behind the file"));
        }
        for (n, (filter, element)) in self.filters.iter().enumerate().rev() {
            if chunk.skipped >> n & 1 == 1 {
                continue;
            }
            match *filter {
                DEFLATE => {
                    // Each checksum before it adds four bytes.
                    let most = (self.bytes + 4 * self.filters.len()) as u64;
                    let mut plain = Vec::with_capacity(self.bytes);
                    let read = ZlibDecoder::new(&bytes[..]).take(most).read_to_end(&mut plain);
                    read.map_err(|_| self.damaged(chunk, "does not unpack"))?;
                    bytes = plain;
                }
                SHUFFLE => bytes = unshuffled(&bytes, *element),
                _ => {
                    let body = bytes.len().saturating_sub(4);
                    if bytes.len() < 4 || bytes[body..] != fletcher(&bytes[..body]).to_le_bytes() {
                        return Err(self.damaged(chunk, "does not agree with its checksum"));
                    }
                    bytes.truncate(body);
                }
            }
        }
        if bytes.len() != self.bytes {
            return Err(
                self.damaged(chunk, &format!("holds {} bytes in place of {}", bytes.len(), self.bytes))
            );
        }
        Ok(bytes)
    }
}

/// Elements whose bytes were stored by their place in the element; a remainder that fills no element stays at
/// the end.
fn unshuffled(bytes: &[u8], element: usize) -> Vec<u8> {
    let count = bytes.len().checked_div(element).unwrap_or(0);
    let mut out = Vec::with_capacity(bytes.len());
    for n in 0..count {
        out.extend((0..element).map(|place| bytes[place * count + n]));
    }
    out.extend_from_slice(&bytes[count * element..]);
    out
}

/// Fletcher's checksum of 16-bit words whose first byte is the upper one.
fn fletcher(bytes: &[u8]) -> u32 {
    let (mut low, mut high) = (0_u32, 0_u32);
    for word in bytes.chunks(2) {
        low = (low + (u32::from(word[0]) << 8 | word.get(1).map_or(0, |b| u32::from(*b)))) % 65_535;
        high = (high + low) % 65_535;
    }
    // Folding sums leaves 65535 where the remainder is 0, but for sums of nothing.
    let folded = |sum: u32| if sum == 0 && bytes.iter().any(|b| *b != 0) { 65_535 } else { sum };
    folded(high) << 16 | folded(low)
}
