//! Apache Parquet: tables of named columns, as pandas, polars and DuckDB read them.

use std::borrow::Borrow;
use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{
    Compression, ConvertedType, Encoding, LogicalType, Repetition, TimeUnit, Type as Physical, ZstdLevel,
};
use parquet::column::reader::ColumnReader;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, FloatType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnDescriptor, ColumnPath, Type};
use stribeck_dsp::channel::Samples;

use crate::number::{Kind, Number};
use crate::recording::left_out;
use crate::{Channel, Error, Recording, Result, units};

const FORMAT: &str = "Parquet";

/// Rows that are read at a time.
const BATCH: usize = 1 << 16;

/// The values of a column; missing ones are null.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers.
    Number(Vec<Option<f64>>),
    /// Whole numbers.
    Count(Vec<Option<i64>>),
    /// True or false.
    Flag(Vec<Option<bool>>),
    /// Texts.
    Text(Vec<Option<String>>),
    /// Series of numbers in single precision, one a row, none of them missing.
    Series(Vec<Vec<f32>>),
}

impl Values {
    /// No values of this kind.
    fn none(&self) -> Self {
        match self {
            Self::Number(_) => Self::Number(Vec::new()),
            Self::Count(_) => Self::Count(Vec::new()),
            Self::Flag(_) => Self::Flag(Vec::new()),
            Self::Text(_) => Self::Text(Vec::new()),
            Self::Series(_) => Self::Series(Vec::new()),
        }
    }
}

/// A named column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its values, one a row.
    pub values: Values,
}

impl Column {
    /// Numbers, none of them missing.
    pub fn numbers(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), values: Values::Number(values.into_iter().map(Some).collect()) }
    }

    fn rows(&self) -> usize {
        match &self.values {
            Values::Number(v) => v.len(),
            Values::Count(v) => v.len(),
            Values::Flag(v) => v.len(),
            Values::Text(v) => v.len(),
            Values::Series(v) => v.len(),
        }
    }

    fn schema(&self) -> std::result::Result<Type, ParquetError> {
        let (physical, logical) = match &self.values {
            Values::Number(_) => (Physical::DOUBLE, None),
            Values::Count(_) => (Physical::INT64, None),
            Values::Flag(_) => (Physical::BOOLEAN, None),
            Values::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            Values::Series(_) => return series(&self.name),
        };
        let optional = Repetition::OPTIONAL;
        Type::primitive_type_builder(&self.name, physical)
            .with_repetition(optional)
            .with_logical_type(logical)
            .build()
    }
}

/// A list of single numbers in each row, by the three levels that Parquet has for it.
fn series(name: &str) -> std::result::Result<Type, ParquetError> {
    let number = Type::primitive_type_builder("element", Physical::FLOAT);
    let number = number.with_repetition(Repetition::REQUIRED).build()?;
    let list = Type::group_type_builder("list").with_repetition(Repetition::REPEATED);
    let list = list.with_fields(vec![Arc::new(number)]).build()?;
    Type::group_type_builder(name)
        .with_repetition(Repetition::REQUIRED)
        .with_logical_type(Some(LogicalType::List))
        .with_fields(vec![Arc::new(list)])
        .build()
}

/// A table that is written group of rows by group of rows, so that it need not fit into memory. Equal tables
/// are equal bytes.
pub struct Writer {
    path: std::path::PathBuf,
    schema: Vec<Column>,
    file: SerializedFileWriter<File>,
}

