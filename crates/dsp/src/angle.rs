//! Signals over the angle of a shaft: order tracking and the time-synchronous average.

use crate::error::{check_len, check_signal};
use crate::{Error, Result};

/// A signal at equal angles.
#[derive(Debug, Clone, PartialEq)]
pub struct OverAngle {
    /// Samples a turn.
    pub samples_per_turn: usize,
    /// Whole turns, one after the other.
    pub values: Vec<f64>,
}

/// Samples `signal`, taken at a constant rate, at equal angles between the `pulses` of a tachometer: times of
/// one pulse a turn, in samples, ascending. Within a turn the speed is taken as constant; between samples the
/// signal follows the cubic through its four neighbours (Catmull and Rom 1974).
///
/// # Errors
/// [`Error::TooShort`] for fewer than two pulses, no samples a turn or fewer than four samples,
/// [`Error::NotFinite`], [`Error::Undefined`] for pulses that do not ascend or leave the record.
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

/// Means of `signal`, taken at a constant rate, over equal steps of a shaft's angle: `steps_per_turn` of
/// them, as many as the record holds. `turns` is the angle at each sample, in turns, never falling; between
/// samples signal and angle follow straight lines. Every sample enters a mean, so that an envelope has no
/// aliases at any speed from rest on; samples taken at standstill have no weight. A line of `n` waves a turn
/// loses the factor sin x/x with x = π n/`steps_per_turn`.
///
/// # Errors
/// [`Error::TooShort`] for a record without a whole step, [`Error::WrongLength`], [`Error::NotFinite`],
/// [`Error::Undefined`] for an angle that falls.
pub fn means_over_angle(signal: &[f64], turns: &[f64], steps_per_turn: usize) -> Result<Vec<f64>> {
    check_signal(signal, 2, "order tracking")?;
    check_signal(turns, 2, "order tracking")?;
    check_len("turns", turns.len(), signal.len())?;
    if turns.windows(2).any(|pair| pair[1] < pair[0]) {
        let why =
            "it must never fall; turn the sign of one that does, and cut a record where the shaft turns back";
        return Err(Error::Undefined { quantity: "angle of the shaft", why });
    }
    let per_turn = steps_per_turn as f64;
    let made = (turns[turns.len() - 1] - turns[0]) * per_turn;
    // An end that rounding has cut off counts.
    let steps = (made + 1e-9).floor() as usize;
    if steps == 0 {
        return Err(Error::TooShort { field: "turns", len: 0, least: 1, purpose: "order tracking" });
    }
    let mut until = vec![0.0; signal.len()];
    for n in 1..signal.len() {
        until[n] = until[n - 1] + 0.5 * (signal[n - 1] + signal[n]) * (turns[n] - turns[n - 1]);
    }
    // The integral of the signal over the angle, up to an angle.
    let mut below = 0;
    let mut upto = |angle: f64| {
        while below + 2 < turns.len() && turns[below + 1] < angle {
            below += 1;
        }
        let (a, b) = (turns[below], turns[below + 1]);
        let t = if b > a { ((angle - a) / (b - a)).clamp(0.0, 1.0) } else { 1.0 };
        let rise = signal[below + 1] - signal[below];
        until[below] + t * (b - a) * (signal[below] + 0.5 * t * rise)
    };
    let mut values = Vec::with_capacity(steps);
    let mut last = 0.0;
    for step in 1..=steps {
        let next = upto(turns[0] + step as f64 / per_turn);
        values.push((next - last) * per_turn);
        last = next;
    }
    Ok(values)
}

impl OverAngle {
    /// Number of whole turns.
    pub fn turns(&self) -> usize {
        self.values.len() / self.samples_per_turn
    }

    /// Time-synchronous average: the mean turn. Components not locked to the shaft decrease as one over the
    /// square root of the turns.
    pub fn average(&self) -> Vec<f64> {
        let mut mean = vec![0.0; self.samples_per_turn];
        for turn in self.values.chunks_exact(self.samples_per_turn) {
            mean.iter_mut().zip(turn).for_each(|(sum, x)| *sum += x);
        }
        let turns = self.turns() as f64;
        mean.iter_mut().for_each(|sum| *sum /= turns);
        mean
    }

    /// The signal less its average: everything not locked to the shaft.
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
        // The cubic is off by (2π·3/60)³/16 of the amplitude at the fastest turn, more next to a change of
        // speed.
        for (n, x) in tracked.average().iter().enumerate() {
            assert!((x - (3.0 * TAU * n as f64 / 64.0).sin()).abs() < 5e-3, "{n}: {x}");
        }
        assert!(tracked.residual().iter().all(|x| x.abs() < 3e-2));
    }

    #[test]
    fn example_means_over_the_angle_of_a_shaft_that_starts_from_rest() {
        // 20 turns in 10 000 samples of a constant acceleration; three waves a turn about 2.
        let turns: Vec<f64> = (0..10_000).map(|n| 20.0 * (f64::from(n) / 9_999.0).powi(2)).collect();
        let signal: Vec<f64> = turns.iter().map(|turn| 2.0 + (3.0 * TAU * turn).sin()).collect();
        let means = means_over_angle(&signal, &turns, 64).unwrap();
        assert_eq!(means.len(), 20 * 64);
        for (n, mean) in means.iter().enumerate() {
            // The mean of a sine over a step, and the lines between samples at the fastest turn:
            // (2π·3/250)²/8.
            let x = std::f64::consts::PI * 3.0 / 64.0;
            let wave = (3.0 * TAU * (n as f64 + 0.5) / 64.0).sin() * x.sin() / x;
            assert!((mean - 2.0 - wave).abs() < 1e-3, "{n}: {mean} {wave}");
        }
        let constant = means_over_angle(&vec![3.0; 10_000], &turns, 7).unwrap();
        assert!(constant.iter().all(|mean| (mean - 3.0).abs() < 1e-9));
    }

    #[test]
    fn refuses_angles_that_fall() {
        let signal = vec![1.0; 4];
        assert!(means_over_angle(&signal, &[0.0, 1.0, 0.5, 2.0], 8).is_err());
        assert!(means_over_angle(&signal, &[0.0, 1.0], 8).is_err());
        assert!(means_over_angle(&signal, &[0.0, 0.01, 0.02, 0.03], 8).is_err());
        // A pause of the shaft changes nothing.
        assert_eq!(means_over_angle(&signal, &[0.0, 1.0, 1.0, 2.0], 2).unwrap(), [1.0; 4]);
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
