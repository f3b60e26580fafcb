//! Written files are read back, by us and by the programs that the formats belong to.

use std::path::Path;
use std::process::Command;

use stribeck_formats::parquet::{Column, Values, Writer};
use stribeck_formats::{Channel, Error, Recording, csv, mat5, npz, parquet, uff58, wav};
use stribeck_testing::{Noise, Scratch, peer::python_with};

const RATE_HZ: f64 = 12_800.0;

fn channels() -> Vec<Channel> {
    let mut noise = Noise::new(4);
    let mut channel = |name: &str| {
        let samples = (0..1003).map(|n| noise.uniform() * 10_f64.powi(n % 7 - 3)).collect();
        Channel::held(name, samples).at_rate(Some(RATE_HZ)).in_unit(Some("m/s^2".to_owned()))
    };
    vec![channel("housing_x"), channel("housing_y")]
}

fn notes() -> Vec<String> {
    vec!["scene a".to_owned(), "commit b".to_owned()]
}

fn write(path: &Path) {
    let (channels, notes) = (channels(), notes());
    match path.extension().unwrap().to_str().unwrap() {
        "csv" => csv::write(path, &channels, &notes),
        "npz" => npz::write(path, &channels, &notes),
        "mat" => mat5::write(path, &channels, &notes),
        "uff" => uff58::write(path, &channels, &notes),
        "parquet" => parquet::write(path, &channels, &notes),
        "wav" => wav::write(path, &channels, &notes),
        other => panic!("{other}"),
    }
    .unwrap();
}

#[test]
fn roundtrip_every_format_keeps_samples_names_and_rate() {
    let folder = Scratch::create("formats-roundtrip");
    for extension in ["csv", "npz", "mat", "uff", "parquet", "wav"] {
        let path = folder.path().join(format!("a.{extension}"));
        write(&path);
        let recording = Recording::open(&path).unwrap();
        for (n, channel) in channels().iter().enumerate() {
            // WAV has no names.
            let name = if extension == "wav" { (n + 1).to_string() } else { channel.name.clone() };
            let read = recording.channel(&name).unwrap();
            assert_eq!(read.rate_hz, Some(RATE_HZ), "{extension}");
            let (ours, theirs) = (read.read().unwrap(), channel.read().unwrap());
            assert_eq!(ours.len(), theirs.len(), "{extension}");
            // Thirteen digits in a universal file.
            let tolerance = if extension == "uff" { 5e-13 } else { 0.0 };
            let near = ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() <= tolerance * b.abs());
            assert!(near, "{extension} {name}");
        }
    }
}

#[test]
fn roundtrip_numbers_and_gaps() {
    let desk = Scratch::create("formats-roundtrip-parquet");
    let path = desk.join("a.parquet");
    let columns = [
        Column { name: "run".into(), values: Values::Text(vec![Some("a".into()), None, Some("b".into())]) },
        Column { name: "load_n".into(), values: Values::Number(vec![Some(1.5), None, Some(-0.0)]) },
        Column { name: "count".into(), values: Values::Count(vec![Some(3), Some(4), None]) },
        Column { name: "done".into(), values: Values::Flag(vec![Some(true), Some(false), None]) },
    ];
    let mut writer = Writer::create(&path, &columns, &[("rate_hz".into(), "100".into())]).unwrap();
    writer.add(&columns).unwrap();
    writer.add(&columns).unwrap();
    writer.finish().unwrap();
    let mut broken = Writer::create(&desk.join("b.parquet"), &columns, &[]).unwrap();
    assert!(matches!(broken.add(&columns[..1]), Err(Error::DoesNotFit { .. })));
    let back = Recording::open(&path).unwrap();
    assert_eq!(back.notes.len(), 1, "{:?}", back.notes);
    let load = back.channel("load_n").unwrap();
    let values = load.read().unwrap();
    assert_eq!((values.len(), load.rate_hz), (6, Some(100.0)));
    assert!(values[0] == 1.5 && values[1].is_nan() && values[5].to_bits() == (-0.0_f64).to_bits());
    assert_eq!(back.channel("count").unwrap().read().unwrap()[..2], [3.0, 4.0]);
    // Damaged ones get an answer.
    let bytes = std::fs::read(&path).unwrap();
    for cut in [4, bytes.len() / 2, bytes.len() - 3] {
        std::fs::write(&path, &bytes[..cut]).unwrap();
        assert!(matches!(Recording::open(&path), Err(Error::Damaged { .. })), "{cut}");
    }
}

