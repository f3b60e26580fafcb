//! Deconvolution of the path from a defect to the sensor: which filter turns a record into pulses of a known
//! period?

use crate::error::{check_positive, check_signal};
use crate::{Error, Result};

/// A record through the filter that makes it most like pulses of one period.
#[derive(Debug, Clone, PartialEq)]
pub struct Deconvolved {
    /// Period [samples].
    pub period: f64,
    /// Multipoint kurtosis: 1 when all of the output stands at the pulses, in equal heights; near `period`
    /// over its length for noise.
    pub kurtosis: f64,
    /// Taps, of unit norm.
    pub filter: Vec<f64>,
    /// The output; value n stands for sample `n + filter − 1` of the record.
    pub output: Vec<f64>,
}

/// Multipoint optimal minimum entropy deconvolution: for each of `periods` [samples], the `filter` taps whose
/// output is closest in direction to unit pulses at 0, T, 2T … of the output, `f = (X₀X₀ᵀ)⁻¹X₀t`. The mean is
/// removed first.
///
/// Where in a period the pulses stand is fixed, and the filter shifts the record to meet them, so it should
/// be longer than a period, or the kurtosis depends on where the record begins.
///
/// Source: G. L. McDonald and Q. Zhao, Mech. Syst. Signal Process. 82 (2017) 461–477; the kurtosis, their
/// equation of MKurt.
///
/// # Errors
/// [`Error::TooShort`] for a filter below two taps or a record that does not hold two of them,
/// [`Error::NotPositive`] for a period, [`Error::NotFinite`], [`Error::Undefined`] for a record whose samples
/// follow from each other, such as a sine.
pub fn momeda(signal: &[f64], filter: usize, periods: &[f64]) -> Result<Vec<Deconvolved>> {
    if filter < 2 {
        return Err(Error::TooShort { field: "filter", len: filter, least: 2, purpose: "deconvolution" });
    }
    check_signal(signal, filter.saturating_mul(2), "deconvolution with this filter")?;
    periods.iter().try_for_each(|period| check_positive("period", *period))?;
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let x: Vec<f64> = signal.iter().map(|v| v - mean).collect();
    let factor = cholesky(covariance(&x, filter), filter)?;
    Ok(periods.iter().map(|period| at_period(&x, filter, &factor, *period)).collect())
}

fn at_period(x: &[f64], taps: usize, factor: &[f64], period: f64) -> Deconvolved {
    let count = x.len() + 1 - taps;
    let pulses: Vec<usize> =
        (0..).map(|k| (f64::from(k) * period).round() as usize).take_while(|at| *at < count).collect();
    let mut filter: Vec<f64> =
        (0..taps).map(|lag| pulses.iter().map(|at| x[at + taps - 1 - lag]).sum()).collect();
    solve(factor, &mut filter);
    let norm = filter.iter().map(|f| f * f).sum::<f64>().sqrt();
    filter.iter_mut().for_each(|f| *f /= norm);
    let output: Vec<f64> = (0..count)
        .map(|n| filter.iter().enumerate().map(|(lag, f)| f * x[n + taps - 1 - lag]).sum())
        .collect();
    // (Σt²)² Σ(t y)⁴ / (Σt⁸ (Σy²)²) with t of ones and zeros.
    let energy: f64 = output.iter().map(|y| y * y).sum();
    let fourth: f64 = pulses.iter().map(|at| output[*at].powi(4)).sum();
    Deconvolved { period, kurtosis: pulses.len() as f64 * fourth / (energy * energy), filter, output }
}

/// `X₀X₀ᵀ`, row after row: sums of `x[n − i] x[n − j]` over every n that has all taps behind it.
fn covariance(x: &[f64], taps: usize) -> Vec<f64> {
    let mut sums = vec![0.0; taps * taps];
    for j in 0..taps {
        let first: f64 = (taps - 1..x.len()).map(|n| x[n] * x[n - j]).sum();
        sums[j] = first;
        sums[j * taps] = first;
    }
    // Along a diagonal the sum moves by one sample: one enters at the front, one leaves at the end.
    for i in 1..taps {
        for j in i..taps {
            let before = sums[(i - 1) * taps + j - 1];
            let moved = before + x[taps - 1 - i] * x[taps - 1 - j] - x[x.len() - i] * x[x.len() - j];
            sums[i * taps + j] = moved;
            sums[j * taps + i] = moved;
        }
    }
    sums
}

/// The lower factor, in place of the lower half.
fn cholesky(mut a: Vec<f64>, n: usize) -> Result<Vec<f64>> {
    for j in 0..n {
        let own = a[j * n + j];
        let pivot = own - a[j * n..j * n + j].iter().map(|l| l * l).sum::<f64>();
        if pivot <= 1e-14 * own {
            return Err(Error::Undefined {
                quantity: "the filter",
                why: "the samples follow from each other; use fewer taps, or a record with noise",
            });
        }
        let root = pivot.sqrt();
        a[j * n + j] = root;
        for i in j + 1..n {
            let (above, below) = a.split_at(i * n);
            let sum: f64 = above[j * n..j * n + j].iter().zip(below).map(|(p, q)| p * q).sum();
            a[i * n + j] = (a[i * n + j] - sum) / root;
        }
    }
    Ok(a)
}

fn solve(factor: &[f64], b: &mut [f64]) {
    let n = b.len();
    for i in 0..n {
        let sum: f64 = factor[i * n..i * n + i].iter().zip(&*b).map(|(l, x)| l * x).sum();
        b[i] = (b[i] - sum) / factor[i * n + i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| factor[k * n + i] * b[k]).sum();
        b[i] = (b[i] - sum) / factor[i * n + i];
    }
}
