//! Power over its own mean course in a period, which removes what repeats with the period and keeps
//! everything else.
//!
//! Where the power is `a(t) (1 + m(t)) + b(t)` with a repeating course `a` as the larger part, the quotient
//! is `1 + m + b/a`: the modulator at its own frequency instead of about the lines of the course, and the
//! rest, weighted most where the course is weak.
//!
//! Source: means over a period, P. D. McFadden, Mech. Syst. Signal Process. 1 (1987) 83–95; to divide by them
//! is our own.

use crate::Result;
use crate::error::check_positive;

/// A period of the power of a segment.
#[derive(Debug, Clone)]
pub(crate) struct Cycle {
    frequency_hz: f64,
    /// Sum and count of the samples of each part of a period.
    parts: Vec<(f64, u32)>,
}

/// Fewest samples of a period.
const LEAST: usize = 4;

impl Cycle {
    /// A frequency [Hz], of segments whose envelopes hold at most `samples` samples.
    pub(crate) fn new(frequency_hz: f64, samples: usize) -> Result<Self> {
        check_positive("frequency_hz", frequency_hz)?;
        Ok(Self { frequency_hz, parts: vec![(0.0, 0); samples] })
    }

    /// Divides the power of a segment of `duration_s` by its mean over the periods, in as many parts of a
    /// period as it holds samples; makes it zero where a period holds fewer than four.
    pub(crate) fn divide(&mut self, power: &mut [f64], duration_s: f64) {
        let turns = self.frequency_hz * duration_s;
        let count = (power.len() as f64 / turns) as usize;
        if count < LEAST || count > self.parts.len() {
            power.fill(0.0);
            return;
        }
        let parts = &mut self.parts[..count];
        parts.fill((0.0, 0));
        let step = turns / power.len() as f64;
        // In the middle of a sample: where a period is a whole number of them, its ends would fall on the
        // ends of parts.
        let part = |n: usize| ((((n as f64 + 0.5) * step).fract() * count as f64) as usize).min(count - 1);
        for (n, value) in power.iter().enumerate() {
            let (sum, times) = &mut parts[part(n)];
            *sum += value;
            *times += 1;
        }
        for (n, value) in power.iter_mut().enumerate() {
            let (sum, times) = parts[part(n)];
            // No power in any period: the quotient is zero.
            *value = if sum > 0.0 { *value * f64::from(times) / sum } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Source: (1 + 0.8 cos a)(1 + 0.3 cos b) over the mean of its period in a is 1 + 0.3 cos b.
    #[test]
    fn analytic_a_modulated_course_leaves_its_modulator() {
        const SAMPLES: usize = 20_000;
        let at = |n: usize| n as f64 / SAMPLES as f64;
        // 100 periods and 7 of the modulator.
        let modulator = |n: usize| 1.0 + 0.3 * (TAU * 7.0 * at(n)).cos();
        let mut power: Vec<f64> =
            (0..SAMPLES).map(|n| (1.0 + 0.8 * (TAU * 100.0 * at(n)).cos()) * modulator(n)).collect();
        Cycle::new(100.0, SAMPLES).unwrap().divide(&mut power, 1.0);
        // A mean over 100 values of the modulator, seven whole periods, is exact; only round-off remains.
        let worst = power.iter().enumerate().map(|(n, p)| (p - modulator(n)).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{worst}");
    }

    #[test]
    fn refuses_periods_that_it_cannot_tell() {
        stribeck_testing::assert_refused(Cycle::new(0.0, 10), "greater than 0");
        let mut power = vec![1.0; 300];
        Cycle::new(100.0, 300).unwrap().divide(&mut power, 1.0);
        assert!(power.iter().all(|p| *p == 0.0));
    }
}