/// pyarrow and polars read a column of series, an empty one among them.
/// Source: pyarrow 26.0.1 and polars 2.1.0.
#[test]
fn peer_series_are_read_by_others() {
    let desk = Scratch::create("formats-series");
    let path = desk.join("a.parquet");
    let series = vec![vec![1.5, -2.25, 1e-3], vec![], vec![7.0; 5000]];
    let columns = [
        Column { name: "run".into(), values: Values::Count(vec![Some(1), Some(2), Some(3)]) },
        Column { name: "a".into(), values: Values::Series(series) },
    ];
    parquet::write_table(&path, &columns, &[]).unwrap();
    assert!(Recording::open(&path).unwrap().notes[0].contains("it holds lists"));
    for (module, read) in [
        ("pyarrow", "import pyarrow.parquet as p; a = p.read_table(path)['a'].to_pylist()"),
        ("polars", "import polars as p; a = p.read_parquet(path)['a'].to_list()"),
    ] {
        let Some(python) = python_with(&[module]) else { continue };
        let script = format!(
            "import sys; path = sys.argv[1]; {read}; assert a[0][:2] == [1.5, -2.25] and a[1] == [] and a[2] == [7.0] * 5000, a[:2]"
        );
        let run = Command::new(&python).args(["-c", &script]).arg(&path).output().unwrap();
        assert!(run.status.success(), "{module}: {}", String::from_utf8_lossy(&run.stderr));
    }
}

#[test]
fn roundtrip_whole_numbers_keep_samples_to_half_a_step_and_clip() {
    let folder = Scratch::create("formats-pcm");
    let mut noise = Noise::new(6);
    let mut channel = || -> Vec<f64> { (0..1001).map(|_| noise.uniform()).collect() };
    let mut channels = vec![channel(), channel(), channel()];
    (channels[0][3], channels[1][4]) = (1.5, -1.5);
    for (bits, step) in [(12, 2_f64.powi(-15)), (24, 2_f64.powi(-23)), (32, 2_f64.powi(-31))] {
        let path = folder.path().join(format!("{bits}.wav"));
        let whole = wav::Whole::holding(bits).unwrap();
        std::fs::write(&path, wav::pcm(48_000, whole, &channels, &notes()).unwrap()).unwrap();
        let recording = Recording::open(&path).unwrap();
        assert!(recording.notes.is_empty(), "{:?}", recording.notes);
        for (n, channel) in channels.iter().enumerate() {
            let read = recording.channel(&(n + 1).to_string()).unwrap();
            assert_eq!((read.rate_hz, read.len), (Some(48_000.0), 1001));
            for (a, b) in read.read().unwrap().iter().zip(channel) {
                // The positive end is one step lower, as two's complement has it.
                assert!((a - b.clamp(-1.0, 1.0 - step)).abs() <= 0.5 * step, "{bits}: {a} {b}");
            }
        }
    }
    assert_eq!(wav::Whole::holding(33), None);
    assert!(wav::pcm(48_000, wav::Whole::Of16, &[vec![0.0], vec![]], &[]).is_none());
}

#[test]
fn survives_files_damaged_at_any_byte() {
    let folder = Scratch::create("formats-damaged");
    for extension in ["csv", "npz", "mat", "uff", "parquet", "wav"] {
        let path = folder.path().join(format!("a.{extension}"));
        write(&path);
        survives_damage(&path);
    }
}

