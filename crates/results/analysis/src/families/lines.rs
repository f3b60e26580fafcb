//! The lines of a family, read from the spectra at its carrier and sidebands.

use stribeck_dsp::{Peak, Spectrum, Welch, WelchOptions, Window};

use super::{Channel, FamilyLine, SIDEBANDS};
use crate::Error;
use crate::tones::LEAST_PROMINENCE_DB;

/// Half width of a line's surroundings, in widths of a line at −6 dB.
const SURROUNDINGS_WIDTHS: f64 = 12.0;

/// Spectra of all channels of a record, in which the families' lines lie BPFO apart.
pub(super) struct Spectra<'a> {
    of: Vec<(&'a Channel, Spectrum)>,
    bpfo_hz: f64,
}

impl<'a> Spectra<'a> {
    /// Of the whole record with a Hann window.
    pub(super) fn of(channels: &'a [Channel], sample_rate_hz: f64, bpfo_hz: f64) -> Result<Self, Error> {
        let spectrum = |channel: &'a Channel| -> Result<(&'a Channel, Spectrum), Error> {
            let samples = channel.values.len();
            let options =
                WelchOptions { window: Window::Hann, nfft: 4 * samples, ..WelchOptions::new(samples) };
            let mut welch = Welch::new(sample_rate_hz, samples, &options).map_err(Error::Signal)?;
            Ok((channel, welch.estimate(&channel.values).map_err(Error::Signal)?))
        };
        Ok(Self { of: channels.iter().map(spectrum).collect::<Result<_, _>>()?, bpfo_hz })
    }

    /// Carrier and sidebands in every channel.
    pub(super) fn lines(&self, carrier_hz: f64) -> Vec<FamilyLine> {
        let mut lines = Vec::new();
        for (channel, spectrum) in &self.of {
            for sideband in -SIDEBANDS..=SIDEBANDS {
                let predicted_hz = carrier_hz + f64::from(sideband) * self.bpfo_hz;
                let peak = self.peak(spectrum, predicted_hz).filter(|(_, db)| *db >= LEAST_PROMINENCE_DB);
                let line = peak.and_then(|(peak, _)| spectrum.sinusoid(&peak).ok());
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
        lines
    }

    /// How far the highest peak at a frequency stands above its surroundings [dB], over all channels; `None`
    /// without a peak there.
    pub(super) fn prominence_db(&self, hz: f64) -> Option<f64> {
        self.of.iter().filter_map(|(_, spectrum)| Some(self.peak(spectrum, hz)?.1)).reduce(f64::max)
    }

    /// The peak within half a resolution of a frequency, and how far it stands above its surroundings [dB].
    fn peak(&self, spectrum: &Spectrum, hz: f64) -> Option<(Peak, f64)> {
        let resolution = spectrum.resolution();
        let (reach, width) = (0.5 * resolution.resolution_hz, resolution.width_6db_hz);
        // The family itself is no surroundings.
        let own = f64::from(SIDEBANDS) * self.bpfo_hz + width;
        let peak = spectrum.peak(hz - reach, hz + reach).ok().filter(|peak| !peak.at_edge)?;
        let half = own + SURROUNDINGS_WIDTHS * width;
        let low = (peak.frequency_hz - half).max(0.0);
        let high = (peak.frequency_hz + half).min(0.5 * spectrum.sample_rate_hz());
        let above = spectrum.stands_above_db(&peak, low, high, own).ok()?;
        Some((peak, above))
    }
}