impl Writer {
    /// Begins a file with columns of these names and kinds; their values do not matter. `notes` are written
    /// beside it, each under its name.
    pub fn create(path: &Path, columns: &[Column], notes: &[(String, String)]) -> Result<Self> {
        let refused = |e: ParquetError| refused(path, &e);
        let fields: std::result::Result<Vec<_>, ParquetError> =
            columns.iter().map(|column| column.schema().map(Arc::new)).collect();
        let schema = Type::group_type_builder("table")
            .with_fields(fields.map_err(refused)?)
            .build()
            .map_err(refused)?;
        let notes = notes.iter().map(|(name, text)| KeyValue::new(name.clone(), text.clone())).collect();
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by("stribeck".to_owned())
            .set_key_value_metadata(Some(notes));
        for column in columns.iter().filter(|column| matches!(column.values, Values::Series(_))) {
            // Exponents of a signal are alike, the rest of it is not: a third less, for data sets that travel.
            let path = ColumnPath::new(vec![column.name.clone(), "list".to_owned(), "element".to_owned()]);
            properties = properties
                .set_column_compression(path.clone(), Compression::ZSTD(ZstdLevel::default()))
                .set_column_dictionary_enabled(path.clone(), false)
                .set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT);
        }
        let properties = properties.build();
        let file = File::create(path).map_err(|e| Error::write(path, e))?;
        let file =
            SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties)).map_err(refused)?;
        let blank = |column: &Column| Column { name: column.name.clone(), values: column.values.none() };
        Ok(Self { path: path.to_owned(), schema: columns.iter().map(blank).collect(), file })
    }

    /// Adds a group of rows: the columns of the file, equally long. Each is requested after the one before is
    /// written, so that they need not be in memory together.
    ///
    /// # Errors
    /// [`Error::DoesNotFit`] for other columns, [`Error::Io`]. The file is then unusable.
    pub fn add(&mut self, columns: impl IntoIterator<Item = impl Borrow<Column>>) -> Result<()> {
        let Self { path, schema, file } = self;
        let refused = |e: ParquetError| refused(path, &e);
        let other = || {
            let what = "its groups of rows must have the same columns, equally long".to_owned();
            Error::DoesNotFit { path: path.clone(), format: FORMAT, what }
        };
        let (mut known, mut rows) = (schema.iter(), None);
        let mut group = file.next_row_group().map_err(refused)?;
        for column in columns {
            let column: &Column = column.borrow();
            let known = known.next().ok_or_else(other)?;
            let same = column.name == known.name
                && column.rows() == *rows.get_or_insert(column.rows())
                && std::mem::discriminant(&column.values) == std::mem::discriminant(&known.values);
            if !same {
                return Err(other());
            }
            write_column(&mut group, &column.values).map_err(refused)?;
        }
        if known.next().is_some() {
            return Err(other());
        }
        group.close().map_err(refused)?;
        Ok(())
    }

    /// Ends the file.
    pub fn finish(self) -> Result<()> {
        let Self { path, file, .. } = self;
        file.close().map_err(|e| refused(&path, &e))?;
        Ok(())
    }
}

/// Writes one table.
pub fn write_table(path: &Path, columns: &[Column], notes: &[(String, String)]) -> Result<()> {
    let mut writer = Writer::create(path, columns, notes)?;
    writer.add(columns)?;
    writer.finish()
}

/// Writes channels as columns, a row a sample; `notes` as one text.
///
/// # Errors
/// [`Error::DoesNotFit`] when channels differ in length, [`Error::Io`].
pub fn write(path: &Path, channels: &[Channel], notes: &[String]) -> Result<()> {
    let columns: Result<Vec<Column>> =
        channels.iter().map(|c| Ok(Column::numbers(&c.name, c.read()?))).collect();
    let mut texts = vec![("notes".to_owned(), notes.join("\n"))];
    if let Some(rate_hz) = channels.first().and_then(|c| c.rate_hz) {
        texts.push(("rate_hz".to_owned(), rate_hz.to_string()));
    }
    write_table(path, &columns?, &texts)
}

