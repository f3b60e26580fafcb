//! One line, or one band, of any signal.

use stribeck_dsp::{Spectrum, Welch, WelchOptions, Window, running_mean};

use crate::Error;

/// Amplitude of the line within one resolution of `frequency_hz`, over the whole record with a Hann window;
/// `None` for a record that cannot hold it.
pub fn amplitude(signal: &[f64], sample_rate_hz: f64, frequency_hz: f64) -> Option<f64> {
    if signal.len() < 16 {
        return None;
    }
    let options =
        WelchOptions { window: Window::Hann, nfft: 4 * signal.len(), ..WelchOptions::new(signal.len()) };
    let spectrum = Welch::new(sample_rate_hz, signal.len(), &options).ok()?.estimate(signal).ok()?;
    let reach = spectrum.resolution().resolution_hz;
    let peak = spectrum.peak(frequency_hz - reach, frequency_hz + reach).ok()?;
    Some(spectrum.sinusoid(&peak).ok()?.amplitude)
}

/// A line of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Frequency [Hz].
    pub hz: f64,
    /// Amplitude [unit of the signal].
    pub amplitude: f64,
    /// How far it stands above the median of its surroundings [dB].
    pub above_db: f64,
}

/// The highest peak between two frequencies [Hz], over the whole record with a Hann window; `None` when there
/// is none between them.
pub fn line_between(signal: &[f64], sample_rate_hz: f64, from_hz: f64, to_hz: f64) -> Option<Line> {
    let options =
        WelchOptions { window: Window::Hann, nfft: 4 * signal.len(), ..WelchOptions::new(signal.len()) };
    let spectrum = Welch::new(sample_rate_hz, signal.len(), &options).ok()?.estimate(signal).ok()?;
    let peak = spectrum.peak(from_hz, to_hz).ok().filter(|peak| !peak.at_edge)?;
    let width = spectrum.resolution().width_6db_hz;
    let half = (12.0 * width).max(0.1 * peak.frequency_hz);
    let (low, high) = ((peak.frequency_hz - half).max(0.0), peak.frequency_hz + half);
    let above_db = spectrum.stands_above_db(&peak, low, high.min(0.5 * sample_rate_hz), 1.5 * width).ok()?;
    let line = spectrum.sinusoid(&peak).ok()?;
    Some(Line { hz: line.frequency_hz, amplitude: line.amplitude, above_db })
}

/// Density [unit²/Hz] of the first `seconds` of a signal on a grid [Hz]; `None` when the signal is shorter.
pub fn density_of_start(
    signal: &[f64],
    sample_rate_hz: f64,
    seconds: f64,
    grid_hz: f64,
) -> Result<Option<Spectrum>, Error> {
    let samples = (seconds * sample_rate_hz).round() as usize;
    let Some(first) = signal.get(..samples) else { return Ok(None) };
    let mut welch = Welch::for_grid(sample_rate_hz, samples, grid_hz).map_err(Error::Signal)?;
    welch.estimate(first).map(Some).map_err(Error::Signal)
}

/// Root mean square of the part of a signal between two frequencies; `None` for a record that cannot hold it.
pub fn band_rms(signal: &[f64], sample_rate_hz: f64, low_hz: f64, high_hz: f64) -> Option<f64> {
    if signal.len() < 16 {
        return None;
    }
    let welch = Welch::new(sample_rate_hz, signal.len(), &WelchOptions::new(signal.len()));
    welch.ok()?.estimate(signal).ok()?.band_rms(low_hz, high_hz).ok()
}

/// Largest magnitude of the running mean over `width_s` [s]: the height of a peak behind that low pass;
/// `None` where the signal is shorter.
pub fn smoothed_peak(signal: &[f64], interval_s: f64, width_s: f64) -> Option<f64> {
    let width = samples(width_s, interval_s);
    let means = (width <= signal.len()).then(|| running_mean(signal, width))?;
    means.into_iter().map(f64::abs).max_by(f64::total_cmp)
}

/// Samples in a time, at least one.
fn samples(time_s: f64, interval_s: f64) -> usize {
    (time_s / interval_s).round().max(1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planted_amplitude_of_a_cosine_between_two_bins() {
        let tone = |n: usize| 3.0 + 2.0 * (std::f64::consts::TAU * 4671.5 * n as f64 * 1e-5).cos();
        let signal: Vec<f64> = (0..1200).map(tone).collect();
        assert!((amplitude(&signal, 1e5, 4680.0).unwrap() - 2.0).abs() < 0.02);
        assert_eq!(amplitude(&signal[..10], 1e5, 4680.0), None);
        let line = line_between(&signal, 1e5, 4600.0, 4700.0).unwrap();
        assert!((line.hz - 4671.5).abs() < 1.0 && (line.amplitude - 2.0).abs() < 0.02, "{line:?}");
        assert!(line.above_db > 40.0, "{line:?}");
        assert_eq!(line_between(&signal, 1e5, 4690.0, 4720.0), None);
    }

    #[test]
    fn by_hand_band_and_running_mean_of_a_step_with_a_tone() {
        // A tone of 20 periods in 20 samples each: three bins of Hann's window hold it all.
        let tone: Vec<f64> =
            (0..400).map(|n| 3.0 * (std::f64::consts::TAU * n as f64 / 20.0).sin()).collect();
        assert!((band_rms(&tone, 1e5, 4e3, 6e3).unwrap() - 3.0 / 2f64.sqrt()).abs() < 1e-12);
        let signal: Vec<f64> = (0..400).map(|n| tone[n] + f64::from(u8::from(n >= 200))).collect();
        assert!((smoothed_peak(&signal, 1e-5, 20e-5).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(smoothed_peak(&signal[..10], 1e-5, 20e-5), None);
    }
}
