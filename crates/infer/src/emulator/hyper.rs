//! Length scales and variances by maximum of the marginal likelihood, with a weak prior.

use faer::{Mat, Side};

use super::kernel::{Kernel, TREND_VARIANCE, matern, trend};

/// Most points from which they are found; the cost of a step grows with the cube.
pub(super) const SUBSET: usize = 300;

/// Steps of the search from each start.
const STEPS: usize = 40;

/// Smallest variance of the noise, in units of the output's variance.
pub(super) const LEAST_NOISE: f64 = 1e-8;

/// Bounds of the logarithms: length scales, variance of the function, variance of the noise, odds of its
/// common part.
const BOUNDS: [[f64; 2]; 4] = [[-3.5, 5.0], [-9.0, 5.0], [-18.4, 2.0], [-7.0, 9.0]];

/// Means and standard deviations of their prior, the first of the length scales but for ½ ln of their number.
const PRIOR: [[f64; 2]; 4] =
    [[std::f64::consts::SQRT_2, 1.732_050_807_568_877_2], [0.0, 3.0], [-4.0, 4.0], [0.0, 3.0]];

/// Hyperparameters of an output, in units of its standard deviation.
#[derive(Debug, Clone)]
pub(super) struct Hyper {
    pub(super) kernel: Kernel,
    /// Variance of a single run about the function, times the factor of its point.
    pub(super) noise: f64,
    /// Share of it that values of one block have in common, 0 … 1; 0 where each has its own.
    pub(super) shared: f64,
}

/// Points with a mean of runs each, standardised.
pub(super) struct Sample<'a> {
    pub(super) points: &'a [Vec<f64>],
    pub(super) values: &'a [f64],
    /// Variance of each value in units of the noise: the point's factor over its number of runs.
    pub(super) factors: &'a [f64],
    /// Number of the block of each value: readings of the same simulations.
    pub(super) blocks: &'a [usize],
    pub(super) linear: bool,
}

/// The search for the maximum over the logarithms of length scales, variance and noise.
struct Search {
    /// Squared differences of each pair `j < i`, dimension by dimension.
    squares: Vec<f64>,
    trend: Mat<f64>,
    values: Vec<f64>,
    factors: Vec<f64>,
    /// Pairs `i > j` of one block, with the root of the product of their factors.
    together: Vec<(usize, usize, f64)>,
    dimensions: usize,
}

impl Hyper {
    /// From the sample, from a start if there is one.
    pub(super) fn fit(sample: &Sample, start: Option<&Self>) -> Self {
        let search = Search::new(sample);
        let d = search.dimensions;
        let level = (d as f64).sqrt().ln();
        let starts = match start {
            Some(hyper) => vec![hyper.logarithms(search.is_shared())],
            None => [(level, -2.0), (level - 1.2, -4.0)]
                .map(|(length, noise)| {
                    let shared = vec![0.0; usize::from(search.is_shared())];
                    [vec![length; d], vec![0.0, noise], shared].concat()
                })
                .to_vec(),
        };
        let best = starts.into_iter().map(|start| search.climb(start)).max_by(|a, b| a.1.total_cmp(&b.1));
        Self::of(&best.expect("one start at least").0, d)
    }

    fn logarithms(&self, is_shared: bool) -> Vec<f64> {
        let lengths = self.kernel.rates.iter().map(|rate| -rate.ln());
        let odds = is_shared.then(|| (self.shared / (1.0 - self.shared)).ln());
        lengths.chain([self.kernel.variance.ln(), self.noise.ln()]).chain(odds).collect()
    }

    fn of(logarithms: &[f64], d: usize) -> Self {
        let rates = logarithms[..d].iter().map(|length| (-length).exp()).collect();
        let noise = logarithms[d + 1].exp().max(LEAST_NOISE);
        let shared = logarithms.get(d + 2).map_or(0.0, |odds| share_of(*odds));
        Self { kernel: Kernel { variance: logarithms[d].exp(), rates }, noise, shared }
    }
}

/// The share with these odds, given by their logarithm.
fn share_of(odds: f64) -> f64 {
    1.0 / (1.0 + (-odds).exp())
}

/// Rows from which hyperparameters are found: all, or so many evenly from each part of the list. Of blocks
/// with several rows two are kept, in turn, so that what they have in common can be seen.
fn subset(blocks: &[usize]) -> Vec<usize> {
    let n = blocks.len();
    let members = members(blocks);
    if n <= SUBSET || members.len() == n {
        return (0..n).step_by(n.div_ceil(SUBSET).max(1)).collect();
    }
    let two = |(number, of): (usize, &Vec<usize>)| -> Vec<usize> {
        let m = of.len();
        if m == 1 { of.clone() } else { vec![of[number % m], of[(number + m / 2) % m]] }
    };
    let pairs: Vec<Vec<usize>> = members.iter().enumerate().map(two).collect();
    let every = pairs.iter().map(Vec::len).sum::<usize>().div_ceil(SUBSET).max(1);
    let mut rows: Vec<usize> = pairs.into_iter().step_by(every).flatten().collect();
    rows.sort_unstable();
    rows
}

