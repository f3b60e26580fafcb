//! Signals over the angle of a shaft: order tracking and the time-synchronous average.

use crate::error::check_signal;
use crate::{Error, Result};

/// A signal at equal angles.
#[derive(Debug, Clone, PartialEq)]
pub struct OverAngle {
    /// Samples a turn.
    pub samples_per_turn: usize,
    /// Whole turns, one after the other.
    pub values: Vec<f64>,
}

/// Samples `signal`, taken at a constant rate, at equal angles between the `pulses` of a tachometer: times of one pulse a
/// turn, in samples, ascending. Within a turn the speed is taken as constant; between samples the signal follows the cubic
/// through its four neighbours (Catmull and Rom 1974).
///
/// # Errors
/// [`Error::TooShort`] for fewer than two pulses, no samples a turn or fewer than four samples, [`Error::NotFinite`],
/// [`Error::Undefined`] for pulses that do not ascend or leave the record.
pub fn order_track(signal: &[f64], pulses: &[f64], samples_per_turn: usize) -> Result<OverAngle> {
    check_signal(signal, 4, "order tracking")?;
    let short = |field, len, least| Error::TooShort { field, len, least, purpose: "order tracking" };
    if pulses.len() < 2 {
        return Err(short("pulses", pulses.len(), 2));
    }
    if samples_per_turn == 0 {
        return Err(short("samples_per_turn", 0, 1));
    }
    let ascend = pulses.windows(2).all(|pair| pair[1] > pair[0]);
    let last = (signal.len() - 1) as f64;
    if !ascend || pulses[0] < 0.0 || pulses[pulses.len() - 1] > last {
        let why = "pulses must ascend and lie in the record; check the tachometer's channel";
        return Err(Error::Undefined { quantity: "angle of the shaft", why });
    }
    let mut values = Vec::with_capacity((pulses.len() - 1) * samples_per_turn);
    for turn in pulses.windows(2) {
        let step = (turn[1] - turn[0]) / samples_per_turn as f64;
        values.extend((0..samples_per_turn).map(|n| between(signal, turn[0] + n as f64 * step)));
    }
    Ok(OverAngle { samples_per_turn, values })
}

impl OverAngle {
    /// Number of whole turns.
    pub fn turns(&self) -> usize {
        self.values.len() / self.samples_per_turn
    }

    /// Time-synchronous average: the mean turn. What is not locked to the shaft falls as one over the root of the turns.
    pub fn average(&self) -> Vec<f64> {
        let mut mean = vec![0.0; self.samples_per_turn];
        for turn in self.values.chunks_exact(self.samples_per_turn) {
            mean.iter_mut().zip(turn).for_each(|(sum, x)| *sum += x);
        }
        let turns = self.turns() as f64;
        mean.iter_mut().for_each(|sum| *sum /= turns);
        mean
    }

    /// What the average leaves: everything that is not locked to the shaft.
    pub fn residual(&self) -> Vec<f64> {
        let mean = self.average();
        self.values.iter().zip(mean.iter().cycle()).map(|(x, m)| x - m).collect()
    }
}

/// Value at a place between samples; the ends repeat.
fn between(signal: &[f64], at: f64) -> f64 {
    let below = (at.floor() as usize).min(signal.len() - 2);
    let t = at - below as f64;
    let sample = |n: isize| signal[(below as isize + n).clamp(0, signal.len() as isize - 1) as usize];
    let [a, b, c, d] = [-1, 0, 1, 2].map(sample);
    b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn example_a_line_of_a_shaft_that_speeds_up_stands_still_over_the_angle() {
        // Turns of 100, 99, … samples; three waves a turn.
        let mut pulses = vec![2.0];
        (0..40).for_each(|n| pulses.push(pulses[n] + 100.0 - n as f64));
        let mut signal = vec![0.0; 3400];
        for turn in pulses.windows(2) {
            for n in turn[0].ceil() as usize..turn[1].ceil() as usize {
                signal[n] = (3.0 * TAU * (n as f64 - turn[0]) / (turn[1] - turn[0])).sin();
            }
        }
        let tracked = order_track(&signal, &pulses, 64).unwrap();
        assert_eq!(tracked.turns(), 40);
        // The cubic is off by (2π·3/60)³/16 of the amplitude at the fastest turn, more next to a change of speed.
        for (n, x) in tracked.average().iter().enumerate() {
            assert!((x - (3.0 * TAU * n as f64 / 64.0).sin()).abs() < 5e-3, "{n}: {x}");
        }
        assert!(tracked.residual().iter().all(|x| x.abs() < 3e-2));
    }

    #[test]
    fn refuses_pulses_that_are_none() {
        let signal = vec![1.0; 100];
        assert!(order_track(&signal, &[5.0], 8).is_err());
        assert!(order_track(&signal, &[5.0, 4.0], 8).is_err());
        assert!(order_track(&signal, &[5.0, 400.0], 8).is_err());
        assert!(order_track(&signal, &[5.0, 9.0], 0).is_err());
    }
}
