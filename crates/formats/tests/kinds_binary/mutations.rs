//! Files of all formats with bytes changed at random: none makes a reader panic.

use parquet::basic::{Compression, LogicalType, ZstdLevel};
use stribeck_formats::Recording;
use stribeck_testing::{Noise, Scratch};

use crate::mdf::{MdfChannel, mdf, mdf_channel, timed};
use crate::numeric_arrays::mat5_matrix;
use crate::parquet_columns::{Stored, parquet_file};
use crate::tdms::{F64, Index, Is, tdms_object, tdms_segment};
use crate::{RATE_HZ, opened, signal};

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
