//! A trace on disk: what NumPy would read, what a killed run leaves, what is refused.

use std::path::PathBuf;

use proptest::prelude::*;
use stribeck_testing::Scratch;

use super::{Trace, TraceFile, TraceWriter, header};
use crate::error::Error;

/// A file of its own for each call, removed at the end.
struct File(Scratch);

impl File {
    fn new() -> Self {
        Self(Scratch::create("trace"))
    }

    fn path(&self) -> PathBuf {
        self.0.join("trace.npy")
    }

    fn write(&self, names: &[&str], rows: &[Vec<f64>]) -> Vec<u8> {
        let mut writer = TraceWriter::create(self.path(), names).expect("writable");
        for row in rows {
            writer.push(row).expect("writable");
        }
        writer.finish().expect("writable");
        std::fs::read(self.path()).expect("readable")
    }

    fn read(&self, bytes: &[u8]) -> Result<Trace, Error> {
        std::fs::write(self.path(), bytes).expect("writable");
        Trace::read(self.path())
    }
}

fn rows(count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|i| vec![i as f64 * 1e-5, (i as f64).sin()]).collect()
}

#[test]
fn example_the_file_is_a_structured_npy_array() {
    let file = File::new();
    let bytes = file.write(&["time_s", "ay_m_s2"], &rows(3));
    let data = bytes.len() - 3 * 16;
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    assert_eq!(usize::from(u16::from_le_bytes([bytes[8], bytes[9]])) + 10, data);
    assert_eq!(data % 64, 0, "NumPy aligns the data to 64 bytes");
    let text = std::str::from_utf8(&bytes[10..data]).expect("ASCII");
    let expected =
        "{'descr': [('time_s', '<f8'), ('ay_m_s2', '<f8')], 'fortran_order': False, 'shape': (3,), }";
    assert_eq!(text.trim_end(), expected);
    assert!(text.ends_with('\n'));
    assert_eq!(&bytes[data + 16..data + 24], &1e-5_f64.to_le_bytes());
}

#[test]
fn invariant_equal_samples_make_equal_bytes() {
    let (a, b) = (File::new(), File::new());
    assert_eq!(a.write(&["time_s", "x"], &rows(250)), b.write(&["time_s", "x"], &rows(250)));
}

#[test]
fn invariant_parts_are_those_of_the_whole() {
    let file = File::new();
    // Some blocks' worth of rows.
    let mut all = rows(40_000);
    file.write(&["time_s", "x"], &all);
    let trace = TraceFile::open(file.path()).expect("readable");
    assert_eq!((trace.len(), trace.names()), (40_000, &["time_s".to_owned(), "x".to_owned()][..]));
    let whole = trace.read_all().expect("readable");
    let column = |at: usize| all.iter().map(|row| row[at]).collect::<Vec<_>>();
    assert_eq!(whole.columns, [column(0), column(1)]);
    for rows in [0..0, 3..4, 17_000..40_000, 39_999..50_000] {
        let part = trace.read(rows.clone(), |name| name == "x").expect("readable");
        let expected = &whole.columns[1][rows.start..rows.end.min(40_000)];
        assert_eq!((part.get("time_s"), part.get("x")), (None, Some(expected)), "{rows:?}");
    }
    assert!(
        trace.channel("x").expect("readable") == Some(column(1))
            && trace.read_finite(0..usize::MAX, |_| true).unwrap() == whole
    );
    assert_eq!(trace.channel("y").expect("readable"), None);
    // Up to the first that is no number, in whichever channel.
    for (at, value) in [(39_999, f64::NAN), (16_384, f64::INFINITY), (0, f64::NEG_INFINITY)] {
        all[at][1] = value;
        file.write(&["time_s", "x"], &all);
        let trace = TraceFile::open(file.path()).expect("readable");
        let finite = trace.read_finite(0..usize::MAX, |name| name == "time_s").expect("readable");
        assert_eq!(finite.columns, [&whole.columns[0][..at]]);
    }
}

#[test]
fn survives_a_kill_but_for_a_hundred_rows() {
    let file = File::new();
    let mut writer = TraceWriter::create(file.path(), &["time_s", "x"]).expect("writable");
    for row in rows(250) {
        writer.push(&row).expect("writable");
    }
    // What another process sees while the writer still runs.
    let seen = Trace::read(file.path()).expect("readable");
    assert_eq!(seen.len(), 200);
    let text = std::fs::read(file.path()).expect("readable");
    assert!(String::from_utf8_lossy(&text).contains("'shape': (200,)"));
    drop(writer);
    assert_eq!(Trace::read(file.path()).expect("readable").len(), 250);
}

#[test]
fn roundtrip_a_continued_file_is_that_of_one_writer() {
    let file = File::new();
    let names = ["time_s", "x"];
    let whole = file.write(&names, &rows(7));
    for kept in 0..=7 {
        // Rows beyond those kept, and a torn one, as a killed run leaves them.
        std::fs::write(file.path(), [whole.as_slice(), &[1; 9]].concat()).expect("writable");
        let mut writer = TraceWriter::resume(file.path(), &names, kept).expect("it holds as many");
        assert_eq!(writer.rows(), kept);
        for row in &rows(7)[kept as usize..] {
            writer.push(row).expect("writable");
        }
        writer.sync().expect("writable");
        assert!(std::fs::read(file.path()).expect("readable") == whole, "continued after {kept} rows");
    }
}

