//! The stages of an analysis, from a channel to a verdict.

use stribeck_dsp::BandEnvelope;
use stribeck_dsp::channel::Channel;

use crate::families::verdict::orders_and_speed;
use crate::judged::Judged;
use crate::length::estimate;
use crate::record::enhanced::{self, Enhanced};
use crate::record::pass::Record;
use crate::record::quality::{self, Quality};
use crate::{Course, Error, Family, Machine, MeasuredFindings, SPEEDS_RPM, SoundAsHigh, Varying};

/// The numbers and the curves that a report draws.
#[derive(Debug, Clone)]
pub struct Analysis {
    /// The numbers.
    pub findings: MeasuredFindings,
    /// The first samples, for a picture.
    pub beginning: Vec<f64>,
    /// Power spectral density: frequencies [Hz] and values [unit²/Hz].
    pub density: (Vec<f64>, Vec<f64>),
    /// Squared envelope spectra of all bands.
    pub bands: Vec<BandEnvelope>,
    /// The same over the period of the defect that stands highest; none without a defect.
    pub over: Vec<BandEnvelope>,
    /// Density over time.
    pub course: Course,
    /// Spectra over speed and angle where the speed varies; filled by the caller, which has the times of the
    /// turns.
    pub varying: Option<Varying>,
    /// The machine at the speed, and with the rolling elements, that were taken.
    pub machine: Machine,
    /// Enhanced envelope spectrum of the beginning; `None` for a record too short for it.
    pub enhanced: Option<Enhanced>,
}

/// Samples kept for the picture.
const SHOWN: usize = 1 << 16;
/// Harmonics of the fastest family in the enhanced envelope spectrum.
const HARMONICS: f64 = 3.2;
/// Its highest frequency when no family is known [Hz].
const UNKNOWN_HZ: f64 = 500.0;

impl Analysis {
    /// Analyses a channel sampled `rate_hz` times a second.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read, [`Error::NoSignal`] for a record that is too short or
    /// constant, [`Error::Signal`] when it cannot be processed.
    pub fn of(channel: &Channel, rate_hz: f64, machine: &Machine) -> Result<Self, Error> {
        Self::of_inspected(channel, rate_hz, machine, None)
    }

