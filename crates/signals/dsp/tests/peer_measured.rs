//! Against scipy 1.17.1 and PySDKit 0.5.0: the vectors of `fixtures/reference/measured_dsp.json`, which the
//! script beside it writes. The input is impacts every 61.7 samples that ring, in the noise of a linear
//! congruential generator.

use std::f64::consts::TAU;

use serde_json::Value;
use stribeck_dsp::{
    Cyclic, Scaling, WelchOptions, fast_kurtogram, resample_poly, spectral_correlation, spectrogram,
};

/// Both sides round in a different order; tapers and filters are made on either side.
const RELATIVE: f64 = 1e-9;

fn vectors() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/reference/measured_dsp.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn input(count: usize) -> Vec<f64> {
    let mut state: u32 = 12345;
    (0..count)
        .map(|n| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f64::from(state) / 4_294_967_296.0 - 0.5;
            let since = (n as f64).rem_euclid(61.7);
            noise + 3.0 * (-since / 8.0).exp() * (TAU * 0.18 * since).sin()
        })
        .collect()
}

/// Equal to `RELATIVE` of the largest.
fn assert_equal(case: &str, ours: &[f64], theirs: &[f64]) {
    assert_near(case, ours, theirs, RELATIVE);
}

fn assert_near(case: &str, ours: &[f64], theirs: &[f64], relative: f64) {
    assert_eq!(ours.len(), theirs.len(), "{case}: length");
    let largest = theirs.iter().fold(0.0_f64, |most, x| x.abs().max(most));
    for (index, (a, b)) in ours.iter().zip(theirs).enumerate() {
        assert!((a - b).abs() <= relative * largest, "{case}[{index}]: ours {a:e}, theirs {b:e}");
    }
}

#[test]
fn peer_the_input_is_the_same() {
    assert_equal("input", &input(4), &numbers(&vectors()["x_first4"]));
}

#[test]
fn peer_every_band_of_the_fast_kurtogram() {
    let ours = fast_kurtogram(&input(2500), 1000.0, 4).unwrap();
    for row in vectors()["kurtogram"].as_array().unwrap() {
        let of = row["of"].as_u64().unwrap() as usize;
        let bands: Vec<f64> = ours.iter().filter(|b| b.of == of).map(|b| b.kurtosis).collect();
        assert_equal(&format!("{of} bands"), &bands, &numbers(&row["kurtosis"]));
    }
    let best = ours.iter().max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis)).unwrap();
    assert_eq!((best.of, best.low_hz, best.high_hz), (1, 0.0, 500.0));
}

#[test]
fn peer_spectrograms_of_both_scalings() {
    /// One transform of scipy's own size, rounded.
    const ROUNDED: f64 = 1e-12;
    let theirs = vectors();
    for (scaling, kind) in [("density", Scaling::Density), ("spectrum", Scaling::Spectrum)] {
        let options = WelchOptions { overlap: 30, nfft: 64, scaling: kind, ..WelchOptions::new(48) };
        let ours = spectrogram(&input(200), 1000.0, &options).unwrap();
        let case = format!("psd {scaling}");
        let theirs = &theirs["spectrogram"][&case];
        assert_near(&case, &ours.values, &numbers(&theirs["values"]), ROUNDED);
        assert_near(&case, &ours.times_s, &numbers(&theirs["t"]), ROUNDED);
        assert_near(&case, &ours.frequencies_hz, &numbers(&theirs["f"]), ROUNDED);
    }
}

#[test]
fn peer_spectral_correlation_and_coherence() {
    // Against the definition, summed term by term by numpy 2.4.6.
    let theirs = vectors();
    for (name, kind) in [("correlation", Cyclic::Correlation), ("coherence", Cyclic::Coherence)] {
        let ours = spectral_correlation(&input(200), 1000.0, 32, 100.0, kind).unwrap();
        let theirs = &theirs["cyclic"][name];
        let (re, im): (Vec<f64>, Vec<f64>) = ours.values.iter().map(|v| (v.re, v.im)).unzip();
        assert_equal(name, &re, &numbers(&theirs["re"]));
        assert_equal(name, &im, &numbers(&theirs["im"]));
    }
}

#[test]
fn peer_other_sample_rates() {
    // scipy.signal.resample_poly.
    let theirs = vectors();
    for (up, down) in [(1, 2), (3, 2), (7, 9), (5, 1)] {
        let case = format!("{up}/{down}");
        let ours = resample_poly(&input(200), up, down).unwrap();
        assert_near(&case, &ours, &numbers(&theirs["resampled"][&case]), 1e-12);
    }
}

#[test]
fn refuses_what_is_too_short_for_its_levels() {
    for (levels, words) in [(4, "at least 2048"), (90, "a tree of bands of so many levels")] {
        stribeck_testing::assert_refused(fast_kurtogram(&input(2000), 1000.0, levels), words);
    }
}
