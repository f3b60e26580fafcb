//! The velocity level of a machine, from its acceleration.

use std::f64::consts::TAU;

use crate::{Error, Result, Scaling, Spectrum};

impl Spectrum {
    /// Root mean square [unit·s] of the integral over time between two frequencies [Hz], both included: of an
    /// acceleration in m/s² the velocity in m/s. Machines are judged by it from 10 to 1000 Hz (ISO 20816).
    ///
    /// # Errors
    /// [`Error::Undefined`] for a band that begins at zero or a spectrum that is no density, and those of
    /// [`Spectrum::band_rms`].
    pub fn velocity_rms(&self, low_hz: f64, high_hz: f64) -> Result<f64> {
        if low_hz <= 0.0 {
            let why = "what does not oscillate has no bounded integral; begin the band above 0 Hz";
            return Err(Error::Undefined { quantity: "velocity", why });
        }
        if self.scaling() != Scaling::Density {
            let why = "it is the integral of a density; estimate the spectrum with `Scaling::Density`";
            return Err(Error::Undefined { quantity: "velocity", why });
        }
        let grid_hz = self.resolution().grid_hz;
        let sum: f64 = self
            .band(low_hz, high_hz, 1)?
            .map(|bin| self.one_sided(bin) / (TAU * bin as f64 * grid_hz).powi(2))
            .sum();
        Ok((sum * grid_hz).sqrt())
    }
}
