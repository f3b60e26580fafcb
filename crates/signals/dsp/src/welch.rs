//! Averaged modified periodograms: P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70–73, with the
//! conventions of `scipy.signal.welch`. A periodogram of the whole record is the case of one segment.

use std::sync::Arc;

use realfft::{RealFftPlanner, RealToComplex};
use rustfft::num_complex::Complex;

use crate::averages::median;
use crate::error::{check_len, check_positive, check_signal};
use crate::spectrum::Layout;
use crate::{Averaging, Detrend, Resolution, Result, Scaling, Sides, Spectrum, WelchOptions};

/// A planned spectral estimate for records of one length. Planning allocates; [`Welch::process`] does not.
pub struct Welch {
    layout: Layout,
    detrend: Detrend,
    averaging: Averaging,
    record: usize,
    step: usize,
    window: Vec<f64>,
    /// Factor of |X|² that gives a two-sided value.
    scale: f64,
    transform: Arc<dyn RealToComplex<f64>>,
    input: Vec<f64>,
    output: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    /// For the median: one periodogram after the other.
    history: Vec<f64>,
    /// For the median: one bin of all periodograms.
    column: Vec<f64>,
}

impl Welch {
    /// Plans for records of `record` samples.
    ///
    /// # Errors
    /// [`NotPositive`](crate::Error::NotPositive) for the sample rate,
    /// [`TooShort`](crate::Error::TooShort) for a segment below four samples,
    /// [`SegmentTooLong`](crate::Error::SegmentTooLong), [`Overlap`](crate::Error::Overlap),
    /// [`TransformLength`](crate::Error::TransformLength), [`MedianMemory`](crate::Error::MedianMemory)
    /// for options that do not fit.
    /// (scipy shortens a segment that is longer than the record and warns; here that is an error.)
    pub fn new(sample_rate_hz: f64, record: usize, options: &WelchOptions) -> Result<Self> {
        check_positive("sample_rate_hz", sample_rate_hz)?;
        let window = options.window.samples(options.segment)?;
        options.check(record)?;
        let layout = layout(sample_rate_hz, record, options)?;
        let sum: f64 = window.iter().sum();
        let power: f64 = window.iter().map(|w| w * w).sum();
        let transform = RealFftPlanner::<f64>::new().plan_fft_forward(options.nfft);
        let segments = layout.resolution.segments;
        let (history, column) = match options.averaging {
            Averaging::Mean => (0, 0),
            Averaging::Median => (segments * layout.positive_bins(), segments),
        };
        Ok(Self {
            detrend: options.detrend,
            averaging: options.averaging,
            record,
            step: options.segment - options.overlap,
            window,
            scale: match options.scaling {
                Scaling::Density => 1.0 / (sample_rate_hz * power),
                Scaling::Spectrum => 1.0 / (sum * sum),
            },
            input: transform.make_input_vec(),
            output: transform.make_output_vec(),
            scratch: transform.make_scratch_vec(),
            transform,
            history: vec![0.0; history],
            column: vec![0.0; column],
            layout,
        })
    }

    /// Plans with [`WelchOptions::for_grid`].
    pub fn for_grid(sample_rate_hz: f64, record: usize, grid_hz: f64) -> Result<Self> {
        Self::new(sample_rate_hz, record, &WelchOptions::for_grid(sample_rate_hz, record, grid_hz)?)
    }

    /// Resolution of the spectra of this plan.
    pub fn resolution(&self) -> &Resolution {
        &self.layout.resolution
    }

    /// A spectrum of zeros for [`Welch::process`] to fill. Allocates.
    pub fn blank(&self) -> Spectrum {
        Spectrum::blank(self.layout.clone())
    }

    /// Estimates into a new spectrum. Allocates only that.
    pub fn estimate(&mut self, signal: &[f64]) -> Result<Spectrum> {
        let mut out = self.blank();
        self.process(signal, &mut out)?;
        Ok(out)
    }

    /// Estimates the spectrum of `signal` [unit] into `out`, which [`Welch::blank`] made. Does not allocate.
    ///
    /// # Errors
    /// [`WrongLength`](crate::Error::WrongLength) for a signal of another length than planned,
    /// [`NotFinite`](crate::Error::NotFinite) for a bad sample,
    /// [`ForeignOutput`](crate::Error::ForeignOutput) for a spectrum of another plan. `out` is then
    /// unchanged.
    pub fn process(&mut self, signal: &[f64], out: &mut Spectrum) -> Result<()> {
        check_len("signal", signal.len(), self.record)?;
        check_signal(signal, 1, "a spectrum")?;
        out.check_layout(&self.layout)?;
        out.values.fill(0.0);
        let bins = self.layout.positive_bins();
        for index in 0..self.layout.resolution.segments {
            self.transform_segment(&signal[index * self.step..][..self.layout.segment]);
            match self.averaging {
                Averaging::Mean => {
                    let sums = &mut out.values[..bins];
                    sums.iter_mut().zip(&self.output).for_each(|(sum, x)| *sum += x.norm_sqr());
                }
                Averaging::Median => {
                    let row = &mut self.history[index * bins..][..bins];
                    row.iter_mut().zip(&self.output).for_each(|(value, x)| *value = x.norm_sqr());
                }
            }
        }
        self.average(&mut out.values[..bins]);
        self.arrange_sides(&mut out.values);
        Ok(())
    }

