//! Runs and records side by side.

use std::f64::consts::TAU;

use stribeck_analysis::comparison::{Comparison, Side, Verdict};
use stribeck_diagnosis::STANDARD_GRAVITY;
use stribeck_diagnosis::{Analysis, Machine};
use stribeck_dsp::channel::Channel;
use stribeck_testing::Noise;
use stribeck_theory::catalogue::CatalogueBearing;

/// Impacts of the outer raceway of a 6205 at 1200 rpm, `height` times as strong as the noise.
fn record(label: &str, height: f64, unit: &str, scale: f64, seed: u64) -> Side {
    let (rate_hz, mut noise) = (12_800.0, Noise::new(seed));
    let samples = (0..65_536).map(|n| {
        let since = (f64::from(n) / rate_hz).rem_euclid(1.0 / 71.7);
        scale * (noise.uniform() + height * (-since / 1e-3).exp() * (TAU * 3_000.0 * since).sin())
    });
    let channel = Channel::held("housing", samples.collect()).in_unit(Some(unit.to_owned()));
    let bearing = CatalogueBearing::parse("6205").expect("of the catalogue");
    let machine = Machine { speed_rpm: Some(1200.0), bearing: Some(bearing), ..Machine::default() };
    Side::of_record(label, &Analysis::of(&channel, rate_hz, &machine).expect("a valid record"))
}

#[test]
fn planted_a_sound_and_a_damaged_record_in_two_units_of_acceleration() {
    let damaged = record("damaged", 3.0, "m/s²", STANDARD_GRAVITY, 5);
    let both = Comparison::of(vec![record("sound", 0.0, "g", 1.0, 4), damaged]).expect("two records");
    let row = |name: &str| both.rows.iter().find(|row| row.name == name);
    let rms = row("rms").expect("of both");
    let [sound, damaged] = [0, 1].map(|n| rms.values[n].expect("of both").mean);
    // Uniform noise from −1 to 1 or half of that has its closed form; the damaged one has more.
    assert!(damaged > 1.2 * sound && damaged < 5.0 * sound, "{sound} {damaged}");
    assert_eq!(rms.unit, "g");
    let contrast = rms.against_first[0].expect("of both");
    assert_eq!((contrast.verdict, contrast.low), (Verdict::Unknown, None));
    assert!((contrast.difference - (damaged - sound)).abs() < 1e-12);
    let bpfo = row("bpfo_db").expect("of the damaged one");
    assert!(bpfo.values[1].is_some() && bpfo.against_first == [None]);
    assert!(both.sides[1].verdict.contains("outer raceway"), "{}", both.sides[1].verdict);
    assert!(both.fields.is_empty() && both.numbers.is_empty());
    let (band_hz, own) = (both.band_hz().expect("a claim"), both.sides[1].members[0].claimed());
    assert!(own.into_iter().any(|family| family.band_hz == Some(band_hz)));
    let (envelope, found_hz) = both.sides[0].envelope(band_hz).expect("long enough");
    assert!(found_hz == band_hz && envelope.values.len() > 100);
    assert!(both.is_of_one_speed());
}

#[test]
fn refuses_to_compare_levels_in_volts_with_levels_in_g() {
    let sides = vec![record("a", 0.0, "V", 1.0, 4), record("b", 0.0, "g", 1.0, 5)];
    let both = Comparison::of(sides).expect("two records");
    assert!(both.rows.iter().all(|row| row.name != "rms") && !both.rows.is_empty());
    assert!(both.notes[0].contains("a is in V, b is in g"), "{}", both.notes[0]);
}
