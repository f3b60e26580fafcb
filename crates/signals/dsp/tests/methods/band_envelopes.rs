//! Envelopes of bands of a record of any length.
//!
//! Source: R. B. Randall and J. Antoni, Mech. Syst. Signal Process. 25 (2011) 485–520.

use std::f64::consts::TAU;

use stribeck_dsp::BandEnvelopes;

const RATE_HZ: f64 = 10_000.0;

fn modulated(depth: f64, samples: usize) -> Vec<f64> {
    (0..samples)
        .map(|n| n as f64 / RATE_HZ)
        .map(|t| (1.0 + depth * (TAU * 37.3 * t).cos()).max(0.0).sqrt() * (TAU * 2_500.0 * t).sin())
        .collect()
}

#[test]
fn planted_the_depth_of_a_modulation_is_read_back() {
    let mut plan = BandEnvelopes::new(RATE_HZ, 8_000, &[(1_250.0, 3_750.0)], 500.0).unwrap();
    for segment in modulated(0.6, 24_000).chunks(8_000) {
        plan.add(segment).unwrap();
    }
    let band = &plan.bands()[0];
    assert_eq!((band.segments, band.low_hz, band.high_hz), (3, 1250.0, 3750.0));
    // 37.3 Hz lies between lines of 1.25 Hz; five of them hold all but a thousandth of its power.
    assert!((band.depth(37.3) - 0.6).abs() < 2e-3, "{}", band.depth(37.3));
    assert!(band.depth(200.0) < 1e-2);
    assert!((band.rms - 0.5_f64.sqrt()).abs() < 1e-3, "{}", band.rms);
    // ⟨(1 + d cos)²⟩ − 2 = d²/2 − 1.
    assert!((band.kurtosis - (0.18 - 1.0)).abs() < 2e-3, "{}", band.kurtosis);
}

/// Source: the autocorrelation of 1 + d cos(2πft) less its mean is cos(2πfτ).
#[test]
fn analytic_the_power_of_a_modulation_is_like_itself_after_its_period() {
    const HZ: f64 = 37.3;
    let mut plan = BandEnvelopes::new(RATE_HZ, 8_000, &[(1_250.0, 3_750.0)], 500.0).unwrap();
    plan.add(&modulated(0.6, 8_000)).unwrap();
    let correlation = plan.bands()[0].autocorrelation().unwrap();
    // Values lie 1 ms apart; the window of 0.8 s has lost 2 % of itself at 30 ms.
    for (periods, like) in [(0.0, 1.0), (0.5, -1.0), (1.0, 1.0)] {
        let lag_s: f64 = (periods / HZ * 1e3_f64).round() * 1e-3;
        let expected = (TAU * HZ * lag_s).cos();
        let found = correlation.at(lag_s).unwrap();
        assert!((found - expected).abs() < 0.02 && found * like > 0.9, "{periods}: {found} for {expected}");
    }
    assert_eq!(correlation.at(0.5), None);
}

#[test]
fn invariant_processing_moves_no_buffer() {
    let mut plan = BandEnvelopes::new(RATE_HZ, 1_000, &[(0.0, 5_000.0), (100.0, 900.0)], 500.0).unwrap();
    let segment = modulated(0.3, 1_000);
    for _ in 0..3 {
        let taken = allocation_counter::measure(|| plan.add(&segment).unwrap());
        assert_eq!(taken.count_total, 0);
    }
}

#[test]
fn by_hand_segments_are_smooth_and_fit() {
    assert_eq!(BandEnvelopes::segment_of(262_144, 1 << 20), 262_144);
    assert_eq!(BandEnvelopes::segment_of(121_991, 1 << 20), 121_500);
    assert_eq!(BandEnvelopes::segment_of(92_160_000, 1 << 19), 1 << 19);
    assert_eq!(BandEnvelopes::segment_of(1, 1 << 19), 1);
}

/// A band up to half the sample rate was said to end half a line above it, or by a rounding, which whoever
/// filters by it refuses.
#[test]
fn issue_no_band_ends_above_half_the_sample_rate() {
    for (rate_hz, segment) in [(10_000.0, 1_001), (10_000.0, 999), (12_800.0, 44_757), (11_520.1, 9_999)] {
        for segment in segment..segment + 20 {
            let half = 0.5 * rate_hz;
            let mut plan = BandEnvelopes::new(rate_hz, segment, &[(0.5 * half, half)], 500.0).unwrap();
            plan.add(&modulated(0.6, segment)).unwrap();
            let high_hz = plan.bands()[0].high_hz;
            assert!(high_hz <= half && high_hz > 0.99 * half, "{segment} samples: {high_hz} of {half} Hz");
        }
    }
}
