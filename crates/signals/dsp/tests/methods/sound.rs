//! A signal as a loudspeaker plays it.

use std::f64::consts::TAU;

use stribeck_dsp::{Error, Sound};

/// Largest sample over full scale: a decibel of headroom.
const LOUDEST: f64 = 0.891;

/// Zero crossings upwards in the middle of a sound, a second.
fn pitch_hz(sound: &Sound) -> f64 {
    let n = sound.samples.len();
    let middle = &sound.samples[n / 8..n - n / 8];
    let crossings = middle.windows(2).filter(|pair| pair[0] < 0 && pair[1] >= 0).count();
    crossings as f64 * f64::from(sound.rate_hz) / middle.len() as f64
}

#[test]
fn planted_a_tone_keeps_its_pitch_and_slowed_it_sinks() {
    let rate = 97_656.25;
    let tone: Vec<f64> =
        (0..97_656).map(|n| 40.0 + 3.0 * (TAU * 1_500.0 * f64::from(n) / rate).sin()).collect();
    for (played, slow) in [(48_000, 1.0), (44_100, 1.0), (48_000, 4.0)] {
        let sound = Sound::of(&tone, rate, played, slow).unwrap();
        // A crossing more or less in three quarters of a second or more.
        assert!((pitch_hz(&sound) - 1_500.0 / slow).abs() < 2.0, "{played} {slow}: {}", pitch_hz(&sound));
        assert!((sound.duration_s() - slow).abs() < 1e-3, "{}", sound.duration_s());
        let peak = sound.samples.iter().map(|x| x.unsigned_abs()).max().unwrap();
        assert_eq!(peak, (LOUDEST * f64::from(i16::MAX)).round() as u16);
        // Its amplitude of 3 is that peak, but for the ripple of the filter.
        assert!((sound.full_scale * LOUDEST - 3.0).abs() < 0.01, "{}", sound.full_scale);
        assert_eq!(sound.samples[0], 0);
    }
}

#[test]
fn refuses_silence_and_what_is_far_too_slow() {
    assert!(matches!(Sound::of(&[2.0; 100], 1_000.0, 48_000, 1.0), Err(Error::Undefined { .. })));
    assert!(matches!(Sound::of(&[], 1_000.0, 48_000, 1.0), Err(Error::TooShort { .. })));
    assert!(matches!(
        Sound::of(&[1.0, f64::NAN], 1_000.0, 48_000, 1.0),
        Err(Error::NotFinite { index: 1, .. })
    ));
    assert!(matches!(
        Sound::of(&[1.0, 2.0], 1_000.0, 48_000, 0.0),
        Err(Error::NotPositive { field: "slow", .. })
    ));
    assert!(matches!(Sound::of(&[1.0, 2.0], 1_000.0, 48_000, 1_000.0), Err(Error::Undefined { .. })));
}
