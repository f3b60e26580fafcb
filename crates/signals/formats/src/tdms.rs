//! TDMS of LabVIEW and its data acquisition: numeric channels with their rate, their unit and their scale.
//!
//! Source: *TDMS File Format Internal Structure*, National Instruments.

mod daqmx;
mod scale;

use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use crate::curve::along;
use crate::number::{Kind, Number};
use crate::recording::left_out;
use crate::strided::{Pieces, Strided};
use crate::units::seconds;
use crate::{Error, Recording, Result, units};

const FORMAT: &str = "TDMS";
/// Bytes of a segment's lead-in.
const LEAD_IN: u64 = 28;
/// Longest metadata of a segment [bytes].
const MAX_METADATA: u64 = 1 << 28;
/// Bits of the table of contents.
const METADATA: u32 = 1 << 1;
const RAW_DATA: u32 = 1 << 3;
const NEW_OBJECTS: u32 = 1 << 2;
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;
const DAQMX: u32 = 1 << 7;

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Property {
    Number(f64),
    Text(String),
}

#[derive(Debug, Clone, Default)]
struct Object {
    /// Storage of its numbers; `None` for values that are not real numbers.
    number: Option<Number>,
    /// Values in a chunk, and the bytes that they take.
    count: u64,
    bytes: u64,
    /// Time from sample to sample, in seconds or in the unit beside it.
    increment: Option<f64>,
    increment_unit: Option<String>,
    /// Time of the first sample, since 1904, and what is added to it [s].
    start_time_s: Option<f64>,
    start_offset_s: Option<f64>,
    /// Sample rates by properties such as `SamplingRate` [Hz], and why others that should say one do not.
    rates: units::Rates,
    unit: Option<String>,
    /// Properties of its scales, by name.
    scales: BTreeMap<String, Property>,
    pieces: Vec<(Strided, u64)>,
    /// A file may change the type of a channel: then it is left out.
    mixed: bool,
    /// Its place in the rows of DAQmx, or why it has none.
    scaler: Option<daqmx::Scaler>,
    foreign: Option<String>,
}

const INCREMENT: &str = "wf_increment";

