//! Resampling by a polyphase filter.

use std::f64::consts::PI;

use crate::error::check_signal;
use crate::{Error, Result};

/// Zeros of the filter on either side, in samples of the slower rate.
const REACH: usize = 10;
/// Shape of its Kaiser window.
const BETA: f64 = 5.0;
/// Sums that a product of two rows is added up in, so that they do not wait for each other.
const LANES: usize = 8;

/// `signal` at `up/down` times its rate: `scipy.signal.resample_poly(x, up, down)` with its default filter, a
/// Kaiser window of β = 5 over ten zeros of the sinc on either side, without delay. Half of the amplitude is
/// left at half of the slower rate, so components just above it are aliased; beyond its ends the signal
/// counts as zero.
///
/// # Errors
/// [`Error::TooShort`] for an empty signal, [`Error::NotFinite`], [`Error::Undefined`] for a ratio of or with
/// zero, or of numbers above 20 000.
pub fn resample_poly(signal: &[f64], up: usize, down: usize) -> Result<Vec<f64>> {
    const MOST: usize = 20_000;
    check_signal(signal, 1, "another rate")?;
    let undefined = |why| Err(Error::Undefined { quantity: "resampled signal", why });
    if up == 0 || down == 0 {
        return undefined("up and down must be at least 1");
    }
    let common = divisor(up, down);
    let (up, down) = (up / common, down / common);
    if up.max(down) > MOST {
        return undefined("up and down may be 20 000 at most in lowest terms; choose a rounder ratio");
    }
    if up == down {
        return Ok(signal.to_vec());
    }
    let half = REACH * up.max(down);
    let phases = phases(&filter(half, up, up.max(down)), up);
    let count = (signal.len() * up).div_ceil(down);
    Ok((0..count)
        .map(|m| {
            // Sample m stands at m·down of the finer grid, sample k of the signal at k·up: taps half + m·down
            // − k·up.
            let at = half + m * down;
            let (newest, taps) = (at / up, &phases[at % up]);
            let first = (newest + 1).saturating_sub(taps.len());
            let last = (newest + 1).min(signal.len());
            let skipped = first + taps.len() - (newest + 1);
            if first >= last { 0.0 } else { product(&signal[first..last], &taps[skipped..]) }
        })
        .collect())
}

/// `scipy.signal.firwin(2·half + 1, 1/slower, window=("kaiser", β))` times `up`.
fn filter(half: usize, up: usize, slower: usize) -> Vec<f64> {
    let mut taps: Vec<f64> = (0..=2 * half)
        .map(|n| {
            let x = n as f64 - half as f64;
            let turn = PI * x / slower as f64;
            let sinc = if x == 0.0 { 1.0 } else { turn.sin() / turn };
            sinc * bessel(BETA * (1.0 - (x / half as f64).powi(2)).max(0.0).sqrt())
        })
        .collect();
    let sum: f64 = taps.iter().sum();
    taps.iter_mut().for_each(|tap| *tap *= up as f64 / sum);
    taps
}

/// Every `up`-th tap from each of the first ones on, the last one first, as they meet samples in ascending
/// order.
fn phases(taps: &[f64], up: usize) -> Vec<Vec<f64>> {
    (0..up)
        .map(|phase| {
            let mut of: Vec<f64> = taps.iter().skip(phase).step_by(up).copied().collect();
            of.reverse();
            of
        })
        .collect()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (a, b) = (&a[..a.len().min(b.len())], &b[..a.len().min(b.len())]);
    let ((wide_a, rest_a), (wide_b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    for (x, y) in wide_a.iter().zip(wide_b) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    sums.iter().sum::<f64>() + rest_a.iter().zip(rest_b).map(|(x, y)| x * y).sum::<f64>()
}

/// Modified Bessel function of the first kind and order zero, by its series.
fn bessel(x: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    let mut k = 1.0;
    while term > f64::EPSILON * sum {
        term *= (0.5 * x / k).powi(2);
        sum += term;
        k += 1.0;
    }
    sum
}

fn divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { divisor(b, a % b) }
}
