//! Random numbers from a seed: the same on every machine.

use rand_pcg::{
    Pcg64Mcg,
    rand_core::{Rng, SeedableRng},
};
use statrs::distribution::{ContinuousCDF, Normal};

#[derive(Debug, Clone)]
pub(crate) struct Random(Pcg64Mcg);

impl Random {
    /// One of many sequences that a seed stands for.
    pub(crate) fn stream(seed: u64, number: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
    }

    /// Uniform, 0 ≤ … < 1.
    pub(crate) fn share(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// 0 … n − 1.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        ((self.share() * n as f64) as usize).min(n.saturating_sub(1))
    }

    /// Normally distributed with zero mean and unit variance.
    pub(crate) fn normal(&mut self) -> f64 {
        normal_quantile((self.share() + 2_f64.powi(-54)).min(1.0 - 2_f64.powi(-53)))
    }
}

/// The quantile of the standard normal distribution.
pub(crate) fn normal_quantile(share: f64) -> f64 {
    Normal::standard().inverse_cdf(share)
}

/// The share of the standard normal distribution below `value`.
pub(crate) fn normal_share(value: f64) -> f64 {
    Normal::standard().cdf(value)
}
