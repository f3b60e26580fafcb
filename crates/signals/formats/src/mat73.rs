//! MATLAB `.mat`, version 7.3: HDF5 behind 512 bytes of text. Plain HDF5 files are read in the same way.
//!
//! Arrays of numbers and of logicals are channels, members of structs are called `struct.member`; a matrix
//! gives channels along its longer side. Cells, texts and objects are left out. Samples stay in the file, in
//! one piece or in chunks; those in chunks packed otherwise than MATLAB does are held in memory.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use hdf5_pure::{
    AttrValue, DType, Dataset, Datatype, DatatypeByteOrder, File, FixedPointLayout, FloatingPointLayout,
    FormatError, Group, Layout,
};

use stribeck_dsp::channel::memory;

use crate::curve::{Curve, Marks, along, without};
use crate::number::{Kind, Number};
use crate::recording::left_out;
use crate::strided::Strided;
use crate::{Channel, Error, Recording, Result, csv, hdf5_chunks, hdf5_links, hdf5_version5, shape, units};

const FORMAT: &str = "MATLAB 7.3 (HDF5)";
/// Structs within structs; a forged file may hold itself.
const DEEPEST: usize = 16;
/// Most columns of a matrix that become channels.
const COLUMNS: u64 = 4096;
/// Most numbers held of one file: 256 MiB.
const MOST: u64 = 1 << 25;

/// Opens a file.
pub fn open(path: &Path) -> Result<Recording> {
    // A damaged file must not take the program along, whatever the library thinks of it.
    let read = std::panic::catch_unwind(|| {
        let broken = |why: hdf5_pure::Error| Error::damaged(path, FORMAT, why.to_string());
        let (file, unclosed) = match File::open_streaming(path) {
            Err(hdf5_pure::Error::FileMarkedInUse { .. }) => (in_use(path)?, true),
            opened => (opened.map_err(broken)?, false),
        };
        let size = std::fs::metadata(path).map_err(|e| Error::read(path, e))?.len();
        let all = |file: &File| {
            let mut found = Found {
                path: path.to_owned(),
                size,
                channels: Vec::new(),
                left_out: 0,
                too_long: Vec::new(),
                numbers: 0,
                notes: Vec::new(),
                rates: Vec::new(),
                is_version_5: false,
            };
            found.group(&file.root(), "", &mut Vec::new());
            found
        };
        let mut found = all(&file);
        if found.is_version_5 {
            let bytes = hdf5_version5::as_version_4(whole(path, "a file of HDF5 2.0")?);
            found = all(&File::from_bytes(bytes).map_err(broken)?);
        }
        if unclosed {
            found.notes.push(
                "the program that wrote the file did not close it, or still writes: what it wrote last may be missing"
                    .to_owned(),
            );
        }
        Ok(found)
    });
    let found = read.map_err(|_| Error::damaged(path, FORMAT, "its structure contradicts itself"))??;
    let mut notes = found.notes;
    if found.left_out > 0 {
        notes.push(format!("{} texts, cells and other values are left out", found.left_out));
    }
    if !found.too_long.is_empty() {
        notes.push(format!(
            "left out, as chunks that are packed otherwise than by gzip are read as a whole, of at most \
             {MOST} numbers a file: {}. Pack them anew with `h5repack -f GZIP=1`",
            found.too_long.join(", ")
        ));
    }
    let mut channels = found.channels;
    // The rate of the innermost group.
    for channel in channels.iter_mut().filter(|c| c.rate_hz.is_none()) {
        let of = found.rates.iter().filter(|(prefix, _)| channel.name.starts_with(prefix.as_str()));
        channel.rate_hz = of.max_by_key(|(prefix, _)| prefix.len()).map(|(_, hz)| *hz);
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes })
}

/// A file that is marked as being written: as its writer offers it to readers, or as its bytes stand.
fn in_use(path: &Path) -> Result<File> {
    if let Ok(file) = File::open_swmr(path) {
        return Ok(file);
    }
    File::from_bytes(whole(path, "a file that was not closed")?).map_err(|why| {
        let what =
            format!("it was not closed by the program that wrote it, and its structure is not whole: {why}");
        Error::damaged(path, FORMAT, what)
    })
}

