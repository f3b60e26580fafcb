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
