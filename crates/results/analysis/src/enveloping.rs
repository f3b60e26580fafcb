//! The squared envelope spectrum of the leading sensor, and the defect's family of lines in it.

use serde::{Deserialize, Serialize};
use stribeck_dsp::{EnvelopeSpectrum, PeriodCount, PeriodVerdict, Spectrum};

use crate::Error;
use crate::tones::{self, PredictedLine, Tone};
use stribeck_diagnosis::quantities;

/// Lower end of the band whose envelope is taken [Hz]: above the facet tone, so that its beats are not taken
/// for impacts.
const BAND_FROM_HZ: f64 = 6_000.0;
/// Upper end as a part of half the sample rate.
const BAND_TO: f64 = 0.9;

quantities! {
    /// Lines of the envelope spectrum at the defect's frequencies.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct EnvelopeFinding {
        /// Band whose envelope was taken [Hz].
        pub band_hz: (f64, f64),
        /// Periods of the defect in the record.
        pub periods: f64,
        /// Resolution of the spectrum [Hz].
        pub resolution_hz: f64,
        /// Each line of the family.
        pub lines: Vec<EnvelopeLine>,
    }
}

quantities! {
    /// One line of the family.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct EnvelopeLine = of(tone: &Tone) {
        /// Multiple of the defect's frequency.
        pub harmonic: usize = tone.harmonic,
        /// Predicted frequency without slip [Hz].
        pub predicted_hz: f64 = tone.predicted_hz,
        /// Measured frequency [Hz]; `None` when nothing stands out.
        pub measured_hz: Option<f64> = tone.measured_hz,
        /// Height above the surroundings [dB].
        pub prominence_db: Option<f64> = tone.prominence_db,
    }
}

/// Envelope spectrum [g⁴] and finding; `None` with the reason when the record holds too few periods of
/// `lines`, whose first is the fundamental.
pub fn analyse(
    signal_g: &[f64],
    sample_rate_hz: f64,
    lines: &[PredictedLine],
) -> Result<Result<(Spectrum, EnvelopeFinding), String>, Error> {
    let Some(fundamental) = lines.first().map(|l| l.predicted_hz).filter(|&hz| hz > 0.0) else {
        return Ok(Err("no envelope spectrum: nothing passes a defect".into()));
    };
    let record_s = signal_g.len() as f64 / sample_rate_hz;
    let Ok(count) = PeriodCount::new(record_s, fundamental) else {
        return Ok(Err("no envelope spectrum: the record is empty".into()));
    };
    if count.verdict() == PeriodVerdict::TooFew {
        return Ok(Err(format!("no envelope spectrum: {count}")));
    }
    let band_hz = band_hz(sample_rate_hz);
    let mut planned =
        EnvelopeSpectrum::new(sample_rate_hz, signal_g.len(), Some(band_hz)).map_err(Error::Signal)?;
    let mut spectrum = planned.blank();
    planned.process(signal_g, &mut spectrum).map_err(Error::Signal)?;
    let tones = tones::measure("envelope", lines, &spectrum)?;
    let finding = EnvelopeFinding {
        band_hz,
        periods: count.periods(),
        resolution_hz: spectrum.resolution().resolution_hz,
        lines: tones.iter().map(EnvelopeLine::of).collect(),
    };
    Ok(Ok((spectrum, finding)))
}

/// Band whose envelope is taken of a record sampled so often [Hz].
pub(crate) fn band_hz(sample_rate_hz: f64) -> (f64, f64) {
    let to = 0.5 * BAND_TO * sample_rate_hz;
    if to > 2.0 * BAND_FROM_HZ { (BAND_FROM_HZ, to) } else { (0.1 * to, to) }
}