/// An answer, whatever it is, for every file that is damaged at some bytes or cut off; a message when it is
/// an error.
fn survives_damage(path: &Path) {
    const EACH: u64 = 700;
    let whole = std::fs::read(path).unwrap();
    let name = path.file_name().unwrap().to_str().unwrap();
    let damaged = path.with_file_name(format!("damaged-{name}"));
    let mut noise = Noise::new(7);
    for n in 0..EACH {
        let mut bytes = whole.clone();
        let mut place =
            || (((noise.uniform() + 1.0) / 2.0 * whole.len() as f64) as usize).min(whole.len() - 1);
        // Heads hold the structure: half of the damage is there.
        for k in 0..4 {
            let at = if k % 2 == 0 { place() % 400.min(whole.len()) } else { place() };
            bytes[at] = (n.wrapping_mul(37).wrapping_add(at as u64) & 0xff) as u8;
        }
        if n % 3 == 0 {
            bytes.truncate(place());
        }
        std::fs::write(&damaged, &bytes).unwrap();
        match Recording::open(&damaged) {
            Ok(recording) => recording.channels.iter().for_each(|c| drop(c.read())),
            Err(why) => assert!(why.to_string().contains("damaged-"), "{why}"),
        }
    }
}

#[test]
fn peer_other_programs_read_what_is_written() {
    // numpy 2.4.6, scipy.io 1.17.1, pyuff 2.5.8, pyarrow 26.0.1 and soundfile 0.14.0, where the interpreter
    // in STRIBECK_PYTHON (or python3) has them.
    let folder = Scratch::create("formats-foreign");
    let expected = folder.path().join("expected.csv");
    csv::write(&expected, &channels(), &[]).unwrap();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/read_signals.py");
    for (extension, module) in [
        ("csv", "numpy"),
        ("npz", "numpy"),
        ("mat", "scipy.io"),
        ("uff", "pyuff"),
        ("parquet", "pyarrow"),
        ("wav", "soundfile"),
    ] {
        let Some(python) = python_with(&[module]) else { continue };
        let path = folder.path().join(format!("a.{extension}"));
        write(&path);
        let run = Command::new(&python).arg(script).args([&path, &expected]).output().unwrap();
        let said = String::from_utf8_lossy(&run.stdout);
        assert!(run.status.success(), "{extension}: {said}{}", String::from_utf8_lossy(&run.stderr));
        assert!(said.contains("2 channels agree"), "{extension}: {said}");
    }
}

#[test]
fn peer_files_of_other_programs_are_read() {
    // npTDMS 1.13.0, scipy.io 1.17.1, soundfile 0.14.0, asammdf 8.8.28 and h5py 3.16.0 write what the formats
    // allow and we do not: other types, byte orders, structs, segments, chunks.
    let folder = Scratch::create("formats-theirs");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/write_signals.py");
    for (name, module) in [
        ("theirs.tdms", "nptdms"),
        ("theirs.mat", "scipy.io"),
        ("theirs.npz", "numpy"),
        ("theirs.uff", "pyuff"),
        ("theirs.wav", "soundfile"),
        ("theirs.flac", "soundfile"),
        ("plain.mf4", "asammdf"),
        ("packed.mf4", "asammdf"),
        ("split.mf4", "asammdf"),
        ("theirs.h5", "h5py"),
    ] {
        let kind = name;
        let Some(python) = python_with(&[module]) else { continue };
        let path = folder.path().join(name);
        let run = Command::new(&python).args([script, path.to_str().unwrap()]).output().unwrap();
        assert!(run.status.success(), "{kind}: {}", String::from_utf8_lossy(&run.stderr));
        // One line a channel: its name, its tolerance, and what its samples are a multiple of, sample n being
        // k·(n mod 50).
        let said = String::from_utf8_lossy(&run.stdout).into_owned();
        assert!(said.lines().count() >= 2, "{kind}: {said}");
        let recording = Recording::open(&path).unwrap();
        for line in said.lines() {
            let [name, rate, k] = line.split('|').collect::<Vec<_>>()[..] else { panic!("{line}") };
            let channel =
                recording.channel(name).unwrap_or_else(|why| panic!("{kind}: {why} {:?}", recording.notes));
            assert_eq!(channel.rate_hz, rate.parse().ok(), "{kind} {name}");
            let k: f64 = k.parse().unwrap();
            let samples = channel.read().unwrap();
            assert_eq!(samples.len(), 1000, "{kind} {name}");
            for (n, x) in samples.iter().enumerate() {
                assert!(
                    (x - k * (n % 50) as f64).abs() <= 1e-6 * (1.0 + x.abs()),
                    "{kind} {name} [{n}]: {x}"
                );
            }
        }
        survives_damage(&path);
    }
}
