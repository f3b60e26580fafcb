//! Levels of a signal, and the phases of a record.

use stribeck_analysis::levels::{Phase, Visit, gap_spans, level, phase_level, phases};

#[test]
fn by_hand_level_of_a_sine() {
    let sine: Vec<f64> = (0..1000).map(|n| 50.0 * (std::f64::consts::TAU * 0.05 * n as f64).sin()).collect();
    let found = level(&sine, &[0..500, 500..1000]).unwrap();
    // Whole periods: peak A, root mean square A/√2 to rounding.
    assert!((found.peak - 50.0).abs() < 1e-9 && (found.rms - 50.0 / 2f64.sqrt()).abs() < 1e-9);
    assert_eq!(level(&sine, &[]), None);
    let outside = 2000..2100;
    assert_eq!(level(&sine, &[outside]), None);
}

/// The paper's three passages: unloading 0.1 ms behind the leading edge, loaded again 0.2 ms before the
/// trailing one.
fn visits() -> Vec<Visit> {
    [(0.84e-3, 5.08e-3), (11.94e-3, 16.18e-3), (23.04e-3, 27.28e-3)]
        .map(|(from_s, until_s)| Visit {
            from_s,
            entry_s: from_s + 0.1e-3,
            exit_s: until_s - 0.2e-3,
            until_s,
        })
        .to_vec()
}

#[test]
fn by_hand_every_sample_has_one_phase() {
    let time: Vec<f64> = (0..3000).map(|n| n as f64 * 1e-5).collect();
    let found = phases(&time, &visits());
    // By hand [ms]: 0.84 − 0.5, 0.94 + 1, 4.88 − 1, 5.08 + 2, 11.94 − 0.5.
    let ends = [
        (Phase::StartUp, 0.34),
        (Phase::Entry, 1.94),
        (Phase::Defect, 3.88),
        (Phase::Exit, 7.08),
        (Phase::Gap, 11.44),
    ];
    let mut from = 0;
    for (phase, end_ms) in ends {
        let length = found[from..].iter().take_while(|p| **p == phase).count();
        from += length;
        assert!((1e3 * time[from] - end_ms).abs() < 0.015, "{phase:?} ends at {} ms", 1e3 * time[from]);
    }
    assert_eq!(found[2999], Phase::Gap);
    // One value a phase, and a peak that belongs to the start alone.
    let value = |p: &Phase| [40.0, 30.0, 20.0, 10.0, 5.0][*p as usize];
    let signal: Vec<f64> = found.iter().map(value).collect();
    for (phase, g) in [Phase::StartUp, Phase::Entry, Phase::Defect, Phase::Exit, Phase::Gap]
        .into_iter()
        .zip([40.0, 30.0, 20.0, 10.0, 5.0])
    {
        let level = phase_level(&signal, &found, phase).unwrap();
        assert!((level.peak - g).abs() < 1e-12 && (level.rms - g).abs() < 1e-12, "{phase:?} {level:?}");
    }
    assert_eq!(phase_level(&signal[..20], &found[..20], Phase::Exit), None);
}

#[test]
fn behaves_a_sound_bearing_has_start_up_and_gap_only() {
    let time: Vec<f64> = (0..1000).map(|n| n as f64 * 1e-5).collect();
    let found = phases(&time, &[]);
    assert!(found[..200].iter().all(|p| *p == Phase::StartUp));
    assert!(found[200..].iter().all(|p| *p == Phase::Gap));
    let gap = gap_spans(&time, &found, 0.0);
    assert!(gap.len() == 1 && gap[0] == (200..1000), "{gap:?}");
    assert_eq!(phases(&[], &visits()), []);
}

#[test]
fn invariant_gaps_avoid_events_and_the_start() {
    let time: Vec<f64> = (0..3000).map(|n| n as f64 * 1e-5).collect();
    let found = phases(&time, &visits());
    let in_ms: Vec<(f64, f64)> =
        gap_spans(&time, &found, 0.0).iter().map(|s| (1e3 * time[s.start], 1e3 * time[s.end - 1])).collect();
    let expected = [(7.09, 11.43), (18.19, 22.53), (29.29, 29.99)];
    assert_eq!(in_ms.len(), expected.len());
    for (found, wanted) in in_ms.iter().zip(expected) {
        assert!((found.0 - wanted.0).abs() < 0.015 && (found.1 - wanted.1).abs() < 0.015, "{in_ms:?}");
    }
    assert_eq!(gap_spans(&time, &found, 8e-3)[0].start, 800);
}
