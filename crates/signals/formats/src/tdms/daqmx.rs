//! Raw data of NI-DAQmx in TDMS: the rows of one or more cards, in which each channel has its place. The
//! scales of a channel make volts and units of them.
//!
//! Source: *TDMS File Format Internal Structure*, National Instruments, with the values that files have for
//! the two sorts of scalers.

use std::collections::HashMap;
use std::path::Path;

use super::{Metadata, Object};
use crate::number::{Kind, Number};
use crate::strided::Strided;

/// Indices of raw data that are such scalers: of numbers, and of digital lines.
pub(super) const NUMBERS: u32 = 0x1269;
pub(super) const LINES: u32 = 0x126a;

/// Where the numbers of a channel stand.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scaler {
    /// Rows of a chunk.
    count: u64,
    number: Number,
    /// The card, and the first byte in its row.
    buffer: usize,
    offset: u64,
    /// The number of the scale that stands for the stored numbers.
    pub(super) id: u32,
    /// Bytes of a row of each card.
    widths: Vec<u64>,
}

impl Scaler {
    /// Metadata behind the index: the scaler of a channel, or why it has none.
    pub(super) fn read(text: &mut Metadata<'_>, index: u32) -> Option<Result<Self, String>> {
        let (_, _, count) = (text.word()?, text.word()?, text.long()?);
        let scalers = text.word()?;
        let mut last = None;
        for _ in 0..scalers {
            let (kind, buffer, offset) = (text.word()?, text.word()?, text.word()?);
            // The format of a sample, which has one byte for digital lines.
            text.take(if index == LINES { 1 } else { 4 })?;
            last = Some((kind, buffer as usize, u64::from(offset), text.word()?));
        }
        let cards = text.word()?;
        let widths = (0..cards).map(|_| text.word().map(u64::from)).collect::<Option<Vec<u64>>>()?;
        if index == LINES {
            return Some(Err("it is a digital line".to_owned()));
        }
        let Some((kind, buffer, offset, id)) = last.filter(|_| scalers == 1) else {
            return Some(Err(format!("it is made of {scalers} scalers; channels of one are read")));
        };
        let kind = match kind {
            0 => Kind::U8,
            1 => Kind::I8,
            2 => Kind::U16,
            3 => Kind::I16,
            4 => Kind::U32,
            5 => Kind::I32,
            6 => Kind::U64,
            7 => Kind::I64,
            8 => Kind::F32,
            9 => Kind::F64,
            other => return Some(Err(format!("its scaler has the unknown type {other}"))),
        };
        let inside = widths.get(buffer).is_some_and(|width| offset + kind.bytes() as u64 <= *width);
        if !inside {
            return Some(Err("it stands behind the end of its row".to_owned()));
        }
        let number = Number { kind, big_endian: text.big_endian };
        Some(Ok(Self { count, number, buffer, offset, id, widths }))
    }
}

/// Locates the values of a segment. Returns a note on anything unusual.
pub(super) fn place(
    path: &Path,
    (start, held): (u64, u64),
    is_cut: bool,
    active: &[String],
    objects: &mut HashMap<String, Object>,
) -> Option<String> {
    let scalers: Vec<&Scaler> = active.iter().filter_map(|name| objects.get(name)?.scaler.as_ref()).collect();
    let widths = scalers.first()?.widths.clone();
    let others =
        active.iter().filter_map(|name| objects.get(name)).any(|o| o.scaler.is_none() && o.bytes > 0);
    if others || scalers.iter().any(|scaler| scaler.widths != widths) {
        return Some("its channels do not agree in how a row is made: it is left out".to_owned());
    }
    let rows = |card: usize| scalers.iter().filter(|s| s.buffer == card).map(|s| s.count).max().unwrap_or(0);
    let sizes: Option<Vec<u64>> =
        (0..widths.len()).map(|card| rows(card).checked_mul(widths[card])).collect();
    let chunk = sizes.as_ref().and_then(|all| all.iter().try_fold(0_u64, |sum, n| sum.checked_add(*n)));
    let (Some(sizes), Some(chunk)) = (sizes, chunk.filter(|n| *n > 0)) else {
        return Some("its sizes are no sizes: it is left out".to_owned());
    };
    // Far more chunks than any recorder writes would be a damaged count.
    const MOST: u64 = 10_000_000;
    let (chunks, rest) = ((held / chunk).min(MOST), held % chunk);
    // Where the recorder was stopped, the last chunk holds what was written until then, card after card.
    let mut unread = if is_cut { rest } else { 0 };
    let last: Vec<u64> = sizes
        .iter()
        .zip(&widths)
        .map(|(size, width)| {
            let here = unread.min(*size);
            unread -= here;
            here.checked_div(*width).unwrap_or(0)
        })
        .collect();
    for name in active {
        let Some(object) = objects.get_mut(name) else { continue };
        let Some(scaler) = object.scaler.clone() else { continue };
        let before: u64 = sizes[..scaler.buffer].iter().sum();
        let mut piece = |chunk_start: u64, count: u64| {
            let start = chunk_start + before + scaler.offset;
            let stride = widths[scaler.buffer] as usize;
            let strided =
                Strided { path: path.to_owned(), start, stride, number: scaler.number, factor: 1.0 };
            object.pieces.push((strided, count));
        };
        (0..chunks).for_each(|k| piece(start + k * chunk, scaler.count));
        let last = last[scaler.buffer].min(scaler.count);
        if last > 0 {
            piece(start + chunks * chunk, last);
        }
    }
    (rest > 0 && !is_cut).then(|| format!("{rest} bytes at its end are no whole chunk and are left out"))
}