/// Opens a file; a channel is called `group/channel`. Samples stay in the file.
pub fn open(path: &Path) -> Result<Recording> {
    let io = |e| Error::read(path, e);
    let mut file = BufReader::new(File::open(path).map_err(io)?);
    let size = file.get_ref().metadata().map_err(io)?.len();
    let mut objects: HashMap<String, Object> = HashMap::new();
    // Objects in the order of the file, and those with data in the segment.
    let (mut known, mut active): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    let mut notes = Vec::new();
    let mut at = 0;
    while at + LEAD_IN <= size {
        let damaged = |what: String| Error::damaged(path, FORMAT, format!("segment at byte {at}: {what}"));
        file.seek(SeekFrom::Start(at)).map_err(io)?;
        let mut lead = [0; LEAD_IN as usize];
        file.read_exact(&mut lead).map_err(io)?;
        if &lead[..4] != b"TDSm" {
            return Err(damaged("it does not begin with `TDSm`".to_owned()));
        }
        let contents = u32::from_le_bytes([lead[4], lead[5], lead[6], lead[7]]);
        let long = |from: usize| lead[from..from + 8].try_into().map_or(0, u64::from_le_bytes);
        // The last segment of a file that was not closed has no valid length.
        let behind = size - at - LEAD_IN;
        let (next, raw) = (long(12).min(behind), long(20));
        if long(12) > behind {
            notes.push("the file was not closed, or is cut off: its last samples may be missing".to_owned());
        }
        if raw > next && long(12) > behind && at > 0 {
            // The recorder stopped in the middle of the metadata: earlier segments are sound.
            break;
        }
        if raw > next || raw > MAX_METADATA {
            return Err(damaged(format!("its metadata take {raw} of {next} bytes")));
        }
        if contents & METADATA != 0 {
            let mut bytes = vec![0; raw as usize];
            file.read_exact(&mut bytes).map_err(io)?;
            if contents & NEW_OBJECTS != 0 {
                active.clear();
            }
            let mut text = Metadata { bytes: &bytes, at: 0, big_endian: contents & BIG_ENDIAN != 0 };
            text.read(&mut objects, &mut known, &mut active)
                .ok_or_else(|| damaged("its metadata end early or hold an unknown type".to_owned()))?;
        }
        if contents & RAW_DATA != 0 {
            let data = (at + LEAD_IN + raw, next - raw);
            let (interleaved, is_cut) = (contents & INTERLEAVED != 0, long(12) > behind);
            let odd = if contents & DAQMX != 0 {
                daqmx::place(path, data, is_cut, &active, &mut objects)
            } else {
                place(path, data, (interleaved, is_cut), &active, &mut objects)
            };
            notes.extend(odd.map(|what| format!("segment at byte {at}: {what}")));
        }
        at += LEAD_IN + next;
    }
    let mut channels = Vec::new();
    // A scale may stand with the channel, with its group, or with the file.
    let of_file = objects.get("/").map(|o| o.scales.clone()).unwrap_or_default();
    let groups: HashMap<String, BTreeMap<String, Property>> =
        objects.iter().map(|(name, o)| (name.clone(), o.scales.clone())).collect();
    let has_times = objects.values().any(|o| o.start_time_s.is_some());
    let mut said: HashMap<String, f64> = HashMap::new();
    let mut names: Vec<(&String, &mut Object)> = objects.iter_mut().collect();
    names.sort_by_key(|(name, _)| *name);
    for (name, object) in names {
        if let Some(step) = object.increment {
            // It has seconds, as far as it is shorter than one.
            let unit = object.increment_unit.as_deref().filter(|unit| seconds(unit).is_some()).unwrap_or("s");
            let unit =
                Some(unit).filter(|unit| seconds(unit).is_some_and(|(_, second)| step * second <= 1.0));
            // What was asked of a card is not what it takes; one second is what stands there where nobody says.
            if step > 0.0 && step < 1.0 || object.rates.said.is_empty() {
                object.rates.said.clear();
                object.rates.numbers(INCREMENT, INCREMENT, unit, &[step]);
            }
        }
        said.extend(object.rates.clone().agreed(&mut notes).map(|hz| (name.clone(), hz)));
    }
    for path_in_file in known {
        let Some(object) = objects.remove(&path_in_file).filter(|o| o.count > 0 || !o.pieces.is_empty())
        else {
            continue;
        };
        let name = spoken(&path_in_file);
        if let Some(why) = &object.foreign {
            notes.push(left_out(&name, why));
            continue;
        }
        if object.scaler.is_none() && object.number.is_none() || object.mixed {
            notes.push(left_out(&name, "its values are no real numbers of one type"));
            continue;
        }
        let group = path_in_file.rsplit_once("/'").map_or("", |(group, _)| group);
        let none = BTreeMap::new();
        let of_group = groups.get(group).unwrap_or(&none);
        let scales = [&object.scales, of_group, &of_file].into_iter().find(|s| scale::count(s) > 0);
        let curve = match scale::curve(scales.unwrap_or(&none), object.scaler.as_ref().map(|s| s.id)) {
            Ok(curve) => curve,
            Err(why) => {
                notes.push(left_out(&name, &why));
                continue;
            }
        };
        let of_others = said.get(group).or(said.get("/")).filter(|_| object.rates.said.is_empty());
        let rate_hz = said.get(&path_in_file).or(of_others).copied();
        // Where others have a time, one without it has none on their axis.
        let start_s = match object.start_time_s {
            Some(time_s) => Some(time_s + object.start_offset_s.unwrap_or(0.0)),
            None if has_times => None,
            None => object.start_offset_s,
        };
        let channel = Pieces(object.pieces).channel(name).at_rate(rate_hz).from_time(start_s);
        let channel = channel.in_unit(object.unit);
        channels.push(along(channel, curve).of_group(group));
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes })
}

