//! Kinds of files whose numbers, units, scales, shapes or rates were once lost in silence, or which were refused,
//! each as a tiny input of our own; damaged files, and files of all formats with bytes changed.

mod clocks_and_sizes;
mod damaged;
mod hdf5;
mod mdf;
mod mutations;
mod numeric_arrays;
mod parquet_columns;
mod tdms;
mod texts_and_sounds;

use stribeck_formats::{Channel, Error, Recording};
use stribeck_testing::Scratch;

const RATE_HZ: f64 = 12_800.0;
/// Samples of each input.
const COUNT: usize = 300;

fn signal(n: usize) -> f64 {
    ((n * 37 % 101) as f64 - 50.0) / 50.0
}

fn try_open(desk: &Scratch, name: &str, bytes: &[u8]) -> Result<Recording, Error> {
    let path = desk.join(name);
    std::fs::write(&path, bytes).unwrap();
    Recording::open(&path)
}

fn opened(desk: &Scratch, name: &str, bytes: &[u8]) -> Recording {
    try_open(desk, name, bytes).unwrap_or_else(|why| panic!("{name}: {why}"))
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