/// Opens a table: its columns of numbers are channels, others are left out with a note. A missing number
/// becomes NaN. Values stay in the file.
pub fn open(path: &Path) -> Result<Recording> {
    let file = File::open(path).map_err(|e| Error::read(path, e))?;
    let damaged = |e: ParquetError| Error::damaged(path, FORMAT, e.to_string());
    let reader = guarded(|| SerializedFileReader::new(file)).map_err(damaged)?;
    let columns = reader.metadata().file_metadata().schema_descr().columns().to_vec();
    let (mut channels, mut notes) = (Vec::new(), Vec::new());
    let given = reader.metadata().file_metadata().key_value_metadata();
    let mut rates = units::Rates::default();
    for note in given.into_iter().flatten() {
        rates.words(&note.key, note.value.as_deref().unwrap_or_default());
    }
    let rate_hz = rates.agreed(&mut notes);
    let pandas = given
        .and_then(|all| all.iter().find(|note| note.key == "pandas"))
        .and_then(|note| note.value.as_deref());
    let rows = (0..reader.num_row_groups()).map(|n| reader.metadata().row_group(n).num_rows());
    let rows = rows.map(|n| u64::try_from(n).unwrap_or(0)).fold(0_u64, u64::saturating_add);
    for (number, column) in columns.iter().enumerate() {
        let name = column.path().string();
        match Meaning::of(column) {
            Ok((meaning, unit)) => {
                let unit = unit.or_else(|| duration_unit(&name, pandas?));
                let stored =
                    Stored { path: path.to_owned(), number, defined: column.max_def_level(), meaning };
                channels.push(Channel::new(name, rows, stored).at_rate(rate_hz).in_unit(unit));
            }
            Err(why) => notes.push(left_out(&name, why)),
        }
    }
    Ok(Recording { path: path.to_owned(), format: FORMAT, channels, notes })
}

/// The unit of a column of durations, which Parquet stores as whole numbers, by what pandas wrote beside them.
fn duration_unit(name: &str, pandas: &str) -> Option<String> {
    let of_column = pandas.split('{').find(|part| {
        let plain: String = part.chars().filter(|c| !c.is_whitespace()).collect();
        plain.contains(&format!("\"field_name\":\"{name}\""))
    })?;
    let (_, unit) = of_column.split_once("timedelta64[")?;
    Some(unit.split_once(']')?.0.to_owned())
}

/// Conversion of the stored values of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Meaning {
    Number,
    /// Whole numbers without a sign.
    Unsigned,
    /// Whole numbers over a power of ten.
    Decimal(i32),
    Half,
}

impl Meaning {
    /// That of a column, with its unit where it counts time, or why the column is no channel.
    fn of(column: &ColumnDescriptor) -> std::result::Result<(Self, Option<String>), &'static str> {
        if column.max_rep_level() > 0 {
            return Err("it holds lists");
        }
        let (logical, converted) = (column.logical_type_ref(), column.converted_type());
        let whole = matches!(column.physical_type(), Physical::INT32 | Physical::INT64);
        let packed = matches!(column.physical_type(), Physical::FIXED_LEN_BYTE_ARRAY | Physical::BYTE_ARRAY);
        let unsigned =
            [ConvertedType::UINT_8, ConvertedType::UINT_16, ConvertedType::UINT_32, ConvertedType::UINT_64];
        match logical {
            Some(LogicalType::Decimal(_)) if whole || packed => {
                return Ok((Self::Decimal(column.type_scale()), None));
            }
            Some(LogicalType::Float16) => return Ok((Self::Half, None)),
            Some(LogicalType::Timestamp(time)) => return Ok((Self::Number, unit_of_time(&time.unit))),
            Some(LogicalType::Time(time)) => return Ok((Self::Number, unit_of_time(&time.unit))),
            Some(LogicalType::Date) => return Err("it holds dates without a time"),
            _ => {}
        }
        match converted {
            ConvertedType::DECIMAL if whole || packed => Ok((Self::Decimal(column.type_scale()), None)),
            ConvertedType::TIMESTAMP_MILLIS | ConvertedType::TIME_MILLIS => {
                Ok((Self::Number, Some("ms".to_owned())))
            }
            ConvertedType::TIMESTAMP_MICROS | ConvertedType::TIME_MICROS => {
                Ok((Self::Number, Some("us".to_owned())))
            }
            of if whole && unsigned.contains(&of) => Ok((Self::Unsigned, None)),
            _ => match column.physical_type() {
                Physical::DOUBLE | Physical::FLOAT | Physical::BOOLEAN => Ok((Self::Number, None)),
                _ if whole => Ok((Self::Number, None)),
                Physical::INT96 => Err("it holds times of 96 bits: save them as 64-bit timestamps"),
                _ => Err("it holds texts or bytes"),
            },
        }
    }

    fn of_i32(self, v: i32) -> f64 {
        if self == Self::Unsigned { f64::from(v as u32) } else { self.of_i64(i64::from(v)) }
    }

    fn of_i64(self, v: i64) -> f64 {
        match self {
            Self::Unsigned => v as u64 as f64,
            Self::Decimal(scale) => v as f64 / 10_f64.powi(scale),
            _ => v as f64,
        }
    }

    /// Whole numbers in bytes, the most significant first; halves the other way round.
    fn of_bytes(self, bytes: &[u8]) -> f64 {
        if self == Self::Half {
            return Number::little(Kind::F16).decode(bytes);
        }
        let Self::Decimal(scale) = self else { return f64::NAN };
        let first = bytes.first().map_or(0.0, |b| f64::from(*b as i8));
        let whole = bytes.iter().skip(1).fold(first, |sum, b| 256.0 * sum + f64::from(*b));
        whole / 10_f64.powi(scale)
    }
}

