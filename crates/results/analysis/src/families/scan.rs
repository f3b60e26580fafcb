//! Shares explained at the many offsets of a scan, interpolated between a few of them.
//!
//! A column that is shifted by δ and averaged over a filter's length is exp 2πiδt, with t the middle of each
//! average, times a factor that hardly changes with δ, because an average is short. So inner products of two
//! columns are smooth functions of δ; those of a column and a channel are sums of exp(−2πiδt) times smooth
//! functions, with t the middles of blocks of a few averages. Both are interpolated, to rounding, between the
//! few offsets of Chebyshev nodes, and shares follow from them by Cholesky's factorisation (THEORY §7.7).
//! Where columns nearly depend on each other that would lose digits, and the result is `None`.

use std::f64::consts::{PI, TAU};

use super::comb::{Blocks, INDEPENDENT};
use super::kernels::{Complex, Signal, dot, square, times};
use super::products::Interpolated;

/// Error of the interpolation that rounding exceeds.
const ROUNDING: f64 = 1e-15;
/// Least pivot, over the largest squared norm of a column, at which half of all digits are left.
pub(super) const WELL_APART: f64 = 1e-8;

/// Offsets between which functions of the offset are interpolated.
pub(super) struct Nodes {
    reach_hz: f64,
    pub(super) hz: Vec<f64>,
}

impl Nodes {
    /// As many as exp 2πift needs for offsets up to `reach_hz` and times up to `reach_s`: Chebyshev's series
    /// of exp iφx, |x| ≤ 1, ends with 2 (φ/2)ⁿ/n!.
    pub(super) fn new(reach_hz: f64, reach_s: f64) -> Self {
        let phase = TAU * reach_hz * reach_s;
        let (mut count, mut left) = (1, phase);
        while left > ROUNDING {
            count += 1;
            left *= 0.5 * phase / count as f64;
        }
        let hz = (0..count).map(|n| reach_hz * Self::angle(n, count).cos()).collect();
        Self { reach_hz, hz }
    }

    fn angle(n: usize, count: usize) -> f64 {
        PI * (n as f64 + 0.5) / count as f64
    }

    /// Weights of the nodes at `hz`: barycentric interpolation.
    /// Source: J.-P. Berrut and L. N. Trefethen, *SIAM Review* 46, 2004, (4.2) and (5.3).
    fn weights(&self, hz: f64) -> Vec<f64> {
        let count = self.hz.len();
        let parts: Vec<f64> = (0..count)
            .map(|n| {
                let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
                sign * Self::angle(n, count).sin() * self.reach_hz / (hz - self.hz[n])
            })
            .collect();
        if let Some(hit) = parts.iter().position(|part| !part.is_finite()) {
            return (0..count).map(|n| f64::from(u8::from(n == hit))).collect();
        }
        let sum: f64 = parts.iter().sum();
        parts.iter().map(|part| part / sum).collect()
    }
}

/// Offsets of a scan.
pub(super) struct Offsets {
    /// Of each node, for each offset.
    weights: Vec<Vec<f64>>,
    /// Factors of the blocks, for each offset.
    turns: Vec<Signal>,
}

impl Offsets {
    pub(super) fn new(hz: &[f64], nodes: &Nodes, blocks: &Blocks) -> Self {
        let turn = |hz: &f64| blocks.turned(Signal::constant((1.0, 0.0), blocks.count()), -hz);
        Self {
            weights: hz.iter().map(|hz| nodes.weights(*hz)).collect(),
            turns: hz.iter().map(turn).collect(),
        }
    }
}

/// Columns of one kind, and the channels that they are fitted to.
pub(super) struct Scan {
    /// Inner products of columns, for each node: of each with those up to itself.
    columns: Vec<Vec<Complex>>,
    /// Inner products of each column with each channel, then with each orthonormal column of the fit, block
    /// by block.
    products: Vec<Vec<Interpolated>>,
    /// Of each channel what the fit leaves, and its inner products with the columns of the fit.
    channels: Vec<(f64, Vec<Complex>)>,
}

