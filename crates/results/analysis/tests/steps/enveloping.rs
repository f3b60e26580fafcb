//! Envelope spectra of impacts.

use std::f64::consts::TAU;

use stribeck_analysis::enveloping::analyse;
use stribeck_analysis::tones::{self, PredictedLine};

/// Impacts 90.1 times a second that ring at 12 kHz.
fn impacts(seconds: f64) -> Vec<f64> {
    (0..(1e5 * seconds) as usize)
        .map(|n| {
            let since = (n as f64 * 1e-5).rem_euclid(1.0 / 90.1);
            100.0 * (-since / 0.5e-3).exp() * (TAU * 12_000.0 * since).sin()
        })
        .collect()
}

fn family() -> Vec<PredictedLine> {
    tones::harmonics(&[("BPFO".into(), 90.1)], 4, 1e9)
}

#[test]
fn planted_impacts_show_their_rate_and_its_multiples() {
    let (_, finding) = analyse(&impacts(0.4), 1e5, &family()).unwrap().unwrap();
    assert!(finding.periods > 36.0);
    for line in &finding.lines {
        // Half of the resolution of 2.5 Hz.
        assert!((line.measured_hz.unwrap() - line.predicted_hz).abs() < 1.25, "{line:?}");
    }
}

#[test]
fn refuses_a_short_record_and_says_why() {
    let why = analyse(&impacts(0.03), 1e5, &family()).unwrap().unwrap_err();
    assert!(why.contains("2.7 periods"), "{why}");
    stribeck_testing::assert_refused(analyse(&[], 1e5, &family()).unwrap(), "the record is empty");
    stribeck_testing::assert_refused(analyse(&impacts(0.4), 1e5, &[]).unwrap(), "nothing passes a defect");
}
