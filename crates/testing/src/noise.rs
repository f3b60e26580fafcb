//! Random numbers that are the same on every machine.

/// Repeatable numbers between −1 and 1, evenly distributed (Knuth's linear congruential generator).
#[derive(Debug, Clone)]
pub struct Noise(u64);

impl Noise {
    /// The same seed gives the same numbers.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number, between −1 and 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// The next number, between 0 and 1.
    pub fn share(&mut self) -> f64 {
        0.5 * (self.uniform() + 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Noise;

    /// Mean 0 and variance 1/3, within four standard deviations of the estimates.
    #[test]
    fn by_hand_mean_and_variance_are_those_of_an_even_distribution() {
        const N: usize = 10_000;
        let mut noise = Noise::new(1);
        let numbers: Vec<f64> = (0..N).map(|_| noise.uniform()).collect();
        assert!(numbers.iter().all(|x| (-1.0..1.0).contains(x)));
        let mean = numbers.iter().sum::<f64>() / N as f64;
        let variance = numbers.iter().map(|x| x * x).sum::<f64>() / N as f64;
        assert!(mean.abs() < 4.0 * (1.0 / 3.0 / N as f64).sqrt(), "{mean}");
        // The fourth moment is 1/5, so the variance of x² is 1/5 − 1/9 = 4/45.
        assert!((variance - 1.0 / 3.0).abs() < 4.0 * (4.0 / 45.0 / N as f64).sqrt(), "{variance}");
    }
}
