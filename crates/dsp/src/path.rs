//! Paths from a force to a sensor: random resonances, or the path that a record's spectrum implies.

use std::f64::consts::PI;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::error::{check_positive, check_signal};
use crate::{Error, Result};

/// Resonances of a path that is drawn.
const RESONANCES: usize = 12;
/// The lowest one, over half the sample rate of the record.
const LOWEST: f64 = 0.02;
/// Damping ratios: from a bolted casing to one with a gasket.
const DAMPING: (f64, f64) = (0.005, 0.05);
/// Share of the record at either end that is faded in and out.
const FADED: f64 = 0.02;
/// Least density over the highest that a path of a record passes.
const FLOOR: f64 = 1e-8;

/// One mode of a structure, between the place of the force and that of the sensor.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Resonance {
    hz: f64,
    damping: f64,
    strength: f64,
}

/// From a force to the acceleration of a sensor: a sum of modes.
#[derive(Debug, Clone, PartialEq)]
pub struct Path(Vec<Resonance>);

impl Path {
    /// Twelve modes below `highest_hz`, evenly over the logarithm of the frequency, of any sign. `share`
    /// yields numbers between 0 and 1, the same path for the same numbers.
    pub fn drawn(highest_hz: f64, mut share: impl FnMut() -> f64) -> Self {
        let mut one = |_| Resonance {
            hz: highest_hz * LOWEST.powf(share()),
            damping: DAMPING.0 * (DAMPING.1 / DAMPING.0).powf(share()),
            strength: 2.0 * share() - 1.0,
        };
        Self((0..RESONANCES).map(&mut one).collect())
    }

    /// Acceleration by a harmonic force of 1.
    fn response(&self, hz: f64) -> Complex<f64> {
        let of = |mode: &Resonance| {
            let below = Complex::new(mode.hz * mode.hz - hz * hz, 2.0 * mode.damping * mode.hz * hz);
            Complex::new(-mode.strength * hz * hz, 0.0) / below
        };
        self.0.iter().map(of).sum()
    }

    /// Acceleration at the sensor under a force sampled at `rate_hz`, resampled to the lower rate `to_hz`:
    /// without a mean, faded in and out.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for a rate, [`Error::Undefined`] for a record faster than the force,
    /// [`Error::TooShort`], [`Error::NotFinite`].
    pub fn through(&self, force: &[f64], rate_hz: f64, to_hz: f64) -> Result<Vec<f64>> {
        shaped(force, rate_hz, to_hz, |hz| self.response(hz))
    }
}

/// `signal` with the power density of a record, behind a causal path of minimum phase, the shortest ringing
/// with that density. The density is at even steps from 0 to half the sample rate of the signal.
///
/// # Errors
/// [`Error::TooShort`] for fewer than 16 samples or densities, [`Error::NotFinite`].
pub fn coloured_like(signal: &[f64], density: &[f64]) -> Result<Vec<f64>> {
    check_signal(signal, 16, "a signal")?;
    check_signal(density, 16, "a density")?;
    let white = whitened(&faded(signal), density.len());
    let filter = minimum_phase(density);
    // The filter is short; the signal is longer than it by zeros, so that nothing wraps around.
    let count = signal.len() + filter.len();
    let padded = |values: &[f64]| -> Vec<f64> {
        values.iter().copied().chain(std::iter::repeat(0.0)).take(count).collect()
    };
    let (mut lines, response) = (lines_of(&padded(&white)), lines_of(&padded(&filter)));
    lines.iter_mut().zip(&response).for_each(|(line, r)| *line *= r / count as f64);
    FftPlanner::new().plan_fft_inverse(count).process(&mut lines);
    Ok(lines.iter().take(signal.len()).map(|z| z.re).collect())
}

/// A signal at a lower rate `to_hz`, without its mean, faded in and out.
pub fn at_rate(signal: &[f64], rate_hz: f64, to_hz: f64) -> Result<Vec<f64>> {
    shaped(signal, rate_hz, to_hz, |_| Complex::new(1.0, 0.0))
}

fn shaped(
    force: &[f64],
    rate_hz: f64,
    to_hz: f64,
    response: impl Fn(f64) -> Complex<f64>,
) -> Result<Vec<f64>> {
    check_positive("rate_hz", rate_hz)?;
    check_positive("to_hz", to_hz)?;
    check_signal(force, 16, "a force")?;
    if to_hz > rate_hz {
        let why = "the force is sampled more slowly than the record";
        return Err(Error::Undefined { quantity: "record of a force", why });
    }
    let lines = lines_of(&faded(force));
    let grid_hz = rate_hz / lines.len() as f64;
    let count = (force.len() as f64 * to_hz / rate_hz).round() as usize;
    let mut kept = vec![Complex::default(); count];
    for n in 1..count.div_ceil(2).min(lines.len() / 2) {
        kept[n] = lines[n] * response(n as f64 * grid_hz) / lines.len() as f64;
        kept[count - n] = kept[n].conj();
    }
    FftPlanner::new().plan_fft_inverse(count).process(&mut kept);
    Ok(kept.iter().map(|z| z.re).collect())
}