/// Where the rows of every block have equal values, one row of each, in turn, with all rows of the block:
/// values that repeat say nothing, and a likelihood that took them for independent would have no noise. None
/// where they differ, or where every row is its own block.
pub(super) fn representatives(blocks: &[usize], values: &[f64]) -> Option<Vec<(usize, Vec<usize>)>> {
    let members = members(blocks);
    let equal = |block: &Vec<usize>| block.iter().all(|&row| values[row] == values[block[0]]);
    (members.len() < blocks.len() && members.iter().all(equal))
        .then(|| members.into_iter().enumerate().map(|(n, block)| (block[n % block.len()], block)).collect())
}

/// Rows of each block, in the order of first occurrence.
pub(crate) fn members(blocks: &[usize]) -> Vec<Vec<usize>> {
    let mut place = std::collections::BTreeMap::new();
    let mut members: Vec<Vec<usize>> = Vec::new();
    for (row, block) in blocks.iter().enumerate() {
        let at = *place.entry(block).or_insert(members.len());
        if at == members.len() {
            members.push(Vec::new());
        }
        members[at].push(row);
    }
    members
}

impl Search {
    fn new(sample: &Sample) -> Self {
        let rows = subset(sample.blocks);
        let dimensions = sample.points[0].len();
        let mut squares = Vec::with_capacity(rows.len() * rows.len() / 2 * dimensions);
        let mut together = Vec::new();
        for (i, &a) in rows.iter().enumerate() {
            for (j, &b) in rows[..i].iter().enumerate() {
                if sample.blocks[a] == sample.blocks[b] {
                    together.push((i, j, (sample.factors[a] * sample.factors[b]).sqrt()));
                }
                squares
                    .extend(sample.points[a].iter().zip(&sample.points[b]).map(|(p, q)| (p - q) * (p - q)));
            }
        }
        let terms: Vec<Vec<f64>> = rows.iter().map(|&i| trend(&sample.points[i], sample.linear)).collect();
        let trend = Mat::from_fn(rows.len(), terms[0].len(), |i, j| terms[i][j]);
        let pick = |of: &[f64]| rows.iter().map(|&i| of[i]).collect();
        let (values, factors) = (pick(sample.values), pick(sample.factors));
        Self { squares, trend, values, factors, together, dimensions }
    }

    /// Whether some values may have a part of their noise in common.
    fn is_shared(&self) -> bool {
        !self.together.is_empty()
    }

    /// Logarithm of the posterior density, and its gradient; none where the covariance is not positive
    /// definite.
    fn density(&self, at: &[f64]) -> Option<(f64, Vec<f64>)> {
        let (n, d) = (self.values.len(), self.dimensions);
        let inverse_squares: Vec<f64> = at[..d].iter().map(|length| (-2.0 * length).exp()).collect();
        let (variance, noise) = (at[d].exp(), at[d + 1].exp().max(LEAST_NOISE));
        let mut slopes = vec![0.0; n * n.saturating_sub(1) / 2];
        let mut smooth = Mat::<f64>::zeros(n, n);
        let mut pair = 0;
        for i in 0..n {
            smooth[(i, i)] = variance;
            for j in 0..i {
                let squares = &self.squares[pair * d..][..d];
                let squared: f64 = squares.iter().zip(&inverse_squares).map(|(s, w)| s * w).sum();
                let (value, slope) = matern(squared);
                smooth[(i, j)] = variance * value;
                smooth[(j, i)] = variance * value;
                slopes[pair] = variance * slope;
                pair += 1;
            }
        }
        let mut covariance = &smooth + TREND_VARIANCE * (&self.trend * self.trend.transpose());
        for i in 0..n {
            covariance[(i, i)] += noise * self.factors[i] + 1e-10 * variance;
        }
        let shared = at.get(d + 2).map_or(0.0, |odds| share_of(*odds));
        for &(i, j, factor) in &self.together {
            covariance[(i, j)] += noise * shared * factor;
            covariance[(j, i)] += noise * shared * factor;
        }
        let (value, outer) = self.likelihood(&covariance)?;
        let mut gradient = vec![0.0; at.len()];
        for &(i, j, factor) in &self.together {
            gradient[d + 1] += outer[(i, j)] * noise * shared * factor;
            gradient[d + 2] += outer[(i, j)] * noise * shared * (1.0 - shared) * factor;
        }
        pair = 0;
        for i in 0..n {
            gradient[d] += 0.5 * outer[(i, i)] * variance;
            gradient[d + 1] += 0.5 * outer[(i, i)] * noise * self.factors[i];
            for j in 0..i {
                gradient[d] += outer[(i, j)] * smooth[(i, j)];
                let weight = outer[(i, j)] * slopes[pair];
                for (k, square) in self.squares[pair * d..][..d].iter().enumerate() {
                    gradient[k] += weight * square * inverse_squares[k];
                }
                pair += 1;
            }
        }
        Some(self.with_prior(at, value, gradient))
    }

