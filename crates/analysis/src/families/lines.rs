//! The lines of a found family, read from the spectra.

use stribeck_dsp::{Welch, WelchOptions, Window};

use super::{Channel, FamilyLine, SIDEBANDS};
use crate::Error;
use crate::tones::LEAST_PROMINENCE_DB;

/// Half width of a line's surroundings, in widths of a line at −6 dB.
const SURROUNDINGS_WIDTHS: f64 = 12.0;

/// Carrier and sidebands in every channel, over the whole record with a Hann window.
pub(super) fn read(
    channels: &[Channel],
    sample_rate_hz: f64,
    carrier_hz: f64,
    bpfo_hz: f64,
) -> Result<Vec<FamilyLine>, Error> {
    let mut lines = Vec::new();
    for channel in channels {
        let samples = channel.values.len();
        let options = WelchOptions { window: Window::Hann, nfft: 4 * samples, ..WelchOptions::new(samples) };
        let mut welch = Welch::new(sample_rate_hz, samples, &options).map_err(Error::Signal)?;
        let spectrum = welch.estimate(&channel.values).map_err(Error::Signal)?;
        let resolution = spectrum.resolution();
        let (reach, width) = (0.5 * resolution.resolution_hz, resolution.width_6db_hz);
        // The family itself is no surroundings.
        let own = f64::from(SIDEBANDS) * bpfo_hz + width;
        for sideband in -SIDEBANDS..=SIDEBANDS {
            let predicted_hz = carrier_hz + f64::from(sideband) * bpfo_hz;
            let peak = spectrum.peak(predicted_hz - reach, predicted_hz + reach).ok().filter(|p| !p.at_edge);
            let line = peak.and_then(|peak| {
                let half = own + SURROUNDINGS_WIDTHS * width;
                let low = (peak.frequency_hz - half).max(0.0);
                let high = (peak.frequency_hz + half).min(0.5 * sample_rate_hz);
                let above = spectrum.stands_above_db(&peak, low, high, own).ok()?;
                if above < LEAST_PROMINENCE_DB {
                    return None;
                }
                spectrum.sinusoid(&peak).ok()
            });
            lines.push(FamilyLine {
                sideband,
                predicted_hz,
                measured_hz: line.map(|l| l.frequency_hz),
                level_g: line.map(|l| l.amplitude),
                sensor: channel.sensor.clone(),
                component: channel.component.clone(),
            });
        }
    }
    Ok(lines)
}
