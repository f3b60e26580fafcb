//! The envelope of a modulated signal and its spectrum: at what rate do impulses repeat?

use std::fmt;
use std::sync::Arc;

use realfft::{RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use crate::error::{check_band, check_len, check_positive, check_signal};
use crate::{Detrend, Error, Resolution, Result, Scaling, Spectrum, Welch, WelchOptions, Window};

/// A planned Hilbert envelope, `abs(scipy.signal.hilbert(x))`, for records of one length.
///
/// The record is taken as periodic, so values near its ends are unreliable. Its mean stays in the envelope:
/// remove it, or choose a band.
pub struct Envelope {
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn Fft<f64>>,
    /// Factor of each bin that is not negative: 2/N, half of it at the ends, 0 outside the band.
    weights: Vec<f64>,
    /// The record, which its transform destroys.
    record: Vec<f64>,
    data: Vec<Complex<f64>>,
    /// Of the forward and of the inverse transform.
    scratch: [Vec<Complex<f64>>; 2],
}

impl Envelope {
    /// Plans for records of `record` samples. Lengths with a large prime factor are slow.
    ///
    /// # Errors
    /// [`Error::TooShort`] for an empty record.
    pub fn new(record: usize) -> Result<Self> {
        if record == 0 {
            return Err(Error::TooShort { field: "record", len: 0, least: 1, purpose: "an envelope" });
        }
        let scale = 1.0 / record as f64;
        let weight = |bin: usize| match bin {
            0 => scale,
            _ if 2 * bin == record => scale,
            _ => 2.0 * scale,
        };
        let forward = RealFftPlanner::new().plan_fft_forward(record);
        let inverse = FftPlanner::new().plan_fft_inverse(record);
        let scratch = [forward.get_scratch_len(), inverse.get_inplace_scratch_len()];
        Ok(Self {
            forward,
            inverse,
            weights: (0..=record / 2).map(weight).collect(),
            record: vec![0.0; record],
            data: vec![Complex::default(); record],
            scratch: scratch.map(|len| vec![Complex::default(); len]),
        })
    }

    /// Plans the envelope of the band between two frequencies [Hz], both included: everything else is set to
    /// zero in the transform. That is a band-pass with infinitely steep flanks, and it rings by about one
    /// over its width.
    ///
    /// # Errors
    /// Those of [`Envelope::new`], [`Error::NotPositive`] for the sample rate, [`Error::Band`] for a band
    /// that leaves 0 to half the sample rate, [`Error::BandTooNarrow`] for one with fewer than two transform
    /// lines.
    pub fn in_band(sample_rate_hz: f64, record: usize, low_hz: f64, high_hz: f64) -> Result<Self> {
        // A single line has a constant envelope whatever the signal was.
        const LEAST: usize = 2;
        check_positive("sample_rate_hz", sample_rate_hz)?;
        check_band(low_hz, high_hz, sample_rate_hz)?;
        let mut plan = Self::new(record)?;
        let grid_hz = sample_rate_hz / record as f64;
        let mut bins = 0;
        for bin in 0..=record / 2 {
            let frequency_hz = bin as f64 * grid_hz;
            if frequency_hz < low_hz || frequency_hz > high_hz {
                plan.weights[bin] = 0.0;
            } else {
                bins += 1;
            }
        }
        if bins < LEAST {
            return Err(Error::BandTooNarrow { low_hz, high_hz, bins, least: LEAST, grid_hz });
        }
        Ok(plan)
    }

    /// Writes the envelope [unit] of `signal` [unit] into `out`, never negative. Does not allocate.
    ///
    /// # Errors
    /// [`Error::WrongLength`] for a slice of another length than planned, [`Error::NotFinite`] for a bad
    /// sample.
    pub fn process(&mut self, signal: &[f64], out: &mut [f64]) -> Result<()> {
        check_len("signal", signal.len(), self.record.len())?;
        check_len("out", out.len(), self.record.len())?;
        check_signal(signal, 1, "an envelope")?;
        self.record.copy_from_slice(signal);
        let (kept, negative) = self.data.split_at_mut(self.weights.len());
        self.forward
            .process_with_scratch(&mut self.record, kept, &mut self.scratch[0])
            .expect("all buffers have the plan's lengths");
        kept.iter_mut().zip(&self.weights).for_each(|(z, &w)| *z *= w);
        negative.fill(Complex::default());
        self.inverse.process_with_scratch(&mut self.data, &mut self.scratch[1]);
        // Not the norm, which guards against magnitudes beyond 10¹⁵⁴ at three times the price.
        out.iter_mut().zip(&self.data).for_each(|(a, z)| *a = z.norm_sqr().sqrt());
        Ok(())
    }
}

/// A planned squared envelope spectrum: the power spectrum [unit⁴] of the squared envelope less its mean,
/// over the whole record with a Hann window.
///
/// Repeated impacts show as lines at their rate and its multiples, whatever the resonance they excite.
/// Source: R. B. Randall and J. Antoni, Mech. Syst. Signal Process. 25 (2011) 485–520.
pub struct EnvelopeSpectrum {
    envelope: Envelope,
    squared: Vec<f64>,
    welch: Welch,
}

impl EnvelopeSpectrum {
    /// Plans for records of `record` samples. `band_hz` limits the signal first (low and high end [Hz]), as
    /// [`Envelope::in_band`] does; `None` takes all of it.
    pub fn new(sample_rate_hz: f64, record: usize, band_hz: Option<(f64, f64)>) -> Result<Self> {
        let options = WelchOptions {
            window: Window::Hann,
            detrend: Detrend::Constant,
            scaling: Scaling::Spectrum,
            ..WelchOptions::new(record)
        };
        let welch = Welch::new(sample_rate_hz, record, &options)?;
        let envelope = match band_hz {
            Some((low_hz, high_hz)) => Envelope::in_band(sample_rate_hz, record, low_hz, high_hz)?,
            None => Envelope::new(record)?,
        };
        Ok(Self { envelope, squared: vec![0.0; record], welch })
    }

    /// Resolution of the spectrum.
    pub fn resolution(&self) -> &Resolution {
        self.welch.resolution()
    }

    /// A spectrum of zeros for [`EnvelopeSpectrum::process`] to fill. Allocates.
    pub fn blank(&self) -> Spectrum {
        self.welch.blank()
    }

    /// Writes the squared envelope spectrum of `signal` into `out`, which [`EnvelopeSpectrum::blank`] made.
    /// Does not allocate.
    pub fn process(&mut self, signal: &[f64], out: &mut Spectrum) -> Result<()> {
        self.envelope.process(signal, &mut self.squared)?;
        self.squared.iter_mut().for_each(|a| *a *= *a);
        self.welch.process(&self.squared, out)
    }
}

/// Whether a record is long enough to resolve a repetition rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PeriodVerdict {
    /// Below ten periods: an envelope spectrum would mislead.
    TooFew,
    /// Ten periods or more: the line is found.
    Enough,
    /// Twenty-seven periods or more: its sidebands can be resolved, too.
    Comfortable,
}