/// The unit of a column of times.
fn unit_of_time(unit: &TimeUnit) -> Option<String> {
    let unit = match unit {
        TimeUnit::MILLIS => "ms",
        TimeUnit::MICROS => "us",
        TimeUnit::NANOS => "ns",
    };
    Some(unit.to_owned())
}

/// A column of numbers in a file.
#[derive(Debug, Clone)]
pub(crate) struct Stored {
    path: PathBuf,
    number: usize,
    /// Level of definition of a value that is there.
    defined: i16,
    meaning: Meaning,
}

impl Samples for Stored {
    fn for_each_block(&self, len: u64, take: &mut dyn FnMut(&[f64]) -> bool) -> Result<()> {
        let file = File::open(&self.path).map_err(|e| Error::read(&self.path, e))?;
        let damaged = |e: ParquetError| Error::damaged(&self.path, FORMAT, e.to_string());
        let reader = guarded(|| SerializedFileReader::new(file)).map_err(damaged)?;
        let mut left = len;
        let mut give = |block: &[f64]| {
            let count = left.min(block.len() as u64);
            left -= count;
            (count == 0 || take(&block[..count as usize])) && left > 0
        };
        for group in 0..reader.num_row_groups() {
            let group = reader.get_row_group(group).map_err(damaged)?;
            let places = group.metadata().columns().get(self.number).map(|of| {
                [of.data_page_offset(), of.dictionary_page_offset().unwrap_or(0), of.compressed_size()]
            });
            if places.is_none_or(|all| all.iter().any(|place| *place < 0)) {
                return Err(Error::damaged(&self.path, FORMAT, "a column begins or ends before the file"));
            }
            let column = guarded(|| group.get_column_reader(self.number)).map_err(damaged)?;
            let going = match column {
                ColumnReader::DoubleColumnReader(mut r) => each(&mut r, self.defined, |v| v, &mut give),
                ColumnReader::FloatColumnReader(mut r) => each(&mut r, self.defined, f64::from, &mut give),
                ColumnReader::Int64ColumnReader(mut r) => {
                    each(&mut r, self.defined, |v| self.meaning.of_i64(v), &mut give)
                }
                ColumnReader::Int32ColumnReader(mut r) => {
                    each(&mut r, self.defined, |v| self.meaning.of_i32(v), &mut give)
                }
                ColumnReader::BoolColumnReader(mut r) => each(&mut r, self.defined, f64::from, &mut give),
                ColumnReader::ByteArrayColumnReader(mut r) => {
                    each(&mut r, self.defined, |v| self.meaning.of_bytes(v.data()), &mut give)
                }
                ColumnReader::FixedLenByteArrayColumnReader(mut r) => {
                    each(&mut r, self.defined, |v| self.meaning.of_bytes(v.data()), &mut give)
                }
                _ => Ok(false),
            };
            if !going.map_err(damaged)? {
                return Ok(());
            }
        }
        if left > 0 {
            return Err(Error::damaged(&self.path, FORMAT, format!("a column ends {left} values early")));
        }
        Ok(())
    }
}

