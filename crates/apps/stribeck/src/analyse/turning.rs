//! Spectra over speed and angle of a record whose shaft changes its speed.

use anyhow::Result;
use stribeck_diagnosis::speed::varying::turns_between;
use stribeck_diagnosis::{Analysis, Varying};
use stribeck_formats::Channel;

/// Spectra over speed and angle of a channel; `pulses` are the times of whole turns, in samples. `None`
/// without a speed, or for a record that is too short.
pub(super) fn varying(
    analysis: &Analysis,
    channel: &Channel,
    rate_hz: f64,
    pulses: &[f64],
) -> Result<Option<Varying>> {
    let Some(rpm) = analysis.findings.speed_rpm else { return Ok(None) };
    let signal = channel.read()?;
    let length = pulses.last().zip(pulses.first()).map_or(0.0, |(last, first)| last - first);
    let (range, turns) = turns_between(pulses, rpm / 60.0 * length / rate_hz, signal.len());
    if turns.len() < LEAST_VARYING {
        return Ok(None);
    }
    let half = 0.5 * rate_hz;
    // The bands of the analysis are those over the angle, at the mean speed.
    let (low, high) = analysis.leading_band_hz().unwrap_or((0.1 * half, 0.9 * half));
    let band_hz = (low.clamp(0.02 * half, 0.5 * half), high.min(0.95 * half));
    Ok(Some(Varying::of(&signal[range], rate_hz, &turns, band_hz)?))
}

/// Fewest samples of a record with spectra over speed.
const LEAST_VARYING: usize = 4096;
