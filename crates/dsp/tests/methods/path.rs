//! Paths from a force to a sensor.

use std::f64::consts::PI;

use stribeck_dsp::{Detrend, Path, Welch, WelchOptions, Window, coloured_like};
use stribeck_testing::Noise;

/// Acceleration of a mode of unit mass at resonance: F/(2ζ). Meirovitch 2001, §3.2.
#[test]
fn analytic_a_record_behind_one_mode_is_louder_by_half_over_its_damping() {
    // The first mode is at the highest frequency, damped by 0.005 × 10^log₁₀ 2 and of strength 1; the others
    // have none.
    let mut of_first = [0.0, 2.0_f64.log10(), 1.0].into_iter();
    let path = Path::drawn(1000.0, || of_first.next().unwrap_or(0.5));
    let rate_hz = 40_000.0;
    let force: Vec<f64> = (0..40_000).map(|n| (2.0 * PI * 1000.0 * f64::from(n) / rate_hz).sin()).collect();
    let record = path.through(&force, rate_hz, 10_000.0).unwrap();
    assert_eq!(record.len(), 10_000);
    let most = record[3000..7000].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!((most / 50.0 - 1.0).abs() < 0.01, "{most}");
}

#[test]
fn invariant_a_coloured_signal_has_the_density_and_begins_when_it_does() {
    // A click takes on the path's ringing, which is causal; noise takes on the path's density.
    let density: Vec<f64> = (0..257).map(|n| 1.0 / (1e-3 + (f64::from(n) / 256.0 - 0.3).powi(2))).collect();
    let mut noise = Noise::new(5);
    let noise: Vec<f64> = (0..65_536).map(|_| noise.share() - 0.5).collect();
    let coloured = coloured_like(&noise, &density).unwrap();
    let whole = WelchOptions {
        window: Window::Boxcar,
        overlap: 0,
        detrend: Detrend::None,
        ..WelchOptions::new(coloured.len())
    };
    let lines = Welch::new(1.0, coloured.len(), &whole).unwrap().estimate(&coloured).unwrap();
    let power = |from: f64, to: f64| {
        let bins = (from * 32_768.0) as usize..(to * 32_768.0) as usize;
        lines.values()[bins.clone()].iter().sum::<f64>() / bins.len() as f64
    };
    let expected = |at: f64| 1.0 / (1e-3 + (at - 0.3_f64).powi(2));
    let ratio = power(0.295, 0.305) / power(0.6, 0.61) / (expected(0.3) / expected(0.605));
    assert!((0.7..1.4).contains(&ratio), "{ratio}");
    let mut click = vec![0.0; 4096];
    click[2000] = 1.0;
    let rings = coloured_like(&click, &density).unwrap();
    let energy = |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>();
    assert!(energy(&rings[..1995]) < 0.02 * energy(&rings), "{}", energy(&rings[..1995]));
}

#[test]
fn refuses_a_record_faster_than_its_force() {
    let mut noise = Noise::new(1);
    let path = Path::drawn(1e4, || noise.share());
    let why = path.through(&[0.0; 32], 1e4, 2e4).expect_err("too fast").to_string();
    assert!(why.contains("sampled more slowly"), "{why}");
}
