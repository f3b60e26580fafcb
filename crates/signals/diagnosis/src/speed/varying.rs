//! Spectra over speed and over the angle of a shaft whose speed varies, for pictures.

use stribeck_dsp::{Envelope, means_over_angle};

use crate::Error;
use crate::record::course::Course;

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
