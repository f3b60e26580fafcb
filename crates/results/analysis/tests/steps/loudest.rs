//! Where in the spectrum a signal is loudest.

use std::f64::consts::TAU;

use stribeck_analysis::loudest::loudest;
use stribeck_dsp::Welch;

/// Two tones: 3 g at 1 kHz and 4 g in two neighbouring parts at 5.9 and 6.1 kHz, sampled at 20 kHz; parts
/// are 400 Hz wide, and the band's root mean square is that of its two tones.
#[test]
fn planted_the_band_of_two_tones_beside_a_weaker_one() {
    const RATE_HZ: f64 = 20e3;
    /// The window spreads each tone over neighbouring lines.
    const SPREAD: f64 = 0.01;
    let wave = |g: f64, hz: f64, n: usize| g * (TAU * hz * n as f64 / RATE_HZ).sin();
    let signal: Vec<f64> =
        (0..20_000).map(|n| wave(3.0, 1000.0, n) + wave(4.0, 5900.0, n) + wave(4.0, 6100.0, n)).collect();
    let density = Welch::for_grid(RATE_HZ, signal.len(), 3.0).unwrap().estimate(&signal).unwrap();
    let found = loudest(&density).unwrap();
    assert_eq!(found.band_hz, (5600.0, 6400.0));
    assert!((found.rms - 4.0).abs() < SPREAD, "{}", found.rms);
    assert!((found.total_rms - (16.0_f64 + 4.5).sqrt()).abs() < SPREAD, "{}", found.total_rms);
    let silent = Welch::for_grid(RATE_HZ, 20_000, 3.0).unwrap().estimate(&vec![0.0; 20_000]).unwrap();
    assert_eq!(loudest(&silent), None);
}