/// All bytes of a file, if memory may hold them.
fn whole(path: &Path, what: &str) -> Result<Vec<u8>> {
    let io = |e| Error::read(path, e);
    memory::ask(path, what, std::fs::metadata(path).map_err(io)?.len())?;
    std::fs::read(path).map_err(io)
}

struct Found {
    path: PathBuf,
    /// Bytes of the file.
    size: u64,
    channels: Vec<Channel>,
    left_out: usize,
    /// Sets that are too long to be held.
    too_long: Vec<String>,
    /// Numbers held so far.
    numbers: u64,
    notes: Vec<String>,
    /// Sample rates from attributes, each with the prefix of the names that it applies to.
    rates: Vec<(String, f64)>,
    /// Whether the layout of a set has a number that the library does not know.
    is_version_5: bool,
}

impl Found {
    /// Adds the channels of a group; unreadable ones are noted, and do not affect the rest.
    fn group(&mut self, group: &Group, prefix: &str, trail: &mut Vec<String>) {
        if let Ok(attributes) = group.attrs() {
            let said = rates(&attributes, &mut self.notes);
            self.rates.extend(said.map(|hz| (prefix.to_owned(), hz)));
        }
        let (sets, groups) = match (group.iter_datasets(), group.iter_groups()) {
            (Ok(sets), Ok(groups)) => (
                sets.map(|(name, set)| (name, Ok(set))).collect(),
                groups.map(|(name, group)| (name, Ok(group))).collect::<Vec<_>>(),
            ),
            (Err(why), _) | (_, Err(why)) => {
                // A link to another object, or a damaged one, spoils the library's list of a group; each name
                // alone can be opened.
                let Some(members) = hdf5_links::members(&self.path, trail) else {
                    self.notes.push(left_out(&format!("{prefix}*"), &why.to_string()));
                    return;
                };
                let (objects, links): (Vec<_>, Vec<_>) =
                    members.into_iter().partition(hdf5_links::Member::is_object);
                for link in links {
                    let name = format!("{prefix}{}", link.name);
                    self.notes.push(left_out(&name, "it is a link to another object"));
                }
                let opened = objects.into_iter().map(|of| (group.dataset(&of.name), of.name));
                let (sets, groups): (Vec<_>, Vec<_>) = opened.partition(|(set, _)| set.is_ok());
                let groups = groups.into_iter().map(|(_, name)| (group.group(&name), name));
                let groups = groups.map(|(group, name)| (name, group)).collect();
                (sets.into_iter().map(|(set, name)| (name, set)).collect::<Vec<_>>(), groups)
            }
        };
        for (name, set) in sets {
            let full = format!("{prefix}{name}");
            let done = set.and_then(|set| self.dataset(&set, &full));
            if let Err(why) = done {
                self.is_version_5 |=
                    matches!(why, hdf5_pure::Error::Format(FormatError::InvalidLayoutVersion(5)));
                self.notes.push(left_out(&full, &why.to_string()));
            }
        }
        for (name, group) in groups {
            // Data referenced by cells and objects have no names.
            if trail.len() >= DEEPEST || name.starts_with('#') {
                continue;
            }
            match group {
                Ok(group) => {
                    let prefix = format!("{prefix}{name}.");
                    trail.push(name);
                    self.group(&group, &prefix, trail);
                    trail.pop();
                }
                Err(why) => self.notes.push(left_out(&format!("{prefix}{name}"), &why.to_string())),
            }
        }
    }

