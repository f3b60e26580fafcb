//! How a record went: its spectra over time, for a picture.

use stribeck_dsp::{Spectrograph, WelchOptions};

use crate::Error;

/// Samples of a segment: at 25.6 kHz 40 ms, lines 25 Hz apart.
const SEGMENT: usize = 1 << 10;
/// Columns of the picture.
const COLUMNS: usize = 480;

/// Density over time and frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// Time from one column to the next [s]; the first begins at 0.
    pub step_s: f64,
    /// Distance of neighbouring frequencies [Hz], from 0.
    pub grid_hz: f64,
    /// Frequencies a column.
    pub lines: usize,
    /// Density [unit²/Hz], one column after the other, each the mean over its time; not a number where the
    /// record holds none.
    pub values: Vec<f64>,
}

impl Course {
    /// Of a record that is in memory.
    ///
    /// # Errors
    /// [`Error::Signal`] for a record of a few samples.
    pub fn of(values: &[f64], rate_hz: f64) -> Result<Self, Error> {
        let mut tracing = Tracing::new(rate_hz, values.len())?;
        tracing.add(values).map_err(Error::Signal)?;
        Ok(tracing.finish())
    }
}

/// A course in the making.
pub(crate) struct Tracing {
    plan: Spectrograph,
    course: Course,
    counts: Vec<u32>,
}

impl Tracing {
    /// Plans for a record of `samples` samples.
    pub(crate) fn new(rate_hz: f64, samples: usize) -> Result<Self, Error> {
        let segment = SEGMENT.min(samples / 4).max(4);
        // Long records need no overlap: a column holds many segments as it is.
        let overlap = if samples / segment > 2 * COLUMNS { 0 } else { segment / 2 };
        let plan = Spectrograph::new(rate_hz, &WelchOptions { overlap, ..WelchOptions::new(segment) })
            .map_err(Error::Signal)?;
        let frames = (samples - overlap) / (segment - overlap);
        let columns = COLUMNS.min(frames).max(1);
        let lines = plan.frequencies_hz().len();
        let course = Course {
            step_s: samples as f64 / rate_hz / columns as f64,
            grid_hz: plan.frequencies_hz()[1],
            lines,
            values: vec![0.0; columns * lines],
        };
        Ok(Self { plan, course, counts: vec![0; columns] })
    }

    /// Adds samples, all of them numbers.
    pub(crate) fn add(&mut self, samples: &[f64]) -> Result<(), stribeck_dsp::Error> {
        let Self { plan, course, counts } = self;
        plan.add(samples, |time_s, values| {
            let column = ((time_s / course.step_s) as usize).min(counts.len() - 1);
            counts[column] += 1;
            let sums = &mut course.values[column * course.lines..][..course.lines];
            sums.iter_mut().zip(values).for_each(|(sum, v)| *sum += v);
        })
    }

    /// Leaves samples out.
    pub(crate) fn skip(&mut self, samples: usize) {
        self.plan.skip(samples);
    }

    pub(crate) fn finish(mut self) -> Course {
        for (column, count) in self.course.values.chunks_exact_mut(self.course.lines).zip(&self.counts) {
            column.iter_mut().for_each(|sum| *sum /= f64::from(*count));
        }
        self.course
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn planted_a_tone_that_changes_stands_where_and_when_it_sounds() {
        let rate_hz = 10_000.0;
        let tone = |hz: f64| -> Vec<f64> {
            (0..40_000).map(|n| (TAU * hz * f64::from(n) / rate_hz).sin()).collect()
        };
        let mut tracing = Tracing::new(rate_hz, 120_000).unwrap();
        tracing.add(&tone(1_000.0)).unwrap();
        tracing.skip(40_000);
        tracing.add(&tone(3_000.0)).unwrap();
        let course = tracing.finish();
        let loudest = |t: f64| {
            let column = &course.values[(t / course.step_s) as usize * course.lines..][..course.lines];
            let most = (0..course.lines).max_by(|a, b| column[*a].total_cmp(&column[*b])).unwrap();
            (column[most].is_finite()).then_some(most as f64 * course.grid_hz)
        };
        for (t, hz) in [(1.0, 1_000.0), (3.0, 1_000.0), (9.0, 3_000.0), (11.0, 3_000.0)] {
            assert!((loudest(t).unwrap() - hz).abs() <= course.grid_hz, "{t} s: {:?}", loudest(t));
        }
        assert_eq!(loudest(6.0), None);
    }
}