fn lines_of(values: &[f64]) -> Vec<Complex<f64>> {
    let mut lines: Vec<Complex<f64>> = values.iter().map(|x| Complex::new(*x, 0.0)).collect();
    FftPlanner::new().plan_fft_forward(lines.len()).process(&mut lines);
    lines
}

/// Without its mean, and faded in and out.
fn faded(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let end = (FADED * values.len() as f64).max(1.0);
    let weight = |n: usize| {
        let near = n.min(values.len() - 1 - n) as f64 / end;
        if near < 1.0 { 0.5 - 0.5 * (PI * near).cos() } else { 1.0 }
    };
    values.iter().enumerate().map(|(n, x)| weight(n) * (x - mean)).collect()
}

/// The signal with a magnitude of 1 at every frequency, in the mean over as many stretches of frequency as
/// there are densities: its own fine structure, which its events make, stays.
fn whitened(values: &[f64], stretches: usize) -> Vec<f64> {
    let mut lines = lines_of(values);
    let (count, half) = (lines.len(), lines.len() / 2);
    let width = half.div_ceil(stretches).max(1);
    for start in (0..=half).step_by(width) {
        let end = (start + width).min(half + 1);
        let power = lines[start..end].iter().map(Complex::norm_sqr).sum::<f64>() / (end - start) as f64;
        let scale = if power > 0.0 { power.sqrt().recip() } else { 0.0 };
        for n in start..end {
            lines[n] *= scale;
            if n > 0 && n < count - n {
                lines[count - n] = lines[n].conj();
            }
        }
    }
    FftPlanner::new().plan_fft_inverse(count).process(&mut lines);
    lines.iter().map(|z| z.re / (count as f64).sqrt()).collect()
}

/// The causal filter of least delay whose power response is `density`.
fn minimum_phase(density: &[f64]) -> Vec<f64> {
    let mut lines = folded(density);
    let count = lines.len();
    FftPlanner::new().plan_fft_inverse(count).process(&mut lines);
    lines.iter().map(|z| z.re / count as f64).collect()
}

/// The response of this filter at as many frequencies as there are densities.
pub(crate) fn least_delay(density: &[f64]) -> Vec<Complex<f64>> {
    let mut lines = folded(density);
    lines.truncate(density.len());
    lines
}

/// Its response at all frequencies, positive and negative. Source: A. V. Oppenheim and R. W. Schafer,
/// Discrete-Time Signal Processing, 3rd ed., Pearson 2010, §13.5: the folded cepstrum.
fn folded(density: &[f64]) -> Vec<Complex<f64>> {
    let count = 2 * (density.len() - 1);
    let most = density.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let mut lines: Vec<Complex<f64>> = (0..count)
        .map(|n| density[n.min(count - n)].max(FLOOR * most))
        .map(|power| Complex::new(0.5 * power.ln(), 0.0))
        .collect();
    let mut planner = FftPlanner::new();
    let (forward, inverse) = (planner.plan_fft_forward(count), planner.plan_fft_inverse(count));
    inverse.process(&mut lines);
    for (n, line) in lines.iter_mut().enumerate() {
        let folded = match n {
            0 => 1.0,
            n if n < count / 2 => 2.0,
            n if n == count / 2 => 1.0,
            _ => 0.0,
        };
        *line = Complex::new(line.re * folded / count as f64, 0.0);
    }
    forward.process(&mut lines);
    lines.iter_mut().for_each(|line| *line = line.exp());
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform(mut seed: u64) -> impl FnMut() -> f64 {
        move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    #[test]
    fn analytic_one_mode_amplifies_by_half_over_its_damping() {
        // Acceleration of a mode of unit mass at resonance: F/(2ζ). Meirovitch 2001, §3.2.
        let path = Path(vec![Resonance { hz: 1000.0, damping: 0.01, strength: 1.0 }]);
        assert!((path.response(1000.0).norm() / 50.0 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn invariant_a_path_is_that_of_its_numbers() {
        let drawn = |seed| Path::drawn(10_000.0, uniform(seed));
        assert_eq!(drawn(1), drawn(1));
        assert_ne!(drawn(1), drawn(2));
        assert!(drawn(3).0.iter().all(|mode| (200.0..10_000.0).contains(&mode.hz)));
    }
}
