//! How likely targets are at a point: Student's t for each output about its prediction, joined by the
//! correlation of their residuals (a Gaussian copula), times the probabilities that they exist, or do not.

use crate::{
    emulator::{Emulator, Scaled, Tails},
    error::Error,
    random::normal_quantile,
    runs::Target,
};

/// Points that are predicted in one go.
const CHUNK: usize = 512;

/// Targets against an emulator.
pub(crate) struct Likelihood<'a> {
    emulator: &'a Emulator,
    pub(crate) asked: Vec<Asked>,
}

/// A target on the scale of its output.
#[derive(Debug, Clone)]
pub(crate) struct Asked {
    output: usize,
    /// None if the output must be missing.
    value: Option<f64>,
    tolerance: f64,
    tails: Option<Tails>,
}

/// A target as it looks from one point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    /// Logarithm of the probability that the output exists, or does not, as the target asks.
    log_exists: f64,
    /// Target minus predicted mean, on the output's scale.
    residual: f64,
    /// Scale of the prediction's own uncertainty, and of the scatter of runs.
    pub(crate) uncertainty: f64,
    pub(crate) scatter: f64,
}

impl Seen {
    /// Scale of a run about the prediction, and with the tolerance of the target.
    fn scales(&self, tolerance: f64) -> [f64; 2] {
        let scale = self.uncertainty.hypot(self.scatter);
        [scale, scale.hypot(tolerance).max(f64::MIN_POSITIVE)]
    }
}

/// Some outputs at some points.
pub(crate) struct Predictions {
    points: usize,
    /// Of each output: the probability that it exists, and its prediction, point by point.
    columns: Vec<(Vec<f64>, Option<Vec<Scaled>>)>,
}

impl Predictions {
    pub(crate) fn of(emulator: &Emulator, outputs: &[usize], points: &[Vec<f64>]) -> Self {
        let column = |&output: &usize| (emulator.exists(output, points), emulator.scaled(output, points));
        Self { points: points.len(), columns: outputs.iter().map(column).collect() }
    }
}

impl<'a> Likelihood<'a> {
    pub(crate) fn new(emulator: &'a Emulator, targets: &[Target]) -> Result<Self, Error> {
        let outputs: Vec<_> = emulator.outputs().cloned().collect();
        let asked = |(number, target): (usize, &Target)| {
            target.check(number, &outputs)?;
            let scale = emulator.scale_of(target.output);
            let unit = target.value.map_or(1.0, |value| scale.slope(value));
            Ok(Asked {
                output: target.output,
                value: target.value.map(|value| scale.forward(value)),
                tolerance: target.tolerance / unit,
                tails: emulator.tails(target.output),
            })
        };
        let asked = targets.iter().enumerate().map(asked).collect::<Result<_, _>>()?;
        Ok(Self { emulator, asked })
    }

    /// Every target from every point (`[point][target]`).
    pub(crate) fn see(&self, points: &[Vec<f64>]) -> Vec<Vec<Seen>> {
        let outputs: Vec<usize> = self.asked.iter().map(|asked| asked.output).collect();
        let some = |some: &[Vec<f64>]| self.compare(&Predictions::of(self.emulator, &outputs, some));
        points.chunks(CHUNK).flat_map(some).collect()
    }

    /// Every target against predictions, whose columns are the targets.
    fn compare(&self, predictions: &Predictions) -> Vec<Vec<Seen>> {
        let mut rows = vec![Vec::with_capacity(self.asked.len()); predictions.points];
        for (asked, (exists, scaled)) in self.asked.iter().zip(&predictions.columns) {
            for (j, row) in rows.iter_mut().enumerate() {
                let probability = if asked.value.is_some() { exists[j] } else { 1.0 - exists[j] };
                let mut seen =
                    Seen { log_exists: probability.ln(), residual: 0.0, uncertainty: 0.0, scatter: 0.0 };
                if let (Some(value), Some(all)) = (asked.value, scaled) {
                    seen.residual = value - all[j].mean;
                    (seen.uncertainty, seen.scatter) = (all[j].uncertainty, all[j].scatter);
                }
                row.push(seen);
            }
        }
        rows
    }

    /// The emulator's predictions of outputs at points.
    pub(crate) fn predictions(&self, outputs: &[usize], points: &[Vec<f64>]) -> Predictions {
        Predictions::of(self.emulator, outputs, points)
    }

    /// Logarithm of the joint density against predictions, whose columns are the targets.
    pub(crate) fn at_predicted(&self, predictions: &Predictions) -> Vec<f64> {
        self.compare(predictions).iter().map(|seen| self.density(seen, |_| true)).collect()
    }

    /// Logarithm of the joint density at points, on the scales of the outputs.
    pub(crate) fn at(&self, points: &[Vec<f64>]) -> Vec<f64> {
        self.see(points).iter().map(|seen| self.density(seen, |_| true)).collect()
    }

