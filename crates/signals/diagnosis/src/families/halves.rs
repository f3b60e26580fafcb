//! Does a family stand in both halves of a record?
//!
//! A defect impacts as long as the machine turns. Three lines that stand in one half only are chance, or
//! something that passed.

use stribeck_dsp::{BandEnvelopes, CombTest, Whitened};

use crate::families::limits::ALPHA;
use crate::record::bands::HIGHEST_HZ;
use crate::{Defect, Error, Family};

/// A family this far from noise stands in both halves, or in one so high that no chance makes it.
const CERTAIN: f64 = 1e-9;
/// The same for that of the cage, by its probability of a false alarm.
const COMES_AND_GOES: f64 = 1e-5;
/// Lines of a half about the frequency of the whole that are searched.
const REACH: f64 = 1.0;

/// Whether a comb of `comb_hz` stands in the `band_hz` of either half of `samples`.
fn agree(samples: &[f64], rate_hz: f64, band_hz: (f64, f64), comb_hz: f64) -> Result<bool, Error> {
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

/// Withdraws claims of families that stand in one half of the record only, but for those that no chance
/// makes, and a sure one of the cage: a spot on an element meets the raceways while it spins about the right axis,
/// and comes and goes.
pub(crate) fn without_passing(
    families: Vec<Family>,
    samples: &[f64],
    rate_hz: f64,
) -> Result<Vec<Family>, Error> {
    let finite = samples.iter().all(|x| x.is_finite());
    let lasts = |family: &Family| {
        let comes_and_goes = family.name == Defect::Ftf && family.p_value < COMES_AND_GOES;
        let certain = family.over.is_some() || comes_and_goes || family.noise_p_value < CERTAIN;
        let asked = family.claimed && !certain && finite;
        let (Some(band_hz), Some(hz), true) = (family.band_hz, family.measured_hz, asked) else {
            return Ok(true);
        };
        agree(samples, rate_hz, band_hz, family.name.shocks_per_period() * hz)
    };
    families
        .into_iter()
        .map(|family| {
            let lasts = lasts(&family)?;
            Ok(if lasts {
                family
            } else {
                family.refused("both halves", "it stands in one half of the record only".to_owned())
            })
        })
        .collect()
}
