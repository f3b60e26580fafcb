//! The distance of two events that follow each other.

use std::f64::consts::TAU;

use stribeck_dsp::{Error, EventSpacing, event_spacing, passage_spacing};
use stribeck_testing::Noise;

const RATE_HZ: f64 = 40_000.0;

/// Pairs of bursts `apart_s` from one another that ring at two frequencies and die away with `decay_s`,
/// 60 times a second and never quite on time, in noise.
fn pairs(apart_s: f64, decay_s: f64) -> Vec<f64> {
    unequal(apart_s, decay_s, 1.5)
}

/// The same, the second burst `louder` times the first.
fn unequal(apart_s: f64, decay_s: f64, louder: f64) -> Vec<f64> {
    let mut noise = Noise::new(11);
    let mut signal: Vec<f64> = (0..120_000).map(|_| 0.2 * noise.uniform()).collect();
    for k in 1..170 {
        let at = (f64::from(k) + 0.02 * noise.uniform()) / 60.0;
        let rings = [(at, 3.0, 9_000.0), (at, 2.0, 13_000.0)];
        let again = rings.map(|(at, strength, hz)| (at + apart_s, louder * strength, hz));
        for (start, strength, hz) in rings.into_iter().chain(again) {
            let first = (start * RATE_HZ).ceil() as usize;
            for n in first..(first + 80).min(signal.len()) {
                let since = n as f64 / RATE_HZ - start;
                signal[n] += strength * (-since / decay_s).exp() * (TAU * hz * since).sin();
            }
        }
    }
    signal
}

#[test]
fn planted_the_distance_of_pairs_is_found() {
    for apart_s in [1.5e-3, 3.1e-3] {
        let found = event_spacing(&pairs(apart_s, 0.2e-3), RATE_HZ, 0.5e-3, 7e-3).unwrap();
        let EventSpacing::Pairs(found) = found else { panic!("{found:?}") };
        // Bursts rise within a quarter of a period, and not alike: a few samples.
        assert!((found.lag_s - apart_s).abs() < 0.1e-3, "{found:?}");
    }
}

/// A second event of a twenty-fifth of the first one’s energy drowns in the correlation.
#[test]
fn planted_a_weak_second_event_shows_where_the_rhythm_is_known() {
    for louder in [0.2, 5.0] {
        let signal = unequal(3.1e-3, 0.2e-3, louder);
        let blind = event_spacing(&signal, RATE_HZ, 0.5e-3, 7e-3).unwrap();
        assert!(!matches!(blind, EventSpacing::Pairs(_)), "{blind:?}");
        let found = passage_spacing(&signal, RATE_HZ, 60.0, 0.5e-3, 7e-3).unwrap();
        let EventSpacing::Pairs(found) = found else { panic!("{louder}: {found:?}") };
        assert!((found.lag_s - 3.1e-3).abs() < 0.1e-3 && found.uncertainty_s >= 0.1e-3, "{found:?}");
    }
}

/// A second event that stands twice above what lies between passages in one band only.
#[test]
fn planted_a_faint_second_event_shows_in_both_bands_together() {
    let found = passage_spacing(&unequal(3.1e-3, 0.2e-3, 0.16), RATE_HZ, 60.0, 0.5e-3, 8e-3).unwrap();
    let EventSpacing::Pairs(found) = found else { panic!("{found:?}") };
    assert!((found.lag_s - 3.1e-3).abs() < 0.1e-3, "{found:?}");
    // At a tenth of the strength it is no higher than what scatters.
    let found = passage_spacing(&unequal(3.1e-3, 0.2e-3, 0.08), RATE_HZ, 60.0, 0.5e-3, 8e-3).unwrap();
    assert!(!matches!(found, EventSpacing::Pairs(_)), "{found:?}");
}

/// Half of a period is looked at, where an event is as far from the passage before as from the next.
#[test]
fn planted_a_second_event_halfway_between_passages_shows() {
    let found = passage_spacing(&unequal(8.2e-3, 0.2e-3, 0.4), RATE_HZ, 60.0, 0.5e-3, 0.5 / 60.0).unwrap();
    let EventSpacing::Pairs(found) = found else { panic!("{found:?}") };
    assert!((found.lag_s - 8.2e-3).abs() < 0.1e-3, "{found:?}");
}