    fn dataset(&mut self, dataset: &Dataset, name: &str) -> std::result::Result<(), hdf5_pure::Error> {
        let number = matches!(
            dataset.dtype()?,
            DType::F32
                | DType::F64
                | DType::I8
                | DType::I16
                | DType::I32
                | DType::I64
                | DType::U8
                | DType::U16
                | DType::U32
                | DType::U64
        );
        let attributes = dataset.attrs()?;
        let text = attributes.get("MATLAB_class").and_then(|class| class.as_str().map(str::to_owned));
        // An empty array is stored as its size.
        let empty = attributes.contains_key("MATLAB_empty");
        let shape = dataset.shape()?;
        let count = shape.iter().try_fold(1_u64, |product, n| product.checked_mul(*n)).unwrap_or(0);
        if empty || count == 0 || matches!(text.as_deref(), Some("char" | "cell" | "function_handle")) {
            self.left_out += 1;
            return Ok(());
        }
        let kind = dataset.datatype()?;
        if !number && plain(&kind).is_none() {
            let texts = matches!(dataset.dtype()?, DType::String | DType::VariableLengthString);
            let short = name.rsplit('.').next().unwrap_or(name);
            if texts && units::rate_hz(short, None, 1e-3).is_some() {
                self.notes.push(format!("`{name}` is a text{}", units::NO_RATE));
            } else if texts || matches!(dataset.dtype()?, DType::ObjectReference) {
                self.left_out += 1;
            } else {
                let what = match dataset.dtype()? {
                    DType::Compound(fields) => {
                        let names: Vec<String> = fields.into_iter().map(|(name, _)| name).collect();
                        format!("it is a table of records ({}): save each column as a set", names.join(", "))
                    }
                    other => format!("its values are of type {other}"),
                };
                self.notes.push(left_out(name, &what));
            }
            return Ok(());
        }
        if dataset.layout()? == Layout::Virtual {
            self.notes.push(left_out(name, "it is a virtual set, put together from others: open those"));
            return Ok(());
        }
        if let Some(why) = unknown_filter(dataset) {
            self.notes.push(left_out(name, &why));
            return Ok(());
        }
        let axes = match shape::table(&shape).map(|_| Axes::of(&shape, text.is_some())) {
            Ok(axes) => axes,
            Err(why) => {
                self.notes.push(left_out(name, &why));
                return Ok(());
            }
        };
        let Some(axes) = axes else {
            let sizes = shape.iter().map(u64::to_string).collect::<Vec<_>>().join(" × ");
            self.notes.push(left_out(name, &format!("{sizes} numbers are more channels than {COLUMNS}")));
            return Ok(());
        };
        let rate_hz = rates(&attributes, &mut self.notes);
        let start_s = start_s(&attributes);
        let scale = scale(&attributes);
        let marks = marks(&attributes);
        let unit = ["unit", "units", "Unit", "Units", "unit_string"].into_iter();
        let unit = unit.filter_map(|key| attributes.get(key)?.as_str().map(str::to_owned)).next();
        let unit = unit.filter(|unit| !unit.trim().is_empty());
        if let Some(why) = self.beyond(dataset, count)? {
            self.notes.push(left_out(name, &why));
            return Ok(());
        }
        let axes = Some(axes);
        let streamed = match (&axes, plain(&dataset.datatype()?)) {
            (Some(axes), Some(number)) => self.streamed((dataset, name), number, &shape, axes)?,
            _ => None,
        };
        let channels = match streamed {
            Some(channels) => channels,
            None if count <= MOST.saturating_sub(self.numbers) => {
                self.numbers += count;
                held(&dataset.read_f64()?, &shape, axes.as_ref())
            }
            None => {
                if dataset.chunks()?.is_empty() {
                    self.notes.push(left_out(name, &unwritten(count)));
                } else {
                    self.too_long.push(format!("`{name}`"));
                }
                return Ok(());
            }
        };
        let (alone, rows) = (channels.len() == 1, axes.is_some_and(|axes| axes.along == 0));
        self.channels.extend(channels.into_iter().enumerate().map(|(k, mut channel)| {
            channel.name = match (alone, rows, &text) {
                (true, ..) => name.to_owned(),
                (_, _, None) => format!("{name}[{k}]"),
                (_, false, _) => format!("{name}(:,{})", k + 1),
                (_, true, _) => format!("{name}({},:)", k + 1),
            };
            channel.group = name.rsplit_once('.').map_or("", |(group, _)| group).to_owned();
            let channel = channel.at_rate(rate_hz).from_time(start_s).in_unit(unit.clone());
            along(without(channel, &marks), scale.clone())
        }));
        Ok(())
    }

