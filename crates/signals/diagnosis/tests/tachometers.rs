//! Tachometers as they are: pulses of any shape and height, wheels, angles, and speeds over time.

use stribeck_diagnosis::speed::tacho::{Turns, of, of_angle, pulses, turns};
use stribeck_dsp::channel::Channel;
use stribeck_testing::{Noise, assert_refused};

#[test]
fn planted_pulses_give_the_speed_between_samples() {
    // 1234 rpm, pulses of a tenth of a turn, sampled 1000 times a second.
    let pulse = |n: usize| (1234.0 / 60.0 * n as f64 / 1e3).fract();
    let samples = (0..10_000).map(|n| if pulse(n) < 0.1 { 5.0 } else { 0.1 }).collect();
    let found = turns(&Channel::held("tacho", samples), 1e3).unwrap();
    // Each edge is off by half a sample at most: 1 ms over 9.9 s.
    assert!((found.rpm / 1234.0 - 1.0).abs() < 1.1e-4, "{found:?}");
    assert_eq!(found.count, 204);
    assert!(found.variation < 0.05, "{found:?}");
}

#[test]
fn planted_an_angle_gives_pulses_and_the_mean_speed() {
    // From 10 to 30 turns a second, counter-clockwise, in a second of 10 000 samples.
    let angle =
        (0..10_000).map(|n| 1e-4 * f64::from(n)).map(|t| std::f64::consts::TAU * (10.0 * t + 10.0 * t * t));
    let found = of_angle(&Channel::held("shaft.angle_rad", angle.collect()), 1e4).unwrap();
    assert!((found.rpm / 1200.0 - 1.0).abs() < 2e-3, "{}", found.rpm);
    assert_eq!((found.count, found.pulses.len()), (19, 1199));
    assert!((found.variation - 1.0).abs() < 0.02, "{}", found.variation);
    // The first turn is over when 10 t + 10 t² = 1.
    let turn = 1e4 * (0.35_f64.sqrt() - 0.5);
    assert!((found.pulses[59] - turn).abs() < 1e-2, "{} {turn}", found.pulses[59]);
    let back = Channel::held("shaft.angle_rad", vec![0.0, 1.0, 0.5]);
    assert!(of_angle(&back, 1.0).unwrap_err().to_string().contains("turns back"));
    assert_refused(of_angle(&Channel::held("shaft.angle_rad", vec![0.0; 9]), 1.0), "a twentieth of a turn");
}

/// Pulses of a tenth of a turn at 1200 rpm, 12 800 samples a second, `n` turns; `keep` says whether turn
/// k has one.
fn wheel(n: usize, keep: impl Fn(usize) -> bool) -> Vec<f64> {
    let turn = |at: usize| at as f64 / 640.0 + 0.003;
    (0..640 * n).map(|at| f64::from(turn(at).fract() < 0.1 && keep(turn(at) as usize))).collect()
}

#[test]
fn planted_missing_and_double_pulses_are_bridged_and_noted() {
    let one = turns(&Channel::held("tacho", wheel(26, |k| k != 12)), 12_800.0).unwrap();
    assert!((one.rpm / 1200.0 - 1.0).abs() < 1e-4 && one.variation < 0.01, "{one:?}");
    assert!(
        one.notes[0].contains("a pulse is missing, at 0.5999 s") && one.notes.len() == 1,
        "{:?}",
        one.notes
    );
    let missing = |all: &'static [usize]| {
        turns(&Channel::held("tacho", wheel(60, move |k| !all.contains(&k))), 12_800.0)
    };
    let three = missing(&[7, 21, 50]).unwrap();
    assert!(
        (three.rpm / 1200.0 - 1.0).abs() < 1e-4 && three.notes[0].contains("3 pulses are missing"),
        "{three:?}"
    );
    // More than a twentieth.
    assert_refused(missing(&[7, 21, 30, 50]), "4 of 60 pulses are missing");
    let mut double = wheel(26, |_| true);
    double[640 * 9 + 200..640 * 9 + 210].fill(1.0);
    let double = turns(&Channel::held("tacho", double), 12_800.0).unwrap();
    assert!((double.rpm / 1200.0 - 1.0).abs() < 1e-4, "{double:?}");
    assert!(double.notes[0].contains("a pulse is too many, at 0.465"), "{:?}", double.notes);
    let teeth = pulses(&Channel::held("tacho", wheel(120, |_| true)), 12_800.0, 60).unwrap();
    assert!((teeth.rpm / 20.0 - 1.0).abs() < 1e-4 && teeth.count == 1, "{teeth:?}");
}

