//! MATLAB `.mat`, version 7.3: HDF5 behind 512 bytes of text. Plain HDF5 files are read in the same way.
//!
//! Arrays of numbers and of logicals are channels, members of structs are called `struct.member`; a matrix gives a channel a
//! column. Cells, texts and objects are left out. Samples are held in memory.

use std::path::Path;

use hdf5_pure::{DType, Dataset, File, Group};

use crate::{Channel, Error, Recording, Result};

const FORMAT: &str = "MATLAB 7.3 (HDF5)";
/// Structs within structs; a forged file may hold itself.
const DEEPEST: usize = 16;
/// Most columns of a matrix that become channels.
const COLUMNS: u64 = 4096;
/// Most numbers read from one file: 4 GiB.
const MOST: u64 = 1 << 29;

/// Opens a file.
///
/// # Errors
/// [`Error::Damaged`].
pub fn open(path: &Path) -> Result<Recording> {
    // A damaged file must not take the program along, whatever the library thinks of it.
    let read = std::panic::catch_unwind(|| {
        let broken = |why: hdf5_pure::Error| Error::damaged(path, FORMAT, why.to_string());
        let file = File::open_streaming(path).map_err(broken)?;
        let mut found = Found { channels: Vec::new(), left_out: 0, numbers: 0 };
        found.group(&file.root(), "", 0).map_err(broken)?;
        Ok(found)
    });
    let found = read.map_err(|_| Error::damaged(path, FORMAT, "its structure contradicts itself"))??;
    let mut notes = Vec::new();
    if found.left_out > 0 {
        notes.push(format!("{} texts, cells and other values are left out", found.left_out));
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels: found.channels, notes })
}

struct Found {
    channels: Vec<Channel>,
    left_out: usize,
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
        let count = shape.iter().try_fold(1_u64, |product, n| product.checked_mul(*n)).unwrap_or(u64::MAX);
        let fits = count > 0 && self.numbers.saturating_add(count) <= MOST;
        if !number || empty || !fits || matches!(text.as_deref(), Some("char" | "cell" | "function_handle")) {
            self.left_out += 1;
            return Ok(());
        }
        self.numbers += count;
        let all = dataset.read_f64()?;
        // MATLAB's columns run fastest, so the last extent of the file is the length of a column.
        let (columns, rows) = match shape[..] {
            [columns, rows] if columns > 1 && rows > 1 && columns <= COLUMNS => {
                (columns as usize, rows as usize)
            }
            _ => (1, all.len()),
        };
        if columns == 1 {
            self.channels.push(Channel::held(name, all));
        } else {
            let parts = all.chunks(rows.max(1)).take(columns).enumerate();
            self.channels
                .extend(parts.map(|(k, part)| Channel::held(format!("{name}(:,{})", k + 1), part.to_vec())));
        }
        Ok(())
    }
}
