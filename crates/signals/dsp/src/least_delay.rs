//! The causal filter of least delay with a given power response.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Least density over the highest that a filter passes.
const FLOOR: f64 = 1e-8;

/// The response of the causal filter of least delay whose power response is `density`, at as many frequencies.
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
