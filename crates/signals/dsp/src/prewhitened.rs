//! Power of a signal over time, with all of its lines brought to one magnitude.
//!
//! A path from an impact to the sensor changes the magnitude of every line, and its phase slowly:
//! pre-whitening makes events equally sharp again, whatever the path.
//!
//! Source: N. Sawalhi and R. B. Randall, Mech. Syst. Signal Process. 25 (2011) 846–870.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// The power is cut off above this quantile, so that a few strong events do not dominate.
const LOUDEST: f64 = 0.999;

/// Squared envelope of the pre-whitened signal in a band, whose ends are parts of half the sample rate: as
/// many values as samples, with a mean of its bandwidth but for the cut.
///
/// Shape: `signal.len()` values, without a unit. An empty signal yields none.
pub fn prewhitened_power(signal: &[f64], (from, to): (f64, f64)) -> Vec<f64> {
    let count = signal.len();
    if count == 0 {
        return Vec::new();
    }
    let mut planner = FftPlanner::new();
    let mut lines: Vec<Complex<f64>> = signal.iter().map(|x| Complex::new(*x, 0.0)).collect();
    planner.plan_fft_forward(count).process(&mut lines);
    let kept = (0.5 * from * count as f64) as usize..(0.5 * to * count as f64) as usize;
    for (n, line) in lines.iter_mut().enumerate() {
        let magnitude = line.norm();
        *line = if kept.contains(&n) && magnitude > 0.0 { *line / magnitude } else { Complex::default() };
    }
    planner.plan_fft_inverse(count).process(&mut lines);
    let mut power: Vec<f64> = lines.iter().map(Complex::norm_sqr).collect();
    let mut sorted = power.clone();
    let (_, limit, _) =
        sorted.select_nth_unstable_by((LOUDEST * (count - 1) as f64) as usize, f64::total_cmp);
    let limit = *limit;
    power.iter_mut().for_each(|e| *e = e.min(limit));
    power
}
