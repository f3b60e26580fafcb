//! Spectral correlation and coherence: at which cyclic frequency is which part of the spectrum modulated?

use std::f64::consts::TAU;

use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::error::{check_band, check_positive, check_signal};
use crate::{Error, Result, Window};

/// Normalisation of a spectral correlation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cyclic {
    /// Nothing: the spectral correlation [unit²/Hz].
    Correlation,
    /// The power at both frequencies: the spectral coherence, 0 for stationary noise but for its scatter, 1
    /// for full modulation.
    Coherence,
}

/// Spectral correlation or coherence over cyclic and carrier frequency.
#[derive(Debug, Clone, PartialEq)]
pub struct SpectralCorrelation {
    /// Distance of neighbouring cyclic frequencies [Hz], the first of which is 0: one over the length of the
    /// record.
    pub cyclic_grid_hz: f64,
    /// Number of cyclic frequencies.
    pub cyclic: usize,
    /// Distance of neighbouring carrier frequencies [Hz], the first of which is 0.
    pub grid_hz: f64,
    /// Values, one row a carrier frequency, one column a cyclic frequency.
    pub values: Vec<Complex<f64>>,
}

/// Fast spectral correlation of `signal` up to the cyclic frequency `highest_hz`, with carrier frequencies
/// `sample_rate_hz / window` apart (periodic Hann window).
///
/// With `X(i, f)` the transform of the segment about sample `iR + window/2`, R at most half a period of
/// `highest_hz`,
///
/// `S(α, f) = R_w(0)/Σ_p R_w(α − pΔf) · Σ_i X(i, f) Σ_p X*(i, f − pΔf) e^{−2πjα(iR + window/2)/fs} / (K ‖w‖²
/// fs)`,
///
/// p from 0 to `highest_hz/Δf`, rounded up, and `R_w` the transform of the squared window. It is the
/// correlation of the components at f and at f − α. For the coherence every X is divided by the root of its
/// mean power first. Memory: 16 bytes × cyclic × (window/2 + 1).
///
/// Source: J. Antoni, G. Xin and N. Hamzaoui, Mech. Syst. Signal Process. 92 (2017) 248–277.
///
/// # Errors
/// [`Error::NotPositive`], [`Error::TooShort`] for a window below sixteen samples or a record below four
/// windows, [`Error::Band`] for cyclic frequencies that need more than half the rate or steps of less than a
/// sample, [`Error::NotFinite`].
pub fn spectral_correlation(
    signal: &[f64],
    sample_rate_hz: f64,
    window: usize,
    highest_hz: f64,
    kind: Cyclic,
) -> Result<SpectralCorrelation> {
    const LEAST: usize = 16;
    check_positive("sample_rate_hz", sample_rate_hz)?;
    check_positive("highest_hz", highest_hz)?;
    check_band(0.0, highest_hz, sample_rate_hz)?;
    if window < LEAST {
        return Err(Error::TooShort {
            field: "window",
            len: window,
            least: LEAST,
            purpose: "a spectral correlation",
        });
    }
    check_signal(signal, window.saturating_mul(4), "a spectral correlation with this window")?;
    let weights = Window::Hann.samples(window)?;
    let energy: f64 = weights.iter().map(|w| w * w).sum();
    // A quarter of a window at most, or the Hann window's own sidelobes would fold.
    let step = ((0.5 * sample_rate_hz / highest_hz) as usize).clamp(1, window / 4);
    let frames = (signal.len() - window) / step + 1;
    let lines = window / 2 + 1;
    let mut transforms = short_time(signal, &weights, step, frames);
    let power: Vec<f64> =
        transforms.chunks_exact(frames).map(|row| row.iter().map(|x| x.norm_sqr()).sum::<f64>()).collect();
    let scale = match kind {
        Cyclic::Correlation => 1.0 / (frames as f64 * energy * sample_rate_hz),
        Cyclic::Coherence => {
            for (row, power) in transforms.chunks_exact_mut(frames).zip(&power) {
                let factor = if *power > 0.0 { (frames as f64 / power).sqrt() } else { 0.0 };
                row.iter_mut().for_each(|x| *x *= factor);
            }
            1.0 / frames as f64
        }
    };
    let grid_hz = sample_rate_hz / window as f64;
    let shifts = (highest_hz / grid_hz).ceil() as usize;
    let cyclic_grid_hz = sample_rate_hz / (step * frames) as f64;
    let cyclic = ((highest_hz / cyclic_grid_hz) as usize + 1).min(frames / 2 + 1);
    let gains = gains(&weights, cyclic, shifts, |n| n as f64 * cyclic_grid_hz / sample_rate_hz);
    let transform = FftPlanner::new().plan_fft_forward(frames);
    let mut scratch = vec![Complex::default(); transform.get_inplace_scratch_len()];
    let mut products = vec![Complex::default(); frames];
    let mut values = Vec::with_capacity(lines * cyclic);
    for line in 0..lines {
        products.fill(Complex::<f64>::default());
        for shift in 0..=shifts {
            // f − pΔf below zero is the conjugate of its mirror image, and beyond the Nyquist line values
            // repeat.
            let below = line as isize - shift as isize;
            let place = below.rem_euclid(window as isize) as usize;
            let (place, mirrored) = if place < lines { (place, false) } else { (window - place, true) };
            let row = &transforms[place * frames..][..frames];
            // Segments count from their middle: the phase of one line of the grid over half a window.
            let sign = if shift.is_multiple_of(2) { 1.0 } else { -1.0 };
            for (sum, x) in products.iter_mut().zip(row) {
                *sum += if mirrored { *x } else { x.conj() } * sign;
            }
        }
        let row = &transforms[line * frames..][..frames];
        products.iter_mut().zip(row).for_each(|(sum, x)| *sum *= x);
        transform.process_with_scratch(&mut products, &mut scratch);
        values.extend(products.iter().take(cyclic).enumerate().map(|(n, s)| {
            let turns = -(n as f64) * 0.5 * window as f64 / (step * frames) as f64;
            s * Complex::from_polar(scale * gains[n], TAU * turns)
        }));
    }
    Ok(SpectralCorrelation { cyclic_grid_hz, cyclic, grid_hz, values })
}