    /// As [`Analysis::of`]; `quality` is that of the samples as they were measured ([`quality::of`]), where the
    /// channel was made of them, or nothing for simulated ones, which no sensor has spoilt.
    pub fn of_inspected(
        channel: &Channel,
        rate_hz: f64,
        machine: &Machine,
        quality: Option<Vec<Quality>>,
    ) -> Result<Self, Error> {
        if let Some(rpm) = machine.speed_rpm.filter(|rpm| !SPEEDS_RPM.contains(rpm)) {
            return Err(Error::NoSignal(format!(
                "a speed of {rpm} rpm: shafts turn {} to {} times a minute; is it in another unit?",
                SPEEDS_RPM.start(),
                SPEEDS_RPM.end()
            )));
        }
        if let Some(hz) = far_beyond(machine, rate_hz, channel.len as f64 / rate_hz) {
            return Err(Error::NoSignal(format!(
                "families of this bearing at this speed lie at {hz:.3e} Hz, far above half of the {rate_hz} samples \
                 a second; is the speed, a diameter or the rate in another unit?"
            )));
        }
        let mut record = Record::read(channel, rate_hz)?;
        let quality = match quality {
            Some(quality) => quality,
            None => {
                let hum = quality::hum_of(&record.kept, rate_hz, machine.speed_rpm)?;
                std::mem::take(&mut record.quality).into_iter().chain(hum).collect()
            }
        };
        let is_spoilt = quality.iter().any(|found| found.kind.spoils_verdicts());
        let judged = Judged::of(channel, &record, machine, is_spoilt)?;
        let no_signal = quality::no_signal(&quality);
        let Judged { machine: taken, speed, is_corrected, decided, families, over, conclusion, verdict } =
            match &no_signal {
                Some(headline) => judged.without_claims(headline),
                None => judged,
            };
        let spall = estimate::estimate(&record.kept, rate_hz, &taken, &families);
        let enhanced = enhanced::of(&record.kept, rate_hz, enhanced_up_to_hz(&families).min(0.5 * rate_hz))?;
        let duration_s = record.duration_s();
        let of_quality = quality.iter().map(|of| of.words.clone()).collect();
        let reservation = quality::reservation(&quality).filter(|_| no_signal.is_none());
        let notes = [record.notes, of_quality, speed.notes, decided.notes, vec![spall.note]].concat();
        Ok(Self {
            findings: MeasuredFindings {
                channel: channel.name.clone(),
                unit: channel.unit.clone(),
                rate_hz,
                samples: record.count,
                duration_s,
                speed_rpm: taken.speed_rpm,
                speed_given_rpm: speed.given_rpm.filter(|_| is_corrected),
                speed_uncertainty_rpm: speed.uncertainty_rpm,
                bearing: taken.bearing.as_ref().map(|b| format!("{}: {b}", b.name)),
                resolution_hz: rate_hz / record.segment as f64,
                segments: record.segments,
                health: record.health,
                velocity_mm_s: record.velocity_mm_s,
                zone: None,
                families,
                unexplained: decided.unexplained,
                score_db: decided.score_db,
                sound_as_high: decided
                    .sound
                    .map(|sound| SoundAsHigh { as_high: sound.as_high, records: sound.records }),
                conclusion,
                verdict: std::iter::once(verdict).chain(reservation).collect::<Vec<_>>().join(" "),
                spall_mm: spall.length_mm,
                spall_otherwise_mm: spall.otherwise_mm,
                event_spacing_ms: spall.spacing_ms,
                spall_below_mm: spall.below_mm,
                quality,
                notes,
            },
            beginning: record.kept.into_iter().take(SHOWN).collect(),
            density: record.density,
            bands: record.bands,
            over,
            course: record.course,
            varying: None,
            machine: taken,
            enhanced,
        })
    }

    /// The band of the family that stands highest; without one that has the strongest impacts [Hz].
    pub fn leading_band_hz(&self) -> Option<(f64, f64)> {
        let there = self.findings.families.iter().filter(|f| f.is_there() && f.band_hz.is_some());
        let leading = there.min_by(|a, b| a.p_value.total_cmp(&b.p_value)).and_then(|f| f.band_hz);
        let most = self.bands.iter().max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis));
        leading.or_else(|| most.map(|band| (band.low_hz, band.high_hz)))
    }

    /// The band in which a family stands highest.
    pub fn band_of(&self, family: &Family) -> Option<&BandEnvelope> {
        let (low_hz, high_hz) = family.band_hz?;
        let bands = if family.over.is_some() { &self.over } else { &self.bands };
        bands.iter().find(|b| b.low_hz == low_hz && b.high_hz == high_hz)
    }
}

/// The highest frequency of a family, where no record could hold it and the search for it would not end: so many
/// times the sample rate, and as many resolutions.
fn far_beyond(machine: &Machine, rate_hz: f64, duration_s: f64) -> Option<f64> {
    const TIMES: f64 = 10.0;
    const RESOLUTIONS: f64 = 1e5;
    let (orders, shaft_hz) = orders_and_speed(machine).ok()?;
    let hz = shaft_hz * [orders.bpfo, orders.bpfi, orders.bsf].into_iter().fold(0.0, f64::max);
    (hz > TIMES * rate_hz && hz * duration_s > RESOLUTIONS).then_some(hz)
}

/// Highest frequency of the enhanced envelope spectrum [Hz].
fn enhanced_up_to_hz(families: &[Family]) -> f64 {
    let fastest_hz = families.iter().map(|f| f.expected_hz).fold(0.0, f64::max);
    if fastest_hz > 0.0 { HARMONICS * fastest_hz } else { UNKNOWN_HZ }
}
