//! Where a roller is unloaded and loaded again.

use stribeck_analysis::events::{Passage, crossings, pick};

const INTERVAL: f64 = 1e-5;
const PASSAGE: Passage =
    Passage { entry_s: 0.84e-3, exit_s: 5.08e-3, middle_s: 2.96e-3, smoothing_s: 0.214e-3 };
/// A twentieth of a millisecond: the median moves a step under a strong tone by a fraction of the tone's
/// period.
const TOLERANCE_S: f64 = 0.05e-3;

/// 10 kN, unloaded from `entry` to `exit`, with a facet tone of 60 %, deterministic noise of 20 % and a
/// shock of 25 kN on the floor that lasts 0.06 ms.
fn force(entry: f64, exit: f64, samples: usize) -> (Vec<f64>, Vec<f64>) {
    let mut seed = 1u64;
    (0..samples)
        .map(|n| {
            let t = n as f64 * INTERVAL;
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let noise = (seed >> 40) as f64 / (1u64 << 24) as f64 - 0.5;
            let loaded = if (entry..exit).contains(&t) { 0.0 } else { 10e3 };
            let tone = 0.6 * (std::f64::consts::TAU * 4671.0 * t).sin();
            let floor = if (entry + 0.8e-3..entry + 0.86e-3).contains(&t) { 25e3 } else { 0.0 };
            (t, (loaded * (1.0 + tone + 0.4 * noise)).max(0.0) + floor)
        })
        .unzip()
}

#[test]
fn planted_events_are_found_under_facet_noise_and_a_floor_shock() {
    let (entry, exit) = (1.1e-3, 4.8e-3);
    let (time, force) = force(entry, exit, 800);
    let picked = pick(&time, &force, &PASSAGE);
    assert!(picked.notes.is_empty(), "{:?}", picked.notes);
    assert!((picked.entry_s.unwrap() - entry).abs() < TOLERANCE_S, "{:?}", picked);
    assert!((picked.exit_s.unwrap() - exit).abs() < TOLERANCE_S, "{:?}", picked);
}

#[test]
fn planted_a_trapped_roller_has_no_exit_and_says_why() {
    let (time, force) = force(1.1e-3, 1.0, 3000);
    let picked = pick(&time, &force, &PASSAGE);
    assert!(picked.exit_s.is_none() && picked.entry_s.is_some());
    assert!(picked.notes[0].contains("less than half its load until the search ends"), "{:?}", picked.notes);
}

#[test]
fn planted_a_record_that_ends_early_invents_no_event() {
    let (time, force) = force(1.1e-3, 4.8e-3, 350);
    let picked = pick(&time, &force, &PASSAGE);
    assert!(picked.entry_s.is_some() && picked.exit_s.is_none());
    assert!(picked.notes[0].contains("the record ends"), "{:?}", picked.notes);
    let (time, force) = (&time[..20], &force[..20]);
    assert!(pick(time, force, &PASSAGE).notes[0].contains("no level to compare"));
    assert_eq!(pick(&[], &[], &PASSAGE).entry_s, None);
}

#[test]
fn planted_a_sound_raceway_gives_no_event() {
    let (time, force) = force(2.0, 3.0, 800);
    let picked = pick(&time, &force, &PASSAGE);
    assert_eq!((picked.entry_s, picked.exit_s), (None, None));
}

#[test]
fn by_hand_crossings_of_a_steady_rotation() {
    // 94° at −1351.4672 °/s passes 92.86479° after 0.84 ms and again one turn later.
    let time: Vec<f64> = (0..30_000).map(|n| n as f64 * INTERVAL).collect();
    let rate = -1_351.467_194_2_f64.to_radians();
    let angle: Vec<f64> = time.iter().map(|t| 94f64.to_radians() + rate * t).collect();
    let found = crossings(&time, &angle, (90.0 + 2.864_788_98f64).to_radians());
    assert_eq!(found.len(), 2);
    assert!((found[0] - 0.839_984e-3).abs() < 1e-8, "{}", found[0]);
    assert!((found[1] - found[0] - std::f64::consts::TAU / rate.abs()).abs() < 1e-8);
}