/// Transforms of all segments, one row a line of the grid.
fn short_time(signal: &[f64], weights: &[f64], step: usize, frames: usize) -> Vec<Complex<f64>> {
    let forward = RealFftPlanner::<f64>::new().plan_fft_forward(weights.len());
    let (mut input, mut output, mut scratch) =
        (forward.make_input_vec(), forward.make_output_vec(), forward.make_scratch_vec());
    let mut all = vec![Complex::default(); frames * output.len()];
    for frame in 0..frames {
        for (slot, (x, w)) in input.iter_mut().zip(signal[frame * step..].iter().zip(weights)) {
            *slot = x * w;
        }
        forward
            .process_with_scratch(&mut input, &mut output, &mut scratch)
            .expect("all three buffers have the plan's lengths");
        for (line, x) in output.iter().enumerate() {
            all[line * frames + frame] = *x;
        }
    }
    all
}

/// `R_w(0)/Σ_p R_w(α − pΔf)` for each cyclic frequency `turns(n)` [turns a sample].
fn gains(weights: &[f64], cyclic: usize, shifts: usize, turns: impl Fn(usize) -> f64) -> Vec<f64> {
    let middle = 0.5 * weights.len() as f64;
    let squared = |turns: f64| -> f64 {
        weights.iter().enumerate().map(|(n, w)| w * w * (TAU * turns * (n as f64 - middle)).cos()).sum()
    };
    let at_zero = squared(0.0);
    let of = |n: usize| {
        let sum: f64 = (0..=shifts).map(|p| squared(turns(n) - p as f64 / weights.len() as f64)).sum();
        at_zero / sum
    };
    (0..cyclic).map(of).collect()
}

impl SpectralCorrelation {
    /// Number of carrier frequencies.
    pub fn lines(&self) -> usize {
        self.values.len() / self.cyclic
    }

    /// Values of one carrier frequency over the cyclic frequencies.
    pub fn row(&self, line: usize) -> &[Complex<f64>] {
        &self.values[line * self.cyclic..][..self.cyclic]
    }

    /// Mean magnitude over a band of carrier frequencies [Hz], both ends included, for each cyclic frequency.
    /// Of the coherence this is the enhanced envelope spectrum over the whole range, the improved one over a
    /// chosen band.
    ///
    /// # Errors
    /// [`Error::BandTooNarrow`] for a band without a line of the grid.
    pub fn envelope_spectrum(&self, low_hz: f64, high_hz: f64) -> Result<Vec<f64>> {
        let inside: Vec<usize> =
            (0..self.lines()).filter(|n| (low_hz..=high_hz).contains(&(*n as f64 * self.grid_hz))).collect();
        if inside.is_empty() {
            return Err(Error::BandTooNarrow { low_hz, high_hz, bins: 0, least: 1, grid_hz: self.grid_hz });
        }
        let mut sums = vec![0.0; self.cyclic];
        for line in &inside {
            sums.iter_mut().zip(self.row(*line)).for_each(|(sum, s)| *sum += s.norm());
        }
        sums.iter_mut().for_each(|sum| *sum /= inside.len() as f64);
        Ok(sums)
    }
}
