//! What sensor, amplifier, converter and recorder did to the samples: clipping, gaps that were filled, a
//! channel that died, too few levels, a limited slew rate, a mean that drifts, mains hum, and content that no
//! anti-alias filter let pass.
//!
//! All of it is found in the pass in which a record is read anyway, in memory that does not grow with it. Each
//! rule compares the record with itself, so that none needs the range or the unit of the sensor.

mod flat;
mod histogram;
mod inspection;
mod jumps;
mod rails;
mod similarity;
mod spectral;

use serde::Serialize;
use stribeck_dsp::channel::Channel;
use stribeck_dsp::{Welch, WelchOptions};

pub(crate) use self::inspection::Inspection;
pub(crate) use self::spectral::folded;
use crate::Error;
use crate::quantities;

/// What is wrong with samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Samples pile up at a rail.
    Clipped,
    /// Samples stand still at a value inside the range: gaps filled with zeros, a mark, or the last value.
    Held,
    /// The channel stands still, or is silent, from the beginning or to the end.
    Dead,
    /// The converter resolves a few levels of the signal only.
    FewLevels,
    /// Steps from sample to sample pile up at the largest.
    SlewLimited,
    /// The mean moves by more than the signal.
    Drift,
    /// Lines of the mains stand out.
    Hum,
    /// Much of the power lies just below half the sample rate, where an anti-alias filter leaves none.
    Aliased,
    /// Values leave the range at one end and come back at the other.
    Wrapped,
    /// Negative values were read or written without their sign.
    SignLost,
    /// The bytes of the numbers stand in the other order.
    Swapped,
    /// One value stands more often than any that is measured.
    Marked,
    /// A stretch stands a second time.
    Repeated,
    /// Samples held, stuffed with zeros, interpolated, or of channels in turn.
    Pattern,
    /// Samples pile up at rails that drift.
    DriftingRails,
    /// Gain or offset change at once.
    Jump,
}

quantities! {
    /// A finding on the quality of a record.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct Quality {
        /// What it is.
        pub kind: Kind,
        /// Share of the samples that it concerns, from 0 to 1.
        pub share: f64,
        /// The first of them [s].
        pub first_s: f64,
        /// In words, with what to do.
        pub words: String,
    }
}

impl Kind {
    /// Whether levels, impacts and lines of such samples are no longer those of the machine.
    pub fn spoils_verdicts(self) -> bool {
        !matches!(self, Self::Drift | Self::Hum | Self::Aliased)
    }

    /// In a few words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clipped => "clipped",
            Self::Held => "filled gaps",
            Self::Dead => "dead channel",
            Self::FewLevels => "few levels",
            Self::SlewLimited => "limited slew rate",
            Self::Drift => "drifting mean",
            Self::Hum => "mains hum",
            Self::Aliased => "aliasing",
            Self::Wrapped => "wrapped values",
            Self::SignLost => "sign lost",
            Self::Swapped => "bytes swapped",
            Self::Marked => "one value too often",
            Self::Repeated => "repeated stretches",
            Self::Pattern => "not samples of one signal",
            Self::DriftingRails => "clipped at rails that drift",
            Self::Jump => "gain or offset changed",
        }
    }
}

impl Quality {
    /// Whether such samples are no record of a signal, so that neither a defect nor its absence follows from them:
    /// gaps and dead stretches from half of the record on.
    pub fn is_no_signal(&self) -> bool {
        match self.kind {
            Kind::Held | Kind::Dead => self.share > 0.5,
            Kind::Clipped | Kind::FewLevels | Kind::SlewLimited | Kind::Drift | Kind::Hum | Kind::Aliased => {
                false
            }
            _ => true,
        }
    }
}

/// The headline of samples that are no record of a signal, with what to do; `None` where they are one.
pub fn no_signal(found: &[Quality]) -> Option<String> {
    let why = found.iter().find(|of| of.is_no_signal())?;
    Some(format!("No verdict: the samples are no record of a signal. Why: {}.", why.words))
}

/// The quality of a channel sampled `rate_hz` times a second; `speed_rpm` is that of the shaft, where it is
/// known and does not vary.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::Signal`] when it cannot be processed.
pub fn of(channel: &Channel, rate_hz: f64, speed_rpm: Option<f64>) -> Result<Vec<Quality>, Error> {
    let len = usize::try_from(channel.len).unwrap_or(usize::MAX);
    let mut inspection = Inspection::new(rate_hz, len);
    let mut kept = Vec::new();
    channel.for_each_block(|block| {
        inspection.add(block);
        kept.extend(block.iter().take(KEPT - kept.len()));
        true
    })?;
    let mut found = inspection.finish(&kept);
    found.extend(hum_of(&kept, rate_hz, speed_rpm)?);
    Ok(found)
}

/// Samples that are kept for the lines of the mains, and the length of their segments [s].
const KEPT: usize = 1 << 20;
const SEGMENT_S: f64 = 4.0;

/// Lines of the mains in the first samples of a record.
pub(crate) fn hum_of(kept: &[f64], rate_hz: f64, speed_rpm: Option<f64>) -> Result<Option<Quality>, Error> {
    let kept = &kept[..kept.iter().position(|x| !x.is_finite()).unwrap_or(kept.len())];
    let segment = kept.len().min((SEGMENT_S * rate_hz) as usize);
    if segment < MINIMUM {
        return Ok(None);
    }
    let mut welch = Welch::new(rate_hz, kept.len(), &WelchOptions::new(segment)).map_err(Error::Signal)?;
    let density = welch.estimate(kept).map_err(Error::Signal)?;
    Ok(spectral::hum(&density, speed_rpm.map(|rpm| rpm / 60.0)))
}

/// Fewest samples of a spectrum.
const MINIMUM: usize = 1024;

/// The sentence by which a verdict says that it rests on such samples; `None` for valid ones.
pub(crate) fn reservation(found: &[Quality]) -> Option<String> {
    let spoils: Vec<String> = found
        .iter()
        .filter(|of| of.kind.spoils_verdicts())
        .map(|of| format!("{} ({} of the samples)", of.kind.name(), percent(of.share)))
        .collect();
    (!spoils.is_empty())
        .then(|| format!("The samples are damaged, and the verdict rests on them: {}.", spoils.join(", ")))
}

fn percent(share: f64) -> String {
    match 100.0 * share {
        all if all > 99.95 => "100 %".to_owned(),
        more if more >= 0.95 => format!("{more:.1} %"),
        less => format!("{less:.2} %"),
    }
}

/// The middle one, the upper of two.
fn median(all: &[f64]) -> Option<f64> {
    let mut sorted = all.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied()
}
