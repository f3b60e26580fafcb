//! Bands of a record and their squared envelope spectra.

use stribeck_dsp::channel::Channel;
use stribeck_dsp::{BandEnvelope, BandEnvelopes};

use crate::Error;

/// Levels of the dyadic tree of bands: halves, quarters, eighths.
const LEVELS: u32 = 3;
/// Lower end of the lowest bands as a part of half the sample rate: below lie the shaft and its multiples.
pub(crate) const LOWEST: f64 = 0.02;
/// Highest frequency of the envelope spectra [Hz]; bearings make impacts more slowly.
pub(crate) const HIGHEST_HZ: f64 = 4_000.0;

/// The bands of a channel over the period of a frequency [Hz]: the samples are read again.
pub(crate) fn over_period(
    channel: &Channel,
    rate_hz: f64,
    segment: usize,
    frequency_hz: f64,
) -> Result<Vec<BandEnvelope>, Error> {
    let highest_hz = HIGHEST_HZ.min(0.5 * rate_hz);
    let mut envelopes = BandEnvelopes::new(rate_hz, segment, &bands(rate_hz), highest_hz)
        .and_then(|envelopes| envelopes.over_period(frequency_hz))
        .map_err(Error::Signal)?;
    let mut buffer: Vec<f64> = Vec::with_capacity(segment);
    let mut failed = None;
    channel.for_each_block(|mut block| {
        while !block.is_empty() && failed.is_none() {
            let (now, later) = block.split_at((segment - buffer.len()).min(block.len()));
            buffer.extend_from_slice(now);
            block = later;
            if buffer.len() == segment {
                // Segments with values that are not numbers have been left out before, too.
                let sound = buffer.iter().all(|x| x.is_finite());
                failed = if sound { envelopes.add(&buffer).err() } else { None };
                buffer.clear();
            }
        }
        failed.is_none()
    })?;
    failed.map_or_else(|| Ok(envelopes.bands()), |why| Err(Error::Signal(why)))
}

/// The whole range, its halves, quarters and eighths.
pub(crate) fn bands(rate_hz: f64) -> Vec<(f64, f64)> {
    let half = 0.5 * rate_hz;
    let level = |level: u32| {
        let count = 1_u32 << level;
        let end = move |n: u32| if n == 0 { LOWEST * half } else { half * f64::from(n) / f64::from(count) };
        (0..count).map(move |n| (end(n), end(n + 1)))
    };
    (0..=LEVELS).flat_map(level).collect()
}
