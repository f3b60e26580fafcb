//! A trace on disk: as NumPy reads it, after a kill, and damaged.

use std::path::PathBuf;
use std::process::Command;

use proptest::prelude::*;
use stribeck_testing::{Scratch, assert_refused, said};

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
fn by_hand_the_file_is_a_structured_npy_array() {
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
    // The file as another process reads it while the writer still runs.
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

/// A file with another byte at a place is refused, or has no more samples than it can hold.
fn survives(file: &File, bytes: &[u8], at: usize, values: &[u8]) {
    for value in values {
        let mut damaged = bytes.to_vec();
        damaged[at] = *value;
        if let Ok(trace) = file.read(&damaged) {
            assert!(trace.len() <= bytes.len() / 8, "byte {at}");
        }
    }
}

#[test]
fn survives_a_file_damaged_at_any_byte() {
    let file = File::new();
    let bytes = file.write(&["time_s", "x"], &rows(2));
    (0..bytes.len()).for_each(|at| survives(&file, &bytes, at, &[0, b'\'', b'(', 0xff]));
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
        (b"PK\x03\x04".to_vec(), "no complete NumPy archive"),
        (b"PK".to_vec(), "does not begin like a `.npy` file"),
        (plain, "not named little-endian doubles"),
        (single, "channel `a` is not a little-endian double"),
        (fortran, "fortran_order"),
        (twins, "two channels are called `a`"),
        (claim, "claims 4294967295 bytes"),
        (b"\x93NUMPY\x09\x00\x00\x00".to_vec(), "version 9"),
    ] {
        assert_refused(file.read(&bytes), words);
    }
    assert_refused(Trace::read(std::env::temp_dir()), "it is not a regular file");
}

#[test]
fn refuses_wrong_rows_and_names() {
    let file = File::new();
    let mut writer = TraceWriter::create(file.path(), &["time_s", "x"]).expect("writable");
    assert_refused(writer.push(&[1.0]), "a row of 1 values was pushed into 2 channels");
    assert_eq!(writer.rows(), 0);
    for (names, words) in [
        (&[][..], "one channel at least"),
        (&["a", "a"], "two channels are called `a`"),
        (&[""], "printable ASCII"),
        (&["a'b"], "printable ASCII"),
        (&["µ"], "printable ASCII"),
    ] {
        assert_refused(TraceWriter::create(file.path(), names), words);
    }
}