    /// Why the pieces of a set cannot be read as a whole: the library takes the memory that a piece claims.
    fn beyond(&self, dataset: &Dataset, count: u64) -> std::result::Result<Option<String>, hdf5_pure::Error> {
        let Some(shape) = dataset.chunk_shape()? else { return Ok(None) };
        let chunk = shape.iter().fold(1_u64, |product, n| product.saturating_mul(*n));
        let stored = dataset.chunks()?;
        let ends = stored.iter().map(|of| of.address.saturating_add(of.storage_size));
        Ok(if stored.is_empty() && count > MOST {
            Some(unwritten(count))
        } else if chunk > 2 * MOST {
            Some(format!(
                "it is packed in pieces of {chunk} numbers, which must be unpacked whole, and {} are the \
                 most: pack it anew with `h5repack -l CHUNK=65536 -f GZIP=1`",
                2 * MOST
            ))
        } else if ends.max().is_some_and(|end| end > self.size) {
            Some("a piece of it ends behind the end of the file".to_owned())
        } else {
            None
        })
    }

    /// Channels whose samples stay in the file.
    fn streamed(
        &mut self,
        (dataset, name): (&Dataset, &str),
        number: Number,
        shape: &[u64],
        axes: &Axes,
    ) -> std::result::Result<Option<Vec<Channel>>, hdf5_pure::Error> {
        let len = shape.get(axes.along).copied().unwrap_or(1);
        let width = number.kind.bytes() as u64;
        match dataset.layout()? {
            Layout::Contiguous { address: Some(address), .. } => {
                let needed = shape.iter().try_fold(width, |product, n| product.checked_mul(*n));
                if needed.and_then(|n| n.checked_add(address)).is_none_or(|end| end > self.size) {
                    return Ok(None);
                }
                let stride = |axis: usize| width * shape[axis + 1..].iter().product::<u64>();
                let channel = |n: u64| {
                    let strided = Strided {
                        path: self.path.clone(),
                        start: address + axes.across.map_or(0, |across| n * stride(across)),
                        stride: if shape.is_empty() { width } else { stride(axes.along) } as usize,
                        number,
                        factor: 1.0,
                    };
                    strided.channel("", len)
                };
                Ok(Some((0..axes.across.map_or(1, |across| shape[across])).map(channel).collect()))
            }
            Layout::Chunked { .. } if !shape.is_empty() => {
                let columns =
                    hdf5_chunks::columns(&self.path, FORMAT, dataset, number, axes.along, axes.across)?;
                if let Some((missing, first)) = columns.iter().flatten().find_map(|of| of.missing(len)) {
                    self.notes.push(format!(
                        "`{name}`: {missing} of {len} samples were never written, from sample {first} on; they are \
                         taken for missing, as the fill value that stands for them is none of the sensor's"
                    ));
                }
                Ok(columns.map(|all| all.into_iter().map(|of| Channel::new("", len, of)).collect()))
            }
            _ => Ok(None),
        }
    }
}

fn unwritten(count: u64) -> String {
    format!("none of its {count} numbers was ever written")
}

/// The line from stored to physical values that netCDF's conventions write beside a set.
fn scale(attributes: &HashMap<String, AttrValue>) -> Option<Curve> {
    let [slope, offset] = ["scale_factor", "add_offset"].map(|name| attributes.get(name).and_then(number));
    (slope.is_some() || offset.is_some()).then(|| Curve::linear(offset.unwrap_or(0.0), slope.unwrap_or(1.0)))
}

/// Stored values that stand for missing samples, by netCDF's conventions.
fn marks(attributes: &HashMap<String, AttrValue>) -> Marks {
    let of = |name: &str| attributes.get(name).and_then(numbers).unwrap_or_default();
    let names = ["_FillValue", "missing_value", "FillValue", "fill_value"];
    let limit = |name: &str, end: usize, none: f64| {
        of(name).first().or(of("valid_range").get(end)).copied().filter(|x| !x.is_nan()).unwrap_or(none)
    };
    Marks {
        values: names.into_iter().flat_map(of).collect(),
        valid: limit("valid_min", 0, f64::NEG_INFINITY)..=limit("valid_max", 1, f64::INFINITY),
    }
}

