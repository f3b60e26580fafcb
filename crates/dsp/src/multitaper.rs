//! Thomson's multitaper spectrum with discrete prolate spheroidal sequences.
//!
//! Source: D. J. Thomson, Proc. IEEE 70 (1982) 1055–1096; tapers by D. Slepian, Bell Syst. Tech. J. 57 (1978)
//! 1371–1430, signs and norm as `scipy.signal.windows.dpss(…, norm=2)`.

use std::f64::consts::TAU;

use crate::error::{check_positive, check_signal};
use crate::{Error, Result};

/// The first `count` tapers of `len` samples for the time-half-bandwidth product `nw`, each of unit energy.
///
/// # Errors
/// [`Error::TooShort`] for fewer than two samples or no taper, [`Error::NotPositive`] for `nw`,
/// [`Error::Undefined`] when `nw` is not below half of the samples or there are more tapers than samples.
pub fn dpss(len: usize, nw: f64, count: usize) -> Result<Vec<Vec<f64>>> {
    check_positive("nw", nw)?;
    if len < 2 || count == 0 {
        return Err(Error::TooShort { field: "len", len, least: 2, purpose: "tapers" });
    }
    if nw >= 0.5 * len as f64 || count > len {
        let why = "nw must lie below half of the samples, and tapers are no more than samples";
        return Err(Error::Undefined { quantity: "tapers", why });
    }
    let cosine = (TAU * nw / len as f64).cos();
    let diagonal: Vec<f64> =
        (0..len).map(|n| (0.5 * (len as f64 - 1.0) - n as f64).powi(2) * cosine).collect();
    let beside: Vec<f64> = (1..len).map(|n| 0.5 * (n * (len - n)) as f64).collect();
    let tapers = (0..count).map(|k| {
        let mut taper = eigenvector(&diagonal, &beside, eigenvalue(&diagonal, &beside, k));
        // Even tapers have a positive mean; odd ones begin with a positive lobe.
        let sign = if k % 2 == 0 {
            taper.iter().sum::<f64>()
        } else {
            let least = 1e-7_f64.max(1.0 / len as f64);
            taper.iter().copied().find(|x| x * x > least).unwrap_or(1.0)
        };
        if sign < 0.0 {
            taper.iter_mut().for_each(|x| *x = -*x);
        }
        taper
    });
    Ok(tapers.collect())
}

/// One-sided power spectral density [unit²/Hz] of the whole signal: the mean over `count` tapers. Frequencies
/// are those of `rfft`. The mean is removed first; the resolution is `2 nw` over the length.
///
/// # Errors
/// Those of [`dpss`], [`Error::NotPositive`] for the sample rate, [`Error::NotFinite`].
pub fn multitaper(signal: &[f64], sample_rate_hz: f64, nw: f64, count: usize) -> Result<Vec<f64>> {
    check_positive("sample_rate_hz", sample_rate_hz)?;
    check_signal(signal, 2, "a spectrum")?;
    let len = signal.len();
    let mean = signal.iter().sum::<f64>() / len as f64;
    let transform = realfft::RealFftPlanner::<f64>::new().plan_fft_forward(len);
    let (mut input, mut lines) = (transform.make_input_vec(), transform.make_output_vec());
    let mut density = vec![0.0; lines.len()];
    for taper in dpss(len, nw, count)? {
        input.iter_mut().zip(signal).zip(&taper).for_each(|((z, x), w)| *z = w * (x - mean));
        transform.process(&mut input, &mut lines).expect("both buffers have the plan's lengths");
        density.iter_mut().zip(&lines).for_each(|(p, x)| *p += x.norm_sqr());
    }
    for (bin, value) in density.iter_mut().enumerate() {
        let sides = if bin == 0 || 2 * bin == len { 1.0 } else { 2.0 };
        *value *= sides / (sample_rate_hz * count as f64);
    }
    Ok(density)
}

/// The eigenvalue of a symmetric tridiagonal matrix that `k` others exceed, by counting signs (Sturm).
fn eigenvalue(diagonal: &[f64], beside: &[f64], k: usize) -> f64 {
    let reach =
        |n: usize| beside.get(n).copied().unwrap_or(0.0) + n.checked_sub(1).map_or(0.0, |m| beside[m]);
    let ends = (0..diagonal.len()).map(|n| (diagonal[n] - reach(n), diagonal[n] + reach(n)));
    let (mut low, mut high) =
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), (a, b)| (l.min(a), h.max(b)));
    let above = |x: f64| {
        let mut pivot = 1.0;
        let mut count = 0;
        for n in 0..diagonal.len() {
            let coupling = if n > 0 { beside[n - 1] * beside[n - 1] / pivot } else { 0.0 };
            pivot = diagonal[n] - x - coupling;
            if pivot == 0.0 {
                pivot = f64::MIN_POSITIVE.sqrt();
            }
            count += usize::from(pivot > 0.0);
        }
        count
    };
    for _ in 0..120 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if above(middle) > k { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Unit eigenvector by inverse iteration, with row exchanges.
fn eigenvector(diagonal: &[f64], beside: &[f64], value: f64) -> Vec<f64> {
    let len = diagonal.len();
    // Neither even nor odd, so that no taper is missed.
    let mut x: Vec<f64> = (0..len).map(|n| 1.0 + n as f64 / len as f64).collect();
    for _ in 0..4 {
        solve(diagonal, beside, value, &mut x);
        let norm = x.iter().map(|v| v * v).sum::<f64>().sqrt();
        x.iter_mut().for_each(|v| *v /= norm);
    }
    x
}

/// Solves (T − value) y = x in place. Upper rows have up to three entries after exchanges.
fn solve(diagonal: &[f64], beside: &[f64], value: f64, x: &mut [f64]) {
    let len = diagonal.len();
    let tiny = f64::EPSILON * diagonal.iter().chain(beside).fold(1.0_f64, |most, v| v.abs().max(most));
    let mut rows: Vec<[f64; 3]> = Vec::with_capacity(len);
    let entry = |n: usize| beside.get(n).copied().unwrap_or(0.0);
    let mut row = [diagonal[0] - value, entry(0), 0.0];
    for n in 0..len - 1 {
        let mut next = [beside[n], diagonal[n + 1] - value, entry(n + 1)];
        if next[0].abs() > row[0].abs() {
            std::mem::swap(&mut row, &mut next);
            x.swap(n, n + 1);
        }
        if row[0] == 0.0 {
            row[0] = tiny;
        }
        let factor = next[0] / row[0];
        x[n + 1] -= factor * x[n];
        rows.push(row);
        row = [next[1] - factor * row[1], next[2] - factor * row[2], 0.0];
    }
    if row[0] == 0.0 {
        row[0] = tiny;
    }
    rows.push(row);
    for n in (0..len).rev() {
        let after = |k: usize| x.get(n + k).copied().unwrap_or(0.0);
        x[n] = (x[n] - rows[n][1] * after(1) - rows[n][2] * after(2)) / rows[n][0];
    }
}
