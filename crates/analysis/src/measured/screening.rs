//! Is a record sound? Values that are not numbers, clipping, and the numbers that describe it as a whole, in one pass.

use serde::Serialize;

/// Numbers that describe a signal as a whole; its mean is removed first.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Health {
    /// Mean [unit].
    pub mean: f64,
    /// Root mean square about the mean [unit].
    pub rms: f64,
    /// Largest distance from the mean [unit].
    pub peak: f64,
    /// Peak over root mean square.
    pub crest_factor: f64,
    /// Fourth central moment over the square of the second; 3 for Gaussian noise.
    pub kurtosis: f64,
    /// Third central moment over the power 3/2 of the second.
    pub skewness: f64,
    /// Largest magnitude over the mean of magnitudes, both about zero.
    pub impulse_factor: f64,
    /// Entropy of the density over the logarithm of its number of lines: 1 for white noise, near 0 for one line.
    pub spectral_entropy: f64,
}

/// What one pass finds.
#[derive(Debug, Clone, Default)]
pub(super) struct Screening {
    count: u64,
    /// Values that are not numbers, and the place of the first.
    bad: u64,
    first_bad: Option<u64>,
    /// First finite value: sums count from it, so that a large mean costs no digits.
    origin: Option<f64>,
    /// Sums of the first four powers, and of magnitudes.
    sums: [f64; 5],
    lowest: Extreme,
    highest: Extreme,
}

/// An extreme value and how often it occurs in a row.
#[derive(Debug, Clone, Copy, Default)]
struct Extreme {
    value: f64,
    /// Samples in a row at the value, now and at most.
    row: u64,
    longest: u64,
}

/// Samples in a row at the extreme that only a limiter makes.
const CLIPPED_ROW: u64 = 4;

impl Screening {
    pub(super) fn add(&mut self, block: &[f64]) {
        for &x in block {
            self.count += 1;
            if !x.is_finite() {
                self.bad += 1;
                self.first_bad.get_or_insert(self.count - 1);
                continue;
            }
            let origin = *self.origin.get_or_insert(x);
            let d = x - origin;
            let square = d * d;
            self.sums[0] += d;
            self.sums[1] += square;
            self.sums[2] += square * d;
            self.sums[3] += square * square;
            self.sums[4] += x.abs();
            self.highest.see(d);
            self.lowest.see(-d);
        }
    }

    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// What is odd about the samples.
    pub(super) fn notes(&self, rate_hz: f64) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(first) = self.first_bad {
            notes.push(format!(
                "{} of {} samples are not numbers, the first at {first} ({:.4} s)",
                self.bad,
                self.count,
                first as f64 / rate_hz
            ));
        }
        let origin = self.origin.unwrap_or(0.0);
        for (extreme, value) in
            [(&self.highest, origin + self.highest.value), (&self.lowest, origin - self.lowest.value)]
        {
            if extreme.longest >= CLIPPED_ROW {
                notes.push(format!(
                    "clipped: up to {} samples in a row stand at {value:.6}; levels are too low and the clipping makes harmonics. \
                     Measure again with a larger range",
                    extreme.longest
                ));
            }
        }
        notes
    }

    /// The largest distance from the first value, where its fourth power lies beyond the range of numbers.
    pub(super) fn out_of_range(&self) -> Option<f64> {
        let reach = self.highest.value.max(self.lowest.value);
        let fourth = reach.powi(4);
        (reach > 0.0 && (!self.sums[3].is_finite() || fourth < f64::MIN_POSITIVE)).then_some(reach)
    }

    /// With the power spectral density of the same signal; `None` for a constant one.
    pub(super) fn health(&self, density: &[f64]) -> Option<Health> {
        let n = (self.count - self.bad) as f64;
        let [s1, s2, s3, s4, _] = self.sums.map(|s| s / n);
        let variance = s2 - s1 * s1;
        if variance.is_nan() || variance <= 1e-24 * s2 || variance <= 0.0 {
            return None;
        }
        let rms = variance.sqrt();
        let peak = (self.highest.value - s1).max(self.lowest.value + s1);
        let third = s3 - 3.0 * s1 * s2 + 2.0 * s1.powi(3);
        let fourth = s4 - 4.0 * s1 * s3 + 6.0 * s1 * s1 * s2 - 3.0 * s1.powi(4);
        let origin = self.origin.unwrap_or(0.0);
        let largest = (origin + self.highest.value).abs().max((origin - self.lowest.value).abs());
        Some(Health {
            mean: origin + s1,
            rms,
            peak,
            crest_factor: peak / rms,
            kurtosis: fourth / (variance * variance),
            skewness: third / (variance * rms),
            impulse_factor: largest * n / self.sums[4],
            spectral_entropy: spectral_entropy(density),
        })
    }
}

/// `−Σ p ln p / ln n` with p the share of each line.
fn spectral_entropy(density: &[f64]) -> f64 {
    let sum: f64 = density.iter().sum();
    let entropy: f64 = density.iter().map(|d| d / sum).filter(|p| *p > 0.0).map(|p| -p * p.ln()).sum();
    entropy / (density.len() as f64).ln()
}

impl Extreme {
    fn see(&mut self, value: f64) {
        if value > self.value || self.longest == 0 {
            *self = Self { value, row: 1, longest: 1 };
        } else if value == self.value {
            self.row += 1;
            self.longest = self.longest.max(self.row);
        } else {
            self.row = 0;
        }
    }
}