/// An element that is let go strikes twice, the second time louder: the entry is the first of them.
#[test]
fn planted_an_event_of_two_peaks_begins_with_the_first() {
    let first = unequal(5e-3, 0.2e-3, 0.5);
    let second = unequal(5.5e-3, 0.2e-3, 0.6);
    let signal: Vec<f64> = first.iter().zip(&second).map(|(x, y)| 0.5 * (x + y)).collect();
    let found = passage_spacing(&signal, RATE_HZ, 60.0, 0.5e-3, 8e-3).unwrap();
    let EventSpacing::Pairs(found) = found else { panic!("{found:?}") };
    assert!((found.lag_s - 5e-3).abs() < 0.1e-3, "{found:?}");
}

/// A body that bounces at the second event strikes twice within a millisecond, both times louder
/// than the next one that enters.
#[test]
fn planted_a_bounce_is_not_taken_for_the_second_event() {
    let weak = unequal(5e-3, 0.2e-3, 0.75);
    let bounce = unequal(0.75e-3, 0.2e-3, 0.9);
    let signal: Vec<f64> = weak.iter().zip(&bounce).map(|(x, y)| 0.5 * (x + y)).collect();
    let found = passage_spacing(&signal, RATE_HZ, 60.0, 0.5e-3, 7e-3).unwrap();
    let EventSpacing::Pairs(found) = found else { panic!("{found:?}") };
    assert!((found.lag_s - 5e-3).abs() < 0.1e-3, "{found:?}");
}

#[test]
fn planted_a_known_rhythm_makes_no_second_event() {
    let signal = pairs(0.0, 0.6e-3);
    let blind = event_spacing(&signal, RATE_HZ, 0.5e-3, 7e-3).unwrap();
    assert_eq!(passage_spacing(&signal, RATE_HZ, 60.0, 0.5e-3, 7e-3).unwrap(), blind);
    // Of noise alone nothing is made, whatever rhythm is looked for.
    let mut source = Noise::new(5);
    for seed in 0..20 {
        let noise: Vec<f64> = (0..40_000 + 977 * seed).map(|_| source.uniform()).collect();
        let found = passage_spacing(&noise, RATE_HZ, 50.0 + seed as f64, 0.5e-3, 7e-3).unwrap();
        assert_eq!(found, EventSpacing::Unknown, "{seed}");
    }
}

#[test]
fn refuses_a_distance_beyond_half_of_a_period() {
    let beyond = passage_spacing(&pairs(3e-3, 0.2e-3), RATE_HZ, 60.0, 0.5e-3, 9e-3);
    assert!(matches!(beyond, Err(Error::Undefined { .. })));
}

#[test]
fn planted_single_events_say_what_would_have_shown() {
    let found = event_spacing(&pairs(0.0, 0.6e-3), RATE_HZ, 0.5e-3, 7e-3).unwrap();
    // Bursts die away with 0.6 ms, their energy with 0.3 ms.
    assert!(
        matches!(found, EventSpacing::Alone { clear_from_s } if (0.5e-3..1.5e-3).contains(&clear_from_s)),
        "{found:?}"
    );
    // Ringing longer than half of the examined lags hides a second event.
    let found = event_spacing(&pairs(0.0, 0.6e-3), RATE_HZ, 0.5e-3, 0.9e-3).unwrap();
    assert_eq!(found, EventSpacing::Unknown);
}

#[test]
fn planted_noise_cannot_tell() {
    let mut noise = Noise::new(7);
    let quiet: Vec<f64> = pairs(3e-3, 0.2e-3).iter().map(|x| 0.02 * x + noise.uniform()).collect();
    assert_eq!(event_spacing(&quiet, RATE_HZ, 0.5e-3, 7e-3).unwrap(), EventSpacing::Unknown);
}

#[test]
fn refuses_distances_that_are_not_ordered_and_short_records() {
    let ramp: Vec<f64> = (0..4000).map(|n| f64::from(n * n % 977)).collect();
    assert!(matches!(event_spacing(&ramp, RATE_HZ, 0.5e-3, 0.4e-3), Err(Error::Undefined { .. })));
    assert!(matches!(event_spacing(&ramp[..100], RATE_HZ, 0.5e-3, 7e-3), Err(Error::TooShort { .. })));
}
