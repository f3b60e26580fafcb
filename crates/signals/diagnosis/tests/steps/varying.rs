//! A record of changing speed, over time and over the angle.

use std::f64::consts::TAU;

use stribeck_diagnosis::Varying;
use stribeck_diagnosis::speed::varying::turns_between;

/// Impacts 3.6 times a turn of a shaft from 10 to 30 turns a second stand at their order all the time.
#[test]
fn planted_a_family_stands_still_over_the_angle() {
    let rate_hz = 20_000.0;
    let times: Vec<f64> = (0..80_000).map(|n| f64::from(n) / rate_hz).collect();
    let turns: Vec<f64> = times.iter().map(|t| 10.0 * t + 2.5 * t * t).collect();
    // A resonance that the speed does not move.
    let ring = |(turns, t): (&f64, &f64)| {
        let since_s = (3.6 * turns).rem_euclid(1.0) / (3.6 * (10.0 + 5.0 * t));
        (-since_s / 1e-3).exp() * (TAU * 4_000.0 * since_s).sin()
    };
    let signal: Vec<f64> = turns.iter().zip(&times).map(ring).collect();
    let found = Varying::of(&signal, rate_hz, &turns, (2_000.0, 9_000.0)).expect("a signal");
    let (first, last) = (found.speeds_rpm[0], found.speeds_rpm[found.speeds_rpm.len() - 1]);
    assert!((first - 600.0).abs() < 10.0 && (last - 1800.0).abs() < 10.0, "{first} {last}");
    let orders = found.orders.expect("enough turns");
    // Impacts are short: their second harmonic is as high as the first, and above the range of the search.
    let below = (5.4 / orders.grid_hz) as usize;
    let columns: Vec<&[f64]> = orders.values.chunks_exact(orders.lines).collect();
    // A column into which no segment falls has no numbers.
    let told: Vec<&&[f64]> = columns.iter().filter(|column| column[2].is_finite()).collect();
    assert!(told.len() + 1 >= columns.len(), "{} of {}", told.len(), columns.len());
    for column in told {
        let highest = (2..below).max_by(|a, b| column[*a].total_cmp(&column[*b])).expect("lines");
        assert!((highest as f64 * orders.grid_hz - 3.6).abs() <= 0.3, "{highest}");
    }
}

#[test]
fn by_hand_turns_between_pulses() {
    let (range, turns) = turns_between(&[1.5, 3.5, 7.5], 2.0, 20);
    assert_eq!(range, 2..8);
    assert_eq!(turns, [0.25, 0.75, 1.125, 1.375, 1.625, 1.875]);
    assert!(turns_between(&[], 2.0, 20).1.is_empty());
}
