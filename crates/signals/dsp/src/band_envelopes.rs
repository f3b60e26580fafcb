//! Squared envelope spectra of many bands at once, averaged over the segments of a record of any length.
//!
//! Each segment is transformed once; the lines of a band, moved down to zero, give its envelope at twice the
//! rate that the band is wide, which holds all of the squared envelope.
//!
//! Source: R. B. Randall and J. Antoni, Mech. Syst. Signal Process. 25 (2011) 485–520; bands as in the dyadic
//! tree of J. Antoni, Mech. Syst. Signal Process. 21 (2007) 108–124.

use std::sync::Arc;

use realfft::{RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use crate::cycle::Cycle;
use crate::error::{check_band, check_len, check_positive, check_signal};
use crate::{Error, Result};

/// Planned envelopes of several bands. [`BandEnvelopes::add`] does not allocate.
pub struct BandEnvelopes {
    sample_rate_hz: f64,
    segment: usize,
    segments: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    input: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    bands: Vec<Band>,
    /// Period over whose mean course the power is taken, if any.
    cycle: Option<Cycle>,
    work: Work,
}

/// Scratch for one band after the other, sized for the longest.
#[derive(Default)]
struct Work {
    analytic: Vec<Complex<f64>>,
    squared: Vec<f64>,
    output: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

struct Band {
    /// First line of the segment's transform, and the one after the last.
    lines: (usize, usize),
    inverse: Arc<dyn Fft<f64>>,
    transform: Arc<dyn RealToComplex<f64>>,
    window: Vec<f64>,
    /// Sum of the power of each line of the squared envelope.
    power: Vec<f64>,
    /// Sums of the squared envelope and of its square.
    sums: [f64; 2],
}

/// Statistics and squared envelope spectrum of one band.
#[derive(Debug, Clone, PartialEq)]
pub struct BandEnvelope {
    /// Lower end [Hz].
    pub low_hz: f64,
    /// Upper end [Hz].
    pub high_hz: f64,
    /// Root mean square of the band [unit]; near √½ where it is [over a period](BandEnvelopes::over_period).
    pub rms: f64,
    /// Kurtosis of the complex envelope, `⟨|a|⁴⟩/⟨|a|²⟩² − 2`: 0 for Gaussian noise, −1 for a steady tone.
    pub kurtosis: f64,
    /// Distance of the lines of the spectrum [Hz]; the first is at zero.
    pub grid_hz: f64,
    /// Squared envelope spectrum with a Hann window, one-sided, over the square of the mean: a modulation of
    /// the power by `1 + d cos` has lines that add up to `1.5 d²/4 · 2`. See [`BandEnvelope::depth`].
    pub values: Vec<f64>,
    /// Segments averaged.
    pub segments: usize,
}

impl BandEnvelopes {
    /// Plans for segments of `segment` samples and `bands_hz` (low and high end), whose spectra are kept up
    /// to `highest_hz`.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for the rate, [`Error::TooShort`] for a segment below 16 samples,
    /// [`Error::Band`] for a band that leaves 0 to half the sample rate, [`Error::BandTooNarrow`] for one
    /// with fewer than four lines.
    pub fn new(
        sample_rate_hz: f64,
        segment: usize,
        bands_hz: &[(f64, f64)],
        highest_hz: f64,
    ) -> Result<Self> {
        const LEAST: usize = 4;
        check_positive("sample_rate_hz", sample_rate_hz)?;
        check_positive("highest_hz", highest_hz)?;
        if segment < 16 {
            return Err(Error::TooShort {
                field: "segment",
                len: segment,
                least: 16,
                purpose: "envelopes of bands",
            });
        }
        let grid_hz = sample_rate_hz / segment as f64;
        let (mut real, mut complex) = (RealFftPlanner::new(), FftPlanner::new());
        let forward = real.plan_fft_forward(segment);
        let mut bands = Vec::with_capacity(bands_hz.len());
        for &(low_hz, high_hz) in bands_hz {
            check_band(low_hz, high_hz, sample_rate_hz)?;
            // The lines at zero and half the sample rate have no partner to make an envelope with.
            let first = ((low_hz / grid_hz).round() as usize).max(1);
            let end = ((high_hz / grid_hz).round() as usize).min(segment.div_ceil(2));
            let lines = end.saturating_sub(first);
            if lines < LEAST {
                return Err(Error::BandTooNarrow { low_hz, high_hz, bins: lines, least: LEAST, grid_hz });
            }
            let len = smooth(2 * lines);
            let inverse = complex.plan_fft_inverse(len);
            let transform = real.plan_fft_forward(len);
            let kept = ((highest_hz / grid_hz).ceil() as usize + 2).min(lines);
            let turn = std::f64::consts::TAU / len as f64;
            bands.push(Band {
                lines: (first, end),
                window: (0..len).map(|n| 0.5 - 0.5 * (turn * n as f64).cos()).collect(),
                power: vec![0.0; kept],
                sums: [0.0; 2],
                inverse,
                transform,
            });
        }
        let longest = |of: &dyn Fn(&Band) -> usize| bands.iter().map(of).max().unwrap_or(0);
        let scratch = |b: &Band| b.inverse.get_inplace_scratch_len().max(b.transform.get_scratch_len());
        let work = Work {
            analytic: vec![Complex::default(); longest(&|b| b.window.len())],
            squared: vec![0.0; longest(&|b| b.window.len())],
            output: vec![Complex::default(); longest(&|b| b.transform.complex_len())],
            scratch: vec![Complex::default(); longest(&scratch)],
        };
        Ok(Self {
            sample_rate_hz,
            segment,
            segments: 0,
            input: forward.make_input_vec(),
            spectrum: forward.make_output_vec(),
            scratch: forward.make_scratch_vec(),
            forward,
            bands,
            cycle: None,
            work,
        })
    }

    /// The same with the power of each band in each segment over its own mean course in a period of
    /// `frequency_hz`, which removes what repeats with it. A modulation of that course remains at its own
    /// frequency, without sidebands of the removed lines. A band in which a period holds fewer than four
    /// samples is left out.
    pub fn over_period(mut self, frequency_hz: f64) -> Result<Self> {
        self.cycle = Some(Cycle::new(frequency_hz, self.work.squared.len())?);
        Ok(self)
    }

    /// A length of at most `record` samples whose transform is fast, and at most `longest`.
    pub fn segment_of(record: usize, longest: usize) -> usize {
        let most = record.min(longest);
        // The largest 2ᵃ·3ᵇ·5ᶜ that fits; every other line would cost time or samples.
        let mut best = 1;
        for five in std::iter::successors(Some(1_usize), |n| n.checked_mul(5)).take_while(|n| *n <= most) {
            for three in std::iter::successors(Some(five), |n| n.checked_mul(3)).take_while(|n| *n <= most) {
                best = best.max(three << (most / three).ilog2());
            }
        }
        best
    }

    /// Samples of a segment.
    pub fn segment(&self) -> usize {
        self.segment
    }

    /// Segments added so far.
    pub fn segments(&self) -> usize {
        self.segments
    }

    /// Adds a segment.
    pub fn add(&mut self, segment: &[f64]) -> Result<()> {
        check_len("segment", segment.len(), self.segment)?;
        check_signal(segment, 1, "an envelope")?;
        self.input.copy_from_slice(segment);
        self.forward
            .process_with_scratch(&mut self.input, &mut self.spectrum, &mut self.scratch)
            .expect("all three buffers have the plan's lengths");
        let scale = 2.0 / self.segment as f64;
        let duration_s = self.segment as f64 / self.sample_rate_hz;
        for band in &mut self.bands {
            let cycle = self.cycle.as_mut().map(|cycle| (cycle, duration_s));
            band.add(&self.spectrum, scale, cycle, &mut self.work);
        }
        self.segments += 1;
        Ok(())
    }

    /// Results of the bands, in the order of the plan; empty before a segment was added. A band without
    /// signal is left out.
    pub fn bands(&self) -> Vec<BandEnvelope> {
        let grid_hz = self.sample_rate_hz / self.segment as f64;
        self.bands
            .iter()
            .filter_map(|band| band.finish(grid_hz, self.sample_rate_hz, self.segments))
            .collect()
    }
}

impl Band {
    fn add(
        &mut self,
        spectrum: &[Complex<f64>],
        scale: f64,
        cycle: Option<(&mut Cycle, f64)>,
        work: &mut Work,
    ) {
        let ((first, end), len) = (self.lines, self.window.len());
        let (analytic, squared) = (&mut work.analytic[..len], &mut work.squared[..len]);
        let output = &mut work.output[..self.transform.complex_len()];
        let (held, rest) = analytic.split_at_mut(end - first);
        held.iter_mut().zip(&spectrum[first..end]).for_each(|(a, x)| *a = x * scale);
        rest.fill(Complex::default());
        self.inverse.process_with_scratch(analytic, &mut work.scratch);
        let count = len as f64;
        squared.iter_mut().zip(&*analytic).for_each(|(e, a)| *e = a.norm_sqr());
        if let Some((cycle, duration_s)) = cycle {
            cycle.divide(squared, duration_s);
        }
        let mut sums = [0.0; 2];
        for e in &*squared {
            sums[0] += e;
            sums[1] += e * e;
        }
        let mean = sums[0] / count;
        self.sums.iter_mut().zip(sums).for_each(|(all, sum)| *all += sum / count);
        squared.iter_mut().zip(&self.window).for_each(|(e, w)| *e = (*e - mean) * w);
        let scratch = self.transform.get_scratch_len();
        self.transform
            .process_with_scratch(squared, output, &mut work.scratch[..scratch])
            .expect("all three buffers have the plan's lengths");
        // (Σw)² = count²/4 for the Hann window.
        let scale = 8.0 / (count * count);
        self.power.iter_mut().zip(&*output).for_each(|(p, x)| *p += scale * x.norm_sqr());
    }

    fn finish(&self, grid_hz: f64, sample_rate_hz: f64, segments: usize) -> Option<BandEnvelope> {
        let mean = self.sums[0] / segments as f64;
        if mean.is_nan() || mean <= 0.0 {
            return None;
        }
        let scale = 1.0 / (segments as f64 * mean * mean);
        Some(BandEnvelope {
            low_hz: self.lines.0 as f64 * grid_hz,
            // The last line may end half a line, or a rounding, beyond what the samples hold.
            high_hz: (self.lines.1 as f64 * grid_hz).min(0.5 * sample_rate_hz),
            rms: (0.5 * mean).sqrt(),
            kurtosis: self.sums[1] / segments as f64 / (mean * mean) - 2.0,
            grid_hz,
            values: self.power.iter().map(|p| p * scale).collect(),
            segments,
        })
    }
}

impl BandEnvelope {
    /// How deep the power of the band is modulated at `frequency_hz`, `d` of `1 + d cos`: 0 for none, 1 when
    /// it falls to zero in between, 2 for short bursts. Power within two lines of it counts.
    pub fn depth(&self, frequency_hz: f64) -> f64 {
        const REACH: usize = 2;
        /// Equivalent noise bandwidth of the Hann window [lines].
        const NOISE_BANDWIDTH: f64 = 1.5;
        let at = (frequency_hz / self.grid_hz).round() as usize;
        let end = (at + REACH + 1).min(self.values.len());
        let sum: f64 = self.values[at.saturating_sub(REACH).min(end)..end].iter().sum();
        (2.0 * sum / NOISE_BANDWIDTH).sqrt()
    }
}

/// An autocorrelation.
#[derive(Debug, Clone, PartialEq)]
pub struct Autocorrelation {
    /// Distance of the values [s].
    step_s: f64,
    /// 1 at first.
    values: Vec<f64>,
}

impl BandEnvelope {
    /// Autocorrelation of the band's power less its mean, from the transform of the spectrum: it finds events
    /// whose spacing holds for a while only. Values lie half a period of the spectrum's end apart; a lag must
    /// be short beside a segment.
    ///
    /// # Errors
    /// [`Error::TooShort`] for a spectrum of fewer than four lines, [`Error::Undefined`] for power that does
    /// not change.
    pub fn autocorrelation(&self) -> Result<Autocorrelation> {
        /// Lines of a Hann window about zero, which are those of the mean.
        const MEAN: usize = 2;
        const LEAST: usize = 4;
        let lines = self.values.len();
        if lines < LEAST {
            let purpose = "an autocorrelation";
            return Err(Error::TooShort { field: "values", len: lines, least: LEAST, purpose });
        }
        let len = 2 * (lines - 1);
        let inverse = RealFftPlanner::<f64>::new().plan_fft_inverse(len);
        let mut power: Vec<Complex<f64>> = self.values.iter().map(|v| Complex::new(*v, 0.0)).collect();
        power[..MEAN].fill(Complex::default());
        let mut values = inverse.make_output_vec();
        inverse.process(&mut power, &mut values).expect("both buffers have the plan's lengths");
        let all = values[0];
        if !all.is_finite() || all <= 0.0 {
            let why = "the power of the band does not change";
            return Err(Error::Undefined { quantity: "autocorrelation", why });
        }
        values.truncate(len / 2);
        values.iter_mut().for_each(|v| *v /= all);
        Ok(Autocorrelation { step_s: 1.0 / (len as f64 * self.grid_hz), values })
    }
}

impl Autocorrelation {
    /// The value nearest to a lag [s]; `None` beyond half a segment.
    pub fn at(&self, lag_s: f64) -> Option<f64> {
        self.values.get((lag_s / self.step_s).round() as usize).copied()
    }
}

/// The smallest even 2ᵃ·3ᵇ·5ᶜ that is not below `least`.
fn smooth(least: usize) -> usize {
    let smooth = |mut n: usize| {
        for factor in [2, 3, 5] {
            while n.is_multiple_of(factor) {
                n /= factor;
            }
        }
        n == 1
    };
    (least.next_multiple_of(2)..).step_by(2).find(|n| smooth(*n)).unwrap_or(least)
}
