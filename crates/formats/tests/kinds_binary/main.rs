//! Kinds of binary files whose units, scales, shapes or rates were once lost, each as a tiny input of our
//! own: TDMS, MDF, MATLAB 4 and 5, NumPy, Parquet and HDF5; and files of all formats with bytes changed.

mod hdf5;
mod mdf;
mod mutations;
mod numeric_arrays;
mod parquet_columns;
mod tdms;

use std::path::PathBuf;

use stribeck_formats::{Channel, Recording};
use stribeck_testing::Scratch;

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
