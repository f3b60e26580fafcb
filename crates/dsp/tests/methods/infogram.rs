//! Bands whose impulses repeat.

use std::f64::consts::TAU;

use stribeck_dsp::{fast_kurtogram, infogram};

#[test]
fn planted_one_loud_bang_does_not_hide_what_repeats() {
    let mut state = 21_u64;
    let mut signal: Vec<f64> = (0..32_768)
        .map(|n| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let noise = (state >> 40) as f64 / f64::from(1 << 24) - 0.5;
            // Knocks at 3.2 kHz every 100 samples of 10 kHz.
            let since = f64::from(n % 100);
            noise + 0.8 * (-since / 12.0).exp() * (TAU * 0.32 * since).sin()
        })
        .collect();
    // And one bang at 900 Hz.
    for n in 0..200 {
        let since = f64::from(n);
        signal[15_000 + n as usize] += 12.0 * (-since / 20.0).exp() * (TAU * 0.09 * since).sin();
    }
    let holds = |low: f64, high: f64, hz: f64| (low..=high).contains(&hz);
    let narrow = fast_kurtogram(&signal, 1e4, 4).unwrap();
    let loudest = narrow.iter().max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis)).unwrap();
    assert!(holds(loudest.low_hz, loudest.high_hz, 900.0), "{loudest:?}");
    let bands = infogram(&signal, 1e4, 4).unwrap();
    let most = bands.iter().max_by(|a, b| a.of_spectrum.total_cmp(&b.of_spectrum)).unwrap();
    assert!(holds(most.low_hz, most.high_hz, 3_200.0), "{most:?}");
    assert_eq!(bands.len(), narrow.len());
}