#[test]
fn refuses_to_continue_a_foreign_file_and_leaves_it_alone() {
    let file = File::new();
    let whole = file.write(&["time_s", "x"], &rows(3));
    let refuse = |bytes: &[u8], names: &[&str], rows, words: &str| {
        std::fs::write(file.path(), bytes).expect("writable");
        let error =
            TraceWriter::resume(file.path(), names, rows).map(|_| ()).expect_err("foreign").to_string();
        assert!(error.contains(words), "{error}");
        assert!(std::fs::read(file.path()).expect("readable") == bytes, "changed although {error}");
    };
    refuse(&whole, &["time_s", "x"], 4, "holds 3 samples and the checkpoint counts 4");
    refuse(&whole, &["time_s", "y"], 3, "other channels");
    refuse(&whole, &["time_s"], 3, "other channels");
    for cut in 0..whole.len() - 3 * 16 {
        refuse(&whole[..cut], &["time_s", "x"], 0, "readable trace");
    }
}

#[test]
fn survives_a_file_cut_at_any_byte() {
    let file = File::new();
    let bytes = file.write(&["time_s", "x"], &rows(4));
    let data = bytes.len() - 4 * 16;
    for cut in 0..bytes.len() {
        match file.read(&bytes[..cut]) {
            Ok(trace) => assert_eq!(trace.len(), (cut - data) / 16, "cut at {cut}"),
            Err(error) => assert!(cut < data && error.to_string().contains("header") || cut < 6, "{error}"),
        }
    }
}

#[test]
fn survives_a_file_damaged_at_any_byte() {
    let file = File::new();
    let bytes = file.write(&["time_s", "x"], &rows(2));
    for at in 0..bytes.len() {
        for value in [0, b'\'', b'(', 0xff] {
            let mut damaged = bytes.clone();
            damaged[at] = value;
            if let Ok(trace) = file.read(&damaged) {
                assert!(trace.len() <= bytes.len() / 8, "byte {at}");
            }
        }
    }
}

#[test]
fn refuses_foreign_files_with_a_reason() {
    let file = File::new();
    let npy = |text: &str| {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((text.len() as u16).to_le_bytes());
        bytes.extend(text.bytes());
        bytes
    };
    let plain = npy("{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }\n");
    let single = npy("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (3,), }\n");
    let fortran = npy("{'descr': [('a', '<f8')], 'fortran_order': True, 'shape': (3,), }\n");
    let twins = npy("{'descr': [('a', '<f8'), ('a', '<f8')], 'fortran_order': False, 'shape': (3,), }\n");
    let mut claim = b"\x93NUMPY\x02\x00".to_vec();
    claim.extend(u32::MAX.to_le_bytes());
    for (bytes, words) in [
        (b"PK\x03\x04".to_vec(), "does not begin like a `.npy` file"),
        (plain, "not named little-endian doubles"),
        (single, "channel `a` is not a little-endian double"),
        (fortran, "fortran_order"),
        (twins, "two channels are called `a`"),
        (claim, "claims 4294967295 bytes"),
        (b"\x93NUMPY\x09\x00\x00\x00".to_vec(), "version 9"),
    ] {
        let error = file.read(&bytes).expect_err("foreign").to_string();
        assert!(error.contains(words), "{error}");
    }
    assert!(Trace::read(std::env::temp_dir()).is_err());
}

#[test]
fn refuses_wrong_rows_and_names() {
    let file = File::new();
    let mut writer = TraceWriter::create(file.path(), &["time_s", "x"]).expect("writable");
    assert!(writer.push(&[1.0]).is_err());
    assert_eq!(writer.rows(), 0);
    for names in [&[][..], &["a", "a"], &[""], &["a'b"], &["µ"]] {
        assert!(TraceWriter::create(file.path(), names).is_err(), "{names:?}");
    }
}

#[test]
fn example_many_channels_take_version_2() {
    let file = File::new();
    let names: Vec<String> = (0..4000).map(|i| format!("roller.{i}.outer_n")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let row: Vec<f64> = (0..4000).map(f64::from).collect();
    let bytes = file.write(&names, std::slice::from_ref(&row));
    assert_eq!(bytes[6], 2);
    let trace = file.read(&bytes).expect("readable");
    assert_eq!(trace.get("roller.3999.outer_n"), Some(&[3999.0][..]));
    let few = header::encode(&["a"], 0).expect("short").len();
    assert_eq!(header::encode(&["a"], u64::MAX).expect("short").len(), few, "the header never grows");
}

#[test]
#[cfg(target_os = "linux")]
fn survives_a_full_disk_and_says_what_is_safe() {
    // The kernel's /dev/full refuses every write as a full disk does.
    let error = TraceWriter::create("/dev/full", &["time_s"]).map(|_| ()).expect_err("full").to_string();
    assert!(error.contains("cannot create `/dev/full`") && error.contains("Nothing was written"), "{error}");
}

proptest! {
    #[test]
    fn roundtrip_any_bits_of_a_trace(
        channels in 1_usize..5,
        bits in proptest::collection::vec(any::<u64>(), 0..800),
    ) {
        let file = File::new();
        let names: Vec<String> = (0..channels).map(|i| format!("channel {i}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let rows: Vec<Vec<f64>> =
            bits.chunks_exact(channels).map(|row| row.iter().map(|b| f64::from_bits(*b)).collect()).collect();
        let bytes = file.write(&names, &rows);
        let trace = file.read(&bytes).expect("readable");
        prop_assert_eq!(trace.len(), rows.len());
        for (i, row) in rows.iter().enumerate() {
            for (column, value) in trace.columns.iter().zip(row) {
                prop_assert_eq!(column[i].to_bits(), value.to_bits());
            }
        }
    }
}
