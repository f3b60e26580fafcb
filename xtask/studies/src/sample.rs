//! Means of independent numbers with their uncertainty.

/// Numbers of one kind, one a start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    pub(crate) mean: f64,
    /// Standard deviation of one number.
    pub(crate) scatter: f64,
    count: usize,
}

impl Sample {
    /// Of two numbers or more.
    pub(crate) fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let scatter = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        Self { mean, scatter, count: values.len() }
    }

    /// Standard error of the mean.
    pub(crate) fn error(&self) -> f64 {
        self.scatter / (self.count as f64).sqrt()
    }
}

/// How far one mean is off another as a part of it, and the standard error of that.
pub(crate) fn ratio(one: &Sample, other: &Sample) -> [f64; 2] {
    let ratio = one.mean / other.mean;
    let error = ratio.abs() * (one.error() / one.mean).hypot(other.error() / other.mean);
    [ratio - 1.0, error]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_means_of_four_numbers_and_their_ratio() {
        let sample = Sample::of(&[1.0, 3.0, 5.0, 7.0]);
        assert_eq!(sample.mean, 4.0);
        assert!((sample.scatter - (20.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert!((sample.error() - (20.0_f64 / 12.0).sqrt()).abs() < 1e-15);
        let double = Sample::of(&[2.0, 6.0, 10.0, 14.0]);
        let [off, error] = ratio(&double, &sample);
        assert!((off - 1.0).abs() < 1e-15);
        // Either mean is known to sqrt(20 / 12) / 4 of itself.
        assert!((error - 2.0 * 2.0_f64.sqrt() * (20.0_f64 / 12.0).sqrt() / 4.0).abs() < 1e-15);
    }
}