    /// Logarithm of the marginal likelihood, and α αᵀ − K⁻¹, whose product with ∂K is twice its change
    /// (Rasmussen and Williams, eq. 5.9).
    fn likelihood(&self, covariance: &Mat<f64>) -> Option<(f64, Mat<f64>)> {
        use faer::linalg::solvers::DenseSolveCore;
        let n = self.values.len();
        let factor = covariance.llt(Side::Lower).ok()?;
        let inverse = factor.inverse();
        let values = Mat::from_fn(n, 1, |i, _| self.values[i]);
        let alpha = &inverse * &values;
        let fit: f64 = (0..n).map(|i| alpha[(i, 0)] * values[(i, 0)]).sum();
        let determinant: f64 = (0..n).map(|i| factor.L()[(i, i)].ln()).sum();
        let value = -0.5 * fit - determinant;
        value.is_finite().then(|| (value, &alpha * alpha.transpose() - &inverse))
    }

    /// Adds the prior: length scales of the order of √dimensions, within a factor of six either way
    /// (Hvarfner, Hellsten and Nardi, *Vanilla Bayesian optimization performs great in high dimensions*, ICML
    /// 2024, §5).
    fn with_prior(&self, at: &[f64], mut value: f64, mut gradient: Vec<f64>) -> (f64, Vec<f64>) {
        let d = self.dimensions;
        for (i, x) in at.iter().enumerate() {
            let kind = (i + 1).saturating_sub(d);
            let [mean, deviation] = PRIOR[kind];
            let mean = if kind == 0 { mean + 0.5 * (d as f64).ln() } else { mean };
            let z = (x - mean) / deviation;
            value -= 0.5 * z * z;
            gradient[i] -= z / deviation;
        }
        (value, gradient)
    }

    /// Climbs by BFGS with halved steps (Nocedal and Wright, *Numerical Optimization*, 2006, alg. 6.1),
    /// within bounds.
    fn climb(&self, start: Vec<f64>) -> (Vec<f64>, f64) {
        let d = self.dimensions;
        let bounds = |i: usize| BOUNDS[(i + 1).saturating_sub(d)];
        let mut at: Vec<f64> =
            start.iter().enumerate().map(|(i, x)| x.clamp(bounds(i)[0], bounds(i)[1])).collect();
        let Some((mut value, mut gradient)) = self.density(&at) else { return (at, f64::NEG_INFINITY) };
        let size = at.len();
        let mut metric = identity(size, 0.05);
        for _ in 0..STEPS {
            let mut direction: Vec<f64> = metric.iter().map(|row| dot(row, &gradient)).collect();
            if dot(&direction, &gradient) <= 0.0 {
                metric = identity(size, 0.05);
                direction = gradient.iter().map(|g| 0.05 * g).collect();
            }
            let longest = direction.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let mut share = (1.5 / longest).min(1.0);
            let next = loop {
                let moved: Vec<f64> = (0..size)
                    .map(|i| (at[i] + share * direction[i]).clamp(bounds(i)[0], bounds(i)[1]))
                    .collect();
                match self.density(&moved) {
                    Some((higher, slope)) if higher > value => break Some((moved, higher, slope)),
                    _ if share < 1e-4 => break None,
                    _ => share *= 0.3,
                }
            };
            let Some((moved, higher, slope)) = next else { break };
            let step: Vec<f64> = moved.iter().zip(&at).map(|(p, q)| p - q).collect();
            let change: Vec<f64> = gradient.iter().zip(&slope).map(|(p, q)| p - q).collect();
            update(&mut metric, &step, &change);
            let gain = higher - value;
            (at, value, gradient) = (moved, higher, slope);
            if gain < 1e-3 {
                break;
            }
        }
        (at, value)
    }
}

fn identity(size: usize, scale: f64) -> Vec<Vec<f64>> {
    (0..size).map(|i| (0..size).map(|j| if i == j { scale } else { 0.0 }).collect()).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(p, q)| p * q).sum()
}

/// The inverse Hessian after a step and the change of the (negative) gradient (Nocedal and Wright, eq. 6.17).
fn update(metric: &mut [Vec<f64>], step: &[f64], change: &[f64]) {
    let curvature = dot(step, change);
    if curvature <= 1e-10 {
        return;
    }
    let pushed: Vec<f64> = metric.iter().map(|row| dot(row, change)).collect();
    let scale = (1.0 + dot(change, &pushed) / curvature) / curvature;
    for i in 0..step.len() {
        for j in 0..step.len() {
            metric[i][j] +=
                scale * step[i] * step[j] - (pushed[i] * step[j] + step[i] * pushed[j]) / curvature;
        }
    }
}
