//! Samples that sensor, converter or recorder have spoilt, and those that are no record of a signal: what is said of
//! them, and that neither a defect nor its absence follows.

use std::f64::consts::TAU;

use proptest::prelude::*;
use stribeck_diagnosis::record::quality::{self, Kind, Quality};
use stribeck_diagnosis::{Analysis, Machine};
use stribeck_dsp::channel::Channel;
use stribeck_testing::Noise;
use stribeck_testing::damage::cases;
use stribeck_theory::catalogue::CatalogueBearing;

const RATE_HZ: f64 = 12_800.0;
const COUNT: usize = 1 << 16;

/// Nearly Gaussian, of unit variance.
fn gaussian(noise: &mut Noise) -> f64 {
    (0..12).map(|_| noise.share()).sum::<f64>() - 6.0
}

/// Noise, and impacts that ring at 3 kHz: a valid record of a damaged bearing.
fn sound() -> Vec<f64> {
    let mut noise = Noise::new(5);
    let ring = |s: f64| 3.0 * (-s / 1e-3).exp() * (TAU * 3000.0 * s).sin();
    (0..COUNT).map(|n| 0.4 * gaussian(&mut noise) + ring((n as f64 / RATE_HZ) % (1.0 / 71.7))).collect()
}

/// The findings but for lines of the mains.
fn found(samples: &[f64]) -> Vec<Quality> {
    let mut found = quality::of(&Channel::held("a", samples.to_vec()), RATE_HZ, None).unwrap();
    found.retain(|of| of.kind != Kind::Hum);
    found
}

fn kinds(samples: &[f64]) -> Vec<Kind> {
    found(samples).into_iter().map(|of| of.kind).collect()
}

/// Up to 11 of 100 samples at a rail in runs of one to three had no word.
#[test]
fn issue_clipping_in_short_runs_is_found_by_its_density() {
    let x = sound();
    let (mut dither, lsb) = (Noise::new(9), 0.8 / 2048.0);
    let clip = |low: f64, high: f64| x.iter().map(|x| x.clamp(low, high)).collect::<Vec<f64>>();
    let hard = clip(-0.8, 0.8);
    let stepped = |samples: Vec<f64>| samples.into_iter().map(|x| (x / lsb).round() * lsb).collect();
    let held: Vec<f64> = (0..COUNT).map(|n| hard[n / 4 * 4]).collect();
    for (name, samples, sides) in [
        ("hard", hard.clone(), 2.0),
        ("12 bits", stepped(clip(-0.8, 0.8 - lsb)), 2.0),
        ("dither", hard.iter().map(|x| x + 2e-4 * gaussian(&mut dither)).collect(), 2.0),
        ("more of it", hard.iter().map(|x| x + 1e-3 * gaussian(&mut dither)).collect(), 2.0),
        ("one side", clip(f64::NEG_INFINITY, 0.8), 1.0),
        ("whole numbers", hard.iter().map(|x| (x * 40_960.0).round().min(32_767.0)).collect(), 2.0),
        ("held fourfold", held, 2.0),
        (
            "a glitch beyond",
            hard.iter().enumerate().map(|(n, x)| if n == 777 { 9.0 } else { *x }).collect(),
            2.0,
        ),
    ] {
        let mut all = found(&samples);
        // Samples that stand many times are called so, too.
        all.retain(|of| of.kind != Kind::Pattern || name != "held fourfold");
        assert!(all.len() == 1 && all[0].kind == Kind::Clipped, "{name}: {all:?}");
        let share =
            x.iter().filter(|x| **x >= 0.8 || sides > 1.0 && **x <= -0.8).count() as f64 / COUNT as f64;
        assert!((all[0].share / share - 1.0).abs() < 0.1, "{name}: {} of {share}", all[0].share);
    }
    // A rail that a sample in four hundred reaches.
    assert_eq!(kinds(&clip(-2.5, 2.5)), [Kind::Clipped]);
}

