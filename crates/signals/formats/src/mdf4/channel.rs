//! Channels of an MDF group: the storage of each, and its conversion to values.

use std::path::Path;
use std::sync::Arc;

use crate::curve::{Curve, along};
use crate::mdf4::{Block, FORMAT, Source};
use crate::mdf4_records::{Field, Packing, Stretch};
use crate::number::{Kind, Number};
use crate::strided::{Count, Pieces, Strided};
use crate::{Channel, Result};

pub(crate) struct Described {
    pub(crate) name: String,
    pub(crate) unit: Option<String>,
    /// Whether it is the time of its group.
    pub(crate) master: bool,
    place: usize,
    /// `None` for a virtual channel, whose stored value is the number of its record.
    number: Option<Number>,
    /// Byte and bit of a record that mark its sample as invalid.
    invalid: Option<(usize, u8)>,
    curve: Option<Curve>,
}

/// A channel, or its name and why it is left out. Invalidation bits begin `data_bytes` into a record.
pub(crate) fn describe(
    source: &mut Source<'_>,
    block: &Block,
    data_bytes: usize,
) -> Result<std::result::Result<Described, (String, String)>> {
    const ALL_INVALID: u32 = 1;
    const HAS_INVALID: u32 = 1 << 1;
    let name = source.text(block.link(2))?.unwrap_or_else(|| "channel".to_owned());
    let unit = source.text(block.link(6))?;
    let (sort, sync, data_type, bit) = (block.byte(0), block.byte(1), block.byte(2), block.byte(3));
    let (place, bits, flags) = (block.word(4) as usize, block.word(8), block.word(12));
    let left_out = |why: String| Ok(Err((name.clone(), why)));
    let is_virtual = matches!(sort, 3 | 6);
    if !matches!(sort, 0 | 2 | 3 | 6) {
        return left_out("its values are of varying length, or stand in another file".to_owned());
    }
    if flags & ALL_INVALID != 0 {
        return left_out("the file says that all its values are invalid".to_owned());
    }
    if block.link(1) != 0 {
        return left_out("it is made of parts, or an array".to_owned());
    }
    let number = match (data_type, bits) {
        _ if is_virtual => None,
        (6.., _) => return left_out("it is no number".to_owned()),
        _ => match kind(data_type, bits).filter(|_| bit == 0) {
            Some(kind) => Some(Number { kind, big_endian: matches!(data_type, 1 | 3 | 5) }),
            None => return left_out(format!("its numbers of {bits} bits are no whole bytes")),
        },
    };
    let (curve, of_conversion) = match block.link(4) {
        0 => (None, None),
        at => {
            let conversion = source.block(at, b"##CC")?;
            match curve(&conversion) {
                Ok(curve) => (curve, source.text(conversion.link(1))?),
                Err(why) => return left_out(why),
            }
        }
    };
    let position = block.word(16) as usize;
    let invalid = (flags & HAS_INVALID != 0).then_some((data_bytes + position / 8, (position % 8) as u8));
    let master = matches!(sort, 2 | 3) && sync == 1;
    Ok(Ok(Described { name, unit: unit.or(of_conversion), master, place, number, invalid, curve }))
}

fn kind(data_type: u8, bits: u32) -> Option<Kind> {
    Some(match (data_type, bits) {
        (0 | 1, 8) => Kind::U8,
        (0 | 1, 16) => Kind::U16,
        (0 | 1, 32) => Kind::U32,
        (0 | 1, 64) => Kind::U64,
        (2 | 3, 8) => Kind::I8,
        (2 | 3, 16) => Kind::I16,
        (2 | 3, 24) => Kind::I24,
        (2 | 3, 32) => Kind::I32,
        (2 | 3, 64) => Kind::I64,
        (4 | 5, 16) => Kind::F16,
        (4 | 5, 32) => Kind::F32,
        (4 | 5, 64) => Kind::F64,
        _ => return None,
    })
}

/// The law of a conversion block; `None` where stored numbers are values, otherwise why there is none.
fn curve(block: &Block) -> std::result::Result<Option<Curve>, String> {
    let value = |n: usize| block.float(24 + 8 * n);
    let pairs = |between: bool| {
        let count = (block.data.len().saturating_sub(24) / 8).min(usize::from(block.count())) / 2;
        let column = |from: usize| (0..count).map(|n| value(2 * n + from)).collect::<Vec<f64>>();
        let table = Curve::table(&column(0), &column(1), between);
        table.map(Some).ok_or_else(|| "the table of its conversion does not ascend".to_owned())
    };
    match block.byte(0) {
        0 => Ok(None),
        1 => Ok(Some(Curve::linear(value(0), value(1)))),
        2 => Ok(Some(Curve::Quotient([value(2), value(1), value(0)], [value(5), value(4), value(3)]))),
        4 => pairs(true),
        5 => pairs(false),
        other => {
            let what = match other {
                3 => "a formula",
                6 => "a table of ranges",
                _ => "one to or from texts",
            };
            Err(format!("its conversion is {what}; linear, rational and tables of values are applied"))
        }
    }
}

impl Block {
    /// Values of a conversion.
    fn count(&self) -> u16 {
        u16::from_le_bytes([self.byte(6), self.byte(7)])
    }
}

impl Described {
    /// Bytes of a record up to its end in it.
    pub(crate) fn end(&self) -> usize {
        let number = self.number.map_or(0, |number| self.place.saturating_add(number.kind.bytes()));
        number.max(self.invalid.map_or(0, |(byte, _)| byte + 1))
    }

    pub(crate) fn channel(&self, path: &Path, data: &Arc<Vec<Stretch>>, width: usize, len: u64) -> Channel {
        let whole = |s: &Stretch| s.packing == Packing::Plain && s.full.is_multiple_of(width as u64);
        let channel = if let Some(number) = self.number.filter(|_| self.invalid.is_none())
            && data.iter().all(whole)
        {
            let mut left = len;
            let pieces = data.iter().map(|stretch| {
                let records = (stretch.full / width as u64).min(left);
                left -= records;
                let start = stretch.at + self.place as u64;
                let path = path.to_owned();
                (Strided { path, start, stride: width, number, factor: 1.0 }, records)
            });
            Pieces(pieces.collect()).channel(&self.name)
        } else if let Some(number) = self.number {
            let field = Field {
                path: path.to_owned(),
                format: FORMAT,
                stretches: data.clone(),
                width,
                place: self.place,
                number,
                invalid: self.invalid,
            };
            Channel::new(&self.name, len, field)
        } else {
            Channel::new(&self.name, len, Count)
        };
        along(channel.in_unit(self.unit.clone()), self.curve.clone())
    }
}