fn number(value: &AttrValue) -> Option<f64> {
    match numbers(value)?[..] {
        [x] => Some(x),
        _ => None,
    }
}

/// The numbers of an attribute, as netCDF and h5py write them.
fn numbers(value: &AttrValue) -> Option<Vec<f64>> {
    let of = |x: f64| Some(vec![x]);
    match value {
        AttrValue::F32(x) => of(f64::from(*x)),
        AttrValue::F64(x) => of(*x),
        AttrValue::I8(x) => of(f64::from(*x)),
        AttrValue::U8(x) => of(f64::from(*x)),
        AttrValue::I16(x) => of(f64::from(*x)),
        AttrValue::I32(x) => of(f64::from(*x)),
        AttrValue::I64(x) => of(*x as f64),
        AttrValue::U16(x) => of(f64::from(*x)),
        AttrValue::U32(x) => of(f64::from(*x)),
        AttrValue::U64(x) => of(*x as f64),
        AttrValue::F64Array(all) => Some(all.clone()),
        AttrValue::F32Array(all) => Some(all.iter().map(|x| f64::from(*x)).collect()),
        AttrValue::I64Array(all) => Some(all.iter().map(|x| *x as f64).collect()),
        AttrValue::U64Array(all) => Some(all.iter().map(|x| *x as f64).collect()),
        AttrValue::I32Array(all) => Some(all.iter().map(|x| f64::from(*x)).collect()),
        AttrValue::U32Array(all) => Some(all.iter().map(|x| f64::from(*x)).collect()),
        AttrValue::I16Array(all) => Some(all.iter().map(|x| f64::from(*x)).collect()),
        AttrValue::U16Array(all) => Some(all.iter().map(|x| f64::from(*x)).collect()),
        AttrValue::I8Array(all) => Some(all.iter().map(|x| f64::from(*x)).collect()),
        AttrValue::U8Array(all) => Some(all.iter().map(|x| f64::from(*x)).collect()),
        other => of(other.as_str()?.trim().parse().ok()?),
    }
}

/// When the first sample was taken [s], by an attribute: a number, or a stamp of date and time; a time and an
/// offset add up.
fn start_s(attributes: &HashMap<String, AttrValue>) -> Option<f64> {
    let mut found: Vec<f64> = attributes
        .iter()
        .filter_map(|(name, value)| {
            let stamp = || {
                let (s, ns) = csv::stamp(value.as_str()?, false)?;
                units::start_s(name, 0.0).map(|_| s as f64 + 1e-9 * f64::from(ns))
            };
            number(value).and_then(|x| units::start_s(name, x)).or_else(stamp)
        })
        .collect();
    found.sort_by(f64::total_cmp);
    found.dedup();
    (!found.is_empty()).then(|| found.iter().sum())
}

/// The sample rate [Hz] in attributes of a group or a set; what should say one and does not is noted.
fn rates(attributes: &HashMap<String, AttrValue>, notes: &mut Vec<String>) -> Option<f64> {
    let mut names: Vec<&String> = attributes.keys().collect();
    names.sort();
    let mut rates = units::Rates::default();
    for name in names {
        match (numbers(&attributes[name]), attributes[name].as_str()) {
            (Some(all), _) => rates.numbers(name, name, None, &all),
            (None, Some(text)) => rates.words(name, text),
            (None, None) => {}
        }
    }
    rates.agreed(notes)
}