#[test]
fn issue_filled_gaps_and_dead_channels_are_named() {
    let x = sound();
    let gap = |fill: &dyn Fn(usize) -> f64, length: usize| {
        let mut y = x.clone();
        for from in (5000..65_000).step_by(10_000) {
            (from..from + length).for_each(|n| y[n] = fill(from));
        }
        y
    };
    let share = |samples: &[f64], kind: Kind| {
        let all = found(samples);
        assert!(all.len() == 1 && all[0].kind == kind, "{kind:?}: {all:?}");
        all[0].share
    };
    let part = |n: usize| n as f64 / COUNT as f64;
    let near = |a: f64, b: f64| assert!((a - b).abs() < 2e-4, "{a} {b}");
    near(share(&gap(&|_| 0.0, 800), Kind::Held), part(4800));
    near(share(&gap(&|_| 0.0, 50), Kind::Held), part(300));
    near(share(&gap(&|_| 0.0, 20), Kind::Held), part(120));
    // A few zeros at a time, and zeros in a signal that never comes near them.
    let often = |every: usize, length: usize| {
        (0..COUNT).map(|n| if n % every < length { 0.0 } else { x[n] }).collect::<Vec<f64>>()
    };
    near(share(&often(1000, 8), Kind::Marked), part(8 * COUNT.div_ceil(1000)));
    let offset: Vec<f64> = gap(&|_| -9.81, 800).iter().map(|x| x + 9.81).collect();
    near(share(&offset, Kind::Held), part(4800));
    near(share(&gap(&|at| x[at - 1], 800), Kind::Held), part(4806));
    near(share(&gap(&|_| -999.0, 800), Kind::Held), part(4800));
    near(share(&gap(&|_| 1e6, 800), Kind::Held), part(4800));
    let tail = |value: &dyn Fn(f64) -> f64| {
        x.iter().enumerate().map(|(n, x)| if n < 40_000 { *x } else { value(*x) }).collect::<Vec<f64>>()
    };
    near(share(&tail(&|_| 0.0), Kind::Dead), part(COUNT - 40_000));
    near(share(&tail(&|_| 7.0), Kind::Dead), part(COUNT - 40_000));
    assert!((share(&tail(&|x| 1e-4 * x), Kind::Dead) - 0.39).abs() < 0.02);
    let bridged: Vec<f64> = (0..COUNT)
        .map(|n| if (20_000..20_800).contains(&n) { x[20_000] + (n - 20_000) as f64 * 1e-4 } else { x[n] })
        .collect();
    near(share(&bridged, Kind::Held), part(800));
}

#[test]
fn issue_converters_amplifiers_and_means_are_named() {
    let x = sound();
    let rounded = |step: f64| x.iter().map(|x| (x / step).round() * step).collect::<Vec<f64>>();
    assert_eq!(kinds(&rounded(1.0)), [Kind::FewLevels]);
    let mut at = 0.0;
    let slow: Vec<f64> = x
        .iter()
        .map(|x| {
            at += (x - at).clamp(-0.25, 0.25);
            at
        })
        .collect();
    assert_eq!(kinds(&slow), [Kind::SlewLimited]);
    let moved = |by: &dyn Fn(f64) -> f64| {
        x.iter().enumerate().map(|(n, x)| x + by(n as f64 / RATE_HZ)).collect::<Vec<f64>>()
    };
    assert_eq!(kinds(&moved(&|s| 5.0 * s)), [Kind::Drift]);
    assert_eq!(kinds(&moved(&|s| 10.0 * (-s).exp())), [Kind::Drift]);
    assert_eq!(kinds(&moved(&|_| 500.0)), []);
}

/// What looks like these, and is none of them.
#[test]
fn behaves_sound_records_have_no_findings() {
    let x = sound();
    let of = |make: &dyn Fn(f64) -> f64| (0..COUNT).map(|n| make(n as f64 / RATE_HZ)).collect::<Vec<f64>>();
    let impact = |s: f64| 3.0 * (-s / 1e-3).exp() * (TAU * 3000.0 * s).sin();
    for (name, samples) in [
        ("noise and impacts", x.clone()),
        ("12 bits", x.iter().map(|x| (x / 0.01).round() * 0.01).collect()),
        ("48 levels", x.iter().map(|x| (x / 0.15).round() * 0.15).collect()),
        ("sine", of(&|s| (TAU * 100.3 * s).sin())),
        ("sine in step with the samples", of(&|s| (TAU * 100.0 * s).sin())),
        ("beating", of(&|s| (1.0 + 0.5 * (TAU * 3.0 * s).sin()) * (TAU * 1000.7 * s).sin())),
        ("impacts without noise", of(&|s| impact(s % (1.0 / 71.7)))),
        (
            "impacts in step with the samples",
            (0..COUNT).map(|n| impact((n % 180) as f64 / RATE_HZ)).collect(),
        ),
    ] {
        assert_eq!(found(&samples), [], "{name}");
    }
}