#[test]
fn planted_noise_and_sparks_are_no_pulses() {
    let mut noise = Noise::new(1);
    let mut samples: Vec<f64> =
        wheel(40, |_| true).into_iter().map(|x| 5.0 * x + 0.75 * noise.uniform()).collect();
    samples[5000] = 90.0;
    let found = turns(&Channel::held("tacho", samples), 12_800.0).unwrap();
    assert!((found.rpm / 1200.0 - 1.0).abs() < 1e-3 && found.count >= 38, "{found:?}");
}

#[test]
fn refuses_a_tachometer_that_is_none() {
    let mut noise = Noise::new(1);
    let samples = (0..20_000).map(|_| noise.share()).collect();
    assert_refused(turns(&Channel::held("tacho", samples), 12_800.0), "no speed follows");
}

#[test]
fn refuses_a_channel_without_pulses() {
    assert!(
        turns(&Channel::held("tacho", vec![1.0; 100]), 1e3).unwrap_err().to_string().contains("no pulse")
    );
}

/// Pulses of a tenth of a turn of the shape `height(turn)`, and what lies below them.
fn shaped(n: usize, height: impl Fn(usize) -> f64, base: impl Fn(usize) -> f64) -> Vec<f64> {
    let turn = |at: usize| at as f64 / 640.0 + 0.003;
    let pulse = |at: usize| if turn(at).fract() < 0.1 { height(turn(at) as usize) } else { 0.0 };
    (0..640 * n).map(|at| base(at) + pulse(at)).collect()
}

/// Holds a tachometer of 1200 rpm that does not vary; a half of a sample on either side of 640.
#[track_caller]
fn even(name: &str, samples: Vec<f64>, turns_at_least: usize) -> Turns {
    let found =
        turns(&Channel::held("tacho", samples), 12_800.0).unwrap_or_else(|why| panic!("{name}: {why}"));
    assert!((found.rpm / 1200.0 - 1.0).abs() < 1e-3, "{name}: {found:?}");
    assert!(found.variation < 0.01 && found.count >= turns_at_least, "{name}: {found:?}");
    found
}

#[test]
fn issue_pulses_of_changing_height_on_a_base_line_that_drifts() {
    let flat = |_: usize| 0.0;
    // Between 2.2 and 5, without a period.
    let changing = |k: usize| 2.2 + 2.8 * (0.618_034 * k as f64).fract();
    for (name, samples) in [
        ("heights differ by half", shaped(60, changing, flat)),
        ("depths differ by half", shaped(60, |k| -changing(k), |_| 5.0)),
        ("downwards", shaped(60, |_| -3.0, |_| 5.0)),
        ("heights grow with the record", shaped(60, |k| 0.1 + 0.08 * k as f64, flat)),
        ("a base line that drifts by two heights", shaped(60, |_| 1.0, |n| 2.0 * n as f64 / 38_400.0)),
        ("a base line that swings", shaped(60, |_| 1.0, |n| 1.5 * (n as f64 / 12_000.0).sin())),
        ("a base line that swings by two heights", shaped(60, |_| 1.0, |n| (n as f64 / 1_850.0).sin())),
        ("volts on 12", shaped(60, |_| 5.0, |_| 12.0)),
    ] {
        let found = even(name, samples, 57);
        assert!(found.notes.is_empty(), "{name}: {:?}", found.notes);
    }
    // Through a capacitor: y' = x' − y/τ, with τ a tenth of a pulse, ten pulses, and 100 turns.
    for tau in [6.4, 640.0, 64_000.0] {
        let (mut y, mut last) = (0.0, 0.0);
        let coupled = shaped(60, |_| 5.0, flat).into_iter().map(|x| {
            y = (y + x - last) / (1.0 + 1.0 / tau);
            last = x;
            y
        });
        even(&format!("coupled with {tau} samples"), coupled.collect(), 57);
    }
}

#[test]
fn issue_one_sample_a_turn_is_a_pulse() {
    // A pulse of one sample, every 6000 of 600 000: more rare than one in a thousand.
    for height in [5.0, -5.0] {
        let samples = (0..600_000).map(|n| if n % 6000 == 77 { height } else { 0.0 }).collect();
        let found = turns(&Channel::held("tacho", samples), 12_800.0).unwrap();
        assert!((found.rpm / 128.0 - 1.0).abs() < 1e-9 && found.count == 99, "{height}: {}", found.rpm);
    }
    // A spark the other way does not hide them.
    let mut samples = wheel(40, |_| true);
    samples[5000] = -90.0;
    even("a spark downwards", samples, 37);
}

