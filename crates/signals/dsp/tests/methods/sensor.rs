//! A signal as a sensor and its recorder record it.

use std::f64::consts::{PI, TAU};

use stribeck_dsp::Sensor;

fn sine(hz: f64, rate_hz: f64, count: usize) -> Vec<f64> {
    (0..count).map(|n| (TAU * hz * n as f64 / rate_hz).sin()).collect()
}

fn rms(signal: &[f64]) -> f64 {
    (signal.iter().map(|x| x * x).sum::<f64>() / signal.len() as f64).sqrt()
}

#[test]
fn planted_what_the_filter_passes_keeps_its_time_and_what_it_stops_is_gone() {
    let sensor = Sensor::ideal(25_600.0);
    let passed = sensor.record(&sine(3_000.0, 100_000.0, 20_000), 100_000.0).unwrap();
    assert_eq!(passed.len(), 19_999 * 32 / 125 + 1);
    let middle = 500..passed.len() - 500;
    for n in middle.clone() {
        // The ends, continued with a kink, reach into the middle by less than this.
        let expected = (TAU * 3_000.0 * n as f64 / 25_600.0).sin();
        assert!((passed[n] - expected).abs() < 1e-3, "{n}: {} {expected}", passed[n]);
    }
    let stopped = sensor.record(&sine(20_000.0, 100_000.0, 20_000), 100_000.0).unwrap();
    assert!(rms(&stopped[middle]) < 1e-3);
}

/// Records of accelerations began and ended with spikes of hundreds of g, which their anti-alias filter
/// should have taken.
#[test]
fn issue_ends_of_a_record_are_filtered_like_its_middle() {
    let heights = [0, 10_000, 20_000].map(|at| {
        let mut signal = vec![0.0; 20_001];
        signal[at] = 1.0;
        Sensor::ideal(25_000.0).record(&signal, 100_000.0).unwrap()[at / 4]
    });
    // A quarter of the band passes it but for the flank.
    assert!(heights.iter().all(|height| (height - 0.225).abs() < 1e-3), "{heights:?}");
}

#[test]
fn planted_a_resonance_amplifies_by_its_quality() {
    let sensor = Sensor { resonance: Some((10_000.0, 20.0)), ..Sensor::ideal(100_000.0) };
    let at = sensor.record(&sine(10_000.0, 100_000.0, 20_000), 100_000.0).unwrap();
    assert!((rms(&at[5_000..15_000]) * 2_f64.sqrt() / 20.0 - 1.0).abs() < 1e-2);
    // Well below it the response is 1/(1 − (f/f₀)²).
    let below = sensor.record(&sine(1_000.0, 100_000.0, 20_000), 100_000.0).unwrap();
    assert!((rms(&below[5_000..15_000]) * 2_f64.sqrt() * 0.99 - 1.0).abs() < 2e-3);
}

#[test]
fn planted_noise_range_and_steps() {
    let quiet = vec![0.0; 50_000];
    let noisy = Sensor { noise_density: 0.01, seed: 3, ..Sensor::ideal(50_000.0) };
    let recorded = noisy.record(&quiet, 50_000.0).unwrap();
    // 0.01 √25 000 = 1.58, scattered by 1/√100 000.
    assert!((rms(&recorded) / (0.01 * 25_000_f64.sqrt()) - 1.0).abs() < 0.013, "{}", rms(&recorded));
    assert_eq!(recorded, noisy.record(&quiet, 50_000.0).unwrap());
    let coarse = Sensor { range: 0.5, bits: Some(3), ..Sensor::ideal(10_000.0) };
    let stepped = coarse.record(&sine(100.0, 10_000.0, 1_000), 10_000.0).unwrap();
    assert!(stepped.iter().all(|x| (x / 0.125).fract() == 0.0 && (-0.5..=0.375).contains(x)));
}

#[test]
fn refuses_a_recorder_that_cannot_be() {
    let signal = sine(1.0, 100.0, 100);
    let why = |sensor: Sensor| sensor.record(&signal, 100.0).unwrap_err().to_string();
    assert!(why(Sensor::ideal(200.0)).contains("faster"));
    assert!(why(Sensor::ideal(10.0 * PI)).contains("rounder"));
    assert!(why(Sensor { bits: Some(8), ..Sensor::ideal(50.0) }).contains("range"));
    assert!(why(Sensor { resonance: Some((0.0, 1.0)), ..Sensor::ideal(50.0) }).contains("resonance"));
}
