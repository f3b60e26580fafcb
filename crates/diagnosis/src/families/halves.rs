//! Does a family stand in both halves of a record?
//!
//! A defect knocks as long as the machine turns. Three lines that stand in one half only are chance, or
//! something that passed.

use stribeck_dsp::{BandEnvelopes, CombTest, Whitened};

use crate::Error;
use crate::HIGHEST_HZ;
use crate::families::limits::ALPHA;

/// A family this far from noise stands in both halves, or in one so high that no chance makes it.
pub(crate) const CERTAIN: f64 = 1e-9;
/// Lines of a half about the frequency of the whole that are searched.
const REACH: f64 = 1.0;

/// Whether a comb of `comb_hz` stands in the `band_hz` of either half of `samples`.
///
/// # Errors
/// [`Error::Signal`] when the samples are not numbers.
pub(crate) fn agree(samples: &[f64], rate_hz: f64, band_hz: (f64, f64), comb_hz: f64) -> Result<bool, Error> {
    let half = BandEnvelopes::segment_of(samples.len() / 2, samples.len() / 2);
    let grid_hz = rate_hz / half as f64;
    for part in [&samples[..half], &samples[samples.len() - half..]] {
        let planned = BandEnvelopes::new(rate_hz, half, &[band_hz], HIGHEST_HZ.min(0.5 * rate_hz));
        let Ok(mut envelopes) = planned else { return Ok(false) };
        envelopes.add(part).map_err(Error::Signal)?;
        let bands = envelopes.bands();
        let Some(band) = bands.first() else { return Ok(false) };
        let spectrum = Whitened::new(&band.values, band.grid_hz, band.segments);
        let (low, high) = (comb_hz - REACH * grid_hz, comb_hz + REACH * grid_hz);
        let stands = spectrum
            .and_then(|spectrum| CombTest::FOUR_OF_FIVE.search(&spectrum, low, high))
            .is_ok_and(|comb| comb.p_value < ALPHA);
        if !stands {
            return Ok(false);
        }
    }
    Ok(true)
}
