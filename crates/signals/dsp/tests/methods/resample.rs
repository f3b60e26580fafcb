//! A record at another rate.

use std::f64::consts::TAU;

use stribeck_dsp::{Error, resample_poly};

#[test]
fn planted_a_tone_keeps_its_amplitude_and_its_place_at_another_rate() {
    let tone = |rate: f64, n: usize| (TAU * 3.0 * n as f64 / rate).cos();
    let signal: Vec<f64> = (0..2000).map(|n| tone(100.0, n)).collect();
    for (up, down) in [(1, 2), (3, 2), (441, 480), (5, 1), (4, 4)] {
        let rate = 100.0 * up as f64 / down as f64;
        let other = resample_poly(&signal, up, down).unwrap();
        assert_eq!(other.len(), (2000 * up).div_ceil(down));
        let inner = other.len() / 4..other.len() / 4 * 3;
        // The ripple of a Kaiser window of 5 is some 5e-4.
        let off = inner.map(|n| (other[n] - tone(rate, n)).abs()).fold(0.0, f64::max);
        assert!(off < 2e-3, "{up}/{down}: {off}");
    }
}

#[test]
fn refuses_ratios_that_are_none() {
    for (up, down) in [(0, 1), (1, 0), (30_001, 30_000)] {
        assert!(matches!(resample_poly(&[1.0], up, down), Err(Error::Undefined { .. })), "{up}/{down}");
    }
    assert!(matches!(resample_poly(&[], 1, 2), Err(Error::TooShort { .. })));
    assert!(matches!(resample_poly(&[f64::NAN], 1, 2), Err(Error::NotFinite { index: 0, .. })));
    assert_eq!(resample_poly(&[1.0, 2.0], 30_000, 30_000).unwrap(), [1.0, 2.0]);
}
