//! What a record could have shown, and what it then lets one conclude: made records.

use std::f64::consts::PI;

use stribeck_diagnosis::joint::Joint;
use stribeck_diagnosis::pool::Pool;
use stribeck_diagnosis::series::Series;
use stribeck_diagnosis::{Analysis, Answer, Defect, Machine, MeasuredFindings};
use stribeck_dsp::channel::Channel;
use stribeck_testing::Noise;
use stribeck_theory::catalogue::CatalogueBearing;

use crate::signals::*;

fn white(seed: u64, samples: usize) -> Vec<f64> {
    let mut noise = Noise::new(seed);
    (0..samples).map(|_| gaussian(&mut noise)).collect()
}

fn analysis(samples: Vec<f64>, rate_hz: f64, machine: &Machine) -> Analysis {
    Analysis::of(&Channel::held("a", samples), rate_hz, machine).unwrap()
}

/// Impacts 3 dB above the limit of a record are claimed and those 3 dB below it are not, in nine of ten.
#[test]
fn planted_impacts_are_claimed_within_three_decibels_of_the_limit() {
    const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;
    let machine = machine(1200.0);
    let is_within = |seed: &u64| {
        let noise = white(*seed, SAMPLES);
        let found = judged(noise.clone(), &machine);
        let outer = family(&found, Defect::Bpfo);
        let limit = outer.limit.unwrap_or_else(|| panic!("{outer:?}"));
        let (low_hz, high_hz) = limit.band_hz;
        let decay_s = 1.0 / (high_hz - low_hz);
        let samples = (8.0 * decay_s * RATE_HZ) as usize;
        let ring = Ring { hz: 0.5 * (low_hz + high_hz), decay_s, samples, ..RING };
        let claims = |peak: f64| {
            let mut signal = noise.clone();
            ring.add_all(&mut signal, &mut Noise::new(99), outer.expected_hz, |_| peak);
            claimed(&judged(signal, &machine)) == ["BPFO"]
        };
        !claims(HALF * limit.peak) && claims(limit.peak / HALF)
    };
    let within = (1..=10).filter(is_within).count();
    assert!(within >= 9, "{within} of 10");
}

/// Eight records of a tenth of a second.
fn series(strength: f64) -> Series {
    const RATE_HZ: f64 = 25_600.0;
    let bearing = CatalogueBearing::parse("elements=13, diameter_mm=3.5, pitch_mm=25.6").ok();
    let machine = Machine { speed_rpm: Some(1800.0), bearing, ..Machine::default() };
    let ring = Ring { rate_hz: RATE_HZ, hz: 5_000.0, decay_s: 0.5e-3, samples: 100 };
    let mut pool = Pool::new(8, 0);
    let of = |at: usize| {
        let mut signal = white(at as u64 + 1, 2_560);
        ring.add_all(&mut signal, &mut Noise::new(at as u64 + 50), 168.35, |_| strength);
        let analysis = analysis(signal, RATE_HZ, &machine);
        pool.add(at, &analysis);
        analysis.findings
    };
    let findings: Vec<MeasuredFindings> = (0..8).map(of).collect();
    let all: Vec<Option<&MeasuredFindings>> = findings.iter().map(Some).collect();
    Series::of(&all, 0, &pool.judged())
}

/// A steady machine with a resonance: impacts as strong as spalls make would have been claimed.
#[test]
fn planted_no_defect_is_said_with_the_impacts_that_would_show() {
    let found = judged(coloured(3, 4 * SAMPLES), &machine(1200.0));
    assert_eq!(found.conclusion.raceways.answer, Answer::NoDefect, "{found:#?}");
    assert_eq!(found.conclusion.elements.answer, Answer::CannotTell, "{found:#?}");
    assert!(found.verdict.starts_with("No defect of a raceway whose impacts exceed"), "{}", found.verdict);
    assert!(
        found.verdict.contains("of damaged rolling elements this method finds one in"),
        "{}",
        found.verdict
    );
}

#[test]
fn planted_short_records_are_judged_together() {
    let noise = series(0.0);
    assert_eq!(noise.conclusion.raceways.answer, Answer::CannotTell, "{noise:#?}");
    assert!(
        noise.verdict.contains("cannot tell") && !noise.verdict.contains("o defect"),
        "{}",
        noise.verdict
    );
    let impacts = series(4.0);
    assert!(impacts.families[0].claimed && impacts.families[0].pooled == Some(8), "{impacts:#?}");
    assert_eq!(impacts.conclusion.raceways.answer, Answer::Defect);
}

/// Impacts of ten times the noise, 0.56 s apart: a small part of its power.
#[test]
fn planted_rare_impacts_of_a_slow_machine_are_claimed() {
    const SAMPLES: usize = 22 * 12_800;
    let slow = machine(30.0);
    let outer_hz = 0.5 * slow.bearing.as_ref().unwrap().orders().unwrap().bpfo;
    let mut signal = white(1, SAMPLES);
    RING.add_all(&mut signal, &mut Noise::new(2), outer_hz, |_| 10.0);
    assert_eq!(claimed(&judged(signal, &slow)), ["BPFO"]);
    let healthy = judged(white(3, SAMPLES), &slow);
    assert!(claimed(&healthy).is_empty(), "{healthy:#?}");
    assert_eq!(healthy.conclusion.raceways.answer, Answer::CannotTell, "{healthy:#?}");
}

