//! Healthy bearings, and records that do not decide: made ones.

use std::f64::consts::TAU;
use stribeck_testing::assert_refused;

use stribeck_diagnosis::{Analysis, Defect, Machine};
use stribeck_dsp::channel::Channel;

use crate::signals::*;

#[test]
fn invariant_noise_is_no_defect_and_false_alarms_are_as_rare_as_stated() {
    const RECORDS: usize = 150;
    let mut below = 0;
    for seed in 0..RECORDS as u64 {
        let findings = analysed(coloured(seed, 16_384), 1500.0);
        assert!(claimed(&findings).is_empty(), "{findings:?}");
        below += findings.families.iter().filter(|f| f.p_value < 0.05).count();
    }
    // Four families a record, 30 of 600 expected at most; three standard deviations of a binomial above that.
    assert!(below <= 30 + 16, "{below}");
}

#[test]
fn planted_a_shallow_modulation_is_seen_and_not_called_a_defect() {
    // What elements passing under the load do in a healthy bearing: the noise swells by a fifth, not quite
    // evenly.
    let swell = |t: f64| 1.0 + 0.2 * (0..4).map(|h| (TAU * 71.7 * f64::from(h + 1) * t).cos()).sum::<f64>();
    let signal: Vec<f64> = coloured(8, 4 * SAMPLES)
        .iter()
        .enumerate()
        .map(|(n, x)| x * swell(n as f64 / RATE_HZ).abs().sqrt())
        .collect();
    let findings = analysed(signal.clone(), 1200.0);
    assert!(claimed(&findings).is_empty(), "{findings:#?}");
    assert!(
        findings.families[0].is_there() && findings.verdict.starts_with("No defect of a raceway whose"),
        "{findings:#?}"
    );
    // Where this machine showed nothing of it when it was healthy, it is a defect; with one healthy record that
    // shows as much, or with too few of them, it is not.
    let score_db = findings.score_db.unwrap();
    let beside = |sound_db: &[f64]| {
        let machine = Machine { sound_db: sound_db.to_vec(), ..machine(1200.0) };
        judged(signal.clone(), &machine)
    };
    let sound_db = [-1.0, 0.5, 0.2, -0.3, 0.8, -0.6, 0.1];
    let found = beside(&sound_db);
    assert!(score_db > 5.0 && claimed(&found) == ["BPFO"], "{found:#?}");
    assert!(found.families[0].reason.to_string().contains("7 records of the healthy machine"), "{found:#?}");
    let one_as_high = beside(&[&sound_db[..], &[score_db]].concat());
    assert!(claimed(&one_as_high).is_empty(), "{one_as_high:#?}");
    assert_eq!(one_as_high.sound_as_high.map(|s| (s.as_high, s.records)), Some((1, 8)));
    // Two count by the distance from the higher, and may be those of a machine with a damaged element, too.
    let two = beside(&sound_db[..2]);
    assert_eq!(claimed(&two), ["BPFO"], "{two:#?}");
    assert_eq!(two.families[0].not_told_apart_from, Some(Defect::Bsf), "{two:#?}");
    assert!(claimed(&beside(&[0.1, score_db - 2.0])).is_empty());
    let too_few = beside(&sound_db[..1]);
    assert!(claimed(&too_few).is_empty(), "{too_few:#?}");
    noted(&too_few, "at least 2");
}

#[test]
fn by_hand_a_short_record_says_how_long_it_should_be() {
    let findings = analysed(coloured(1, 12_800), 300.0);
    let cage = family(&findings, Defect::Ftf);
    // The cage turns 1.99 times a second: ten periods take 5.0 s.
    assert!(cage.reason.to_string().contains("holds 1.99 periods; 5.03 s"), "{}", cage.reason);
    assert_eq!(findings.conclusion.cage.answer, stribeck_diagnosis::Answer::CannotTell);
}

#[test]
fn behaves_a_record_that_is_too_short_for_every_family_is_no_sign_of_health() {
    // 40 ms at 100 rpm hold a third of a period of the inner raceway.
    let findings = analysed(coloured(1, 1024), 100.0);
    assert!(findings.families.iter().all(|f| f.band_hz.is_none()), "{findings:#?}");
    assert!(findings.verdict.contains("cannot tell whether there is a defect"), "{}", findings.verdict);
}

#[test]
fn planted_gaps_and_clipping_are_said() {
    let mut signal = coloured(2, SAMPLES);
    // A slow swing beyond the range: many samples in a row stand at its end.
    let swing = |n: usize| 30.0 * (TAU * 20.0 * n as f64 / RATE_HZ).sin();
    signal.iter_mut().enumerate().for_each(|(n, x)| *x = (*x + swing(n)).clamp(-20.0, 20.0));
    let clipped = analysed(signal.clone(), 1200.0);
    noted(&clipped, "clipped");
    signal[10] = f64::NAN;
    assert_refused(
        Analysis::of(&Channel::held("a", signal), RATE_HZ, &machine(1200.0)),
        "1 of 65536 samples are not numbers, the first at 10",
    );
}

#[test]
fn refuses_what_holds_no_signal() {
    let of = |samples, rate| {
        Analysis::of(&Channel::held("a", samples), rate, &Machine::default()).unwrap_err().to_string()
    };
    assert!(of(vec![1.0; 10], 1e3).contains("1024 are the least"));
    assert!(of(vec![1.0; 5000], 1e3).contains("constant"));
    for scale in [1e300, 1e-300] {
        let out_of_range: Vec<f64> = coloured(1, 5000).into_iter().map(|x| scale * x).collect();
        assert!(of(out_of_range, 1e3).contains("beyond the range of numbers"), "{scale}");
    }
    assert!(of(vec![1.0; 5000], f64::NAN).contains("sample rate"));
    let unknown = judged(coloured(1, 5000), &Machine::default());
    assert!(unknown.families.is_empty() && unknown.verdict.starts_with("No verdict"));
}
