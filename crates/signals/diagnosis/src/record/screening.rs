//! Is a record sound? Values that are not numbers, single samples that stand for themselves, and the numbers
//! that describe it as a whole, in one pass. What sensor and recorder did to many samples is in `quality`.

use crate::quantities;
use serde::Serialize;

quantities! {
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
        /// Entropy of the density over the logarithm of its number of lines: 1 for white noise, near 0 for one
        /// line.
        pub spectral_entropy: f64,
    }
}

/// Sums and extremes of one pass over the samples.
#[derive(Debug, Clone, Default)]
pub(crate) struct Screening {
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

/// An extreme value, and the next ones.
#[derive(Debug, Clone, Default)]
struct Extreme {
    value: f64,
    is_known: bool,
    /// The largest values with their places, ascending.
    largest: Vec<(f64, u64)>,
}

/// How many times as far from the mean as all others a sample is that stands for itself.
const FAR: f64 = 10.0;
/// Samples on either side of an extreme that may belong to it. A resonance with a Q of 2.8 or more has a
/// tenth of its height left beyond them, at any frequency that the record holds: `exp(−π f n/(Q f_s))` with n
/// = 4 and f below half the sample rate.
const NEAR: u64 = 3;
/// Most such samples: more belong to the machine's signal.
const MOST: usize = 8;
/// Largest values kept: those of [`MOST`] samples with their neighbours, and one more.
const KEPT: usize = MOST * (2 * NEAR as usize + 1) + 1;

impl Screening {
    pub(crate) fn add(&mut self, block: &[f64]) {
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
            self.highest.see(d, self.count - 1);
            self.lowest.see(-d, self.count - 1);
        }
    }

    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Faults of the samples.
    pub(crate) fn notes(&self, rate_hz: f64) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(first) = self.first_bad {
            notes.push(format!(
                "{} of {} samples are not numbers, the first at {first} ({:.4} s)",
                self.bad,
                self.count,
                first as f64 / rate_hz
            ));
        }
        notes.extend(self.spurious(rate_hz));
        notes
    }

    /// A note on samples far beyond all others that do not ring.
    fn spurious(&self, rate_hz: f64) -> Option<String> {
        let mean = self.sums[0] / (self.count - self.bad) as f64;
        let of = |extreme: &Extreme, mean: f64| {
            extreme.largest.iter().map(|(value, at)| (value - mean, *at)).rev().collect::<Vec<_>>()
        };
        let (above, below) = (of(&self.highest, mean), of(&self.lowest, -mean));
        // Values beyond the last that was kept are all there.
        let known = |all: &[(f64, u64)]| all.get(KEPT - 1).map_or(0.0, |last| last.0);
        let known = known(&above).max(known(&below));
        let mut all = [above, below].concat();
        all.retain(|(value, _)| *value >= known);
        all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut peaks: Vec<(f64, u64)> = Vec::new();
        for (value, at) in all {
            if peaks.iter().all(|peak| peak.1.abs_diff(at) > NEAR) {
                peaks.push((value, at));
            }
        }
        let count =
            (1..=MOST).rev().find(|n| peaks.get(*n).is_some_and(|next| peaks[n - 1].0 > FAR * next.0))?;
        let (value, at) = peaks[0];
        let sign = if self.highest.largest.iter().any(|largest| largest.1 == at) { 1.0 } else { -1.0 };
        let others = if count > 1 { format!(", and so do {} others", count - 1) } else { String::new() };
        Some(format!(
            "sample {at} ({:.4} s) is {:.6} and stands {:.0} times as far from the mean as the rest of the \
             record{others}: it does not ring as impacts do, so the recording is at fault, and it can hide a \
             defect. Put the mean of its neighbours in its place, or cut the record beside it",
            at as f64 / rate_hz,
            self.origin.unwrap_or(0.0) + mean + sign * value,
            value / peaks[count].0
        ))
    }

    /// The largest distance from the first value, where its fourth power lies beyond the range of numbers.
    pub(crate) fn out_of_range(&self) -> Option<f64> {
        let reach = self.highest.value.max(self.lowest.value);
        let fourth = reach.powi(4);
        (reach > 0.0 && (!self.sums[3].is_finite() || fourth < f64::MIN_POSITIVE)).then_some(reach)
    }

    /// With the power spectral density of the same signal; `None` for a constant one.
    pub(crate) fn health(&self, density: &[f64]) -> Option<Health> {
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
    fn see(&mut self, value: f64, at: u64) {
        let full = self.largest.len() == KEPT;
        if !full || value > self.largest[0].0 {
            let place = self.largest.partition_point(|kept| kept.0 < value);
            self.largest.insert(place, (value, at));
            if full {
                self.largest.remove(0);
            }
        }
        if value > self.value || !self.is_known {
            (self.value, self.is_known) = (value, true);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use stribeck_testing::Noise;

    use super::*;

    fn notes(samples: &[f64]) -> String {
        let mut screening = Screening::default();
        samples.chunks(777).for_each(|block| screening.add(block));
        screening.notes(12_800.0).join("; ")
    }

    /// Noise, and impacts every `period` samples that ring at `hz` times the sample rate with a Q.
    fn impacts(period: usize, height: f64, hz: f64, q: f64) -> Vec<f64> {
        let mut noise = Noise::new(6);
        (0..50_000)
            .map(|n| {
                let since = (n + period / 2) % period;
                let ring =
                    (-TAU * hz * since as f64 / (2.0 * q)).exp() * (TAU * hz * since as f64 + 1.0).sin();
                noise.uniform() + height * ring
            })
            .collect()
    }

    /// A spike of one sample, or of a few places, on any side; in the first one, too.
    #[test]
    fn issue_samples_that_stand_for_themselves_are_told() {
        for (places, value, says) in [
            (&[31_000][..], 1000.0, "sample 31000 (2.4219 s) is 1000.000000"),
            (&[31_000], -1000.0, "sample 31000 (2.4219 s) is -1000.000000"),
            (&[0], 60.0, "sample 0 (0.0000 s) is 60.000000"),
            (&[49_999], 60.0, "sample 49999"),
            (&[9, 10, 700, 40_000], 300.0, "and so do 2 others"),
        ] {
            for offset in [0.0, 2000.0] {
                let mut samples = impacts(700, 2.0, 0.2, 20.0);
                places.iter().for_each(|at| samples[*at] = value);
                samples.iter_mut().for_each(|x| *x += offset);
                let told = notes(&samples);
                assert!(
                    told.contains(&says.replace(&format!("{value:.6}"), &format!("{:.6}", value + offset))),
                    "{told}"
                );
            }
        }
    }

    /// Impacts ring, however rare, high and short they are, and many spikes are how a machine sounds.
    #[test]
    fn planted_impacts_are_not_called_spurious() {
        for (period, hz, q) in [
            (700, 0.2, 20.0),
            (90_000, 0.2, 20.0),
            (90_000, 0.45, 6.0),
            (90_000, 0.02, 2.0),
            (4000, 0.25, 1.0),
        ] {
            for height in [3.0, 100.0, 1e5] {
                let told = notes(&impacts(period, height, hz, q));
                assert!(told.is_empty(), "{period} {hz} {q} {height}: {told}");
            }
        }
    }
}
