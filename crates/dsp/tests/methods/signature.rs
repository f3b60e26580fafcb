//! Numbers of repeated passages that do not depend on the path to the sensor.

use std::f64::consts::TAU;

use stribeck_dsp::{Rhythm, Signature};
use stribeck_testing::Noise;

const RATE_HZ: f64 = 25_600.0;

const RHYTHM: Rhythm =
    Rhythm { passing_hz: 80.0, modulating_hz: [15.0, 6.0], shortest_s: 0.4e-3, longest: 0.45 };

/// Pairs of clicks 3 ms apart, never quite on time, the second one `louder_db` above the first, through a
/// resonance, in noise.
fn record(hz: f64, louder_db: f64, slip: f64, depth: f64) -> Vec<f64> {
    let mut noise = Noise::new(3);
    let mut force = vec![0.0; 2 * Signature::samples_of_piece(RATE_HZ, RHYTHM)];
    let mut at = 0.002;
    while ((at + 0.004) * RATE_HZ) < force.len() as f64 {
        let strength = 1.0 + depth * (TAU * RHYTHM.modulating_hz[0] * at).cos();
        force[(at * RATE_HZ) as usize] += strength;
        force[((at + 0.003) * RATE_HZ) as usize] += strength * 10_f64.powf(louder_db / 20.0);
        at += (1.0 + slip * (noise.share() - 0.5)) / RHYTHM.passing_hz;
    }
    let (decay, turn) = ((-TAU * 0.03 * hz / RATE_HZ).exp(), TAU * hz / RATE_HZ);
    let (mut before, mut last) = (0.0, 0.0);
    let through = |f: f64| {
        let now = 2.0 * decay * turn.cos() * last - decay * decay * before + f;
        (before, last) = (last, now);
        now + 0.3 * f
    };
    let sounds: Vec<f64> = force.into_iter().map(through).collect();
    sounds.into_iter().map(|x| x + 0.01 * (noise.share() - 0.5)).collect()
}

fn of(record: &[f64]) -> Signature {
    Signature::of(record, RATE_HZ, RHYTHM).expect("long enough")
}

#[test]
fn invariant_a_path_leaves_the_signature_alone() {
    let [a, b] = [4_100.0, 7_300.0].map(|hz| of(&record(hz, 6.0, 0.02, 0.0)));
    let expected = 3e-3 * RHYTHM.passing_hz;
    let hump = |s: &Signature| {
        let humps = s.within.iter().zip(Signature::within_at()).filter(|(_, lag)| *lag > 0.15);
        humps.max_by(|a, b| a.0.total_cmp(b.0)).map_or(0.0, |(_, lag)| lag)
    };
    for found in [a, b] {
        assert!((hump(&found) - expected).abs() < 0.02, "{found:?}");
        assert!((found.spacing.expect("pairs") / expected - 1.0).abs() < 0.02, "{found:?}");
        let order = found.first_over_second_db.expect("pairs");
        assert!((order + 6.0).abs() < 2.0, "{found:?}");
    }
    assert!((a.repeats - b.repeats).abs() < 0.2 && (a.swing / b.swing - 1.0).abs() < 0.2, "{a:?} {b:?}");
}

#[test]
fn planted_order_slip_and_load_zone_are_told() {
    let plain = of(&record(4_100.0, 6.0, 0.02, 0.0));
    let turned = of(&record(4_100.0, -6.0, 0.02, 0.0));
    assert!(turned.first_over_second_db > plain.first_over_second_db.map(|db| db + 8.0));
    let slips = of(&record(4_100.0, 6.0, 0.06, 0.0));
    assert!(slips.repeats < 0.7 * plain.repeats, "{slips:?} {plain:?}");
    assert!(slips.repeats_later < 0.8 * plain.repeats_later, "{slips:?} {plain:?}");
    let zone = of(&record(4_100.0, 6.0, 0.02, 0.9));
    assert!(zone.sidebands_db[0] > plain.sidebands_db[0] + 6.0, "{zone:?} {plain:?}");
    assert!((zone.sidebands_db[1] - plain.sidebands_db[1]).abs() < 6.0, "{zone:?} {plain:?}");
}

#[test]
fn refuses_a_record_of_few_passages() {
    let why = Signature::of(&[0.0; 2000], RATE_HZ, RHYTHM).expect_err("short").to_string();
    assert!(why.contains("passages that repeat") && why.contains("9600"), "{why}");
}
