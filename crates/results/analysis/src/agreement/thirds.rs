//! Third octaves: which of them a record holds, and its power in them.

use std::f64::consts::PI;

use stribeck_dsp::{Welch, WelchOptions};

use super::FROM_S;
use crate::Error;

/// Third octaves, as steps of a third from 1 kHz: 500 Hz to 10 kHz.
const THIRDS: std::ops::RangeInclusive<i32> = -3..=10;
/// Bins that a third octave must hold, and its width over its middle.
const LEAST_BINS: f64 = 3.0;
const WIDTH: f64 = 0.23;

/// Middles of the third octaves [Hz] that a record of this length and rate holds.
pub(super) fn centres(samples: usize, rate_hz: f64) -> Vec<f64> {
    let grid_hz = rate_hz / samples as f64;
    let all = THIRDS.map(middle_hz);
    all.filter(|hz| hz * WIDTH >= LEAST_BINS * grid_hz && 1.13 * hz < 0.5 * rate_hz).collect()
}

/// Lengths of a record [ms] that holds the narrowest and the widest need: one third octave, and all of them.
pub(super) fn shortest_records_ms() -> [f64; 2] {
    [*THIRDS.end(), *THIRDS.start()].map(|step| 1e3 * (FROM_S + LEAST_BINS / (WIDTH * middle_hz(step))))
}

/// Middle of a third octave, `step` thirds above 1 kHz [Hz].
fn middle_hz(step: i32) -> f64 {
    1000.0 * (f64::from(step) / 3.0).exp2()
}

/// Mean square [unit²] in third octaves of a signal whose `values` are means over the sampling interval: the
/// low pass of that mean is divided out.
pub(super) fn powers(values: &[f64], rate_hz: f64, centres_hz: &[f64]) -> Result<Vec<f64>, Error> {
    let options = WelchOptions::new(values.len());
    let mut welch = Welch::new(rate_hz, values.len(), &options).map_err(Error::Signal)?;
    let spectrum = welch.estimate(values).map_err(Error::Signal)?;
    let edge = (1.0_f64 / 6.0).exp2();
    let power = |hz: &f64| {
        let half_turn = PI * hz / rate_hz;
        let of_means = half_turn.sin() / half_turn;
        Ok((spectrum.band_rms(hz / edge, hz * edge).map_err(Error::Signal)? / of_means).powi(2))
    };
    centres_hz.iter().map(power).collect()
}
