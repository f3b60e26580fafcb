//! Impacts over the angle of a shaft that speeds up.

use std::f64::consts::TAU;

use stribeck_analysis::duty::{ShockOrder, over_angle};
use stribeck_analysis::{enveloping, tones};
use stribeck_diagnosis::Defect;

/// Impacts 10.81 times a turn, of a shaft from 5 to 20 turns a second in a second, that ring at 12 kHz.
fn impacts() -> (Vec<f64>, Vec<f64>) {
    let turns: Vec<f64> = (0..100_000).map(|n| 1e-5 * f64::from(n)).map(|t| 5.0 * t + 7.5 * t * t).collect();
    let mut signal = vec![0.0; turns.len()];
    let mut since = f64::INFINITY;
    for n in 1..turns.len() {
        let impact = (10.81 * turns[n]).floor() > (10.81 * turns[n - 1]).floor();
        since = if impact { 0.0 } else { since + 1e-5 };
        signal[n] = 100.0 * (-since / 0.3e-3).exp() * (TAU * 12_000.0 * since).sin();
        if since.is_infinite() {
            signal[n] = 0.0;
        }
    }
    (signal, turns)
}

const BPFO: ShockOrder = ShockOrder { defect: Defect::Bpfo, order: 10.81 };

#[test]
fn planted_impacts_of_a_shaft_that_speeds_up_stand_at_their_order() {
    let (signal, turns) = impacts();
    let (_, finding) = over_angle(&signal, 1e5, &turns, BPFO, None).unwrap().unwrap();
    assert!((finding.periods - 12.5 * 10.81).abs() < 0.1 && (finding.resolution - 0.08).abs() < 1e-3);
    for line in &finding.lines {
        assert!((line.measured.unwrap() - line.predicted).abs() < finding.resolution, "{line:?}");
    }
    // At the mean speed of 12.5 turns a second nothing stands where the family would be.
    let family = tones::harmonics(&[("BPFO".into(), 12.5 * 10.81)], 4, 1e9);
    let (_, smeared) = enveloping::analyse(&signal, 1e5, &family).unwrap().unwrap();
    assert!(smeared.lines.iter().all(|line| line.measured_hz.is_none()), "{:?}", smeared.lines);
}

#[test]
fn refuses_few_turns_and_turns_back_and_says_why() {
    let (signal, turns) = impacts();
    let why = over_angle(&signal[..5000], 1e5, &turns[..5000], BPFO, None).unwrap().unwrap_err();
    assert!(why.contains("2.9 periods of BPFO"), "{why}");
    let there_and_back: Vec<f64> = turns.iter().map(|t| t * (10.0 - t)).collect();
    let why = over_angle(&signal, 1e5, &there_and_back, BPFO, None).unwrap().unwrap_err();
    assert!(why.contains("turns back"), "{why}");
    let still = vec![0.0; signal.len()];
    stribeck_testing::assert_refused(over_angle(&signal, 1e5, &still, BPFO, None).unwrap(), "stand still");
}