/// Calls the library so that a panic on a damaged file becomes an error.
fn guarded<T>(
    read: impl FnOnce() -> std::result::Result<T, ParquetError>,
) -> std::result::Result<T, ParquetError> {
    catch_unwind(AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err(ParquetError::General("its structure contradicts itself".to_owned())))
}

/// Passes all values of a column of one row group to `take`; false when `take` has asked to stop.
fn each<T: parquet::data_type::DataType>(
    reader: &mut parquet::column::reader::ColumnReaderImpl<T>,
    defined: i16,
    number: impl Fn(T::T) -> f64,
    give: &mut dyn FnMut(&[f64]) -> bool,
) -> std::result::Result<bool, ParquetError> {
    loop {
        let (mut batch, mut levels) = (Vec::new(), Vec::new());
        let with_levels = (defined > 0).then_some(&mut levels);
        let (rows, _, _) = guarded(|| reader.read_records(BATCH, with_levels, None, &mut batch))?;
        if rows == 0 {
            return Ok(true);
        }
        let mut found = batch.into_iter().map(&number);
        let mut value =
            |level: &i16| if *level == defined { found.next().unwrap_or(f64::NAN) } else { f64::NAN };
        let values: Vec<f64> =
            if defined == 0 { found.collect() } else { levels.iter().map(&mut value).collect() };
        if !give(&values) {
            return Ok(false);
        }
    }
}

fn write_column(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: &Values,
) -> std::result::Result<(), ParquetError> {
    fn split<T: Clone, P>(all: &[Option<T>], to: impl Fn(T) -> P) -> (Vec<P>, Vec<i16>) {
        (
            all.iter().flatten().cloned().map(to).collect(),
            all.iter().map(|v| i16::from(v.is_some())).collect(),
        )
    }
    let Some(mut column) = group.next_column()? else { return Ok(()) };
    match values {
        Values::Number(all) => {
            let (values, levels) = split(all, |v| v);
            column.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
        }
        Values::Count(all) => {
            let (values, levels) = split(all, |v| v);
            column.typed::<Int64Type>().write_batch(&values, Some(&levels), None)?;
        }
        Values::Flag(all) => {
            let (values, levels) = split(all, |v| v);
            column.typed::<BoolType>().write_batch(&values, Some(&levels), None)?;
        }
        Values::Series(all) => {
            let values = all.concat();
            // An empty list has a level of its own, and no value.
            let (mut filled, mut first) = (Vec::new(), Vec::new());
            for of in all {
                filled.extend(std::iter::repeat_n(i16::from(!of.is_empty()), of.len().max(1)));
                first.extend((0..of.len().max(1)).map(|at| i16::from(at > 0)));
            }
            column.typed::<FloatType>().write_batch(&values, Some(&filled), Some(&first))?;
        }
        Values::Text(all) => {
            let (values, levels) = split(all, |v| ByteArray::from(v.into_bytes()));
            column.typed::<ByteArrayType>().write_batch(&values, Some(&levels), None)?;
        }
    }
    column.close()
}

/// An error of the library while writing.
fn refused(path: &Path, error: &ParquetError) -> Error {
    match error {
        ParquetError::External(source) if source.downcast_ref::<std::io::Error>().is_some() => {
            let kind = source.downcast_ref::<std::io::Error>().map(std::io::Error::kind);
            let kind = kind.unwrap_or(std::io::ErrorKind::Other);
            Error::write(path, std::io::Error::new(kind, source.to_string()))
        }
        other => Error::DoesNotFit { path: path.to_owned(), format: FORMAT, what: other.to_string() },
    }
}
