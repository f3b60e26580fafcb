//! Samples at equal angles of a shaft.

use std::f64::consts::TAU;

use stribeck_dsp::{Error, means_over_angle, order_track};

#[test]
fn planted_a_line_of_a_shaft_that_speeds_up_stands_still_over_the_angle() {
    // Turns of 100, 99, … samples; three waves a turn.
    let mut pulses = vec![2.0];
    (0..40).for_each(|n| pulses.push(pulses[n] + 100.0 - n as f64));
    let mut signal = vec![0.0; 3400];
    for turn in pulses.windows(2) {
        for n in turn[0].ceil() as usize..turn[1].ceil() as usize {
            signal[n] = (3.0 * TAU * (n as f64 - turn[0]) / (turn[1] - turn[0])).sin();
        }
    }
    let tracked = order_track(&signal, &pulses, 64).unwrap();
    assert_eq!(tracked.turns(), 40);
    // The cubic is off by (2π·3/60)³/16 of the amplitude at the fastest turn, more next to a change of
    // speed.
    for (n, x) in tracked.average().iter().enumerate() {
        assert!((x - (3.0 * TAU * n as f64 / 64.0).sin()).abs() < 5e-3, "{n}: {x}");
    }
    assert!(tracked.residual().iter().all(|x| x.abs() < 3e-2));
}

#[test]
fn planted_means_over_the_angle_of_a_shaft_that_starts_from_rest() {
    // 20 turns in 10 000 samples of a constant acceleration; three waves a turn about 2.
    let turns: Vec<f64> = (0..10_000).map(|n| 20.0 * (f64::from(n) / 9_999.0).powi(2)).collect();
    let signal: Vec<f64> = turns.iter().map(|turn| 2.0 + (3.0 * TAU * turn).sin()).collect();
    let means = means_over_angle(&signal, &turns, 64).unwrap();
    assert_eq!(means.len(), 20 * 64);
    for (n, mean) in means.iter().enumerate() {
        // The mean of a sine over a step, and the lines between samples at the fastest turn:
        // (2π·3/250)²/8.
        let x = std::f64::consts::PI * 3.0 / 64.0;
        let wave = (3.0 * TAU * (n as f64 + 0.5) / 64.0).sin() * x.sin() / x;
        assert!((mean - 2.0 - wave).abs() < 1e-3, "{n}: {mean} {wave}");
    }
    let constant = means_over_angle(&vec![3.0; 10_000], &turns, 7).unwrap();
    assert!(constant.iter().all(|mean| (mean - 3.0).abs() < 1e-9));
}

#[test]
fn refuses_angles_that_fall() {
    let signal = vec![1.0; 4];
    assert!(matches!(means_over_angle(&signal, &[0.0, 1.0, 0.5, 2.0], 8), Err(Error::Undefined { .. })));
    assert!(matches!(means_over_angle(&signal, &[0.0, 1.0], 8), Err(Error::WrongLength { .. })));
    assert!(matches!(
        means_over_angle(&signal, &[0.0, 0.01, 0.02, 0.03], 8),
        Err(Error::TooShort { field: "turns", .. })
    ));
    // A pause of the shaft changes nothing.
    assert_eq!(means_over_angle(&signal, &[0.0, 1.0, 1.0, 2.0], 2).unwrap(), [1.0; 4]);
}

#[test]
fn refuses_pulses_that_are_none() {
    let signal = vec![1.0; 100];
    assert!(matches!(order_track(&signal, &[5.0], 8), Err(Error::TooShort { field: "pulses", .. })));
    assert!(matches!(order_track(&signal, &[5.0, 4.0], 8), Err(Error::Undefined { .. })));
    assert!(matches!(order_track(&signal, &[5.0, 400.0], 8), Err(Error::Undefined { .. })));
    assert!(matches!(
        order_track(&signal, &[5.0, 9.0], 0),
        Err(Error::TooShort { field: "samples_per_turn", .. })
    ));
}