/// Notes where the values of a segment lie: chunk after chunk, in each one channel after the other or value
/// by value. Returns a note on anything unusual.
fn place(
    path: &Path,
    (start, held): (u64, u64),
    (interleaved, is_cut): (bool, bool),
    active: &[String],
    objects: &mut HashMap<String, Object>,
) -> Option<String> {
    // Far more chunks than any recorder writes would be a damaged count.
    const MOST: u64 = 10_000_000;
    let chunk =
        active.iter().filter_map(|name| objects.get(name)).try_fold(0_u64, |sum, o| sum.checked_add(o.bytes));
    let Some(chunk) = chunk else { return Some("its sizes are no sizes: it is left out".to_owned()) };
    if chunk == 0 {
        return None;
    }
    let (chunks, rest) = (held / chunk, held % chunk);
    let widths = active.iter().filter_map(|name| objects.get(name)?.number).map(|n| n.kind.bytes());
    let row: usize = widths.sum();
    let mut offset = 0;
    for name in active {
        let Some(object) = objects.get_mut(name) else { continue };
        let (bytes, count) = (object.bytes, object.count);
        let Some(number) = object.number else {
            offset += bytes;
            continue;
        };
        let width = number.kind.bytes();
        let piece = |start, stride| Strided { path: path.to_owned(), start, stride, number, factor: 1.0 };
        if interleaved {
            object.pieces.push((piece(start + offset, row), chunks * count));
            offset += width as u64;
            continue;
        }
        for k in 0..chunks.min(MOST) {
            object.pieces.push((piece(start + k * chunk + offset, width), count));
        }
        // Where the recorder was stopped, the last chunk holds what was written until then.
        let left = rest.saturating_sub(offset).min(bytes) / width as u64;
        if is_cut && left > 0 {
            object.pieces.push((piece(start + chunks * chunk + offset, width), left));
        }
        offset += bytes;
    }
    (rest > 0 && !is_cut).then(|| format!("{rest} bytes at its end are no whole chunk and are left out"))
}

struct Metadata<'a> {
    bytes: &'a [u8],
    at: usize,
    big_endian: bool,
}