/// How many periods of a repetition a record holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PeriodCount {
    record_s: f64,
    repetition_hz: f64,
}

impl PeriodCount {
    /// Periods that envelope analysis needs.
    pub const ENOUGH: f64 = 10.0;
    /// Periods with which it is comfortable.
    pub const COMFORTABLE: f64 = 27.0;

    /// For a record of `record_s` [s] and events that repeat `repetition_hz` times a second.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for either.
    pub fn new(record_s: f64, repetition_hz: f64) -> Result<Self> {
        check_positive("record_s", record_s)?;
        check_positive("repetition_hz", repetition_hz)?;
        Ok(Self { record_s, repetition_hz })
    }

    /// Number of periods, with its fraction.
    pub fn periods(&self) -> f64 {
        self.record_s * self.repetition_hz
    }

    /// Whether that is enough.
    pub fn verdict(&self) -> PeriodVerdict {
        match self.periods() {
            few if few < Self::ENOUGH => PeriodVerdict::TooFew,
            some if some < Self::COMFORTABLE => PeriodVerdict::Enough,
            _ => PeriodVerdict::Comfortable,
        }
    }

    /// Shortest record [s] that would be enough.
    pub fn needed_s(&self) -> f64 {
        Self::ENOUGH / self.repetition_hz
    }
}

impl fmt::Display for PeriodCount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (held, rate) = (self.periods(), self.repetition_hz);
        write!(f, "the record of {:.4} s holds {held:.1} periods of {rate:.2} Hz: ", self.record_s)?;
        match self.verdict() {
            PeriodVerdict::TooFew => {
                write!(f, "too few for an envelope spectrum, {:.3} s are needed", self.needed_s())
            }
            PeriodVerdict::Enough => f.write_str("enough for an envelope spectrum"),
            PeriodVerdict::Comfortable => f.write_str("comfortable for an envelope spectrum"),
        }
    }
}