#[test]
fn issue_of_two_pulses_the_one_out_of_place_is_left_out() {
    // A glitch of three samples at every part of a turn, the first and the last turn too.
    for at in [3, 20, 39] {
        for part in [0.15, 0.3, 0.5, 0.6, 0.75, 0.85, 0.95] {
            let mut samples = wheel(41, |_| true);
            let from = 640 * at + (640.0 * part) as usize;
            samples[from..from + 3].fill(1.0);
            let found = even(&format!("turn {at}, part {part}"), samples, 37);
            assert!(found.notes.len() == 1 && found.notes[0].contains("too many"), "{:?}", found.notes);
        }
    }
}

#[test]
fn issue_teeth_are_uneven_and_few_samples_wide() {
    // 60 teeth at 3000 rpm: 4.27 samples each.
    let samples = (0..64_000).map(|n| f64::from((n as f64 * 3000.0 / 12_800.0).fract() < 0.5)).collect();
    let found = pulses(&Channel::held("tacho", samples), 12_800.0, 60).unwrap();
    assert!(
        (found.rpm / 3000.0 - 1.0).abs() < 1e-4 && found.variation < 0.005,
        "{} {}",
        found.rpm,
        found.variation
    );
    // With one pulse a turn it would be 180 000 rpm.
    let told = turns(
        &Channel::held("tacho", (0..64_000).map(|n| f64::from(u8::from(n % 4 < 2))).collect()),
        12_800.0,
    );
    assert!(told.unwrap().notes[0].contains("`--pulses-per-turn`"));
    // Two marks a turn at 0 and 0.3; and a wheel of 60 teeth of which two are missing.
    let two = |n: usize| (n as f64 / 640.0).fract();
    let samples = (0..64_000).map(|n| f64::from(two(n) < 0.05 || (0.3..0.35).contains(&two(n)))).collect();
    let found = pulses(&Channel::held("tacho", samples), 12_800.0, 2).unwrap();
    assert!((found.rpm / 1200.0 - 1.0).abs() < 1e-3 && found.variation < 0.01, "{found:?}");
    let tooth = |n: usize| (n as f64 / 2560.0).fract() * 60.0;
    let samples = (0..128_000).map(|n| f64::from(tooth(n) < 58.0 && tooth(n).fract() < 0.5)).collect();
    let found = pulses(&Channel::held("tacho", samples), 12_800.0, 60).unwrap();
    assert!(
        (found.rpm / 300.0 - 1.0).abs() < 1e-3 && found.variation < 0.01,
        "{} {}",
        found.rpm,
        found.variation
    );
    assert_eq!(found.notes, [""; 0]);
}

/// Wheels whose pulses are unevenly apart, the same way each turn of 640 samples: the turns are those in which the
/// distances recur, whether they were counted with or without the teeth that are missing.
#[test]
fn issue_wheels_with_long_gaps_are_counted_by_their_turns() {
    let of = |teeth: f64, there: f64, per_turn: u32| {
        let tooth = |n: usize| ((n as f64 / 640.0).fract() * teeth).min(teeth - 1e-9);
        let samples = (0..64_000).map(|n| f64::from(tooth(n) < there && tooth(n).fract() < 0.5)).collect();
        pulses(&Channel::held("tacho", samples), 12_800.0, per_turn)
    };
    for (teeth, there, per_turn) in
        [(60.0, 58.0, 58), (60.0, 58.0, 60), (4.0, 3.0, 3), (4.0, 3.0, 4), (36.0, 35.0, 35)]
    {
        let found = of(teeth, there, per_turn).unwrap();
        assert!(
            (found.rpm / 1200.0 - 1.0).abs() < 2e-3 && found.variation < 0.01,
            "{teeth} {per_turn}: {}",
            found.rpm
        );
        assert_eq!(found.notes, [""; 0], "{teeth} {per_turn}");
    }
    assert_refused(of(60.0, 58.0, 36), "recur every 58");
    // Two pulses a turn, and one was said.
    let two = |n: usize| (n as f64 / 640.0).fract();
    let samples = (0..64_000).map(|n| f64::from(two(n) < 0.05 || (0.3..0.35).contains(&two(n)))).collect();
    let found = turns(&Channel::held("tacho", samples), 12_800.0).unwrap();
    assert!((found.rpm / 1200.0 - 1.0).abs() < 2e-3 && found.notes[0].contains("recur every 2"), "{found:?}");
}