/// Why chunks cannot be unpacked, where a filter is unknown.
fn unknown_filter(dataset: &Dataset) -> Option<String> {
    /// Deflate, shuffle, Fletcher's checksum, szip, n-bit, scale-offset, LZF: the filters of the library.
    const KNOWN: [u16; 7] = [1, 2, 3, 4, 5, 6, 32_000];
    let id = dataset.filters().into_iter().find(|id| !KNOWN.contains(id))?;
    let name = match id {
        307 => "bzip2",
        32_001 => "blosc",
        32_004 => "lz4",
        32_008 => "bitshuffle",
        32_013 => "zfp",
        32_015 => "zstd",
        32_026 => "blosc2",
        _ => "an unknown filter",
    };
    Some(format!(
        "it is packed with {name} ({id}), which is not read: pack it anew with `h5repack -f GZIP=1`"
    ))
}

/// Which extent of an array the samples lie along, and which the channels.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axes {
    along: usize,
    across: Option<usize>,
}

impl Axes {
    /// The longer side is the time. Of two equal ones it is MATLAB's column, the last extent of its files,
    /// and the first extent in those of other programs. `None` for arrays of more extents, or of too many
    /// channels.
    fn of(shape: &[u64], matlab: bool) -> Option<Self> {
        let wide: Vec<usize> = (0..shape.len()).filter(|axis| shape[*axis] > 1).collect();
        match wide[..] {
            [] => Some(Self { along: shape.len().saturating_sub(1), across: None }),
            [along] => Some(Self { along, across: None }),
            [first, last] => {
                let turned = shape[first] > shape[last] || !matlab && shape[first] == shape[last];
                let (along, across) = if turned { (first, last) } else { (last, first) };
                (shape[across] <= COLUMNS).then_some(Self { along, across: Some(across) })
            }
            _ => None,
        }
    }
}

/// Channels of numbers in memory; one for arrays that are no matrix.
fn held(all: &[f64], shape: &[u64], axes: Option<&Axes>) -> Vec<Channel> {
    let Some(Axes { along, across: Some(across) }) = axes else {
        return vec![Channel::held("", all.to_vec())];
    };
    let stride = |axis: usize| shape[axis + 1..].iter().product::<u64>() as usize;
    let (channels, len) = (shape[*across] as usize, shape[*along] as usize);
    let samples = |k: usize| all.iter().skip(k * stride(*across)).step_by(stride(*along)).take(len).copied();
    (0..channels).map(|k| Channel::held("", samples(k).collect())).collect()
}

/// Numbers whose bits all count, in one of the usual orders.
fn plain(of: &Datatype) -> Option<Number> {
    let (kind, order) = match of {
        Datatype::FixedPoint { size, byte_order, layout } => {
            let FixedPointLayout { signed, bit_offset, bit_precision } = layout;
            if *bit_offset != 0 || u32::from(*bit_precision) != 8 * size {
                return None;
            }
            let kind = match (size, signed) {
                (1, true) => Kind::I8,
                (1, false) => Kind::U8,
                (2, true) => Kind::I16,
                (2, false) => Kind::U16,
                (4, true) => Kind::I32,
                (4, false) => Kind::U32,
                (8, true) => Kind::I64,
                (8, false) => Kind::U64,
                _ => return None,
            };
            (kind, byte_order)
        }
        // IEEE 754-2008, binary16: the library has no name for it.
        Datatype::FloatingPoint { size: 2, byte_order, layout }
            if (layout.bit_offset, layout.bit_precision) == (0, 16)
                && (layout.exponent_location, layout.exponent_size) == (10, 5)
                && (layout.mantissa_location, layout.mantissa_size, layout.exponent_bias) == (0, 10, 15) =>
        {
            (Kind::F16, byte_order)
        }
        Datatype::FloatingPoint { size: 4, byte_order, layout }
            if *layout == FloatingPointLayout::IEEE754_BINARY32 =>
        {
            (Kind::F32, byte_order)
        }
        Datatype::FloatingPoint { size: 8, byte_order, layout }
            if *layout == FloatingPointLayout::IEEE754_BINARY64 =>
        {
            (Kind::F64, byte_order)
        }
        _ => return None,
    };
    match order {
        DatatypeByteOrder::LittleEndian => Some(Number { kind, big_endian: false }),
        DatatypeByteOrder::BigEndian => Some(Number { kind, big_endian: true }),
        DatatypeByteOrder::Vax => None,
    }
}
