//! Moves of draws at one temperature that leave their distribution invariant.

use crate::random::Random;

/// Shares of the kinds of moves: along a difference of two others, along a whole difference (from one region
/// to another), the rest draws single coordinates anew from the prior.
const KINDS: [f64; 2] = [0.65, 0.15];

/// Steps along differences are to be accepted as often as this.
const ACCEPTED: f64 = 0.25;

/// Draws with the logarithms of their likelihoods.
pub(super) struct Population {
    pub(super) points: Vec<Vec<f64>>,
    pub(super) logs: Vec<f64>,
}

/// Length of steps along differences, in units of the length that is best for a normal distribution.
pub(super) struct Scales(f64);

impl Default for Scales {
    fn default() -> Self {
        Self(1.0)
    }
}

impl Population {
    /// `count` draws by weights of sum 1, systematically: each as often as its weight demands, but for
    /// rounding.
    pub(super) fn resampled(&self, weights: &[f64], count: usize, random: &mut Random) -> Self {
        let offset = random.share();
        let mut below = weights[0];
        let mut at = 0;
        let mut rows = Vec::with_capacity(count);
        for i in 0..count {
            let level = (i as f64 + offset) / count as f64;
            while below < level && at + 1 < weights.len() {
                at += 1;
                below += weights[at];
            }
            rows.push(at);
        }
        // Halves of the population move each other, so equal draws must not all lie in one.
        for i in (1..rows.len()).rev() {
            rows.swap(i, random.below(i + 1));
        }
        Self {
            points: rows.iter().map(|&row| self.points[row].clone()).collect(),
            logs: rows.iter().map(|&row| self.logs[row]).collect(),
        }
    }

    /// Proposes one move to every draw; each half moves by differences of the other, which stays meanwhile
    /// (Goodman and Weare's split ensemble). Returns the share of moves accepted.
    pub(super) fn sweep(
        &mut self,
        inverse_temperature: f64,
        scales: &mut Scales,
        log_likelihood: &impl Fn(&[Vec<f64>]) -> Vec<f64>,
        random: &mut Random,
    ) -> f64 {
        let (n, half) = (self.points.len(), self.points.len() / 2);
        let mut accepted = [0.0; 2];
        let mut steps = [0.0; 2];
        for (own, other) in [(0..half, half..n), (half..n, 0..half)] {
            let others = &self.points[other];
            let proposals: Vec<(Vec<f64>, bool)> =
                own.clone().map(|i| propose(&self.points[i], others, scales.0, random)).collect();
            let points: Vec<Vec<f64>> = proposals.iter().map(|pair| pair.0.clone()).collect();
            let logs = log_likelihood(&points);
            for ((i, (point, stepped)), log) in own.zip(proposals).zip(logs) {
                steps[usize::from(stepped)] += 1.0;
                if random.share().ln() < inverse_temperature * (log - self.logs[i]) {
                    accepted[usize::from(stepped)] += 1.0;
                    (self.points[i], self.logs[i]) = (point, log);
                }
            }
        }
        if steps[1] > 0.0 {
            scales.0 = (scales.0 * (accepted[1] / steps[1] - ACCEPTED).exp()).clamp(0.05, 2.0);
        }
        accepted.iter().sum::<f64>() / n as f64
    }
}

/// A point to move to, as likely as the way back, and whether it is a step of the adapted length.
fn propose(point: &[f64], others: &[Vec<f64>], scale: f64, random: &mut Random) -> (Vec<f64>, bool) {
    let d = point.len();
    let kind = random.share();
    let mut to = point.to_vec();
    if kind >= KINDS[0] + KINDS[1] {
        let coordinates = if random.share() < 0.7 { 1 } else { 2 };
        for _ in 0..coordinates {
            let which = random.below(d);
            to[which] = random.share();
        }
        return (to, false);
    }
    let stepped = kind < KINDS[0];
    let [a, b] = [random.below(others.len()), random.below(others.len())].map(|i| &others[i]);
    let share = if stepped { [1.0, 0.5, 2.0 / d as f64][random.below(3)] } else { 1.0 };
    let moving: Vec<bool> = (0..d).map(|_| random.share() < share).collect();
    let count = moving.iter().filter(|&&moves| moves).count().max(1);
    let length = if stepped { scale * 2.38 / (2.0 * count as f64).sqrt() } else { 1.0 };
    for i in (0..d).filter(|&i| moving[i]) {
        to[i] = reflected(point[i] + length * (a[i] - b[i]) + 1e-4 * random.normal());
    }
    (to, stepped)
}

/// Back into 0 … 1 by reflection at the ends, which keeps moves symmetric.
fn reflected(x: f64) -> f64 {
    let folded = x.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}
