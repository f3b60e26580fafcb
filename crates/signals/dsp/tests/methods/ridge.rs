//! The line of a shaft that speeds up.

use std::f64::consts::TAU;

use stribeck_dsp::{Error, Ridge, Spectrogram, WelchOptions, order_track, ridge, spectrogram};
use stribeck_testing::Noise;

const RATE_HZ: f64 = 2_000.0;

/// A shaft from 20 to 30 Hz in 20 s, and the turns it has made after `t` seconds.
fn turned(t: f64) -> f64 {
    20.0 * t + 0.25 * t * t
}

/// Lines at its speed and at three times that, in noise of twice their power.
fn ramp() -> Vec<f64> {
    let mut noise = Noise::new(7);
    (0..40_000)
        .map(|n| {
            let angle = TAU * turned(f64::from(n) / RATE_HZ);
            angle.sin() + 0.5 * (3.0 * angle + 1.0).sin() + 2.0 * noise.uniform()
        })
        .collect()
}

fn followed(signal: &[f64]) -> Ridge {
    let options = WelchOptions { overlap: 1_500, nfft: 8_000, ..WelchOptions::new(2_000) };
    let spectra = spectrogram(signal, RATE_HZ, &options).unwrap().between(15.0, 40.0);
    ridge(&spectra, 2.0).unwrap()
}

#[test]
fn planted_a_ramp_is_followed_to_its_angle() {
    let signal = ramp();
    let found = followed(&signal);
    assert!(found.height_db > 15.0, "{}", found.height_db);
    for (t, hz) in found.times_s.iter().zip(&found.frequencies_hz) {
        assert!((hz - (20.0 + 0.5 * t)).abs() < 0.15, "{t} s: {hz} Hz");
    }
    let turns = found.turns(RATE_HZ, signal.len(), 1.0).unwrap();
    // 500 turns in all. The ends are carried on at constant speed: half a segment at 0.5 Hz/s is 1/16 of
    // a turn.
    assert!((498..=501).contains(&turns.len()), "{}", turns.len());
    let drift: Vec<f64> = turns.iter().enumerate().map(|(n, at)| turned(at / RATE_HZ) - n as f64).collect();
    let (least, most) = drift.iter().fold((9.0_f64, -9.0_f64), |(l, m), d| (l.min(*d), m.max(*d)));
    assert!(most - least < 0.2, "{least} to {most} turns");
    // Over the angle the line at three times the speed stands still.
    let tracked = order_track(&signal, &turns, 64).unwrap();
    let mean = tracked.average();
    let share = |order: f64| {
        let (c, s) = mean.iter().enumerate().fold((0.0, 0.0), |(c, s), (n, x)| {
            let angle = TAU * order * n as f64 / 64.0;
            (c + x * angle.cos(), s + x * angle.sin())
        });
        2.0 * (c * c + s * s).sqrt() / 64.0
    };
    assert!(share(1.0) > 0.95 && share(3.0) > 0.4 && share(2.0) < 0.15, "{} {}", share(1.0), share(3.0));
}

#[test]
fn planted_noise_has_no_high_ridge() {
    let mut noise = Noise::new(99);
    let signal: Vec<f64> = (0..40_000).map(|_| 0.5 * noise.uniform()).collect();
    let height = followed(&signal).height_db;
    assert!(height < 10.0, "{height}");
}

#[test]
fn refuses_what_has_no_ridge() {
    let flat =
        Spectrogram { times_s: vec![0.0, 1.0], frequencies_hz: vec![1.0, 2.0, 3.0], values: vec![0.0; 6] };
    assert!(matches!(ridge(&flat, 1.0), Err(Error::Undefined { .. })));
    assert!(matches!(ridge(&flat, 0.0), Err(Error::NotPositive { .. })));
    let narrow = Spectrogram { frequencies_hz: vec![1.0], values: vec![1.0; 2], ..flat };
    assert!(matches!(ridge(&narrow, 1.0), Err(Error::TooShort { field: "frequencies_hz", .. })));
}
