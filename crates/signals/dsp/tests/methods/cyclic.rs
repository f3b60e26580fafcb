//! Spectral correlation of modulated noise.

use std::f64::consts::TAU;

use stribeck_dsp::{Cyclic, Error, spectral_correlation};
use stribeck_testing::Noise;

const RATE_HZ: f64 = 10_000.0;

/// White noise whose amplitude goes as `1 + depth cos` at `hz`, below and above alike.
fn modulated(depth: f64, hz: f64, count: usize) -> Vec<f64> {
    let mut noise = Noise::new(5);
    let mut uniform = || 1.0 - noise.share();
    (0..count)
        .map(|n| {
            let gaussian = (-2.0 * uniform().ln()).sqrt() * (TAU * uniform()).cos();
            gaussian * (1.0 + depth * (TAU * hz * n as f64 / RATE_HZ).cos())
        })
        .collect()
}

#[test]
fn analytic_modulated_noise_has_lines_at_its_modulation_and_at_twice_that_only() {
    // Antoni (2017), section 2: of noise of variance s² times 1 + d cos the power goes as
    // (1 + d²/2) + 2d cos + (d²/2) cos 2, so the coherence is d/(1 + d²/2) at the modulation and
    // (d²/4)/(1 + d²/2) at twice that, for all f.
    let (depth, hz) = (0.6, 87.5);
    let signal = modulated(depth, hz, 200_000);
    let found = spectral_correlation(&signal, RATE_HZ, 128, 400.0, Cyclic::Coherence).unwrap();
    let spectrum = found.envelope_spectrum(400.0, 4_600.0).unwrap();
    let near = |hz: f64| {
        let at = (hz / found.cyclic_grid_hz).round() as usize;
        spectrum[at - 1..=at + 1].iter().fold(0.0_f64, |most, v| most.max(*v))
    };
    let mean = 1.0 + depth * depth / 2.0;
    let once = near(hz);
    // A line between grid points loses up to a third (2/π); noise adds in quadrature.
    assert!(once < 1.02 * depth / mean && once > 0.63 * depth / mean, "{once} {}", depth / mean);
    let twice = near(2.0 * hz);
    let expected = depth * depth / 4.0 / mean;
    assert!(twice < 1.15 * expected && twice > 0.6 * expected, "{twice} {expected}");
    // Nothing else stands above the scatter, 1/√frames' equivalent averaged over the carrier lines.
    let rest = spectrum.iter().enumerate().skip((20.0 / found.cyclic_grid_hz) as usize).filter(|(n, _)| {
        let at = *n as f64 * found.cyclic_grid_hz;
        (at - hz).abs() > 1.0 && (at - 2.0 * hz).abs() > 1.0
    });
    let most = rest.map(|(_, v)| *v).fold(0.0, f64::max);
    assert!(most < 0.6 * twice, "{most} beside {twice}");
}

#[test]
fn analytic_the_correlation_at_zero_is_the_density() {
    // Antoni (2017), equation 8: S(0, f) is the power spectral density; two-sided 1/fs for white noise of
    // variance 1.
    let found =
        spectral_correlation(&modulated(0.0, 1.0, 100_000), RATE_HZ, 64, 100.0, Cyclic::Correlation).unwrap();
    let mean = (2..31).map(|n| found.row(n)[0].re).sum::<f64>() / 29.0;
    assert!((mean * RATE_HZ - 1.0).abs() < 0.05, "{}", mean * RATE_HZ);
}

#[test]
fn refuses_cyclic_frequencies_beyond_the_record() {
    let signal = modulated(0.0, 1.0, 1_000);
    let of = |window, most_hz| spectral_correlation(&signal, RATE_HZ, window, most_hz, Cyclic::Coherence);
    assert!(matches!(of(128, 6_000.0), Err(Error::Band { .. })));
    assert!(matches!(of(8, 100.0), Err(Error::TooShort { .. })));
    assert!(matches!(of(512, 100.0), Err(Error::TooShort { .. })));
    let found = of(128, 100.0).unwrap();
    assert!(matches!(found.envelope_spectrum(1.0, 2.0), Err(Error::BandTooNarrow { .. })));
}