#[test]
fn planted_lines_of_the_mains_and_power_below_half_the_rate_are_named() {
    let mut noise = Noise::new(3);
    let mut with = |hz: f64, height: f64, third: f64| -> Vec<f64> {
        let of = |n: usize, hz: f64| (TAU * hz * n as f64 / RATE_HZ).sin();
        (0..COUNT).map(|n| gaussian(&mut noise) + height * of(n, hz) + third * of(n, 3.0 * hz)).collect()
    };
    let named = |samples: &[f64], rpm| {
        let all = quality::of(&Channel::held("a", samples.to_vec()), RATE_HZ, rpm).unwrap();
        all.into_iter().map(|of| of.kind).find(|kind| *kind == Kind::Hum)
    };
    assert_eq!(named(&with(50.0, 0.5, 0.2), None), Some(Kind::Hum));
    assert_eq!(named(&with(60.02, 3.0, 0.0), Some(1200.0 * 1.1)), Some(Kind::Hum));
    assert_eq!(named(&with(50.0, 3.0, 0.5), Some(3000.0)), None, "the shaft turns as fast");
    assert_eq!(named(&with(48.0, 3.0, 0.5), None), None);
    assert_eq!(named(&with(50.0, 0.0, 0.0), None), None);
    // A strong line of the machine beside a harmonic of a weak hum is none of it, and the harmonic is.
    for (hz, is_hum) in [(301.5, None), (300.0, Some(Kind::Hum))] {
        let line = |n: usize| 2.0 * (TAU * hz * n as f64 / RATE_HZ).sin();
        let samples: Vec<f64> = with(60.0, 0.2, 0.0).iter().enumerate().map(|(n, x)| x + line(n)).collect();
        assert_eq!(named(&samples, None), is_hum, "{hz}");
    }
    let high = with(6200.0, 2.0, 0.0);
    let record = |samples: Vec<f64>| {
        let channel = Channel::held("a", samples);
        Analysis::of(&channel, RATE_HZ, &Machine::default()).unwrap().findings.quality
    };
    assert!(record(high).iter().any(|of| of.kind == Kind::Aliased));
    assert_eq!(record(with(3000.0, 2.0, 0.0)), []);
}

#[test]
fn behaves_a_verdict_says_that_it_rests_on_spoilt_samples() {
    let clipped: Vec<f64> = sound().iter().map(|x| x.clamp(-0.8, 0.8)).collect();
    let channel = Channel::held("a", clipped);
    let findings = Analysis::of(&channel, RATE_HZ, &Machine::default()).unwrap().findings;
    assert!(
        findings.verdict.contains("are damaged") && findings.verdict.contains("clipped ("),
        "{}",
        findings.verdict
    );
    assert!(findings.notes.iter().any(|note| note.starts_with("clipped:")), "{:?}", findings.notes);
}

/// A record of so many samples with impacts of an outer raceway of a 6205 at 1200 rpm that ring at 3 kHz.
fn impacts(seed: u64, count: usize, height: f64) -> Vec<f64> {
    let mut noise = Noise::new(seed);
    let ring = |s: f64| height * (-s / 1e-3).exp() * (TAU * 3000.0 * s).sin();
    (0..count).map(|n| 0.4 * gaussian(&mut noise) + ring((n as f64 / RATE_HZ) % (1.0 / 71.696))).collect()
}

fn machine() -> Machine {
    Machine { bearing: CatalogueBearing::parse("6205").ok(), speed_rpm: Some(1200.0), ..Machine::default() }
}

/// Whole numbers of `bits` bits that begin again at the other end.
fn wrapped(x: f64, bits: i32) -> f64 {
    let all = f64::from(bits).exp2();
    (x.round() + 0.5 * all).rem_euclid(all) - 0.5 * all
}

