//! The enhanced envelope spectrum: lines at the rates at which any part of the spectrum comes and goes, each
//! part weighed by how surely it does and not by its power.

use stribeck_dsp::{Cyclic, spectral_correlation};

use crate::Error;

/// Mean magnitude of the spectral coherence over the cyclic frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct Enhanced {
    /// Distance of neighbouring cyclic frequencies [Hz], from 0.
    pub grid_hz: f64,
    /// Values, 0 to 1.
    pub values: Vec<f64>,
    /// Length from the beginning of the record that was used [s].
    pub duration_s: f64,
    /// Distance of the carrier frequencies [Hz].
    pub carrier_hz: f64,
}

/// Samples of a segment.
const WINDOW: usize = 256;
/// Most samples used.
const MOST: usize = 1 << 18;
/// Most values of the transforms: 32 MB.
const VALUES: usize = 1 << 21;

/// `None` for a record that is too short, or holds values that are not numbers.
pub(crate) fn of(samples: &[f64], rate_hz: f64, highest_hz: f64) -> Result<Option<Enhanced>, Error> {
    let highest_hz = highest_hz.min(0.125 * rate_hz);
    let step = ((0.5 * rate_hz / highest_hz) as usize).clamp(1, WINDOW / 4);
    let used = &samples[..samples.len().min(MOST).min(step * VALUES / (WINDOW / 2 + 1))];
    if used.len() < 16 * WINDOW || used.iter().any(|x| !x.is_finite()) {
        return Ok(None);
    }
    let coherence =
        spectral_correlation(used, rate_hz, WINDOW, highest_hz, Cyclic::Coherence).map_err(Error::Signal)?;
    // The lowest lines hold the rest of the mean.
    let low_hz = 2.0 * coherence.grid_hz;
    let values = coherence.envelope_spectrum(low_hz, 0.5 * rate_hz).map_err(Error::Signal)?;
    Ok(Some(Enhanced {
        grid_hz: coherence.cyclic_grid_hz,
        values,
        duration_s: used.len() as f64 / rate_hz,
        carrier_hz: coherence.grid_hz,
    }))
}