#[test]
fn issue_a_speed_ends_where_pulses_end() {
    let mut samples = wheel(60, |_| true);
    samples[640 * 30..].fill(0.0);
    let found = turns(&Channel::held("tacho", samples), 12_800.0).unwrap();
    assert!(
        (found.rpm / 1200.0 - 1.0).abs() < 1e-3 && found.notes[0].contains("no pulses after 1.50 s"),
        "{found:?}"
    );
    // A line of 1024 pulses a turn, 20 480 a second.
    let samples = (0..64_000).map(|n| f64::from((n as f64 * 20_480.0 / 12_800.0).fract() < 0.5)).collect();
    assert_refused(pulses(&Channel::held("tacho", samples), 12_800.0, 1024), "no speed follows");
}

#[test]
fn issue_an_angle_that_begins_anew_each_turn() {
    for low in [0.0, -std::f64::consts::PI] {
        let angle = (0..64_000).map(|n| low + (n as f64 / 640.0).fract() * std::f64::consts::TAU).collect();
        let found = of_angle(&Channel::held("a_rad", angle), 12_800.0).unwrap();
        assert!((found.rpm / 1200.0 - 1.0).abs() < 1e-6 && found.count == 99, "{found:?}");
    }
}

#[test]
fn issue_a_speed_over_time_is_no_tachometer_of_pulses() {
    // From 1100 to 1300 rpm in 10 s, 100 samples a second.
    let speed = |n: usize| 1100.0 + 0.2 * n as f64;
    let held = |name: &str, factor: f64| Channel::held(name, (0..=1000).map(|n| factor * speed(n)).collect());
    for (channel, is_speed) in [
        (held("Drehzahl", 1.0).in_unit(Some("1/min".into())), true),
        (held("n", std::f64::consts::TAU / 60.0).in_unit(Some("rad/s".into())), true),
        (held("Speed (rpm)", 1.0), true),
        (held("shaft_rpm", -1.0), true),
        (held("rpm_hz", 1.0 / 60.0), true),
        (held("omega_rad_s", std::f64::consts::TAU / 60.0), true),
        (held("sampling_speed_hz", 1.0 / 60.0), false),
        (held("tacho", 1.0), false),
        (held("rpm", 1.0).in_unit(Some("V".into())), false),
    ] {
        match of(&channel, 100.0, 1.0) {
            Ok(found) => {
                assert!(is_speed && (found.rpm / 1200.0 - 1.0).abs() < 1e-3, "{}: {found:?}", channel.name);
                // 200 turns, sixty pulses each; the speed at the end less that at the beginning.
                assert!(
                    (found.variation - 200.0 / 1200.0).abs() < 2e-3 && found.count >= 199,
                    "{}",
                    found.count
                );
            }
            Err(why) => assert!(!is_speed, "{}: {why}", channel.name),
        }
    }
    // Pulses of a channel that is called so.
    let called = of(&Channel::held("rpm", wheel(40, |_| true)), 12_800.0, 1.0).unwrap();
    assert!((called.rpm / 1200.0 - 1.0).abs() < 1e-3, "{}", called.rpm);
    let stopped = held("n", 1.0).in_unit(Some("rpm".into()));
    let why = of(
        &Channel::held("n", [&[0.0; 5][..], &stopped.read().unwrap()].concat()).in_unit(stopped.unit.clone()),
        100.0,
        1.0,
    );
    assert!(why.unwrap_err().to_string().contains("stands still at 0.0000 s"));
    // A speed by its name alone, in which values are missing: no pulses, and no speed of a shaft.
    for (mark, told) in [(0.0, "stands still"), (-1.0, "stands still"), (32_767.0, "which no shaft does")] {
        let marked = (0..10_000).map(|n| if n % 1000 == 999 { mark } else { 1200.0 }).collect();
        let why = of(&Channel::held("n_rpm", marked), 12_800.0, 1.0).unwrap_err().to_string();
        assert!(why.contains(told), "{mark}: {why}");
    }
}

/// It had to be a whole number.
#[test]
fn issue_pulses_of_a_shaft_of_a_gear_are_no_whole_number_a_turn() {
    for each_turn in [1.5, 0.4, 2.25] {
        let pulse = |n: usize| (each_turn * 1200.0 / 60.0 * n as f64 / 12_800.0).fract();
        let samples = (0..64_000).map(|n| f64::from(pulse(n) < 0.1)).collect();
        let found = of(&Channel::held("tacho", samples), 12_800.0, each_turn).unwrap();
        assert!((found.rpm / 1200.0 - 1.0).abs() < 1e-4, "{each_turn}: {}", found.rpm);
        // All turns but those before the first pulse and behind the last.
        assert!((found.count as f64 - 99.0).abs() <= 2.0 / each_turn, "{each_turn}: {}", found.count);
    }
}
