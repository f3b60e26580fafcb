//! Parquet: decimal, unsigned and half numbers, and codecs.

use std::sync::Arc;

use parquet::basic::{
    BrotliLevel, Compression, GzipLevel, LogicalType, Repetition, Type as Physical, ZstdLevel,
};
use parquet::data_type::{DoubleType, FixedLenByteArray, FixedLenByteArrayType, Int32Type, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use stribeck_formats::Recording;
use stribeck_testing::Scratch;

use crate::{COUNT, RATE_HZ, holds, signal};

/// A column of a Parquet file.
pub(crate) enum Stored {
    Double(Vec<f64>),
    Int32(Vec<i32>),
    Int64(Vec<i64>),
    Bytes(Vec<Vec<u8>>),
}

pub(crate) fn parquet_file(
    desk: &Scratch,
    compression: Compression,
    columns: &[(&str, Option<LogicalType>, Stored)],
) -> Recording {
    let path = desk.join("a.parquet");
    let fields = columns.iter().map(|(name, logical, stored)| {
        let (physical, length) = match stored {
            Stored::Double(_) => (Physical::DOUBLE, 0),
            Stored::Int32(_) => (Physical::INT32, 0),
            Stored::Int64(_) => (Physical::INT64, 0),
            Stored::Bytes(all) => (Physical::FIXED_LEN_BYTE_ARRAY, all[0].len() as i32),
        };
        let (precision, scale) = match logical {
            Some(LogicalType::Decimal(of)) => (of.precision, of.scale),
            _ => (-1, -1),
        };
        let field = Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::REQUIRED)
            .with_logical_type(logical.clone())
            .with_length(length)
            .with_precision(precision)
            .with_scale(scale);
        Arc::new(field.build().unwrap())
    });
    let schema = Type::group_type_builder("table").with_fields(fields.collect()).build().unwrap();
    let properties = WriterProperties::builder().set_compression(compression).build();
    let file = std::fs::File::create(&path).unwrap();
    let mut writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties)).unwrap();
    let mut group = writer.next_row_group().unwrap();
    for (_, _, stored) in columns {
        let mut column = group.next_column().unwrap().unwrap();
        match stored {
            Stored::Double(all) => column.typed::<DoubleType>().write_batch(all, None, None),
            Stored::Int32(all) => column.typed::<Int32Type>().write_batch(all, None, None),
            Stored::Int64(all) => column.typed::<Int64Type>().write_batch(all, None, None),
            Stored::Bytes(all) => {
                let all: Vec<_> = all.iter().cloned().map(FixedLenByteArray::from).collect();
                column.typed::<FixedLenByteArrayType>().write_batch(&all, None, None)
            }
        }
        .unwrap();
        column.close().unwrap();
    }
    group.close().unwrap();
    writer.close().unwrap();
    Recording::open(&path).unwrap()
}

#[test]
fn issue_numbers_of_parquet_keep_scale_and_sign() {
    let desk = Scratch::create("formats-parquet-numbers");
    let decimal = |precision| Some(LogicalType::decimal(4, precision));
    let whole = |n: usize| (1e4 * signal(n)).round();
    let unsigned = |bits| Some(LogicalType::integer(bits, false));
    let columns = [
        ("a", decimal(9), Stored::Int32((0..COUNT).map(|n| whole(n) as i32).collect())),
        ("b", decimal(18), Stored::Int64((0..COUNT).map(|n| whole(n) as i64).collect())),
        (
            "c",
            decimal(18),
            Stored::Bytes((0..COUNT).map(|n| (whole(n) as i64).to_be_bytes().to_vec()).collect()),
        ),
        ("u", unsigned(32), Stored::Int32((0..COUNT).map(|n| (3e9 + whole(n)) as u32 as i32).collect())),
        (
            "v",
            unsigned(64),
            Stored::Int64((0..COUNT).map(|n| (1e19 + 1e8 * whole(n)) as u64 as i64).collect()),
        ),
        // Halves: 1.0 and -2.5 in turn.
        (
            "h",
            Some(LogicalType::Float16),
            Stored::Bytes(
                (0..COUNT).map(|n| if n % 2 == 0 { vec![0x00, 0x3c] } else { vec![0x00, 0xc1] }).collect(),
            ),
        ),
    ];
    let found = parquet_file(&desk, Compression::UNCOMPRESSED, &columns);
    for name in ["a", "b", "c"] {
        holds(found.channel(name).unwrap(), COUNT, |n| 1e-4 * whole(n));
    }
    holds(found.channel("u").unwrap(), COUNT, |n| 3e9 + whole(n));
    holds(found.channel("v").unwrap(), COUNT, |n| 1e19 + 1e8 * whole(n));
    holds(found.channel("h").unwrap(), COUNT, |n| if n % 2 == 0 { 1.0 } else { -2.5 });
}

#[test]
fn issue_every_usual_codec_of_parquet_is_read() {
    let desk = Scratch::create("formats-parquet-codecs");
    for codec in [
        Compression::SNAPPY,
        Compression::GZIP(GzipLevel::default()),
        Compression::ZSTD(ZstdLevel::default()),
        Compression::LZ4,
        Compression::LZ4_RAW,
        Compression::BROTLI(BrotliLevel::default()),
    ] {
        let columns = [
            ("time_s", None, Stored::Double((0..COUNT).map(|n| n as f64 / RATE_HZ).collect())),
            ("acc", None, Stored::Double((0..COUNT).map(signal).collect())),
        ];
        let found = parquet_file(&desk, codec, &columns);
        assert_eq!(found.channels[1].rate_hz, Some(RATE_HZ), "{codec:?}");
        holds(&found.channels[1], COUNT, signal);
    }
}
