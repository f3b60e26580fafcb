//! One pass over the samples of a channel, segment by segment: a record of hours takes no more memory than
//! one of seconds.

use stribeck_dsp::channel::Channel;
use stribeck_dsp::{BandEnvelope, BandEnvelopes, Welch, WelchOptions};

use crate::Error;
use crate::record::bands::{HIGHEST_HZ, bands};
use crate::record::course::{Course, Tracing};
use crate::record::quality::{self, Inspection, Quality};
use crate::record::screening::{Health, Screening};
use crate::record::unit::MotionUnit;
use crate::record::velocity::VelocityLevel;

/// Longest segment [samples]: its envelopes take some tens of megabytes.
const LONGEST_SEGMENT: usize = 1 << 20;
/// Segments of records that are longer.
const SEGMENT: usize = 1 << 19;
/// Segment of the density [samples].
const DENSITY_SEGMENT: usize = 1 << 13;

/// Shortest record that is analysed [samples].
const LEAST: usize = 1024;

/// A valid record: everything that one pass over its samples yields.
pub(crate) struct Record {
    /// Samples a second [Hz].
    pub(crate) rate_hz: f64,
    /// Samples read.
    pub(crate) count: u64,
    /// Length of a segment of the envelope spectra [samples].
    pub(crate) segment: usize,
    /// Segments averaged.
    pub(crate) segments: usize,
    /// Squared envelope spectra of all bands.
    pub(crate) bands: Vec<BandEnvelope>,
    /// Power spectral density: frequencies [Hz] and values [unit²/Hz].
    pub(crate) density: (Vec<f64>, Vec<f64>),
    pub(crate) course: Course,
    /// Root mean square of the velocity [mm/s], where the channel is an acceleration.
    pub(crate) velocity_mm_s: Option<f64>,
    pub(crate) health: Health,
    /// The first samples, as many as one segment may hold.
    pub(crate) kept: Vec<f64>,
    /// Faults of the samples.
    pub(crate) notes: Vec<String>,
    /// What sensor and recorder did to them; lines of the mains are not among it.
    pub(crate) quality: Vec<Quality>,
}

impl Record {
    /// Reads a channel sampled `rate_hz` times a second.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read, [`Error::NoSignal`] for a record that is too short or
    /// constant, [`Error::Signal`] when it cannot be processed.
    pub(crate) fn read(channel: &Channel, rate_hz: f64) -> Result<Self, Error> {
        if !rate_hz.is_finite() || rate_hz <= 0.0 {
            return Err(Error::NoSignal(format!("a sample rate of {rate_hz} Hz; give one above 0")));
        }
        let len = usize::try_from(channel.len).unwrap_or(usize::MAX);
        if len < LEAST {
            return Err(Error::NoSignal(format!(
                "channel `{}` holds {len} samples; {LEAST} are the least",
                channel.name
            )));
        }
        let pass = Pass::over(channel, rate_hz, len)?;
        let mut notes = pass.notes(rate_hz);
        pass.refuse(channel, &notes)?;
        notes.extend(pass.remainder_note(rate_hz, len));
        let Pass { segment, envelopes, density, tracing, velocity, screening, inspection, kept, .. } = pass;
        let density = density.finish();
        let folded = quality::folded(&density.0, &density.1);
        let quality = inspection.finish(&kept).into_iter().chain(folded).collect();
        let Some(health) = screening.health(&density.1) else {
            return Err(Error::NoSignal(format!(
                "channel `{}` is constant; is the sensor connected?",
                channel.name
            )));
        };
        Ok(Self {
            rate_hz,
            count: screening.count(),
            segment,
            segments: envelopes.segments(),
            bands: envelopes.bands(),
            density,
            course: tracing.finish(),
            velocity_mm_s: velocity.as_ref().and_then(VelocityLevel::finish),
            health,
            kept,
            notes,
            quality,
        })
    }

    /// Length of the record [s].
    pub(crate) fn duration_s(&self) -> f64 {
        self.count as f64 / self.rate_hz
    }

    /// Length of a segment [s].
    pub(crate) fn segment_s(&self) -> f64 {
        self.segment as f64 / self.rate_hz
    }
}

struct Pass {
    /// Length of a segment [samples].
    segment: usize,
    envelopes: BandEnvelopes,
    density: Density,
    tracing: Tracing,
    /// `None` where the channel is no acceleration, or too short.
    velocity: Option<VelocityLevel>,
    screening: Screening,
    inspection: Inspection,
    /// The first samples, as many as one segment may hold.
    kept: Vec<f64>,
    /// Samples that fill no segment yet.
    buffer: Vec<f64>,
    /// Segments with values that are not numbers.
    refused: usize,
}

