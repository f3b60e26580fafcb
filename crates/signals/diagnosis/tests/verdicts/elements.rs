//! Rolling elements and the cage: made records.

use stribeck_diagnosis::{Defect, Machine};
use stribeck_testing::Noise;

use crate::signals::*;

/// Impacts about the middle of each turn of a cage, at times [s] from it that `spread` draws from a number
/// from −1 to 1 for each of them, five in a turn.
fn passages(cage_hz: f64, samples: usize, spread: impl Fn(usize, [f64; 2]) -> f64) -> Vec<f64> {
    let mut noise = Noise::new(17);
    let mut signal = coloured(6, samples);
    for turn in 0..(cage_hz * samples as f64 / RATE_HZ) as usize {
        let of_the_turn = noise.uniform();
        for impact in 0..5 {
            let at = (turn as f64 + 0.5) / cage_hz + spread(impact, [of_the_turn, noise.uniform()]);
            RING.add(&mut signal, at, 40.0);
        }
    }
    signal
}

#[test]
fn planted_an_element_that_loses_its_spin_beyond_the_load_is_distinguished_from_the_cage() {
    let shaft_hz = 20.0;
    let (cage_hz, impacts_hz) = (0.398 * shaft_hz, 2.0 * 2.357 * shaft_hz);
    // Half a spin apart, from a phase that is drawn for every turn.
    let element =
        passages(cage_hz, SAMPLES, |impact, [turn, _]| (impact as f64 - 2.0 + 0.5 * turn) / impacts_hz);
    let findings = analysed(element, 60.0 * shaft_hz);
    assert_eq!(claimed(&findings), ["BSF"], "{findings:#?}");
    let family = family(&findings, Defect::Bsf);
    assert!(family.in_passages && (family.measured_hz.unwrap() / (0.5 * impacts_hz) - 1.0).abs() < 0.01);
    assert!(findings.verdict.contains("a defect of a rolling element"), "{}", findings.verdict);
    // As many as close together, without a rhythm.
    let cage = passages(cage_hz, 4 * SAMPLES, |_, [_, impact]| 2.0 * impact / impacts_hz);
    let findings = analysed(cage, 60.0 * shaft_hz);
    assert_eq!(claimed(&findings), ["FTF"], "{findings:#?}");
    // One element that loses its spin altogether would do the same.
    assert!(findings.verdict.contains("of the cage or of one rolling element"), "{}", findings.verdict);
}

/// In a 6205 twice BSF less three turns of the cage lies 1.8 % below BPFO: a spalled ball was called an outer raceway.
#[test]
fn issue_a_spot_on_an_element_is_not_called_a_raceway() {
    /// A second, as the records were in which it was.
    const SECOND: usize = 12_160;
    for rpm in [900.0, 1500.0, 2100.0, 3000.0] {
        let shaft_hz = rpm / 60.0;
        let (cage_hz, impacts_hz) = (0.394 * shaft_hz, 2.0 * 2.357 * shaft_hz);
        let element = impacts(impacts_hz, SECOND, under_the_load(cage_hz));
        let findings = analysed(sum([(2.0, element), (1.0, coloured(5, SECOND))]), rpm);
        let outer = family(&findings, Defect::Bpfo);
        assert!(!outer.claimed && !family(&findings, Defect::Bpfi).claimed, "{rpm}: {findings:#?}");
        assert!(outer.reason.to_string().contains("sidebands of 2×BSF, 3 times"), "{rpm}: {outer:#?}");
    }
    // A raceway keeps its own lines.
    let findings =
        analysed(sum([(1.0, impacts(179.2, SECOND, |_| 1.0)), (1.0, coloured(5, SECOND))]), 3000.0);
    assert_eq!(claimed(&findings), ["BPFO"], "{findings:#?}");
}

/// Load and sensor stand in space: beside a shaft at rest the cage of a bearing whose outer ring turns
/// follows the ring's lead over the shaft.
#[test]
fn issue_a_cage_is_expected_by_its_turns_in_space() {
    let noise = coloured(3, SAMPLES);
    let ftf = |outer_speed_rpm: f64| {
        let machine = Machine { outer_speed_rpm, ..machine(1500.0) };
        family(&judged(noise.clone(), &machine), Defect::Ftf).expected_hz
    };
    let (still, ahead, behind) = (ftf(0.0), ftf(600.0), ftf(-1500.0));
    assert!(
        (ahead - still - 10.0).abs() < 1e-9 && (behind - (25.0 - still)).abs() < 1e-9,
        "{still} {ahead} {behind}"
    );
}
