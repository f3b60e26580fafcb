//! Ripple of a force, and amplitudes at given frequencies.

use stribeck_analysis::noise::{force_ripple, spectrum_g};
use stribeck_diagnosis::STANDARD_GRAVITY;

#[test]
fn planted_ripple_leaves_a_cubic_alone_and_finds_a_sine() {
    let cubic = |t: f64| 1000.0 + 50.0 * t - 30.0 * t * t + 20.0 * t * t * t;
    let force = |ripple: f64| -> Vec<f64> {
        (0..500).map(|i| cubic(i as f64 / 500.0) + ripple * (0.9 * i as f64).sin()).collect()
    };
    assert!(force_ripple(&force(0.0)).unwrap() < 1e-12);
    let mean = 1000.0 + 25.0 - 10.0 + 5.0;
    // Whole periods but for a fraction: half a per cent.
    assert!((force_ripple(&force(10.0)).unwrap() * mean / 10.0 * 2f64.sqrt() - 1.0).abs() < 0.02);
    assert_eq!(force_ripple(&[1.0; 3]), None);
}

#[test]
fn by_hand_spectrum_of_a_sine() {
    let sine: Vec<f64> =
        (0..1000).map(|i| 3.0 * STANDARD_GRAVITY * (std::f64::consts::TAU * 0.05 * i as f64).sin()).collect();
    let found = spectrum_g(&sine, 1e5, &[5000.0, 20_000.0]);
    assert!((found[0] - 3.0).abs() < 1e-9 && found[1] < 1e-9, "{found:?}");
}