#[test]
fn behaves_many_channels_take_version_2() {
    let file = File::new();
    let names: Vec<String> = (0..4000).map(|i| format!("roller.{i}.outer_n")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let row: Vec<f64> = (0..4000).map(f64::from).collect();
    let mut writer = TraceWriter::create(file.path(), &names).expect("writable");
    writer.push(&row).expect("writable");
    writer.sync().expect("writable");
    let bytes = std::fs::read(file.path()).expect("readable");
    assert_eq!(bytes[6], 2);
    let trace = file.read(&bytes).expect("readable");
    assert_eq!(trace.get("roller.3999.outer_n"), Some(&[3999.0][..]));
    let few = header::encode(&["a"], 0).expect("short").len();
    assert_eq!(header::encode(&["a"], u64::MAX).expect("short").len(), few, "the header never grows");
}

/// Channels of a bearing in oil.
fn channels(rollers: usize) -> Vec<String> {
    let mut names = vec!["time_s".to_owned()];
    for roller in 0..rollers {
        let of = ["x_m", "y_m", "spin_rad", "outer_fx_n", "outer_fy_n", "inner_fx_n", "inner_fy_n"];
        names.extend(of.iter().map(|channel| format!("roller.{roller}.{channel}")));
        names.extend(["outer", "inner"].map(|ring| format!("roller.{roller}.{ring}_film_m")));
    }
    names
}

/// Values that identify channel and sample.
fn distinct(names: &[String], count: usize) -> Vec<Vec<f64>> {
    (0..count).map(|row| (0..names.len()).map(|at| (at * 1000 + row) as f64 / 7.0).collect()).collect()
}

/// A run with 28 rollers in oil had a header of 10 486 characters, which `numpy.load` refuses.
#[test]
fn issue_no_header_is_longer_than_numpy_reads() {
    let file = File::new();
    for rollers in [3, 20, 34, 35, 48, 49, 60, 400] {
        let names = channels(rollers);
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let all = distinct(&channels(rollers), 5);
        let bytes = file.write(&names, &all);
        let header = header::encode(&names, 5).expect("short enough");
        let form = if bytes.starts_with(b"PK") {
            assert!(header.len() > 10_000, "{rollers} rollers need no archive");
            "archive"
        } else {
            assert!(bytes.starts_with(&header) && header.len() <= 10_012, "{rollers}: {}", header.len());
            if header.windows(5).any(|window| window == b"names") { "short form" } else { "pairs" }
        };
        let expected = match rollers {
            0..=34 => "pairs",
            35..=48 => "short form",
            _ => "archive",
        };
        assert_eq!(form, expected, "{rollers} rollers");
        let trace = file.read(&bytes).expect("readable");
        assert_eq!(trace.names, names);
        for (at, column) in trace.columns.iter().enumerate() {
            assert!(column.iter().zip(&all).all(|(value, row)| *value == row[at]), "{rollers}: channel {at}");
        }
    }
}

#[test]
fn invariant_an_archive_is_read_in_parts_as_rows_are() {
    let file = File::new();
    let names = channels(150);
    // More rows than are read at once.
    let mut all = distinct(&names, 3000);
    let short: Vec<&str> = names.iter().map(String::as_str).collect();
    let bytes = file.write(&short, &all);
    assert!(bytes.starts_with(b"PK") && file.write(&short, &all) == bytes, "equal samples make equal bytes");
    let trace = TraceFile::open(file.path()).expect("readable");
    assert_eq!((trace.len(), trace.names()), (3000, names.as_slice()));
    let wanted = "roller.77.outer_fy_n";
    let at = names.iter().position(|name| name == wanted).expect("a channel");
    let column: Vec<f64> = all.iter().map(|row| row[at]).collect();
    assert_eq!(trace.channel(wanted).expect("readable"), Some(column.clone()));
    assert_eq!(trace.last(wanted).expect("readable"), column.last().copied());
    let part = trace.read(2990..5000, |name| name == wanted).expect("readable");
    assert_eq!(part.columns, [&column[2990..]]);
    let finite = trace.read_finite(0..usize::MAX, |name| name == wanted).expect("readable");
    assert_eq!(finite.columns, [column.as_slice()]);
    let thinned = trace.read_thinned(300).expect("readable");
    assert_eq!(thinned.get(wanted), Some(&column.iter().copied().step_by(10).collect::<Vec<_>>()[..]));
    all[2500][5] = f64::NAN;
    file.write(&short, &all);
    let trace = TraceFile::open(file.path()).expect("readable");
    let finite = trace.read_finite(0..usize::MAX, |name| name == wanted).expect("readable");
    assert_eq!(finite.columns, [&column[..2500]]);
}

/// A run that ended may go on, whatever form its trace has: an archive, or a header that an earlier version
/// wrote.
#[test]
fn roundtrip_every_form_can_be_continued() {
    let file = File::new();
    for rollers in [28, 40, 60] {
        let names = channels(rollers);
        let short: Vec<&str> = names.iter().map(String::as_str).collect();
        let all = distinct(&names, 230);
        let whole = file.write(&short, &all);
        let begun = file.write(&short, &all[..120]);
        // As versions before wrote it.
        let long = long_header(&short, 120);
        let values: Vec<u8> = all[..120].iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        for bytes in [begun, [long, values].concat()] {
            std::fs::write(file.path(), bytes).expect("writable");
            let mut writer = TraceWriter::resume(file.path(), &short, 110).expect("it holds as many");
            all[110..].iter().for_each(|row| writer.push(row).expect("writable"));
            writer.finish().expect("writable");
            assert!(std::fs::read(file.path()).expect("readable") == whole, "{rollers} rollers");
        }
    }
}

/// A header of pairs, however long.
fn long_header(names: &[&str], rows: usize) -> Vec<u8> {
    let fields: Vec<String> = names.iter().map(|name| format!("('{name}', '<f8')")).collect();
    let text =
        format!("{{'descr': [{}], 'fortran_order': False, 'shape': ({rows},), }}\n", fields.join(", "));
    [b"\x93NUMPY\x02\x00".as_slice(), &(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

#[test]
fn survives_an_archive_cut_or_damaged() {
    let file = File::new();
    let names = channels(60);
    let short: Vec<&str> = names.iter().map(String::as_str).collect();
    let bytes = file.write(&short, &distinct(&names, 2));
    for at in (0..bytes.len()).step_by(151) {
        if let Ok(trace) = file.read(&bytes[..at]) {
            assert!(trace.is_empty(), "cut at {at}");
        }
        survives(&file, &bytes, at, &[0, 0xff]);
    }
}

/// With NumPy's own limit.
#[test]
fn peer_numpy_opens_every_trace() {
    // NumPy 2.4.6, where the interpreter in STRIBECK_PYTHON (or python3) has it.
    let Some(python) = stribeck_testing::peer::python_with(&["numpy"]) else { return };
    let file = File::new();
    for rollers in [20, 28, 40, 60, 400] {
        let names = channels(rollers);
        let short: Vec<&str> = names.iter().map(String::as_str).collect();
        file.write(&short, &distinct(&names, 3));
        let script = format!(
            "import numpy as np
trace = np.load('trace.npy')
assert len(trace['time_s']) == 3
for at, name in enumerate({names:?}):
    assert trace[name].dtype == np.dtype('<f8')
    assert (trace[name] == (at * 1000 + np.arange(3)) / 7).all(), name
print('agreed')"
        );
        let output = Command::new(&python)
            .current_dir(file.0.path())
            .args(["-c", &script])
            .output()
            .expect("it starts");
        assert!(output.status.success(), "{rollers} rollers: {}", said(&output));
    }
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
