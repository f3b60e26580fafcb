//! The fast kurtogram: which band of a signal is most impulsive?
//!
//! A tree of analytic filters halves bands and cuts them in three; the kurtosis of the complex envelope
//! measures how impulsive each is. Filters, delays and trimming are those of the author's program, so that
//! the bands and values agree with it.
//!
//! Source: J. Antoni, Mech. Syst. Signal Process. 21 (2007) 108–124.

use std::f64::consts::{PI, TAU};

use rustfft::num_complex::Complex;

use crate::error::{check_positive, check_signal};
use crate::{Error, Result};

/// One band of a kurtogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KurtogramBand {
    /// Bands of this width from zero to half the sample rate: 1, 2, 3, 4, 6, 8, 12 …
    pub of: usize,
    /// Lower end [Hz].
    pub low_hz: f64,
    /// Upper end [Hz].
    pub high_hz: f64,
    /// `⟨|a|⁴⟩/⟨|a|²⟩² − 2` of the complex envelope (− 3 for the whole signal): 0 for Gaussian noise.
    pub kurtosis: f64,
}

/// Taps less one of the filters that halve.
const ORDER: usize = 16;
/// Cut-off of the low-pass that they are made of, over half the sample rate.
const CUTOFF: f64 = 0.4;

type Signal = Vec<Complex<f64>>;

struct Filters {
    halves: [Vec<Complex<f64>>; 2],
    thirds: [Vec<Complex<f64>>; 3],
}

/// All bands of `signal`, widest first, then by frequency: `2ᵏ` bands for k from 0 to `levels`, and `3·2ᵏ`
/// between. The mean is removed first.
///
/// # Errors
/// [`Error::NotPositive`] for the sample rate, [`Error::TooShort`] for a signal of fewer than `2^(levels +
/// 7)` samples, [`Error::NotFinite`].
pub fn fast_kurtogram(signal: &[f64], sample_rate_hz: f64, levels: u32) -> Result<Vec<KurtogramBand>> {
    check_levels(signal, sample_rate_hz, levels)?;
    let mut bands = Vec::new();
    for_each_band(signal, sample_rate_hz, levels, |of, low_hz, high_hz, coefficients| {
        // The whole signal is real, and its noise has a kurtosis of three.
        let of_noise = if of == 1 { 3.0 } else { 2.0 };
        bands.push(KurtogramBand { of, low_hz, high_hz, kurtosis: kurtosis(coefficients, of_noise) });
    });
    Ok(bands)
}

/// Passes the settled coefficients of every band to `take`, with the number of bands of its level and its
/// ends [Hz].
fn for_each_band(
    signal: &[f64],
    sample_rate_hz: f64,
    levels: u32,
    mut take: impl FnMut(usize, f64, f64, &[Complex<f64>]),
) {
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let whole: Signal = signal.iter().map(|x| Complex::new(x - mean, 0.0)).collect();
    let filters = Filters::new();
    let mut band = |of: usize, n: usize, coefficients: &[Complex<f64>]| {
        let width = 0.5 * sample_rate_hz / of as f64;
        take(of, n as f64 * width, (n + 1) as f64 * width, coefficients);
    };
    band(1, 0, &whole);
    let mut nodes = vec![whole];
    for level in 0..levels {
        let halves: Vec<Signal> = nodes.iter().flat_map(|node| filters.halve(node)).collect();
        let settled = |n: usize| ORDER - n % 2;
        for (n, half) in halves.iter().enumerate() {
            band(halves.len(), n, trimmed(half, settled(n)));
        }
        // Thirds of this level are narrower than its halves; the last level has none.
        if level + 1 < levels {
            let pairs = nodes.iter().flat_map(|node| filters.thirds.iter().map(move |f| (node, f)));
            for (n, (node, filter)) in pairs.enumerate() {
                band(3 * nodes.len(), n, trimmed(&decimated(node, filter, 3), ORDER));
            }
        }
        nodes = halves;
    }
}

/// Refuses a signal that is too short for this many levels.
fn check_levels(signal: &[f64], sample_rate_hz: f64, levels: u32) -> Result<()> {
    check_positive("sample_rate_hz", sample_rate_hz)?;
    let purpose = "a tree of bands of so many levels";
    let least = 1_usize.checked_shl(levels.saturating_add(7)).filter(|n| *n > 0).ok_or(Error::TooShort {
        field: "signal",
        len: signal.len(),
        least: usize::MAX,
        purpose,
    })?;
    check_signal(signal, least, purpose)
}

impl Filters {
    fn new() -> Self {
        let turned = |taps: &[f64], turns: f64| -> Vec<Complex<f64>> {
            taps.iter().enumerate().map(|(n, h)| Complex::from_polar(*h, TAU * turns * n as f64)).collect()
        };
        let low = turned(&low_pass(ORDER, CUTOFF), 0.125);
        // The mirror image of the low half: its taps in reverse, every second one with the other sign.
        let high = (2..ORDER + 2)
            .map(|n| low[(2 * ORDER + 1 - n) % ORDER] * if n % 2 == 0 { -1.0 } else { 1.0 })
            .collect();
        let third = low_pass(ORDER * 3 / 2, CUTOFF * 2.0 / 3.0);
        let thirds = [0.25 / 3.0, 0.25 / 3.0 + 1.0 / 6.0, 0.25 / 3.0 + 1.0 / 3.0];
        Self { halves: [low, high], thirds: thirds.map(|turns| turned(&third, turns)) }
    }

    fn halve(&self, signal: &Signal) -> [Signal; 2] {
        let low = decimated(signal, &self.halves[0], 2);
        let mut high = decimated(signal, &self.halves[1], 2);
        // Decimation turns the upper half round; this turns it back.
        high.iter_mut().step_by(2).for_each(|x| *x = -*x);
        [low, high]
    }
}

/// Low-pass of `order + 1` taps with a Hamming window, one at zero frequency; the cut-off counts from half
/// the rate.
fn low_pass(order: usize, cutoff: f64) -> Vec<f64> {
    let middle = 0.5 * order as f64;
    let tap = |n: usize| {
        let t = PI * cutoff * (n as f64 - middle);
        let sinc = if t == 0.0 { 1.0 } else { t.sin() / t };
        sinc * (0.54 - 0.46 * (TAU * n as f64 / order as f64).cos())
    };
    let taps: Vec<f64> = (0..=order).map(tap).collect();
    let sum: f64 = taps.iter().sum();
    taps.iter().map(|h| h / sum).collect()
}

/// Every `by`-th value of a causal filter's output, the first at `by − 1`.
fn decimated(signal: &Signal, taps: &[Complex<f64>], by: usize) -> Signal {
    (by - 1..signal.len())
        .step_by(by)
        .map(|n| taps.iter().zip(signal[..=n].iter().rev()).map(|(h, x)| h * x).sum())
        .collect()
}

fn trimmed(signal: &Signal, count: usize) -> &[Complex<f64>] {
    &signal[count.min(signal.len())..]
}

fn kurtosis(signal: &[Complex<f64>], of_noise: f64) -> f64 {
    let count = signal.len() as f64;
    let mean: Complex<f64> = signal.iter().sum::<Complex<f64>>() / count;
    let (mut second, mut fourth) = (0.0, 0.0);
    for x in signal {
        let square = (x - mean).norm_sqr();
        second += square;
        fourth += square * square;
    }
    if second > 0.0 { fourth * count / (second * second) - of_noise } else { 0.0 }
}
