//! Kinds of binary files whose units, scales, shapes or rates were once lost, each as a tiny input of our
//! own: TDMS, MDF, MATLAB 4 and 5, NumPy, Parquet and HDF5.

use std::path::PathBuf;
use std::sync::Arc;

use parquet::basic::{
    BrotliLevel, Compression, GzipLevel, LogicalType, Repetition, Type as Physical, ZstdLevel,
};
use parquet::data_type::{DoubleType, FixedLenByteArray, FixedLenByteArrayType, Int32Type, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use stribeck_formats::{Channel, Recording};
use stribeck_testing::{Noise, Scratch};

const RATE_HZ: f64 = 12_800.0;
/// Samples of each input.
const COUNT: usize = 300;

fn signal(n: usize) -> f64 {
    ((n * 37 % 101) as f64 - 50.0) / 50.0
}

fn opened(desk: &Scratch, name: &str, bytes: &[u8]) -> Recording {
    let path: PathBuf = desk.join(name);
    std::fs::write(&path, bytes).unwrap();
    Recording::open(&path).unwrap_or_else(|why| panic!("{name}: {why}"))
}

/// Asserts that a channel holds what `expected` says, to a part in a million.
#[track_caller]
fn holds(channel: &Channel, count: usize, expected: impl Fn(usize) -> f64) {
    let samples = channel.read().unwrap();
    assert_eq!(samples.len(), count, "{}", channel.name);
    for (n, x) in samples.iter().enumerate() {
        let wanted = expected(n);
        let same = x.is_nan() && wanted.is_nan() || (x - wanted).abs() <= 1e-6 * (1.0 + wanted.abs());
        assert!(same, "{} [{n}]: {x}, not {wanted}", channel.name);
    }
}

#[track_caller]
fn notes(recording: &Recording, words: &[&str]) {
    let all = recording.notes.join("; ");
    assert!(words.iter().all(|word| all.contains(word)), "{words:?} in {all}");
}

// ---------------------------------------------------------------------------------------------- TDMS

/// A property of a TDMS object.
enum Is<'a> {
    Number(f64),
    Word(u32),
    Text(&'a str),
}

/// Index of the data of a TDMS object in a segment.
enum Index {
    /// A type and a number of values.
    Of(u32, u64),
    AsBefore,
    NoData,
}

fn tdms_text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

fn tdms_object(path: &str, index: &Index, properties: &[(&str, Is<'_>)]) -> Vec<u8> {
    let mut out = tdms_text(path);
    match index {
        Index::Of(kind, count) => {
            out.extend([20_u32, *kind, 1].into_iter().flat_map(u32::to_le_bytes));
            out.extend(count.to_le_bytes());
        }
        Index::AsBefore => out.extend(0_u32.to_le_bytes()),
        Index::NoData => out.extend(u32::MAX.to_le_bytes()),
    }
    out.extend((properties.len() as u32).to_le_bytes());
    for (name, value) in properties {
        out.extend(tdms_text(name));
        match value {
            Is::Number(x) => {
                out.extend(10_u32.to_le_bytes());
                out.extend(x.to_le_bytes());
            }
            Is::Word(n) => out.extend([7, *n].into_iter().flat_map(u32::to_le_bytes)),
            Is::Text(text) => {
                out.extend(0x20_u32.to_le_bytes());
                out.extend(tdms_text(text));
            }
        }
    }
    out
}

fn tdms_segment(objects: &[Vec<u8>], is_new: bool, data: &[u8]) -> Vec<u8> {
    let metadata = [&(objects.len() as u32).to_le_bytes()[..], &objects.concat()].concat();
    let mut out = b"TDSm".to_vec();
    out.extend([if is_new { 14_u32 } else { 10 }, 4713].into_iter().flat_map(u32::to_le_bytes));
    out.extend([(metadata.len() + data.len()) as u64, metadata.len() as u64].map(u64::to_le_bytes).concat());
    out.extend(metadata);
    out.extend(data);
    out
}

const F64: u32 = 10;
const I16: u32 = 2;

#[test]
fn issue_scales_of_tdms_are_applied_or_named() {
    let desk = Scratch::create("formats-tdms-scales");
    let counts: Vec<u8> = (0..COUNT).flat_map(|n| ((1000.0 * signal(n)) as i16).to_le_bytes()).collect();
    let stored = |n: usize| f64::from((1000.0 * signal(n)) as i16);
    let read = |scales: Vec<(&str, Is<'_>)>| {
        let mut properties =
            vec![("wf_increment", Is::Number(1.0 / RATE_HZ)), ("unit_string", Is::Text("g"))];
        properties.extend(scales);
        let object = tdms_object("/'g'/'acc'", &Index::Of(I16, COUNT as u64), &properties);
        let plain = tdms_object("/'g'/'plain'", &Index::Of(I16, COUNT as u64), &[]);
        opened(
            &desk,
            "a.tdms",
            &tdms_segment(&[object, plain], true, &[counts.clone(), counts.clone()].concat()),
        )
    };
    let linear = || {
        vec![
            ("NI_Number_Of_Scales", Is::Word(1)),
            ("NI_Scaling_Status", Is::Text("unscaled")),
            ("NI_Scale[0]_Scale_Type", Is::Text("Linear")),
            ("NI_Scale[0]_Linear_Slope", Is::Number(0.001)),
            ("NI_Scale[0]_Linear_Y_Intercept", Is::Number(0.5)),
            ("NI_Scale[0]_Linear_Input_Source", Is::Word(u32::MAX)),
        ]
    };
    let found = read(linear());
    let channel = found.channel("g/acc").unwrap();
    assert_eq!((channel.unit.as_deref(), channel.rate_hz), (Some("g"), Some(RATE_HZ)));
    holds(channel, COUNT, |n| 0.5 + 0.001 * stored(n));
    holds(found.channel("g/plain").unwrap(), COUNT, stored);

    // A polynomial of the result of the line.
    let mut chain = linear();
    chain[0].1 = Is::Word(2);
    chain.extend([
        ("NI_Scale[1]_Scale_Type", Is::Text("Polynomial")),
        ("NI_Scale[1]_Polynomial_Coefficients_Size", Is::Word(3)),
        ("NI_Scale[1]_Polynomial_Coefficients[0]", Is::Number(1.0)),
        ("NI_Scale[1]_Polynomial_Coefficients[1]", Is::Number(0.0)),
        ("NI_Scale[1]_Polynomial_Coefficients[2]", Is::Number(2.0)),
        ("NI_Scale[1]_Polynomial_Input_Source", Is::Word(0)),
    ]);
    holds(read(chain).channel("g/acc").unwrap(), COUNT, |n| 1.0 + 2.0 * (0.5 + 0.001 * stored(n)).powi(2));

    // A table of two pairs is a line between them.
    let table = vec![
        ("NI_Number_Of_Scales", Is::Word(1)),
        ("NI_Scale[0]_Scale_Type", Is::Text("Table")),
        ("NI_Scale[0]_Table_Pre_Scaled_Values_Size", Is::Word(2)),
        ("NI_Scale[0]_Table_Pre_Scaled_Values[0]", Is::Number(-2000.0)),
        ("NI_Scale[0]_Table_Pre_Scaled_Values[1]", Is::Number(2000.0)),
        ("NI_Scale[0]_Table_Scaled_Values_Size", Is::Word(2)),
        ("NI_Scale[0]_Table_Scaled_Values[0]", Is::Number(-4.0)),
        ("NI_Scale[0]_Table_Scaled_Values[1]", Is::Number(4.0)),
        ("NI_Scale[0]_Table_Input_Source", Is::Word(u32::MAX)),
    ];
    let found = read(table);
    let channel = found.channel("g/acc").unwrap();
    holds(channel, COUNT, |n| 0.002 * stored(n));

    let sensor = vec![
        ("NI_Number_Of_Scales", Is::Word(1)),
        ("NI_Scale[0]_Scale_Type", Is::Text("Thermocouple")),
        ("NI_Scale[0]_Thermocouple_Thermocouple_Type", Is::Word(10073)),
    ];
    let found = read(sensor);
    assert!(found.channel("g/acc").is_err());
    notes(&found, &["`g/acc` is left out", "Thermocouple"]);
    holds(found.channel("g/plain").unwrap(), COUNT, stored);
}

#[test]
fn issue_tdms_objects_without_data_take_none() {
    let desk = Scratch::create("formats-tdms-objects");
    let part =
        |from: usize| -> Vec<u8> { (from..from + 100).flat_map(|n| signal(n).to_le_bytes()).collect() };
    let warm = 70.0_f64.to_le_bytes().repeat(100);
    let of = |name: &str, index| tdms_object(&format!("/'g'/'{name}'"), &index, &[]);
    let rate = [("wf_increment", Is::Number(1.0 / RATE_HZ))];
    let acc = tdms_object("/'g'/'acc'", &Index::Of(F64, 100), &rate);
    let bytes = [
        tdms_segment(&[acc, of("temp", Index::Of(F64, 100))], true, &[part(0), warm.clone()].concat()),
        // `temp` pauses for a segment, and comes back.
        tdms_segment(&[of("temp", Index::NoData)], false, &part(100)),
        tdms_segment(&[of("temp", Index::AsBefore)], false, &[part(200), warm].concat()),
    ];
    let found = opened(&desk, "a.tdms", &bytes.concat());
    holds(found.channel("g/acc").unwrap(), 300, signal);
    holds(found.channel("g/temp").unwrap(), 200, |_| 70.0);
    assert_eq!(found.channel("g/acc").unwrap().rate_hz, Some(RATE_HZ));
}

#[test]
fn issue_channels_of_tdms_have_rates_of_their_own() {
    let desk = Scratch::create("formats-tdms-rates");
    let of = |name: &str, hz: f64| {
        tdms_object(name, &Index::Of(F64, COUNT as u64), &[("wf_increment", Is::Number(1.0 / hz))])
    };
    let data: Vec<u8> = (0..2 * COUNT).flat_map(|n| signal(n % COUNT).to_le_bytes()).collect();
    let objects = [of("/'g'/'acc'", RATE_HZ), of("/'g'/'tacho'", 3200.0)];
    let found = opened(&desk, "a.tdms", &tdms_segment(&objects, true, &data));
    let rates: Vec<_> = found.channels.iter().map(|c| c.rate_hz).collect();
    assert_eq!(rates, [Some(RATE_HZ), Some(3200.0)]);
}

// ----------------------------------------------------------------------------------------------- MDF

/// One channel of an MDF group.
struct MdfChannel<'a> {
    name: &'a str,
    unit: &'a str,
    /// 0 fixed length, 2 master, 3 virtual master.
    sort: u8,
    /// 0 unsigned, 4 float; and bits.
    kind: (u8, u32),
    /// Byte in the record.
    place: u32,
    /// Offset and slope.
    line: Option<(f64, f64)>,
    /// Bit that says that a sample is invalid.
    invalid: Option<u32>,
}

/// One group of an MDF file: its channels, bytes of data and of invalidation bits in a record, and its
/// records.
type MdfGroup<'a> = (&'a [MdfChannel<'a>], u32, u32, Vec<Vec<u8>>);

/// An MDF file of such groups.
fn mdf(groups: &[MdfGroup<'_>]) -> Vec<u8> {
    let mut bytes = b"MDF     4.10    tests   \0\0\0\0\x9a\x01".to_vec();
    bytes.resize(64, 0);
    /// Puts a block at the end, and says where it is.
    fn put(bytes: &mut Vec<u8>, sort: &[u8; 4], links: &[u64], data: &[u8]) -> u64 {
        let at = bytes.len() as u64;
        bytes.extend(sort);
        bytes.extend([0; 4]);
        bytes.extend((24 + 8 * links.len() as u64 + data.len() as u64).to_le_bytes());
        bytes.extend((links.len() as u64).to_le_bytes());
        links.iter().for_each(|link| bytes.extend(link.to_le_bytes()));
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        at
    }
    // The header block stands first; its link to the groups is filled in at the end.
    let header = put(&mut bytes, b"##HD", &[0; 6], &[0; 32]);
    let mut next_group = 0;
    for (channels, data_bytes, invalid_bytes, records) in groups.iter().rev() {
        let mut next = 0;
        for of in channels.iter().rev() {
            let text = |bytes: &mut Vec<u8>, text: &str| {
                put(bytes, b"##TX", &[], &[text.as_bytes(), b"\0"].concat())
            };
            let name = text(&mut bytes, of.name);
            let unit = if of.unit.is_empty() { 0 } else { text(&mut bytes, of.unit) };
            let conversion = of.line.map_or(0, |(offset, slope)| {
                let mut data = vec![1, 0, 0, 0, 0, 0, 2, 0];
                data.extend([0.0, 0.0, offset, slope].into_iter().flat_map(f64::to_le_bytes));
                put(&mut bytes, b"##CC", &[0; 4], &data)
            });
            let mut data = vec![of.sort, u8::from(of.sort >= 2), of.kind.0, 0];
            let flags = if of.invalid.is_some() { 2 } else { 0 };
            let words = [of.place, of.kind.1, flags, of.invalid.unwrap_or(0)];
            data.extend(words.into_iter().flat_map(u32::to_le_bytes));
            data.resize(72, 0);
            next = put(&mut bytes, b"##CN", &[next, 0, name, 0, conversion, 0, unit, 0], &data);
        }
        let mut data = 0_u64.to_le_bytes().to_vec();
        data.extend((records.len() as u64).to_le_bytes());
        data.extend([0; 8]);
        data.extend([*data_bytes, *invalid_bytes].into_iter().flat_map(u32::to_le_bytes));
        let group = put(&mut bytes, b"##CG", &[0, next, 0, 0, 0, 0], &data);
        let samples = put(&mut bytes, b"##DT", &[], &records.concat());
        next_group = put(&mut bytes, b"##DG", &[next_group, group, samples, 0], &[0; 8]);
    }
    let at = header as usize + 24;
    bytes[at..at + 8].copy_from_slice(&next_group.to_le_bytes());
    bytes
}

const FLOAT: (u8, u32) = (4, 64);

fn mdf_channel(name: &str, place: u32) -> MdfChannel<'_> {
    MdfChannel { name, unit: "", sort: 0, kind: FLOAT, place, line: None, invalid: None }
}

/// Records of a time, as `time` gives it, and of the signal.
fn timed(time: impl Fn(usize) -> f64) -> Vec<Vec<u8>> {
    (0..COUNT).map(|n| [time(n).to_le_bytes(), signal(n).to_le_bytes()].concat()).collect()
}

#[test]
fn issue_invalid_samples_of_mdf_are_no_numbers() {
    let desk = Scratch::create("formats-mdf-invalid");
    let channels = [
        MdfChannel { unit: "s", sort: 2, ..mdf_channel("time", 0) },
        MdfChannel { unit: "g", invalid: Some(1), ..mdf_channel("acc", 8) },
        MdfChannel { invalid: Some(0), ..mdf_channel("other", 8) },
    ];
    let is_bad = |n: usize| (40..70).contains(&n);
    let records = timed(|n| n as f64 / RATE_HZ).into_iter().enumerate();
    let records = records.map(|(n, record)| [&record[..], &[if is_bad(n) { 2 } else { 0 }]].concat());
    let found = opened(&desk, "a.mf4", &mdf(&[(&channels, 16, 1, records.collect())]));
    let channel = found.channel("acc").unwrap();
    assert_eq!((channel.rate_hz, channel.unit.as_deref()), (Some(RATE_HZ), Some("g")));
    holds(channel, COUNT, |n| if is_bad(n) { f64::NAN } else { signal(n) });
    // The bit of another channel does not count.
    holds(found.channel("other").unwrap(), COUNT, signal);
}

#[test]
fn issue_masters_of_mdf_may_be_virtual_scaled_and_jitter() {
    let desk = Scratch::create("formats-mdf-masters");
    let acc = || mdf_channel("acc", 8);
    let rate = |name: &str, master: MdfChannel<'_>, time: &dyn Fn(usize) -> f64| {
        let found = opened(&desk, name, &mdf(&[(&[master, acc()], 16, 0, timed(time))]));
        let channel = found.channel("acc").unwrap();
        holds(channel, COUNT, signal);
        (channel.rate_hz, found.notes.join("; "))
    };
    let time = || mdf_channel("time", 0);
    let of_virtual = MdfChannel { sort: 3, kind: (0, 0), line: Some((0.0, 1.0 / RATE_HZ)), ..time() };
    assert_eq!(rate("a.mf4", of_virtual, &|_| 0.0).0, Some(RATE_HZ));
    let scaled = MdfChannel { sort: 2, line: Some((5.0, 1.0 / RATE_HZ)), ..time() };
    assert_eq!(rate("b.mf4", scaled, &|n| n as f64).0, Some(RATE_HZ));
    let milliseconds = MdfChannel { sort: 2, unit: "ms", ..time() };
    assert_eq!(rate("c.mf4", milliseconds, &|n| 1e3 * n as f64 / RATE_HZ).0, Some(RATE_HZ));
    let jitter = |n: usize| (n as f64 + 0.03 * signal(7 * n)) / RATE_HZ;
    let (hz, said) = rate("d.mf4", MdfChannel { sort: 2, ..time() }, &jitter);
    assert!((hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-3 && !said.contains("gap"), "{hz:?}: {said}");
    let gap = |n: usize| (n + if n >= 120 { 50 } else { 0 }) as f64 / RATE_HZ;
    let (hz, said) = rate("e.mf4", MdfChannel { sort: 2, ..time() }, &gap);
    assert!((hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-6, "{hz:?}");
    assert!(said.contains("a gap after row 120") && said.contains("missing samples: 50"), "{said}");
}

#[test]
fn issue_groups_of_mdf_have_masters_of_their_own() {
    let desk = Scratch::create("formats-mdf-groups");
    let group = |name| [MdfChannel { sort: 2, ..mdf_channel("time", 0) }, mdf_channel(name, 8)];
    let (acc, tacho) = (group("acc"), group("tacho"));
    let found = opened(
        &desk,
        "a.mf4",
        &mdf(&[(&acc, 16, 0, timed(|n| n as f64 / RATE_HZ)), (&tacho, 16, 0, timed(|n| n as f64 / 3200.0))]),
    );
    assert_eq!(found.channel("acc").unwrap().rate_hz, Some(RATE_HZ), "{:?}", found.notes);
    assert_eq!(found.channel("tacho").unwrap().rate_hz, Some(3200.0), "{:?}", found.notes);
}

// -------------------------------------------------------------------------------------- MATLAB, NumPy

/// An element of a MATLAB 5 file.
fn mat5_element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut out = [kind, data.len() as u32].map(u32::to_le_bytes).concat();
    out.extend(data);
    out.resize(out.len().next_multiple_of(8), 0);
    out
}

/// A matrix of doubles.
fn mat5_matrix(name: &str, shape: &[i32], values: impl Iterator<Item = f64>) -> Vec<u8> {
    let parts = [
        mat5_element(6, &[6_u32, 0].map(u32::to_le_bytes).concat()),
        mat5_element(5, &shape.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>()),
        mat5_element(1, name.as_bytes()),
        mat5_element(9, &values.flat_map(f64::to_le_bytes).collect::<Vec<u8>>()),
    ];
    mat5_element(14, &parts.concat())
}

#[test]
fn issue_arrays_of_matlab_5_keep_their_shape() {
    let desk = Scratch::create("formats-mat5-shape");
    let mut head = b"MATLAB 5.0 MAT-file".to_vec();
    head.resize(124, b' ');
    head.extend([0, 1, b'I', b'M']);
    let bytes = [
        head,
        mat5_matrix("cube", &[2, 3, 50], (0..COUNT).map(signal)),
        mat5_matrix("thin", &[1, 1, 300], (0..COUNT).map(signal)),
        mat5_matrix("two", &[150, 2], (0..COUNT).map(signal)),
        mat5_matrix("fs", &[1, 1], std::iter::once(RATE_HZ)),
    ];
    let found = opened(&desk, "a.mat", &bytes.concat());
    assert!(!found.channels.iter().any(|c| c.name.contains("cube")), "{}", found.names());
    notes(&found, &["`cube` is left out", "3 dimensions, 2 × 3 × 50"]);
    holds(found.channel("thin").unwrap(), COUNT, signal);
    holds(found.channel("two(:,2)").unwrap(), 150, |n| signal(150 + n));
    assert_eq!(found.channel("thin").unwrap().rate_hz, Some(RATE_HZ));
}

#[test]
fn issue_matlab_4_is_read_in_both_byte_orders() {
    let desk = Scratch::create("formats-mat4");
    for is_big in [false, true] {
        let word = |n: u32| if is_big { n.to_be_bytes() } else { n.to_le_bytes() };
        let matrix = |name: &str, kind: u32, rows: u32, columns: u32, data: Vec<u8>| {
            let kind = kind + if is_big { 1000 } else { 0 };
            let head = [kind, rows, columns, 0, name.len() as u32 + 1].map(word).concat();
            [head, name.as_bytes().to_vec(), vec![0], data].concat()
        };
        let double = |x: f64| if is_big { x.to_be_bytes() } else { x.to_le_bytes() };
        let short = |x: i16| if is_big { x.to_be_bytes() } else { x.to_le_bytes() };
        let bytes = [
            matrix("acc", 0, COUNT as u32, 1, (0..COUNT).flat_map(|n| double(signal(n))).collect()),
            matrix("counts", 30, 2, 150, (0..COUNT).flat_map(|n| short(n as i16 - 9)).collect()),
            matrix("sr", 0, 1, 1, double(RATE_HZ).to_vec()),
        ];
        let found = opened(&desk, "a.mat", &bytes.concat());
        holds(found.channel("acc").unwrap(), COUNT, signal);
        assert_eq!(found.channel("acc").unwrap().rate_hz, Some(RATE_HZ));
        holds(found.channel("counts(2,:)").unwrap(), 150, |n| (2 * n + 1) as f64 - 9.0);
    }
}

#[test]
fn issue_arrays_of_numpy_keep_their_shape() {
    let desk = Scratch::create("formats-npy-shape");
    let file = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.into_bytes());
        bytes.extend((0..COUNT).flat_map(|n| signal(n).to_le_bytes()));
        bytes
    };
    holds(&opened(&desk, "a.npy", &file("(1, 300, 1)")).channels[0], COUNT, signal);
    let path = desk.join("b.npy");
    std::fs::write(&path, file("(2, 3, 50)")).unwrap();
    let said = match Recording::open(&path) {
        Err(why) => why.to_string(),
        Ok(found) => {
            assert!(found.channels.is_empty(), "{}", found.names());
            found.notes.join("; ")
        }
    };
    assert!(said.contains("3 dimensions, 2 × 3 × 50"), "{said}");
}

// -------------------------------------------------------------------------------------------- Parquet

/// A column of a Parquet file.
enum Stored {
    Double(Vec<f64>),
    Int32(Vec<i32>),
    Int64(Vec<i64>),
    Bytes(Vec<Vec<u8>>),
}

fn parquet_file(
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

#[test]
fn issue_properties_and_channels_of_tdms_say_the_rate() {
    let desk = Scratch::create("formats-tdms-rates");
    let data: Vec<u8> = (0..COUNT).flat_map(|n| signal(n).to_le_bytes()).collect();
    let of = |index| tdms_object("/'g'/'acc'", &index, &[]);
    for (path, name, value) in [
        ("/'g'", "SamplingRate", RATE_HZ),
        ("/", "Sampling Rate", RATE_HZ),
        ("/", "sample_interval", 1.0 / RATE_HZ),
    ] {
        let parent = tdms_object(path, &Index::NoData, &[(name, Is::Number(value))]);
        let segment = tdms_segment(&[parent, of(Index::Of(F64, COUNT as u64))], true, &data);
        let found = opened(&desk, "a.tdms", &segment);
        assert_eq!(found.channel("g/acc").unwrap().rate_hz, Some(RATE_HZ), "{path} {name}");
    }
    // A channel of times in the group, whose path is no unit.
    for (name, second) in [("Time", 1.0), ("t [ms]", 1e-3)] {
        let times: Vec<u8> = (0..COUNT).flat_map(|n| (n as f64 / RATE_HZ / second).to_le_bytes()).collect();
        let time = tdms_object(&format!("/'g'/'{name}'"), &Index::Of(F64, COUNT as u64), &[]);
        let segment =
            tdms_segment(&[time, of(Index::Of(F64, COUNT as u64))], true, &[times, data.clone()].concat());
        let found = opened(&desk, "a.tdms", &segment);
        let hz = found.channel("g/acc").unwrap().rate_hz.unwrap_or_else(|| panic!("{:?}", found.notes));
        assert!((hz / RATE_HZ - 1.0).abs() < 1e-6, "{name}: {hz}");
    }
}

// ----------------------------------------------------------------------------------------------- HDF5

/// Files that h5py wrote, by `fixtures/signals/make.py`.
fn fixture(name: &str) -> Recording {
    let path = format!("{}/../../fixtures/signals/{name}", env!("CARGO_MANIFEST_DIR"));
    Recording::open(&path).unwrap_or_else(|why| panic!("{name}: {why}"))
}

#[test]
fn issue_one_object_of_hdf5_does_not_spoil_the_others() {
    for (file, name, words) in [
        ("links.h5", "raw.acc", &["`alias` is left out", "link"][..]),
        ("blosc.h5", "acc", &["`packed` is left out", "blosc"]),
        ("btree2.h5", "acc", &["`two` is left out"]),
        ("virtual.h5", "acc", &["`put_together` is left out", "virtual"]),
        ("cube.h5", "acc", &["`cube` is left out", "3 dimensions, 10 × 2 × 3"]),
        ("table.h5", "acc", &["`table` is left out", "records (t, a)"]),
    ] {
        let found = fixture(file);
        let channel = found.channel(name).unwrap_or_else(|why| panic!("{file}: {why} {:?}", found.notes));
        holds(channel, COUNT, |n| signal(n) as f32 as f64);
        notes(&found, words);
    }
}

#[test]
fn issue_a_damaged_object_of_hdf5_costs_that_object_only() {
    let desk = Scratch::create("formats-damaged-object");
    for (file, sets) in [("few.h5", 3), ("many.h5", 60)] {
        let path = format!("{}/../../fixtures/signals/{file}", env!("CARGO_MANIFEST_DIR"));
        let (good, all) = (std::fs::read(path).unwrap(), fixture(file));
        assert_eq!(all.channels.len(), sets);
        let headers: Vec<usize> = (0..good.len() - 4).filter(|at| good[*at..].starts_with(b"OHDR")).collect();
        // Those of the sets, of the group and of the root.
        assert_eq!(headers.len(), sets + 2);
        let mut costs = Vec::new();
        for at in headers {
            // The name of the header, its checksum's sum, or its end: the file is cut off there.
            for damage in 0..2 {
                let mut bytes = good.clone();
                bytes[at + 12 * damage] ^= 0x55;
                let path = desk.join("a.h5");
                std::fs::write(&path, &bytes).unwrap();
                let found = Recording::open(&path);
                let there = found.as_ref().map_or(&[][..], |found| &found.channels);
                let kept = |name: &str| there.iter().find(|c| c.name == name);
                let lost: Vec<_> = all.channels.iter().filter(|c| kept(&c.name).is_none()).collect();
                for of in &all.channels {
                    if let Some(channel) = kept(&of.name) {
                        assert_eq!(channel.read().unwrap(), of.read().unwrap());
                    }
                }
                if let (Ok(found), [only]) = (&found, &lost[..]) {
                    notes(found, &[&format!("`{}` is left out", only.name)]);
                }
                costs.push(lost.len());
            }
        }
        costs.sort_unstable();
        // Every set but those that lie in the group, and the root.
        let in_group = if sets == 3 { 2 } else { 60 };
        let mut expected = vec![1; 2 * sets];
        expected.extend([in_group, in_group, sets, sets]);
        assert_eq!(costs, expected, "{file}");
    }
}

#[test]
fn issue_attributes_of_hdf5_say_rate_and_unit() {
    let found = fixture("attributes.h5");
    let channel = found.channel("near.acc").unwrap();
    assert_eq!((channel.rate_hz, channel.unit.as_deref()), (Some(RATE_HZ), Some("g")), "{:?}", found.notes);
    // A group has a rate of its own.
    assert_eq!(found.channel("far.acc").unwrap().rate_hz, Some(3200.0), "{:?}", found.notes);
}

#[test]
fn issue_times_of_netcdf_count_from_a_date() {
    let found = fixture("since.h5");
    let channel = found.channel("acc").unwrap();
    assert_eq!((channel.rate_hz, channel.len), (Some(RATE_HZ), COUNT as u64), "{:?}", found.notes);
}

#[test]
fn issue_scale_factors_of_hdf5_are_applied() {
    let found = fixture("scaled.h5");
    holds(found.channel("acc").unwrap(), COUNT, |n| 0.5 + 0.001 * (1000.0 * signal(n)).round());
}

// ------------------------------------------------------------------------------------------ mutations

/// Mutations of the tests; `STRIBECK_MUTATIONS` makes them more.
const MUTATIONS: usize = 10_000;

/// Tiny good files of all formats with their names.
fn good_files(desk: &Scratch) -> Vec<(&'static str, Vec<u8>)> {
    let table = |head: &str, separator: &str, comma: bool| {
        let rows = (0..60).map(|n| format!("{:.6}{separator}{:.4}\n", n as f64 / RATE_HZ, signal(n)));
        let rows: String = rows.collect();
        (head.to_owned() + &if comma { rows.replace('.', ",") } else { rows }).into_bytes()
    };
    let stamps = (0..40).map(|n| format!("\"2024-05-01 08:00:00.{:09}\",\"{:.4}\"\n", 78_125 * n, signal(n)));
    let properties = [
        ("NI_Number_Of_Scales", Is::Word(1)),
        ("NI_Scale[0]_Scale_Type", Is::Text("Linear")),
        ("NI_Scale[0]_Linear_Slope", Is::Number(0.001)),
        ("NI_Scale[0]_Linear_Y_Intercept", Is::Number(0.5)),
        ("NI_Scale[0]_Linear_Input_Source", Is::Word(u32::MAX)),
    ];
    let values: Vec<u8> = (0..100).flat_map(|n| signal(n).to_le_bytes()).collect();
    let tdms = [
        tdms_segment(&[tdms_object("/'g'/'acc'", &Index::Of(F64, 100), &properties)], true, &values),
        tdms_segment(&[tdms_object("/'g'/'acc'", &Index::AsBefore, &[])], false, &values),
    ];
    let channels = [
        MdfChannel { sort: 2, line: Some((0.0, 1.0 / RATE_HZ)), ..mdf_channel("time", 0) },
        MdfChannel { unit: "g", invalid: Some(1), ..mdf_channel("acc", 8) },
    ];
    let records = timed(|n| n as f64).into_iter().take(60).map(|record| [&record[..], &[0]].concat());
    let mut mat5 = b"MATLAB 5.0 MAT-file".to_vec();
    mat5.resize(124, b' ');
    mat5.extend([0, 1, b'I', b'M']);
    mat5.extend(mat5_matrix("two", &[30, 2], (0..60).map(signal)));
    let mut mat4 = [0_u32, 60, 1, 0, 4].map(u32::to_le_bytes).concat();
    mat4.extend(b"acc\0");
    mat4.extend((0..60).flat_map(|n| signal(n).to_le_bytes()));
    let header = "{'descr': [('t (s)', '<f8'), ('', '|V6'), (\"it's\", '<i2')], 'fortran_order': False, \
        'shape': (40,), }\n";
    let mut npy = b"\x93NUMPY\x01\x00".to_vec();
    npy.extend((header.len() as u16).to_le_bytes());
    npy.extend(header.bytes());
    npy.extend((0..40).flat_map(|n| [&signal(n).to_le_bytes()[..], &[0; 8]].concat()));
    let mut wav = b"RIFF\0\0\0\0WAVELIST\x05\0\0\0INFOx\0fmt \x10\0\0\0\x01\0\x01\0".to_vec();
    wav.extend([12_800_u32, 25_600].map(u32::to_le_bytes).concat());
    wav.extend(b"\x02\0\x10\0data\0\0\0\0");
    wav.extend((0..100_i16).flat_map(i16::to_le_bytes));
    let decimal = [("d", Some(LogicalType::decimal(4, 9)), Stored::Int32((0..60).collect()))];
    parquet_file(desk, Compression::ZSTD(ZstdLevel::default()), &decimal);
    let mut all = vec![
        ("a.csv", table("Time,Acc\nms,m/s2\n", ",", false)),
        ("b.csv", table("Messung;\n;\nZeit [ms];Beschl. [g]\n", ";", true)),
        ("c.csv", ("timestamp,acc\n".to_owned() + &stamps.collect::<String>()).into_bytes()),
        (
            "d.csv",
            String::from_utf8(table("t acc\n", "\t", false))
                .unwrap()
                .encode_utf16()
                .flat_map(u16::to_le_bytes)
                .collect(),
        ),
        ("a.tdms", tdms.concat()),
        ("a.mf4", mdf(&[(&channels, 16, 1, records.collect())])),
        ("five.mat", mat5),
        ("four.mat", mat4),
        ("a.npy", npy),
        ("a.wav", wav),
        ("a.parquet", std::fs::read(desk.join("a.parquet")).unwrap()),
    ];
    for name in ["links.h5", "blosc.h5", "btree2.h5", "virtual.h5", "attributes.h5"] {
        let path = format!("{}/../../fixtures/signals/{name}", env!("CARGO_MANIFEST_DIR"));
        all.push((name, std::fs::read(path).unwrap()));
    }
    all
}

/// Bytes that are changed, left out, put in, doubled or set to the borders of their range.
fn mutated(good: &[u8], draw: &mut impl FnMut(usize) -> usize) -> Vec<u8> {
    let mut bytes = good.to_vec();
    for _ in 0..=draw(4) {
        if bytes.is_empty() {
            break;
        }
        // Heads hold the structure: half of the mutations are there.
        let among = if draw(2) == 0 { bytes.len().min(400) } else { bytes.len() };
        let at = draw(among);
        let end = (at + 1 + draw(9)).min(bytes.len());
        match draw(6) {
            0 => bytes[at] = draw(256) as u8,
            1 => bytes[at] ^= 1 << draw(8),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
            4 => bytes[at..end].fill([0, 0xff, 0x7f, 0x80][draw(4)]),
            _ => bytes.truncate(at),
        }
    }
    bytes
}

#[test]
fn survives_mutations_of_every_format() {
    let desk = Scratch::create("formats-mutations");
    let all = good_files(&desk);
    for (name, bytes) in &all {
        let found = opened(&desk, name, bytes);
        assert!(found.channels.iter().any(|c| c.len > 1 && c.read().is_ok()), "{name}: {:?}", found.notes);
    }
    let count = std::env::var("STRIBECK_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(MUTATIONS);
    let mut noise = Noise::new(50);
    let mut draw = |among: usize| (((noise.uniform() + 1.0) / 2.0 * among as f64) as usize).min(among - 1);
    let (mut read, mut refused) = (0_usize, 0_usize);
    for n in 0..count {
        let (name, good) = &all[n % all.len()];
        let bytes = mutated(good, &mut draw);
        let path = desk.join(format!("mutated-{name}"));
        std::fs::write(&path, &bytes).unwrap();
        let answer = std::panic::catch_unwind(|| match Recording::open(&path) {
            Ok(found) => {
                for channel in found.channels.iter().filter(|c| c.len < 1_000_000) {
                    if let Ok(samples) = channel.read() {
                        assert!(
                            samples.len() as u64 <= channel.len,
                            "`{}` holds more than it says",
                            channel.name
                        );
                    }
                }
                true
            }
            Err(why) => {
                assert!(why.to_string().contains("mutated-"), "{why}");
                false
            }
        });
        let Ok(answer) = answer else {
            panic!("mutation {n} of {name}: {:02x?}", &bytes[..bytes.len().min(4000)])
        };
        if answer { read += 1 } else { refused += 1 }
    }
    println!("{count} mutations: {read} read, {refused} refused");
    assert!(read > 0 && refused > 0);
}
