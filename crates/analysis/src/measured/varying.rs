//! Spectra over speed and over the angle of a shaft whose speed varies, for pictures.

use stribeck_dsp::{Envelope, means_over_angle};

use super::course::Course;
use crate::Error;

/// Steps of the angle in a turn: orders up to half as many.
const STEPS_PER_TURN: usize = 256;
/// Fewest steps for a picture: four turns.
const LEAST_STEPS: usize = 4 * STEPS_PER_TURN;

/// A record of a shaft whose speed varies.
#[derive(Debug, Clone, PartialEq)]
pub struct Varying {
    /// Density over time.
    pub course: Course,
    /// Mean speed of each of its columns [1/min].
    pub speeds_rpm: Vec<f64>,
    /// Density of the squared envelope over the angle: turns in the place of seconds, orders in that of
    /// hertz; `None` for too few turns.
    pub orders: Option<Course>,
    /// Band whose envelope that is [Hz].
    pub band_hz: (f64, f64),
}

impl Varying {
    /// Of a signal and the turns of the shaft at each sample, which must not fall.
    ///
    /// # Errors
    /// [`Error::Signal`] for turns that fall and signals that cannot be processed.
    pub fn of(signal: &[f64], rate_hz: f64, turns: &[f64], band_hz: (f64, f64)) -> Result<Self, Error> {
        let course = Course::of(signal, rate_hz)?;
        let columns = course.values.len() / course.lines;
        let at = |column: usize| {
            let sample = (column as f64 * course.step_s * rate_hz).round() as usize;
            sample.min(turns.len().saturating_sub(1))
        };
        let speed = |column: usize| {
            let (first, last) = (at(column), at(column + 1));
            60.0 * rate_hz * (turns[last] - turns[first]) / (last - first).max(1) as f64
        };
        let speeds_rpm = (0..columns).map(speed).collect();
        let mut squared = vec![0.0; signal.len()];
        Envelope::in_band(rate_hz, signal.len(), band_hz.0, band_hz.1)
            .and_then(|mut envelope| envelope.process(signal, &mut squared))
            .map_err(Error::Signal)?;
        squared.iter_mut().for_each(|a| *a *= *a);
        let made = turns.last().zip(turns.first()).map_or(0.0, |(last, first)| last - first);
        let orders = if made * STEPS_PER_TURN as f64 > LEAST_STEPS as f64 {
            let mut means = means_over_angle(&squared, turns, STEPS_PER_TURN).map_err(Error::Signal)?;
            let mean = means.iter().sum::<f64>() / means.len() as f64;
            means.iter_mut().for_each(|x| *x -= mean);
            // A step is a sample and a turn a second, so hertz are orders.
            Some(Course::of(&means, STEPS_PER_TURN as f64)?)
        } else {
            None
        };
        Ok(Self { course, speeds_rpm, orders, band_hz })
    }
}

/// Turns of the shaft at each of `samples` samples, and the samples that have some: those between the first
/// and the last of `pulses` [samples], which are equal parts of `turns` turns altogether.
pub fn turns_between(pulses: &[f64], turns: f64, samples: usize) -> (std::ops::Range<usize>, Vec<f64>) {
    let (Some(first), Some(last)) = (pulses.first(), pulses.last()) else { return (0..0, Vec::new()) };
    let range = first.ceil().max(0.0) as usize..((last.floor().max(0.0) as usize) + 1).min(samples);
    if range.is_empty() || pulses.len() < 2 {
        return (0..0, Vec::new());
    }
    let part = turns / (pulses.len() - 1) as f64;
    let mut at = 0;
    let place = |n: usize| {
        let n = n as f64;
        while at + 2 < pulses.len() && pulses[at + 1] < n {
            at += 1;
        }
        part * (at as f64 + ((n - pulses[at]) / (pulses[at + 1] - pulses[at])).clamp(0.0, 1.0))
    };
    (range.clone(), range.map(place).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Knocks 3.6 times a turn of a shaft from 10 to 30 turns a second stand at their order all the time.
    #[test]
    fn example_a_family_stands_still_over_the_angle() {
        let rate_hz = 20_000.0;
        let times: Vec<f64> = (0..80_000).map(|n| f64::from(n) / rate_hz).collect();
        let turns: Vec<f64> = times.iter().map(|t| 10.0 * t + 2.5 * t * t).collect();
        // A resonance that the speed does not move.
        let ring = |(turns, t): (&f64, &f64)| {
            let since_s = (3.6 * turns).rem_euclid(1.0) / (3.6 * (10.0 + 5.0 * t));
            (-since_s / 1e-3).exp() * (TAU * 4_000.0 * since_s).sin()
        };
        let signal: Vec<f64> = turns.iter().zip(&times).map(ring).collect();
        let found = Varying::of(&signal, rate_hz, &turns, (2_000.0, 9_000.0)).expect("a signal");
        let (first, last) = (found.speeds_rpm[0], found.speeds_rpm[found.speeds_rpm.len() - 1]);
        assert!((first - 600.0).abs() < 10.0 && (last - 1800.0).abs() < 10.0, "{first} {last}");
        let orders = found.orders.expect("enough turns");
        // Knocks are short: their second harmonic is as high as the first, and above the range of the search.
        let below = (5.4 / orders.grid_hz) as usize;
        let columns: Vec<&[f64]> = orders.values.chunks_exact(orders.lines).collect();
        // A column into which no segment falls has no numbers.
        let told: Vec<&&[f64]> = columns.iter().filter(|column| column[2].is_finite()).collect();
        assert!(told.len() + 1 >= columns.len(), "{} of {}", told.len(), columns.len());
        for column in told {
            let highest = (2..below).max_by(|a, b| column[*a].total_cmp(&column[*b])).expect("lines");
            assert!((highest as f64 * orders.grid_hz - 3.6).abs() <= 0.3, "{highest}");
        }
    }

    #[test]
    fn example_turns_between_pulses() {
        let (range, turns) = turns_between(&[1.5, 3.5, 7.5], 2.0, 20);
        assert_eq!(range, 2..8);
        assert_eq!(turns, [0.25, 0.75, 1.125, 1.375, 1.625, 1.875]);
        assert!(turns_between(&[], 2.0, 20).1.is_empty());
    }
}
