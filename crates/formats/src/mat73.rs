//! MATLAB `.mat`, version 7.3: HDF5 behind 512 bytes of text. Plain HDF5 files are read in the same way.
//!
//! Arrays of numbers and of logicals are channels, members of structs are called `struct.member`; a matrix of MATLAB gives a
//! channel a column, one of other programs a channel along its longer side. Cells, texts and objects are left out. Samples
//! stay in the file, in one piece or in chunks; those in chunks packed otherwise than MATLAB does are held in memory.

use std::path::{Path, PathBuf};

use hdf5_pure::{
    DType, Dataset, Datatype, DatatypeByteOrder, File, FixedPointLayout, FloatingPointLayout, Group, Layout,
};

use crate::number::{Kind, Number};
use crate::recording::Strided;
use crate::{Channel, Error, Recording, Result, hdf5_chunks};

const FORMAT: &str = "MATLAB 7.3 (HDF5)";
/// Structs within structs; a forged file may hold itself.
const DEEPEST: usize = 16;
/// Most columns of a matrix that become channels.
const COLUMNS: u64 = 4096;
/// Most numbers held of one file: 256 MiB.
const MOST: u64 = 1 << 25;

/// Opens a file.
///
/// # Errors
/// [`Error::Damaged`].
pub fn open(path: &Path) -> Result<Recording> {
    // A damaged file must not take the program along, whatever the library thinks of it.
    let read = std::panic::catch_unwind(|| {
        let broken = |why: hdf5_pure::Error| Error::damaged(path, FORMAT, why.to_string());
        let file = File::open_streaming(path).map_err(broken)?;
        let size = std::fs::metadata(path).map_err(|e| Error::read(path, e))?.len();
        let mut found = Found {
            path: path.to_owned(),
            size,
            channels: Vec::new(),
            left_out: 0,
            too_long: Vec::new(),
            numbers: 0,
        };
        found.group(&file.root(), "", 0).map_err(broken)?;
        Ok(found)
    });
    let found = read.map_err(|_| Error::damaged(path, FORMAT, "its structure contradicts itself"))??;
    let mut notes = Vec::new();
    if found.left_out > 0 {
        notes.push(format!("{} texts, cells and other values are left out", found.left_out));
    }
    if !found.too_long.is_empty() {
        notes.push(format!(
            "left out, as chunks that are packed otherwise than by gzip are read as a whole, of at most {MOST} numbers a file: {}. \
             Pack them anew with `h5repack -f GZIP=1`",
            found.too_long.join(", ")
        ));
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels: found.channels, notes })
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
}

impl Found {
    fn group(
        &mut self,
        group: &Group,
        prefix: &str,
        depth: usize,
    ) -> std::result::Result<(), hdf5_pure::Error> {
        for name in group.datasets()? {
            self.dataset(&group.dataset(&name)?, &format!("{prefix}{name}"))?;
        }
        for name in group.groups()? {
            // What cells and objects point to has no name of its own.
            if depth < DEEPEST && !name.starts_with('#') {
                self.group(&group.group(&name)?, &format!("{prefix}{name}."), depth + 1)?;
            }
        }
        Ok(())
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
        if !number
            || empty
            || count == 0
            || matches!(text.as_deref(), Some("char" | "cell" | "function_handle"))
        {
            self.left_out += 1;
            return Ok(());
        }
        let axes = Axes::of(&shape, text.is_some());
        let streamed = match (&axes, plain(&dataset.datatype()?)) {
            (Some(axes), Some(number)) => self.streamed(dataset, number, &shape, axes)?,
            _ => None,
        };
        let channels = match streamed {
            Some(channels) => channels,
            None if count <= MOST.saturating_sub(self.numbers) => {
                self.numbers += count;
                held(&dataset.read_f64()?, &shape, axes.as_ref())
            }
            None => {
                self.too_long.push(format!("`{name}`"));
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
            channel
        }));
        Ok(())
    }

    /// Channels whose samples stay in the file.
    fn streamed(
        &self,
        dataset: &Dataset,
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
                    Channel::strided("", len, strided)
                };
                Ok(Some((0..axes.across.map_or(1, |across| shape[across])).map(channel).collect()))
            }
            Layout::Chunked { .. } if !shape.is_empty() => {
                let columns =
                    hdf5_chunks::columns(&self.path, FORMAT, dataset, number, axes.along, axes.across)?;
                Ok(columns.map(|all| all.into_iter().map(|of| Channel::chunks("", len, of)).collect()))
            }
            _ => Ok(None),
        }
    }
}

/// Which extent of an array the samples lie along, and which the channels.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axes {
    along: usize,
    across: Option<usize>,
}

impl Axes {
    /// MATLAB's columns run fastest, so the last extent of the file is the length of a column. Other programs have no such
    /// rule: the longer side is the time. `None` for arrays of more extents, or of too many channels.
    fn of(shape: &[u64], matlab: bool) -> Option<Self> {
        let wide: Vec<usize> = (0..shape.len()).filter(|axis| shape[*axis] > 1).collect();
        match wide[..] {
            [] => Some(Self { along: shape.len().saturating_sub(1), across: None }),
            [along] => Some(Self { along, across: None }),
            [first, last] => {
                let turned = if matlab { shape[first] > COLUMNS } else { shape[first] >= shape[last] };
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