    /// Detrends, weighs, pads and transforms one segment into `self.output`.
    fn transform_segment(&mut self, segment: &[f64]) {
        let (start, slope) = trend(segment, self.detrend);
        let (data, padding) = self.input.split_at_mut(segment.len());
        for n in 0..segment.len() {
            data[n] = self.window[n] * (segment[n] - (start + slope * n as f64));
        }
        padding.fill(0.0);
        self.transform
            .process_with_scratch(&mut self.input, &mut self.output, &mut self.scratch)
            .expect("all three buffers have the plan's lengths");
    }

    /// Turns sums (mean) or the history (median) into two-sided values.
    fn average(&mut self, values: &mut [f64]) {
        let segments = self.layout.resolution.segments;
        match self.averaging {
            Averaging::Mean => values.iter_mut().for_each(|value| *value *= self.scale / segments as f64),
            Averaging::Median => {
                for bin in 0..values.len() {
                    for index in 0..segments {
                        self.column[index] = self.history[index * values.len() + bin];
                    }
                    values[bin] = median(&mut self.column) * self.scale / self.layout.line_bias;
                }
            }
        }
    }

    /// Doubles values that have a partner at the negative frequency, or writes that partner.
    fn arrange_sides(&self, values: &mut [f64]) {
        for bin in (0..self.layout.positive_bins()).filter(|&bin| !self.layout.is_alone(bin)) {
            match self.layout.sides {
                Sides::One => values[bin] *= 2.0,
                Sides::Two => values[self.layout.nfft - bin] = values[bin],
            }
        }
    }
}

fn layout(sample_rate_hz: f64, record: usize, options: &WelchOptions) -> Result<Layout> {
    let &WelchOptions { segment, overlap, nfft, window, .. } = options;
    let step = segment - overlap;
    let segments = options.segments(record);
    let resolution_hz = sample_rate_hz / segment as f64;
    Ok(Layout {
        sample_rate_hz,
        segment,
        nfft,
        scaling: options.scaling,
        sides: options.sides,
        line_bias: match options.averaging {
            Averaging::Mean => 1.0,
            Averaging::Median => median_bias(segments),
        },
        resolution: Resolution {
            record_s: record as f64 / sample_rate_hz,
            segment_s: segment as f64 / sample_rate_hz,
            segments,
            unused_s: (record - segment - (segments - 1) * step) as f64 / sample_rate_hz,
            window,
            resolution_hz,
            width_3db_hz: window.width_3db_bins(segment)? * resolution_hz,
            width_6db_hz: window.width_6db_bins(segment)? * resolution_hz,
            noise_bandwidth_hz: window.noise_bandwidth_bins(segment)? * resolution_hz,
            grid_hz: sample_rate_hz / nfft as f64,
            zero_padded: nfft > segment,
        },
    })
}

/// The trend to remove: its value at the first sample, and its slope per sample.
fn trend(segment: &[f64], detrend: Detrend) -> (f64, f64) {
    let count = segment.len() as f64;
    let mean = segment.iter().sum::<f64>() / count;
    match detrend {
        Detrend::None => (0.0, 0.0),
        Detrend::Constant => (mean, 0.0),
        Detrend::Linear => {
            // About the middle sample the normal equations of the straight line decouple.
            let middle = 0.5 * (count - 1.0);
            let moment: f64 = segment.iter().enumerate().map(|(n, x)| (n as f64 - middle) * (x - mean)).sum();
            let slope = moment / (count * (count * count - 1.0) / 12.0);
            (mean - slope * middle, slope)
        }
    }
}

/// Expected median of `count` unit exponential variables: 1 − 1/2 + 1/3 − … with an odd number of terms.
fn median_bias(count: usize) -> f64 {
    (1..=(count - 1) / 2).fold(1.0, |sum, half| {
        let even = 2.0 * half as f64;
        sum + 1.0 / (even + 1.0) - 1.0 / even
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_median_bias_tends_to_the_logarithm_of_two() {
        // The median of the unit exponential distribution is ln 2; with n samples the bias still is about
        // 1/(2n).
        assert_eq!(median_bias(1), 1.0);
        assert_eq!(median_bias(3), 1.0 - 0.5 + 1.0 / 3.0);
        assert!((median_bias(100_001) - std::f64::consts::LN_2).abs() < 1e-5);
    }
}
