//! Kinds of files that once gave wrong numbers in silence or were refused, each as a tiny input of our own.

use std::path::PathBuf;

use stribeck_formats::Recording;
use stribeck_testing::Scratch;

const RATE_HZ: f64 = 12_800.0;

fn signal(n: usize) -> f64 {
    ((n * 37 % 101) as f64 - 50.0) / 50.0
}

fn opened(desk: &Scratch, name: &str, bytes: &[u8]) -> Recording {
    let path: PathBuf = desk.join(name);
    std::fs::write(&path, bytes).unwrap();
    Recording::open(&path).unwrap_or_else(|why| panic!("{name}: {why}"))
}

/// Rows of times in milliseconds and of a signal, behind a head.
fn table(head: &str, separator: char, comma: bool, end: &str) -> String {
    let rows = (0..300).map(|n| {
        let row = format!("{:.5}{separator}{:.4}{end}\n", 1e3 * n as f64 / RATE_HZ, signal(n));
        if comma { row.replace('.', ",") } else { row }
    });
    head.to_owned() + &rows.collect::<String>()
}

#[test]
fn issue_texts_keep_their_units_columns_and_rows() {
    let desk = Scratch::create("formats-kinds");
    for (head, separator, comma, end, name) in [
        ("Time,Acc\nms,m/s²\n", ',', false, "", "Acc"),
        ("Time,Acc\nms,mm/s2\n", ',', false, "", "Acc"),
        ("Time,Acc\nms,EU\n", ',', false, "", "Acc"),
        ("Time,Acc\nms,mV/g\n", ',', false, "", "Acc"),
        ("# t_ms acc_g\n", ' ', false, "", "acc_g"),
        ("\"Time, ms\",\"Acc, g\"\n", ',', false, "", "Acc, g"),
        ("time_ms,acc_g,comment\n", ',', false, ",", "acc_g"),
        ("Messung 7;\n;\nZeit [ms];Beschl. [g]\n", ';', true, "", "Beschl. [g]"),
        ("t [ms]|acc\n", '|', false, "", "acc"),
    ] {
        let text = table(head, separator, comma, end);
        let latin: Vec<u8> = text.chars().map(|c| c as u32 as u8).collect();
        let wide: Vec<u8> =
            [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
        let old = text.replace('\n', "\r").into_bytes();
        for bytes in [text.clone().into_bytes(), latin, wide, old] {
            let found = opened(&desk, "a.csv", &bytes);
            let channel = found.channels.iter().find(|c| !c.is_time).unwrap();
            assert_eq!((channel.name.as_str(), channel.len), (name, 300), "{head:?}");
            let hz = channel.rate_hz.unwrap_or_else(|| panic!("{head:?}: {:?}", found.notes));
            assert!((hz / RATE_HZ - 1.0).abs() < 1e-3, "{head:?}: {hz}");
            let samples = channel.read().unwrap();
            assert!(samples.iter().enumerate().all(|(n, x)| (x - signal(n)).abs() < 1e-4), "{head:?}");
        }
    }
}

#[test]
fn issue_one_column_stamps_and_headers_of_counts() {
    let desk = Scratch::create("formats-kinds-csv");
    let column: String = (0..300).map(|n| format!("{:.4}\n", signal(n)).replace('.', ",")).collect();
    let found = opened(&desk, "a.csv", format!("Beschleunigung\n{column}").as_bytes());
    assert_eq!((found.channels.len(), found.channels[0].name.as_str()), (1, "Beschleunigung"));
    assert_eq!(opened(&desk, "b.csv", column.as_bytes()).channels.len(), 1);
    let counted: String = (0..300).map(|n| format!("{0:.4},{0:.4},{0:.4}\n", signal(n))).collect();
    let found = opened(&desk, "c.csv", format!("0,1,2\n{counted}").as_bytes());
    assert_eq!((found.channels.len(), found.channels[2].len), (3, 300));
    // Whether the third column is called by its header or by its place.
    for asked in ["2", "column 3"] {
        assert_eq!(found.channel(asked).unwrap().name, "2");
    }
    let stamps: String =
        (0..300).map(|n| format!("2024-05-01 08:00:00.{:09},{:.4}\n", 78_125 * n, signal(n))).collect();
    let found = opened(&desk, "d.csv", format!("timestamp,acc\n{stamps}").as_bytes());
    assert!((found.channels[1].rate_hz.unwrap() / RATE_HZ - 1.0).abs() < 1e-4, "{:?}", found.notes);
    let gap = table("t [ms],acc\n", ',', false, "").replace("\n0.07812,", "\n0.07812,oops") + "23.5";
    let found = opened(&desk, "e.csv", gap.as_bytes());
    assert_eq!(found.channels[1].len, 300);
    assert!(
        found.notes.iter().any(|n| n.contains("`oops")) && found.notes.iter().any(|n| n.contains("cut off")),
        "{:?}",
        found.notes
    );
}

#[test]
fn issue_records_of_numpy_have_any_names_and_padding() {
    let desk = Scratch::create("formats-kinds-npy");
    let file = |descr: &str, shape: &str, record: &dyn Fn(usize) -> Vec<u8>| {
        let header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n");
        let header: Vec<u8> = header.chars().map(|c| c as u32 as u8).collect();
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header);
        bytes.extend((0..300).flat_map(record));
        bytes
    };
    let time = |n: usize| (n as f64 / RATE_HZ).to_le_bytes();
    let pair = |n: usize| [time(n), signal(n).to_le_bytes()].concat();
    let found = opened(&desk, "a.npy", &file("[('t (s)', '<f8'), ('acc [m/s²]', '<f8')]", "(300,)", &pair));
    assert_eq!((found.channels[1].name.as_str(), found.channels[1].rate_hz), ("acc [m/s²]", Some(RATE_HZ)));
    let padded = |n: usize| [&[1, 0, 0, 0, 0, 0, 0, 0][..], &signal(n).to_le_bytes()].concat();
    let found =
        opened(&desk, "b.npy", &file("[('n', '<i2'), ('', '|V6'), (\"it's\", '<f8')]", "(300,)", &padded));
    assert_eq!((found.channels[1].name.as_str(), found.channels[1].read().unwrap()[7]), ("it's", signal(7)));
}

#[test]
fn issue_wav_without_its_size_is_read_to_its_end() {
    let desk = Scratch::create("formats-kinds-wav");
    for size in [0_u32, u32::MAX] {
        for odd in [false, true] {
            let mut bytes = b"RIFF\0\0\0\0WAVE".to_vec();
            if odd {
                bytes.extend(b"LIST\x05\0\0\0INFOx");
            }
            bytes.extend(b"fmt \x10\0\0\0\x01\0\x01\0");
            bytes.extend(12_800_u32.to_le_bytes());
            bytes.extend(25_600_u32.to_le_bytes());
            bytes.extend([2, 0, 16, 0]);
            bytes.extend(b"data");
            bytes.extend(size.to_le_bytes());
            bytes.extend((0..300_i16).flat_map(i16::to_le_bytes));
            let found = opened(&desk, "a.wav", &bytes);
            assert_eq!((found.channels[0].len, found.channels[0].rate_hz), (300, Some(RATE_HZ)));
        }
    }
}
