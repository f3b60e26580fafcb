//! A speed that is given a little wrong, or not at all: made records.

use std::f64::consts::TAU;

use stribeck_diagnosis::Machine;
use stribeck_theory::catalogue::CatalogueBearing;

use crate::signals::*;

/// A damaged inner raceway: its impacts go up and down once a turn of the shaft, which is out of balance.
fn inner_raceway(shaft_hz: f64) -> Vec<f64> {
    let order = CatalogueBearing::parse("6205").unwrap().orders().unwrap().bpfi;
    let loaded = |at: f64| 1.0 + 0.8 * (TAU * shaft_hz * at).cos();
    let impacts = impacts(order * shaft_hz, SAMPLES, loaded);
    let turns = |n: usize| -> f64 {
        let at = n as f64 / RATE_HZ;
        (1..=4).map(|k| (TAU * f64::from(k) * shaft_hz * at + f64::from(k)).sin()).sum()
    };
    coloured(5, SAMPLES).iter().zip(impacts).enumerate().map(|(n, (a, b))| a + b + turns(n)).collect()
}

#[test]
fn issue_the_speed_is_found_by_shaft_and_bearing_together() {
    let unknown = Machine { speed_rpm: None, ..machine(0.0) };
    let of = |samples| judged(samples, &unknown);
    // No whole number, and none of which another is a simple multiple within reach.
    let shaft_hz = 23.71;
    let findings = of(inner_raceway(shaft_hz));
    let rpm = findings.speed_rpm.unwrap();
    assert!((rpm / (60.0 * shaft_hz) - 1.0).abs() < 1e-3, "{rpm} {:?}", findings.notes);
    assert!(findings.speed_uncertainty_rpm.is_some_and(|off| (rpm - 60.0 * shaft_hz).abs() < 2.0 * off));
    assert_eq!(claimed(&findings), ["BPFI"], "{findings:?}");
    // A speed that is 4 % off is corrected by the same lines.
    let findings = analysed(inner_raceway(shaft_hz), 1.04 * 60.0 * shaft_hz);
    // To 1.2 rpm: the part that is not corrected.
    assert!((findings.speed_rpm.unwrap() / (60.0 * shaft_hz) - 1.0).abs() < 2e-3, "{:?}", findings.notes);
    assert_eq!(claimed(&findings), ["BPFI"], "{findings:?}");
    // Noise has no speed.
    let findings = of(coloured(8, SAMPLES));
    assert!(findings.speed_rpm.is_none() && findings.families.is_empty(), "{findings:?}");
    noted(&findings, "does not determine the speed");
}

#[test]
fn issue_a_speed_that_is_four_per_cent_off_is_corrected_by_the_lines_of_the_shaft() {
    // A rig ran 4 % off its nominal speed: BPFO plus two turns of the shaft lay at BPFI, and was claimed.
    let true_hz = 25.0;
    let outer = impacts(3.585 * true_hz, 2 * SAMPLES, |t| 1.0 + 0.5 * (TAU * true_hz * t).cos());
    let lines = unbalance(true_hz, 2 * SAMPLES);
    let signal = sum([(1.0, outer), (1.0, coloured(5, 2 * SAMPLES)), (1.0, lines)]);
    let findings = analysed(signal, 0.96 * 60.0 * true_hz);
    assert_eq!(claimed(&findings), ["BPFO"], "{findings:#?}");
    assert!((findings.speed_rpm.unwrap() - 60.0 * true_hz).abs() < 1.0, "{findings:#?}");
    assert!(findings.speed_given_rpm == Some(0.96 * 60.0 * true_hz));
    noted(&findings, "from the 1440.0 rpm that were given");
}

#[test]
fn issue_lines_of_the_bearing_are_not_taken_for_those_of_the_shaft() {
    // In a 6203 BPFO is 3.05 times the shaft, and its lines in the signal itself looked like three times a
    // shaft that turns 1.7 % faster: an exact speed was corrected.
    let shaft_hz = 25.0;
    let bearing = CatalogueBearing::parse("6203").ok();
    let order = bearing.as_ref().unwrap().orders().unwrap().bpfo;
    let machine = Machine { speed_rpm: Some(60.0 * shaft_hz), bearing, ..Machine::default() };
    let at = |n: usize, hz: f64| (TAU * hz * n as f64 / RATE_HZ).sin();
    let lines = |n| (1..=3).map(|m| at(n, f64::from(m) * order * shaft_hz)).sum();
    let lines = (0..SAMPLES).map(lines).collect();
    let impacts = impacts(order * shaft_hz, SAMPLES, |_| 1.0);
    let findings = judged(sum([(1.0, impacts), (1.0, coloured(5, SAMPLES)), (1.0, lines)]), &machine);
    assert_eq!(findings.speed_rpm, Some(60.0 * shaft_hz), "{:?}", findings.notes);
    assert_eq!(claimed(&findings), ["BPFO"], "{findings:#?}");
}

/// A speed a quarter of a per cent off was not corrected, and the family fell silent.
#[test]
fn issue_a_small_error_of_the_speed_is_corrected() {
    /// Part that is left: a fifth of the resolution of the shaft's first line in ten seconds is 7e-4.
    const LEFT: f64 = 1e-3;
    let true_hz = 29.6;
    let outer = impacts(3.585 * true_hz, 2 * SAMPLES, |_| 1.0);
    let signal = sum([(1.0, outer), (1.0, coloured(5, 2 * SAMPLES)), (1.0, unbalance(true_hz, 2 * SAMPLES))]);
    for rpm in [1771.0, 1775.0] {
        let findings = analysed(signal.clone(), rpm);
        assert!((findings.speed_rpm.unwrap() / (60.0 * true_hz) - 1.0).abs() < LEFT, "{rpm}: {findings:#?}");
        assert_eq!(claimed(&findings), ["BPFO"], "{rpm}: {findings:#?}");
    }
}