/// What recorders make of a valid record: each is no record of a signal.
fn spoilt(x: &[f64], how: usize, part: f64) -> (Kind, Vec<f64>) {
    let count = x.len();
    let whole = |factor: f64| x.iter().map(|x| (factor * x).round()).collect::<Vec<f64>>();
    let at = (part * 0.5 * count as f64) as usize + count / 4;
    let mut noise = Noise::new(count as u64 + at as u64);
    let some = |value: f64, mut x: Vec<f64>, noise: &mut Noise| {
        x.iter_mut().filter(|_| noise.share() < 0.02 + 0.05 * part).for_each(|x| *x = value);
        x
    };
    // Where the values begin anew: one in fifty to one in five does.
    let mut sizes: Vec<f64> = x.iter().map(|x| x.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let end = sizes[((0.98 - 0.18 * part) * count as f64) as usize];
    let bytes = |x: f64| f64::from(((x.clamp(-32_768.0, 32_767.0)) as i16).swap_bytes());
    match how {
        0 => (Kind::Wrapped, x.iter().map(|x| wrapped(x / end * 32_768.0, 16)).collect()),
        1 => (Kind::Wrapped, x.iter().map(|x| 1e-4 * wrapped(x / end * 2048.0, 12)).collect()),
        2 => (Kind::SignLost, whole(1000.0).iter().map(|x| x.rem_euclid(65_536.0)).collect()),
        3 => (Kind::SignLost, whole(250.0).iter().map(|x| x.rem_euclid(4096.0)).collect()),
        4 => (Kind::SignLost, x.iter().map(|x| x.abs()).collect()),
        5 => (Kind::Swapped, whole(2000.0 + 4000.0 * part).into_iter().map(bytes).collect()),
        6 => (Kind::Pattern, (0..count).map(|n| x[n / 2 * 2]).collect()),
        7 => (Kind::Pattern, (0..count).map(|n| x[n / 4 * 4]).collect()),
        8 => (Kind::Pattern, (0..count).map(|n| if n % 2 == 0 { x[n] } else { 0.0 }).collect()),
        9 => (Kind::Pattern, (0..count).map(|n| if n % 4 == 0 { x[n] } else { 0.0 }).collect()),
        10 => {
            (Kind::Pattern, (0..count).map(|n| if n % 2 == 0 { x[n] } else { 0.3 * x[count - n] }).collect())
        }
        11 => {
            let block = 256 + (part * 2000.0) as usize;
            let twice = |n: usize| if (at..at + block).contains(&n) { x[n - block] } else { x[n] };
            (Kind::Repeated, (0..count).map(twice).collect())
        }
        12 => (Kind::Repeated, (0..count).map(|n| x[n % (count / 2)]).collect()),
        13 => (Kind::Marked, some(0.0, x.to_vec(), &mut noise)),
        14 => (Kind::Marked, some(-1.0, x.to_vec(), &mut noise)),
        15 => (Kind::Marked, some(32_767.0, whole(2000.0), &mut noise)),
        16 => (Kind::Marked, x.iter().map(|x| if x.abs() < 0.1 + 0.3 * part { 0.0 } else { *x }).collect()),
        17 => (Kind::Jump, (0..count).map(|n| if n < at { x[n] } else { 10.0 * x[n] }).collect()),
        18 => (Kind::Jump, (0..count).map(|n| if n < at { x[n] } else { 8.0 + x[n] }).collect()),
        19 => {
            let bytes = |x: f64| f64::from((x as i32).swap_bytes());
            (Kind::Swapped, whole(2e6 + 4e6 * part).into_iter().map(bytes).collect())
        }
        20 => {
            let (apart, run) = (200 + (800.0 * part) as usize, 1 + (7.0 * part) as usize);
            (Kind::Marked, (0..count).map(|n| if n % apart < run { -999.0 } else { x[n] }).collect())
        }
        21 => {
            let apart = 100 + (200.0 * part) as usize;
            (Kind::Marked, (0..count).map(|n| if n % apart == 7 { 0.0 } else { x[n] }).collect())
        }
        22 => (Kind::Pattern, (0..count).map(|n| (n % 256) as f64 + 100.0 * part * x[n]).collect()),
        23 => {
            let slow = |n: usize| 2.0 * (2e-4 * (1.0 + part) * n as f64).sin();
            (Kind::DriftingRails, (0..count).map(|n| x[n].clamp(-0.6, 0.6) + slow(n)).collect())
        }
        24 => {
            let rail = |n: usize| 0.6 + 0.2 * (6e-4 * (0.1 + part) * n as f64).sin();
            (Kind::DriftingRails, (0..count).map(|n| x[n].clamp(-rail(n), rail(n))).collect())
        }
        _ => {
            let drift = |n: usize| 0.05 * (3.0 * n as f64 / count as f64).sin();
            (Kind::DriftingRails, (0..count).map(|n| x[n].clamp(-0.8, 0.8) + drift(n)).collect())
        }
    }
}

/// Ways to spoil a record.
const WAYS: usize = 26;

/// Each kind of damage is named as what it is; the undamaged record has no finding.
#[test]
fn planted_damage_of_each_kind_is_named() {
    let x = impacts(11, 1 << 15, 2.0);
    assert_eq!(found(&x), [], "undamaged");
    for how in 0..WAYS {
        for part in [0.0, 0.5, 1.0] {
            let (kind, samples) = spoilt(&x, how, part);
            let all = found(&samples);
            assert!(
                all.iter().any(|of| of.kind == kind && of.is_no_signal()),
                "{how} {part}: {kind:?}: {all:?}"
            );
        }
    }
    // A period of noise again and again.
    assert_eq!(kinds(&(0..COUNT).map(|n| x[n % 1024]).collect::<Vec<f64>>()), [Kind::Repeated]);
    assert_eq!(kinds(&(0..COUNT).map(|n| x[n / 2 / 16 * 16]).collect::<Vec<f64>>())[0], Kind::Pattern);
}

/// The remedy is in the words, and the headline is neither a claim nor that there is no defect.
#[test]
fn issue_a_sign_that_was_lost_is_no_verdict() {
    let x = impacts(1, 1 << 14, 2.0);
    let of =
        |samples: Vec<f64>| Analysis::of(&Channel::held("a", samples), RATE_HZ, &machine()).unwrap().findings;
    let signed: Vec<f64> = x.iter().map(|x| (1000.0 * x).round()).collect();
    let sound = of(signed.clone());
    assert!(sound.families.iter().any(|family| family.claimed), "{}", sound.verdict);
    for (bits, factor) in [(16, 1.0), (12, 0.25)] {
        let all = f64::from(bits).exp2();
        let lost = of(signed.iter().map(|x| (x * factor).trunc().rem_euclid(all)).collect());
        assert!(lost.verdict.starts_with("No verdict") && lost.is_no_signal(), "{}", lost.verdict);
        assert!(
            lost.verdict.contains(&format!("subtract {all} above {}", 0.5 * all - 1.0)),
            "{}",
            lost.verdict
        );
        assert!(lost.families.iter().all(|family| !family.claimed));
    }
}

proptest! {
    #![proptest_config(cases(1000))]

    /// Valid records that were wrapped, held, swapped, stuffed, doubled …: no claim, never "no defect".
    #[test]
    fn invariant_spoilt_records_claim_and_exclude_nothing(
        how in 0..WAYS, part in 0.0..1.0, seed in 1_u64..1_000_000, height in 0.0..4.0, bits in 13..15_u32,
    ) {
        let x = impacts(seed, 1 << bits, height);
        let (kind, samples) = spoilt(&x, how, part);
        let all = quality::of(&Channel::held("a", samples), RATE_HZ, Some(1200.0)).unwrap();
        prop_assert!(quality::no_signal(&all).is_some(), "{how} {kind:?} {part} {seed} {height} {bits}: {all:?}");
    }

    /// The same records as they were.
    #[test]
    fn invariant_valid_records_are_records_of_a_signal(
        seed in 1_u64..1_000_000, height in 0.0..4.0, bits in 13..15_u32, digits in 1..4_i32,
    ) {
        let unit = 10_f64.powi(digits);
        let x: Vec<f64> = impacts(seed, 1 << bits, height).iter().map(|x| (unit * x).round() / unit).collect();
        let all = quality::of(&Channel::held("a", x), RATE_HZ, Some(1200.0)).unwrap();
        prop_assert!(quality::no_signal(&all).is_none(), "{seed} {height} {bits} {digits}: {all:?}");
    }
}

/// Noise that was made, in five digits, and a signal of a converter so coarse that most samples are zero.
#[test]
fn behaves_noise_that_was_made_and_coarse_converters_are_signals() {
    let mut noise = Noise::new(7);
    let uniform: Vec<f64> = (0..COUNT).map(|_| (1e5 * noise.uniform()).round() / 1e5).collect();
    assert_eq!(quality::no_signal(&found(&uniform)), None);
    for step in [0.3, 0.6, 1.0] {
        let coarse: Vec<f64> = impacts(3, COUNT, 8.0).iter().map(|x| (x / step).round()).collect();
        assert_eq!(quality::no_signal(&found(&coarse)), None, "{step}");
    }
}