impl Metadata<'_> {
    fn take(&mut self, count: usize) -> Option<&[u8]> {
        let end = self.at.checked_add(count)?;
        let taken = self.bytes.get(self.at..end)?;
        self.at = end;
        Some(taken)
    }

    fn word(&mut self) -> Option<u32> {
        let big = self.big_endian;
        let four = self.take(4)?.try_into().ok()?;
        Some(if big { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) })
    }

    fn long(&mut self) -> Option<u64> {
        let big = self.big_endian;
        let eight = self.take(8)?.try_into().ok()?;
        Some(if big { u64::from_be_bytes(eight) } else { u64::from_le_bytes(eight) })
    }

    fn text(&mut self) -> Option<String> {
        let length = self.word()? as usize;
        Some(String::from_utf8_lossy(self.take(length)?).into_owned())
    }

    fn read(
        &mut self,
        objects: &mut HashMap<String, Object>,
        known: &mut Vec<String>,
        active: &mut Vec<String>,
    ) -> Option<()> {
        const NONE: u32 = u32::MAX;
        for _ in 0..self.word()? {
            let name = self.text()?;
            if !objects.contains_key(&name) {
                known.push(name.clone());
            }
            let object = objects.entry(name.clone()).or_default();
            let index = self.word()?;
            if index != NONE {
                if matches!(index, daqmx::NUMBERS | daqmx::LINES) {
                    let read = daqmx::Scaler::read(self, index)?;
                    object.mixed |= object.number.is_some();
                    object.count = object.count.max(1);
                    (object.scaler, object.foreign) = match read {
                        Ok(scaler) => (Some(scaler), None),
                        Err(why) => (None, Some(why)),
                    };
                } else if index != 0 {
                    let (kind, _, count) = (self.word()?, self.word()?, self.long()?);
                    let number = number(kind, self.big_endian);
                    object.mixed |= object.scaler.take().is_some();
                    object.mixed |= object.number.is_some() && object.number != number;
                    object.number = number;
                    object.count = count;
                    object.bytes = match number {
                        Some(number) => count.checked_mul(number.kind.bytes() as u64)?,
                        // Texts carry their length in bytes; times take 16 each.
                        None if kind == TEXT => self.long()?,
                        None => count.checked_mul(width(kind)? as u64)?,
                    };
                }
                if !active.contains(&name) {
                    active.push(name.clone());
                }
            } else {
                // It has no data in this segment, and in those that follow without a list of their own.
                active.retain(|other| *other != name);
            }
            for _ in 0..self.word()? {
                let property = self.text()?;
                let kind = self.word()?;
                let object = objects.get_mut(&name)?;
                if kind == TEXT {
                    let value = self.text()?;
                    if property == "unit_string" && !value.is_empty() {
                        object.unit = Some(value);
                    } else if property == "wf_xunit_string" {
                        object.increment_unit = Some(value);
                    } else if property.starts_with("NI_") {
                        object.scales.insert(property, Property::Text(value));
                    } else {
                        object.rates.words(&property, &value);
                    }
                } else {
                    let big_endian = self.big_endian;
                    let number = number(kind, big_endian);
                    let bytes = self.take(width(kind)?)?;
                    let value = number.map(|n| n.decode(bytes));
                    if property == "wf_start_time" && kind == TIME {
                        object.start_time_s = stamp_s(bytes, big_endian);
                    } else if property == "wf_start_offset" {
                        object.start_offset_s = value;
                    } else if property == INCREMENT {
                        object.increment = value;
                    } else if let (Some(number), true) = (number, property.starts_with("NI_")) {
                        let value = Property::Number(number.decode(bytes));
                        object.scales.insert(property, value);
                    } else if let Some(value) = value {
                        object.rates.numbers(&property, &property, None, &[value]);
                    }
                }
            }
        }
        Some(())
    }
}

const TEXT: u32 = 0x20;
const TIME: u32 = 0x44;

/// Seconds since 1904: fractions of 2⁻⁶⁴ s, then whole seconds; the other way round where the upper byte is
/// the first. Zero stands for none.
fn stamp_s(bytes: &[u8], big_endian: bool) -> Option<f64> {
    let (first, second): ([u8; 8], [u8; 8]) =
        (bytes.get(..8)?.try_into().ok()?, bytes.get(8..16)?.try_into().ok()?);
    let (whole, fraction) = if big_endian {
        (i64::from_be_bytes(first), u64::from_be_bytes(second))
    } else {
        (i64::from_le_bytes(second), u64::from_le_bytes(first))
    };
    (whole != 0).then(|| whole as f64 + fraction as f64 / 2.0_f64.powi(64))
}

fn number(kind: u32, big_endian: bool) -> Option<Number> {
    let kind = match kind {
        1 => Kind::I8,
        2 => Kind::I16,
        3 => Kind::I32,
        4 => Kind::I64,
        5 | 0x21 => Kind::U8,
        6 => Kind::U16,
        7 => Kind::U32,
        8 => Kind::U64,
        9 | 0x19 => Kind::F32,
        10 | 0x1a => Kind::F64,
        _ => return None,
    };
    Some(Number { kind, big_endian })
}

/// Bytes of a value.
fn width(kind: u32) -> Option<usize> {
    Some(match kind {
        0 => 0,
        TIME | 0x10_000d => 16,
        0x08_000c => 8,
        other => number(other, false)?.kind.bytes(),
    })
}

/// `/'group'/'channel'` as `group/channel`.
fn spoken(path: &str) -> String {
    path.trim_start_matches('/').trim_matches('\'').replace("'/'", "/").replace("''", "'")
}