/// A comb 3 % above the outer raceway: a defect of it, at another speed or rate.
#[test]
fn planted_a_comb_beside_a_raceway_is_a_hypothesis_with_a_name() {
    let place_hz = 3.585 * 20.0;
    let exact = Machine { speed_is_exact: true, ..machine(1200.0) };
    let found =
        judged(sum([(1.0, impacts(1.03 * place_hz, SAMPLES, |_| 1.0)), (1.0, coloured(5, SAMPLES))]), &exact);
    assert!(claimed(&found).is_empty(), "{found:#?}");
    assert!(found.verdict.contains("it is the outer raceway, if the speed is 1236 rpm"), "{}", found.verdict);
    assert_eq!(found.conclusion.raceways.answer, Answer::CannotTell);
}

#[test]
fn issue_a_speed_in_hertz_is_asked_about() {
    let of = |samples| sum([(2.0, impacts(3.585 * 20.0, samples, |_| 1.0)), (1.0, coloured(5, samples))]);
    let found = judged(of(2 * SAMPLES), &machine(20.0));
    assert!(found.verdict.contains("Is the speed 20 Hz, not 20 rpm?"), "{}", found.verdict);
    assert_ne!(found.conclusion.raceways.answer, Answer::NoDefect);
}

#[test]
fn issue_one_channel_twice_is_one_witness() {
    let signal = sum([(1.0, impacts(3.585 * 20.0, SAMPLES, |_| 1.0)), (1.0, coloured(5, SAMPLES))]);
    let one = analysis(signal, RATE_HZ, &machine(1200.0));
    let joint = Joint::of(&[("1".to_owned(), &one), ("2".to_owned(), &one)]).unwrap();
    assert!(joint.notes.iter().any(|note| note.contains("`1` and `2` hold the same samples")), "{joint:?}");
    assert_eq!(joint.channels, ["1"]);
    // Later, turned round, amplified, with a little noise.
    let mut noise = Noise::new(3);
    let copy = one.beginning.iter().skip(37).map(|x| -0.5 * x + 1e-4 * noise.uniform()).collect();
    let copy = analysis(copy, RATE_HZ, &machine(1200.0));
    let joint = Joint::of(&[("1".to_owned(), &one), ("2".to_owned(), &copy)]).unwrap();
    assert_eq!(joint.channels, ["1"]);
    let other = analysis(coloured(6, SAMPLES), RATE_HZ, &machine(1200.0));
    assert_eq!(Joint::of(&[("1".to_owned(), &one), ("2".to_owned(), &other)]).unwrap().channels, ["1", "2"]);
}

/// Where a filter has taken everything away, impacts would stand above next to nothing, and no machine makes them there.
#[test]
fn issue_what_a_filter_took_away_shows_no_healthy_raceway() {
    const TAPS: usize = 256;
    // Half of the range passes: a sinc under a Hann window.
    let tap = |n: usize| {
        let t = n as f64 - 0.5 * TAPS as f64;
        let sinc = if t == 0.0 { 0.5 } else { (0.5 * PI * t).sin() / (PI * t) };
        sinc * (PI * n as f64 / TAPS as f64).sin().powi(2)
    };
    let taps: Vec<f64> = (0..=TAPS).map(tap).collect();
    let noise = white(7, SAMPLES + TAPS);
    let filtered: Vec<f64> =
        noise.windows(TAPS + 1).map(|part| part.iter().zip(&taps).map(|(x, tap)| x * tap).sum()).collect();
    let all = judged(noise, &machine(1200.0));
    assert_eq!(all.conclusion.raceways.answer, Answer::CannotTell, "{all:#?}");
    let found = judged(filtered, &machine(1200.0));
    assert_eq!(found.conclusion.raceways.answer, Answer::CannotTell, "{found:#?}");
    let (_, high_hz) = found.conclusion.raceways.limit_band_hz.unwrap();
    assert!(high_hz <= 0.26 * RATE_HZ, "{found:#?}");
}

/// A 6205 whose outer ring turns with its shaft standing: the cage at half the speed times 1 + d/D.
#[test]
fn by_hand_the_cage_of_a_turning_outer_ring() {
    let machine = Machine { outer_speed_rpm: -1200.0, ..machine(1200.0) };
    let found = judged(coloured(1, SAMPLES), &machine);
    let expected_hz = 0.5 * 20.0 * (1.0 + 7.94 / 39.04);
    let cage_hz = family(&found, Defect::Ftf).expected_hz;
    assert!((cage_hz - expected_hz).abs() < 1e-3 * expected_hz, "{cage_hz}");
}