impl Scan {
    /// Of `columns` at each node.
    pub(super) fn new(
        nodes: &Nodes,
        blocks: &Blocks,
        columns: &[Vec<Signal>],
        channels: &[&Signal],
        fit: &[Signal],
    ) -> Self {
        let inner = |columns: &Vec<Signal>| {
            let pairs = (0..columns.len()).flat_map(|k| (0..=k).map(move |l| (k, l)));
            pairs.map(|(k, l)| dot(&columns[k], &columns[l])).collect()
        };
        let product = |other: &Signal, number: usize| {
            let at_nodes = columns.iter().zip(&nodes.hz);
            let at_nodes =
                at_nodes.map(|(columns, hz)| blocks.turned(blocks.sums(&columns[number], other), *hz));
            Interpolated::of(&at_nodes.collect::<Vec<_>>())
        };
        let of_other = |other: &Signal| (0..columns[0].len()).map(|k| product(other, k)).collect();
        let known = |channel: &&Signal| {
            let along: Vec<Complex> = fit.iter().map(|q| dot(q, channel)).collect();
            (dot(channel, channel).0 - along.iter().copied().map(square).sum::<f64>(), along)
        };
        Self {
            columns: columns.iter().map(inner).collect(),
            products: channels.iter().copied().chain(fit).map(of_other).collect(),
            channels: channels.iter().map(known).collect(),
        }
    }

    /// Share of each channel at each offset; `None` where columns are too nearly dependent for this way.
    pub(super) fn shares(&self, Offsets { weights, turns }: &Offsets) -> Vec<Option<Vec<f64>>> {
        // Of each channel or column of the fit, of each column, of each offset.
        let along: Vec<Vec<Vec<Complex>>> = self
            .products
            .iter()
            .map(|columns| columns.iter().map(|products| products.sums(turns, weights)).collect())
            .collect();
        let at = |(n, weights): (usize, &Vec<f64>)| {
            let along: Vec<Vec<Complex>> =
                along.iter().map(|columns| columns.iter().map(|offsets| offsets[n]).collect()).collect();
            self.shares_of(weights, &along)
        };
        weights.iter().enumerate().map(at).collect()
    }

    /// Share of each channel by the inner products `along` of each column with channels and fit.
    fn shares_of(&self, weights: &[f64], along: &[Vec<Complex>]) -> Option<Vec<f64>> {
        let count = along[0].len();
        let (channels, fit) = along.split_at(self.channels.len());
        let inner = |k: usize, l: usize| {
            let at_nodes = self.columns.iter().map(|pairs| pairs[k * (k + 1) / 2 + l]);
            at_nodes.zip(weights).fold((0.0, 0.0), |sum, (v, w)| (sum.0 + w * v.0, sum.1 + w * v.1))
        };
        let longest = (0..count).map(|k| inner(k, k).0).fold(0.0, f64::max);
        // Rows of Cholesky's factor, but for columns that are nothing.
        let mut factor: Vec<(usize, Vec<Complex>, f64)> = Vec::with_capacity(count);
        for k in 0..count {
            let beside =
                |l: usize| fit.iter().fold(inner(k, l), |rest, q| minus(rest, times(q[k], conj(q[l]))));
            let mut row: Vec<Complex> = Vec::with_capacity(factor.len());
            for (l, earlier, diagonal) in &factor {
                let rest =
                    row.iter().zip(earlier).fold(beside(*l), |rest, (a, b)| minus(rest, times(*a, conj(*b))));
                row.push((rest.0 / diagonal, rest.1 / diagonal));
            }
            let left = beside(k).0 - row.iter().copied().map(square).sum::<f64>();
            if left > WELL_APART * longest {
                factor.push((k, row, left.sqrt()));
            } else if inner(k, k).0 > INDEPENDENT * INDEPENDENT * longest {
                return None;
            }
        }
        let of_channel = |(along, (left, of_fit)): (&Vec<Complex>, &(f64, Vec<Complex>))| {
            let mut solved: Vec<Complex> = Vec::with_capacity(factor.len());
            for (k, row, diagonal) in &factor {
                let beside =
                    fit.iter().zip(of_fit).fold(along[*k], |rest, (q, s)| minus(rest, times(q[*k], *s)));
                let rest = row.iter().zip(&solved).fold(beside, |rest, (a, b)| minus(rest, times(*a, *b)));
                solved.push((rest.0 / diagonal, rest.1 / diagonal));
            }
            share(solved.into_iter().map(square).sum(), *left)
        };
        Some(channels.iter().zip(&self.channels).map(of_channel).collect())
    }
}

fn conj(value: Complex) -> Complex {
    (value.0, -value.1)
}

fn minus(a: Complex, b: Complex) -> Complex {
    (a.0 - b.0, a.1 - b.1)
}

/// What is explained of what is left, 0 to 1.
pub(super) fn share(explained: f64, left: f64) -> f64 {
    if left > 0.0 { (explained / left).clamp(0.0, 1.0) } else { 0.0 }
}
