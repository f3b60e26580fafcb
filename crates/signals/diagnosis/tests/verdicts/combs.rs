//! Combs that are no family of the bearing: made records.

use stribeck_testing::Noise;

use crate::signals::*;

#[test]
fn issue_a_comb_that_is_no_family_is_named_and_nothing_weaker_is_claimed() {
    // The bearing that was given is not the one that runs: 4.3 times the shaft is none of its families.
    let shaft_hz = 20.0;
    let [foreign, raceway] =
        [(4.3, 1.0), (3.585, 0.3)].map(|(order, k)| impacts(order * shaft_hz, SAMPLES, |_| k));
    let signal = sum([(1.0, foreign), (1.0, raceway), (1.0, coloured(5, SAMPLES))]);
    let findings = analysed(signal, 60.0 * shaft_hz);
    assert!(claimed(&findings).is_empty(), "{findings:#?}");
    let other = findings.unexplained.unwrap_or_else(|| panic!("{findings:#?}"));
    assert!((other.order - 4.3).abs() < 0.01 && findings.verdict.contains("times the shaft, which is no"));
}

#[test]
fn issue_a_foreign_comb_in_another_band_does_not_veto_a_raceway() {
    // A rig's converter strikes at 2.1 times the shaft above 5 kHz, louder than the outer raceway below 2 kHz.
    let shaft_hz = 20.0;
    let with = |outer: f64| {
        let mut noise = Noise::new(3);
        let mut signal: Vec<f64> = (0..SAMPLES).map(|_| gaussian(&mut noise)).collect();
        for (order, hz, strength) in [(2.1, 5_800.0, 12.0), (3.585, 1_200.0, outer)] {
            let ring = Ring { hz, decay_s: 0.7e-3, samples: 60, ..RING };
            ring.add_all(&mut signal, &mut Noise::new(17), order * shaft_hz, |_| strength);
        }
        analysed(signal, 60.0 * shaft_hz)
    };
    let findings = with(6.0);
    assert_eq!(claimed(&findings), ["BPFO"], "{findings:#?}");
    let other = findings.unexplained.unwrap_or_else(|| panic!("{findings:#?}"));
    assert!((other.order - 2.1).abs() < 0.01 && other.band_hz.0 > 3_000.0, "{other:?}");
    // Without the raceway nothing is claimed, and the comb is named.
    let findings = with(0.0);
    assert!(claimed(&findings).is_empty() && findings.verdict.contains("no family of this"), "{findings:#?}");
}