impl Pass {
    /// Reads a channel of `len` samples.
    fn over(channel: &Channel, rate_hz: f64, len: usize) -> Result<Self, Error> {
        let longest_kept = BandEnvelopes::segment_of(len, LONGEST_SEGMENT);
        let segment = if len > LONGEST_SEGMENT { SEGMENT } else { longest_kept };
        let highest_hz = HIGHEST_HZ.min(0.5 * rate_hz);
        let unit = channel.unit.as_deref().and_then(MotionUnit::parse);
        let mut pass = Self {
            segment,
            envelopes: BandEnvelopes::new(rate_hz, segment, &bands(rate_hz), highest_hz)
                .map_err(Error::Signal)?,
            density: Density::new(rate_hz, segment)?,
            tracing: Tracing::new(rate_hz, len)?,
            velocity: VelocityLevel::new(rate_hz, segment, unit)?,
            screening: Screening::default(),
            inspection: Inspection::new(rate_hz, len),
            kept: Vec::with_capacity(longest_kept),
            buffer: Vec::with_capacity(segment),
            refused: 0,
        };
        let mut failed = None;
        channel.for_each_block(|block| {
            pass.kept.extend(block.iter().take(longest_kept - pass.kept.len()));
            failed = pass.add(block).err();
            failed.is_none()
        })?;
        failed.map_or(Ok(pass), |why| Err(Error::Signal(why)))
    }

    /// Samples as they follow.
    fn add(&mut self, mut block: &[f64]) -> Result<(), stribeck_dsp::Error> {
        self.screening.add(block);
        self.inspection.add(block);
        while !block.is_empty() {
            let (now, later) = block.split_at((self.segment - self.buffer.len()).min(block.len()));
            self.buffer.extend_from_slice(now);
            block = later;
            if self.buffer.len() == self.segment {
                self.add_segment()?;
                self.buffer.clear();
            }
        }
        Ok(())
    }

    /// The segment that the buffer holds.
    fn add_segment(&mut self) -> Result<(), stribeck_dsp::Error> {
        let samples = &self.buffer;
        if !samples.iter().all(|x| x.is_finite()) {
            self.tracing.skip(samples.len());
            self.refused += 1;
            return Ok(());
        }
        self.envelopes.add(samples)?;
        self.density.add(samples)?;
        self.tracing.add(samples)?;
        self.velocity.as_mut().map_or(Ok(()), |level| level.add(samples))
    }

    fn notes(&self, rate_hz: f64) -> Vec<String> {
        let mut notes = self.screening.notes(rate_hz);
        if self.refused > 0 {
            notes.push(format!(
                "{} segments of {} samples hold values that are not numbers and are left out",
                self.refused, self.segment
            ));
        }
        notes
    }

    /// Refuses a channel without a whole segment of numbers, and one whose powers no number can hold.
    fn refuse(&self, channel: &Channel, notes: &[String]) -> Result<(), Error> {
        if self.envelopes.segments() == 0 {
            return Err(Error::NoSignal(format!(
                "channel `{}` has no run of {} numbers: {}. Cut the record to its valid part",
                channel.name,
                self.segment,
                notes.join("; ")
            )));
        }
        if let Some(reach) = self.screening.out_of_range() {
            return Err(Error::NoSignal(format!(
                "channel `{}` moves by {reach:.1e}, whose powers lie beyond the range of numbers: bring it \
                 near 1 with `--scale`",
                channel.name
            )));
        }
        Ok(())
    }

    /// How much of a record of `len` samples fills no segment, where that is more than a twentieth.
    fn remainder_note(&self, rate_hz: f64, len: usize) -> Option<String> {
        let left = self.buffer.len();
        (left * 20 > len).then(|| {
            format!("the last {:.2} s fill no segment and are left out of the spectra", left as f64 / rate_hz)
        })
    }
}

/// Density averaged over everything that was added.
struct Density {
    welch: Welch,
    segment: usize,
    sum: Vec<f64>,
    count: usize,
}

impl Density {
    fn new(rate_hz: f64, segment: usize) -> Result<Self, Error> {
        let options = WelchOptions::new(DENSITY_SEGMENT.min(segment));
        let welch = Welch::new(rate_hz, segment, &options).map_err(Error::Signal)?;
        Ok(Self { sum: vec![0.0; welch.blank().values().len()], welch, segment, count: 0 })
    }

    fn add(&mut self, samples: &[f64]) -> Result<(), stribeck_dsp::Error> {
        debug_assert_eq!(samples.len(), self.segment);
        let spectrum = self.welch.estimate(samples)?;
        self.sum.iter_mut().zip(spectrum.values()).for_each(|(sum, v)| *sum += v);
        self.count += 1;
        Ok(())
    }

    fn finish(self) -> (Vec<f64>, Vec<f64>) {
        let count = self.count.max(1) as f64;
        (self.welch.blank().frequencies_hz().to_vec(), self.sum.iter().map(|s| s / count).collect())
    }
}