    /// Logarithm of the joint density of those targets that are kept.
    pub(crate) fn density(&self, seen: &[Seen], keep: impl Fn(usize) -> bool) -> f64 {
        let mut sum = 0.0;
        let mut normal: Vec<(usize, f64, f64)> = Vec::with_capacity(seen.len());
        for (i, (asked, seen)) in self.asked.iter().zip(seen).enumerate().filter(|(i, _)| keep(*i)) {
            sum += seen.log_exists;
            if let (Some(_), Some(tails)) = (asked.value, asked.tails) {
                let [scale, whole] = seen.scales(asked.tolerance);
                let t = seen.residual / whole;
                sum += tails.log_density(t) - whole.ln();
                normal.push((i, tails.normal(t), scale / whole));
            }
        }
        sum + self.copula(&normal)
    }

    /// Logarithm of the copula's density, of normal deviates and the share of each that is due to the runs.
    fn copula(&self, normal: &[(usize, f64, f64)]) -> f64 {
        let n = normal.len();
        let mut factor = vec![0.0; n * n];
        for i in 0..n {
            let (a, _, own_a) = normal[i];
            for j in 0..=i {
                let (b, _, own_b) = normal[j];
                let [p, q] = [self.asked[a].output, self.asked[b].output];
                // Two targets of one output stand for two runs, whose scatters are independent.
                let mut rest = match (i == j, p == q) {
                    (true, _) => 1.0,
                    (false, true) => 0.0,
                    (false, false) => own_a * own_b * self.emulator.correlation(p, q),
                };
                for k in 0..j {
                    rest -= factor[i * n + k] * factor[j * n + k];
                }
                factor[i * n + j] = if i == j { rest.max(1e-6).sqrt() } else { rest / factor[j * n + j] };
            }
        }
        let mut forward = vec![0.0; n];
        let mut sum = 0.0;
        for i in 0..n {
            let known: f64 = (0..i).map(|k| factor[i * n + k] * forward[k]).sum();
            forward[i] = (normal[i].1 - known) / factor[i * n + i];
            sum += 0.5 * (normal[i].1 * normal[i].1 - forward[i] * forward[i]) - factor[i * n + i].ln();
        }
        sum
    }

    /// How many scales of scatter and tolerance a target lies from the prediction, as a normal deviate, and
    /// none for a target on existence alone.
    pub(crate) fn deviate(&self, target: usize, seen: &Seen) -> Option<f64> {
        let asked = &self.asked[target];
        let tails = asked.value.and(asked.tails)?;
        Some(tails.normal(seen.residual / seen.scales(asked.tolerance)[1]))
    }

    /// How far one standard deviation of the emulator's mean moves the logarithm of the likelihood, over all
    /// targets.
    pub(crate) fn doubt(&self, seen: &[Seen]) -> f64 {
        let one = |(asked, seen): (&Asked, &Seen)| {
            let Some(tails) = asked.value.and(asked.tails) else { return 0.0 };
            let whole = seen.scales(asked.tolerance)[1];
            let (t, step) = (seen.residual / whole, seen.uncertainty / whole);
            (0.5 * (tails.log_density(t + step) - tails.log_density(t - step))).powi(2)
                + (0.5 * step * step).powi(2)
        };
        self.asked.iter().zip(seen).map(one).sum::<f64>().sqrt()
    }

    /// Probability that the output exists, or does not, as the target asks.
    pub(crate) fn probability(&self, seen: &Seen) -> f64 {
        seen.log_exists.exp()
    }

    /// Improbability of the target on existence, as a two-sided normal deviate: 0 where it is certain.
    pub(crate) fn rarity(&self, seen: &Seen) -> f64 {
        -normal_quantile((0.5 * seen.log_exists.exp()).clamp(1e-12, 0.5))
    }

    /// Median prediction, in the output's unit; NaN for a target on existence alone.
    pub(crate) fn prediction(&self, target: usize, seen: &Seen) -> f64 {
        let asked = &self.asked[target];
        match asked.value.filter(|_| asked.tails.is_some()) {
            Some(value) => self.emulator.scale_of(asked.output).back(value - seen.residual),
            None => f64::NAN,
        }
    }

    /// Narrows the emulator's uncertainty at points as runs at further points will.
    pub(crate) fn learn(&self, points: &[Vec<f64>], seen: &mut [Vec<Seen>], further: &[Vec<f64>]) {
        for (target, asked) in self.asked.iter().enumerate().filter(|(_, asked)| asked.value.is_some()) {
            let Some(left) = self.emulator.left_after(asked.output, points, further) else { continue };
            for (row, share) in seen.iter_mut().zip(left) {
                row[target].uncertainty *= share;
            }
        }
    }
}

impl Emulator {
    /// Logarithm of the joint density of targets at a point, each on the scale of its output: with the
    /// scatter of a start, the emulator's own uncertainty and the targets' tolerances. Several targets of one
    /// output count as separate runs.
    ///
    /// # Errors
    /// When a target is invalid, or the point has other dimensions or lies outside.
    pub fn log_likelihood(&self, point: &[f64], targets: &[Target]) -> Result<f64, Error> {
        let points = [point.to_vec()];
        self.check(&points)?;
        Ok(Likelihood::new(self, targets)?.at(&points)[0])
    }
}
