//! Lines that are predicted, in spectra that have them or not.

use stribeck_analysis::tones::{NearestLine, PredictedLine, clearest, dominant, harmonics, measure, nearest};
use stribeck_dsp::{Spectrum, Welch};

const SAMPLE_RATE_HZ: f64 = 100_000.0;

fn paper_lines() -> Vec<PredictedLine> {
    let of = |name: &str, hz| (name.to_owned(), hz);
    harmonics(&[of("roller vertices", 4671.7), of("outer nodes", 4719.0), of("inner nodes", 4716.0)], 3, 5e4)
}

fn spectrum_of(signal: &[f64]) -> Spectrum {
    Welch::for_grid(SAMPLE_RATE_HZ, signal.len(), 3.0).unwrap().estimate(signal).unwrap()
}

fn tone_in_noise(samples: usize) -> Vec<f64> {
    let mut seed = 7u64;
    (0..samples)
        .map(|n| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let noise = (seed >> 40) as f64 / (1u64 << 24) as f64 - 0.5;
            40.0 * (std::f64::consts::TAU * 4674.0 * n as f64 / SAMPLE_RATE_HZ).sin() + 20.0 * noise
        })
        .collect()
}

#[test]
fn planted_a_tone_in_noise_is_measured_and_merged() {
    // Uniform noise of ±10 g has a density of 33.3/50 000 g²/Hz: under 50 Hz it moves 40 g by about 0.4
    // g.
    const LEVEL_TOLERANCE_G: f64 = 1.5;
    let tones = measure("side", &paper_lines(), &spectrum_of(&tone_in_noise(3000))).unwrap();
    let roller = &tones[0];
    assert!((roller.measured_hz.unwrap() - 4674.0).abs() < 2.0, "{roller:?}");
    assert!((roller.level_g.unwrap() - 40.0).abs() < LEVEL_TOLERANCE_G, "{roller:?}");
    assert!(roller.prominence_db.unwrap() > 30.0, "{roller:?}");
    assert_eq!(roller.unresolved_from, ["inner nodes ×1", "outer nodes ×1"]);
    // 4674 Hz is out of reach of the raceway lines: hidden, not measured.
    assert_eq!((tones[1].measured_hz, tones[2].measured_hz), (None, None));
    // The third harmonics lie 133 Hz apart: resolved, except the two raceways.
    assert!(tones[6].unresolved_from.is_empty() && tones[7].unresolved_from.len() == 1);
    assert_eq!(dominant(&tones, "side"), Some(&tones[0]));
    assert_eq!((dominant(&tones, "bottom"), clearest(&tones)), (None, Some(&tones[0])));
}

#[test]
fn planted_a_long_record_splits_the_lines() {
    // 0.3 s resolve 3.3 Hz: the line 2.3 Hz above the prediction belongs to the rollers alone.
    let tones = measure("side", &paper_lines(), &spectrum_of(&tone_in_noise(30_000))).unwrap();
    assert!(tones[0].unresolved_from.is_empty());
    assert!((tones[0].measured_hz.unwrap() - 4674.0).abs() < 0.5);
    assert!(tones[0].level_g.unwrap() > 20.0 * tones[1].level_g.unwrap_or(0.0), "{:?}", &tones[..3]);
}

#[test]
fn planted_recorded_motion_claims_a_line_that_slip_has_moved() {
    // Rollers 1 % slower than rolling: the line is out of reach of the prediction without slip.
    let mut lines = harmonics(&[("roller vertices".into(), 4721.2)], 1, 5e4);
    let signal = tone_in_noise(30_000);
    assert_eq!(measure("side", &lines, &spectrum_of(&signal)).unwrap()[0].measured_hz, None);
    lines[0].from_motion_hz = Some(4674.5);
    let found = measure("side", &lines, &spectrum_of(&signal)).unwrap()[0].measured_hz;
    assert!((found.unwrap() - 4674.0).abs() < 0.5, "{found:?}");
}

/// 36 g at 4775 Hz, 104 Hz away and out of reach, 12 g at 4655 Hz, and 4 g at five times the latter, in
/// noise of ±10 g.
#[test]
fn planted_the_nearest_line_beside_a_stronger_one() {
    let line = |hz: f64, t: f64| (std::f64::consts::TAU * hz * t).sin();
    let noise = tone_in_noise(3000);
    let signal: Vec<f64> = (0..3000)
        .map(|n| (n as f64 / SAMPLE_RATE_HZ, noise[n] - 40.0 * line(4674.0, n as f64 / SAMPLE_RATE_HZ)))
        .map(|(t, rest)| 36.0 * line(4775.0, t) + 12.0 * line(4655.0, t) + 4.0 * line(23_275.0, t) + rest)
        .collect();
    let spectrum = spectrum_of(&signal);
    let found = nearest(&spectrum, 4671.0).unwrap();
    // Noise of 0.0007 g²/Hz under 50 Hz moves a frequency by a few hertz and 12 g by some tenths.
    assert!((found.hz.unwrap() - 4655.0).abs() < 5.0, "{found:?}");
    assert!((found.level_g.unwrap() - 12.0).abs() < 1.0, "{found:?}");
    assert!(found.above_db.unwrap() > 20.0, "{found:?}");
    let fifth = nearest(&spectrum, 5.0 * 4655.0).unwrap();
    assert!((fifth.hz.unwrap() - 23_275.0).abs() < 10.0 && fifth.above_db.unwrap() > 10.0, "{fifth:?}");
    // No line elsewhere; the height of the highest peak is returned nevertheless.
    let none = nearest(&spectrum, 11_000.0).unwrap();
    assert!(none.hz.is_none() && none.above_db.is_some_and(|db| db < 10.0), "{none:?}");
    let silence = spectrum_of(&vec![0.0; 3000]);
    assert_eq!(nearest(&silence, 4671.0).unwrap(), NearestLine::default());
    assert_eq!(nearest(&spectrum, 90_000.0).unwrap(), NearestLine::default());
}

#[test]
fn behaves_silence_measures_nothing() {
    let tones = measure("side", &paper_lines(), &spectrum_of(&vec![0.0; 3000])).unwrap();
    assert!(tones.iter().all(|t| t.measured_hz.is_none() && t.level_g.is_none()));
    assert_eq!((dominant(&tones, "side"), clearest(&tones)), (None, None));
}

#[test]
fn invariant_no_harmonic_reaches_half_the_sample_rate() {
    let lines = harmonics(&[("a".into(), 20_000.0)], 6, 50_000.0);
    assert_eq!(lines.iter().map(|l| l.harmonic).collect::<Vec<_>>(), [1, 2]);
}
