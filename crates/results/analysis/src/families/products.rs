//! Inner products block by block, and sums of them that are interpolated between nodes.

use pulp::{Arch, Simd, WithSimd};

use super::kernels::{Complex, Signal, sum_of_products, times};

/// Values of one node that lie together: whole vectors.
const GROUP: usize = 16;

/// Σ ā b over blocks of `block` values, and over signals of `length` values one behind the other.
pub(super) fn products(a: &Signal, b: &Signal, length: usize, block: usize) -> Signal {
    Arch::new().dispatch(Products { a, b, length, block })
}

struct Products<'a> {
    a: &'a Signal,
    b: &'a Signal,
    length: usize,
    block: usize,
}

impl WithSimd for Products<'_> {
    type Output = Signal;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Signal {
        let Self { a, b, length, block } = self;
        let mut sums = vec![(0.0, 0.0); length.div_ceil(block)];
        for first in (0..a.len()).step_by(length.max(1)) {
            let ([a_re, a_im], [b_re, b_im]) = (a.part(first..first + length), b.part(first..first + length));
            let blocks = a_re.chunks(block).zip(a_im.chunks(block));
            let blocks = blocks.zip(b_re.chunks(block).zip(b_im.chunks(block)));
            for (n, ((a_re, a_im), (b_re, b_im))) in blocks.enumerate() {
                let (re, im) = sum_of_products([a_re, a_im, b_re, b_im]);
                sums[n] = (sums[n].0 + re, sums[n].1 + im);
            }
        }
        sums.into_iter().collect()
    }
}

/// Signals at some nodes, laid out for weighted sums of them: groups of values, of each node in turn, real
/// and imaginary parts.
pub(super) struct Interpolated {
    groups: Vec<[[f64; GROUP]; 2]>,
    nodes: usize,
}

impl Interpolated {
    /// Of signals of one length, one a node.
    pub(super) fn of(signals: &[Signal]) -> Self {
        let length = signals.first().map_or(0, Signal::len);
        let group = |signal: &Signal, from: usize| {
            signal.part(from..length.min(from + GROUP)).map(|values| {
                let mut group = [0.0; GROUP];
                group[..values.len()].copy_from_slice(values);
                group
            })
        };
        let starts = (0..length).step_by(GROUP);
        let groups = starts.flat_map(|from| signals.iter().map(move |signal| group(signal, from)));
        Self { groups: groups.collect(), nodes: signals.len() }
    }

    /// Σ turn · (signals, interpolated by their weights), for each of `turns` and its weights.
    pub(super) fn sums(&self, turns: &[Signal], weights: &[Vec<f64>]) -> Vec<Complex> {
        Arch::new().dispatch(InterpolatedSums { products: self, turns, weights })
    }
}

struct InterpolatedSums<'a> {
    products: &'a Interpolated,
    turns: &'a [Signal],
    weights: &'a [Vec<f64>],
}

impl WithSimd for InterpolatedSums<'_> {
    type Output = Vec<Complex>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<Complex> {
        let Self { products: Interpolated { groups, nodes }, turns, weights } = self;
        let mut all = Vec::with_capacity(turns.len());
        for (turns, weights) in turns.iter().zip(weights) {
            let mut sums = [[0.0; GROUP]; 2];
            let [turns_re, turns_im] = turns.part(0..turns.len());
            let turns = turns_re.chunks(GROUP).zip(turns_im.chunks(GROUP));
            for (group, (turn_re, turn_im)) in groups.chunks_exact(*nodes).zip(turns) {
                let mut values = [[0.0; GROUP]; 2];
                for (node, weight) in group.iter().zip(weights) {
                    for part in 0..2 {
                        for lane in 0..GROUP {
                            values[part][lane] += weight * node[part][lane];
                        }
                    }
                }
                for (lane, turn) in turn_re.iter().zip(turn_im).enumerate() {
                    let product = times((*turn.0, *turn.1), (values[0][lane], values[1][lane]));
                    sums[0][lane] += product.0;
                    sums[1][lane] += product.1;
                }
            }
            let [re, im] = sums.map(|sums| sums.iter().sum());
            all.push((re, im));
        }
        all
    }
}
