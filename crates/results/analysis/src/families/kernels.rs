//! The kernels of the fit of combs, compiled for the vectors of each processor. Nothing is fused and sums
//! have a fixed order, so that all of them give the same bits.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

/// Real and imaginary part.
pub(super) type Complex = (f64, f64);

/// Values that are turned with one table.
const BLOCK: usize = 16;

/// Averages that are taken together, of values that lie near the processor.
const TOGETHER: usize = 32;

/// Complex values, real and imaginary parts apart: vectors take either as they lie in memory.
#[derive(Debug, Clone, Default)]
pub(super) struct Signal {
    re: Vec<f64>,
    im: Vec<f64>,
}

impl Signal {
    /// The same value `length` times.
    pub(super) fn constant(value: Complex, length: usize) -> Self {
        Self { re: vec![value.0; length], im: vec![value.1; length] }
    }

    pub(super) fn len(&self) -> usize {
        self.re.len()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Complex> {
        self.re.iter().copied().zip(self.im.iter().copied())
    }

    pub(super) fn part(&self, part: Range<usize>) -> [&[f64]; 2] {
        [&self.re[part.clone()], &self.im[part]]
    }

    /// Times a real number.
    pub(super) fn scaled(&self, by: f64) -> Self {
        let scaled = |values: &[f64]| values.iter().map(|value| value * by).collect();
        Self { re: scaled(&self.re), im: scaled(&self.im) }
    }

    /// Adds `more` value by value.
    pub(super) fn add(&mut self, more: &Self) {
        for (sum, more) in [(&mut self.re, &more.re), (&mut self.im, &more.im)] {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
    }

    /// Signals one behind the other.
    pub(super) fn joined(signals: impl Iterator<Item = Self>) -> Self {
        let mut joined = Self::default();
        for signal in signals {
            joined.re.extend(signal.re);
            joined.im.extend(signal.im);
        }
        joined
    }
}

impl FromIterator<Complex> for Signal {
    fn from_iter<I: IntoIterator<Item = Complex>>(values: I) -> Self {
        let (re, im) = values.into_iter().unzip();
        Self { re, im }
    }
}

/// Values times exp 2πi f t, t from zero on.
pub(super) fn turned(mut values: Signal, hz: f64, interval_s: f64) -> Signal {
    let turns = |samples: usize| unit(TAU * hz * interval_s * samples as f64);
    let mut table = [[0.0; BLOCK]; 2];
    for n in 0..BLOCK {
        (table[0][n], table[1][n]) = turns(n);
    }
    Arch::new().dispatch(Turn { values: &mut values, table, step: turns(BLOCK) });
    values
}

struct Turn<'a> {
    values: &'a mut Signal,
    /// Real and imaginary parts.
    table: [[f64; BLOCK]; 2],
    step: Complex,
}

impl WithSimd for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let mut start = (1.0, 0.0);
        for (re, im) in self.values.re.chunks_mut(BLOCK).zip(self.values.im.chunks_mut(BLOCK)) {
            let [table_re, table_im] = &self.table;
            for (((re, im), turn_re), turn_im) in re.iter_mut().zip(im).zip(table_re).zip(table_im) {
                (*re, *im) = times(times(start, (*turn_re, *turn_im)), (*re, *im));
            }
            start = times(start, self.step);
        }
    }
}

/// A Hann-shaped average, taken every few samples.
pub(super) struct LowPass {
    /// Weights, four by four; what the last four lack is zero.
    taps: Vec<[f64; 4]>,
    length: usize,
    step: usize,
}

impl LowPass {
    /// Over `length` samples, taken `overlap` times in its length.
    pub(super) fn new(length: usize, overlap: usize) -> Self {
        let mut taps: Vec<f64> =
            (1..=length).map(|n| (PI * n as f64 / (length + 1) as f64).sin().powi(2)).collect();
        let sum: f64 = taps.iter().sum();
        taps.iter_mut().for_each(|tap| *tap /= sum);
        taps.resize(length.next_multiple_of(4), 0.0);
        Self { taps: taps.as_chunks().0.to_vec(), length, step: (length / overlap).max(1) }
    }

    /// Samples that an average is taken over.
    pub(super) fn length(&self) -> usize {
        self.length
    }

    /// Samples from one average to the next.
    pub(super) fn step(&self) -> usize {
        self.step
    }

    /// Averages of so many samples.
    pub(super) fn count(&self, samples: usize) -> usize {
        (samples + self.step).saturating_sub(self.length) / self.step
    }

    /// Averages of each signal after a shift up by each of `hz`, all of equal length and with samples
    /// `interval_s` apart. Signals are read once for all shifts.
    pub(super) fn shifted(&self, signals: &[&Signal], hz: &[f64], interval_s: f64) -> Vec<Vec<Signal>> {
        let samples = signals.first().map_or(0, |signal| signal.len());
        let turns = |hz: &f64| turned(Signal::constant((1.0, 0.0), samples), *hz, interval_s);
        let turns: Vec<Signal> = hz.iter().map(turns).collect();
        let count = self.count(samples);
        let mut averages = vec![vec![Signal::constant((0.0, 0.0), count); signals.len()]; hz.len()];
        Arch::new().dispatch(Average { filter: self, signals, turns: &turns, averages: &mut averages });
        averages
    }
}

struct Average<'a> {
    filter: &'a LowPass,
    signals: &'a [&'a Signal],
    /// Factors of the values, for each shift.
    turns: &'a [Signal],
    averages: &'a mut [Vec<Signal>],
}

impl WithSimd for Average<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { filter: LowPass { taps, step, .. }, signals, turns, averages } = self;
        let length = TOGETHER * step + 4 * taps.len();
        let mut shifted = Signal::constant((0.0, 0.0), length);
        let samples = signals.first().map_or(0, |signal| signal.len());
        let count = averages.iter().flatten().map(Signal::len).max().unwrap_or(0);
        // Factors of one block, side by side: in their own arrays they lie a whole number of pages apart, and
        // a cache keeps few lines of such places.
        let mut factors = Vec::with_capacity(2 * length * turns.len());
        for first in (0..count).step_by(TOGETHER) {
            let end = count.min(first + TOGETHER);
            let part = first * step..samples.min(first * step + length);
            factors.clear();
            turns
                .iter()
                .flat_map(|turns| turns.part(part.clone()))
                .for_each(|part| factors.extend_from_slice(part));
            for (number, signal) in signals.iter().enumerate() {
                let factors = factors.chunks_exact(2 * part.len());
                for (factors, averages) in factors.zip(&mut *averages) {
                    turn(factors.split_at(part.len()), signal.part(part.clone()), &mut shifted);
                    let Signal { re, im } = &mut averages[number];
                    average(taps, *step, &shifted.re, &mut re[first..end]);
                    average(taps, *step, &shifted.im, &mut im[first..end]);
                }
            }
        }
    }
}

/// Puts turn times value into the first numbers of `shifted`.
#[inline(always)]
fn turn(turns: (&[f64], &[f64]), values: [&[f64]; 2], shifted: &mut Signal) {
    let shifted = shifted.re.iter_mut().zip(&mut shifted.im);
    let turns = turns.0.iter().zip(turns.1);
    let values = values[0].iter().zip(values[1]);
    for (((re, im), turn), value) in shifted.zip(turns).zip(values) {
        (*re, *im) = times((*turn.0, *turn.1), (*value.0, *value.1));
    }
}

/// Weighted sums over the values, one every `step`, each in four partial sums. Those are added up when all
/// are there, so that vectors take four of one average and not one of four.
#[inline(always)]
fn average(taps: &[[f64; 4]], step: usize, values: &[f64], averages: &mut [f64]) {
    let mut parts = [[0.0; 4]; TOGETHER];
    for (parts, window) in
        parts[..averages.len()].iter_mut().zip(values.windows(4 * taps.len()).step_by(step))
    {
        let mut sums = [0.0; 4];
        for (taps, values) in taps.iter().zip(window.as_chunks::<4>().0) {
            for lane in 0..4 {
                sums[lane] += taps[lane] * values[lane];
            }
        }
        *parts = sums;
    }
    for (average, [a, b, c, d]) in averages.iter_mut().zip(parts) {
        *average = (a + b) + (c + d);
    }
}

/// Subtracts from a column its projection on the orthonormal columns of `basis`, which comes in two parts:
/// Gram–Schmidt, twice for rounding.
pub(super) fn orthogonalise(column: &mut Signal, basis: [&[Signal]; 2]) {
    Arch::new().dispatch(Orthogonalise { column, basis });
}

struct Orthogonalise<'a> {
    column: &'a mut Signal,
    basis: [&'a [Signal]; 2],
}

impl WithSimd for Orthogonalise<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for _ in 0..2 {
            for q in self.basis.into_iter().flatten() {
                let share = product(q, self.column);
                let column = self.column.re.iter_mut().zip(&mut self.column.im);
                for ((re, im), q) in column.zip(q.re.iter().zip(&q.im)) {
                    let part = times(share, (*q.0, *q.1));
                    (*re, *im) = (*re - part.0, *im - part.1);
                }
            }
        }
    }
}

/// Σ ā b.
pub(super) fn dot(a: &Signal, b: &Signal) -> Complex {
    Arch::new().dispatch(Dot { a, b })
}

struct Dot<'a> {
    a: &'a Signal,
    b: &'a Signal,
}

impl WithSimd for Dot<'_> {
    type Output = Complex;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Complex {
        product(self.a, self.b)
    }
}

/// e^{iφ}.
pub(super) fn unit(phase: f64) -> Complex {
    let (sin, cos) = phase.sin_cos();
    (cos, sin)
}

/// |z|²
pub(super) fn square(z: Complex) -> f64 {
    z.0 * z.0 + z.1 * z.1
}

#[inline(always)]
pub(super) fn times(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

#[inline(always)]
fn product(a: &Signal, b: &Signal) -> Complex {
    sum_of_products([&a.re, &a.im, &b.re, &b.im])
}

/// Σ ā b in four partial sums, of real and imaginary parts of a and of b.
#[inline(always)]
pub(super) fn sum_of_products(parts: [&[f64]; 4]) -> Complex {
    let numbers = parts.map(|numbers| numbers.as_chunks::<4>());
    let [(a_re, a_re_rest), (a_im, a_im_rest), (b_re, b_re_rest), (b_im, b_im_rest)] = numbers;
    let mut parts = [[0.0; 4]; 2];
    for (((a_re, a_im), b_re), b_im) in a_re.iter().zip(a_im).zip(b_re).zip(b_im) {
        for lane in 0..4 {
            parts[0][lane] += a_re[lane] * b_re[lane] + a_im[lane] * b_im[lane];
            parts[1][lane] += a_re[lane] * b_im[lane] - a_im[lane] * b_re[lane];
        }
    }
    let rest = a_re_rest.iter().zip(a_im_rest).zip(b_re_rest).zip(b_im_rest);
    for (lane, (((a_re, a_im), b_re), b_im)) in rest.enumerate() {
        parts[0][lane] += a_re * b_re + a_im * b_im;
        parts[1][lane] += a_re * b_im - a_im * b_re;
    }
    let [re, im] = parts.map(|[a, b, c, d]| (a + b) + (c + d));
    (re, im)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Several shifts of several signals are what the definition of one is, whatever the filter's length
    /// leaves over of four and the signals' of whole blocks.
    #[test]
    fn invariant_averages_taken_together_are_those_taken_alone() {
        const INTERVAL_S: f64 = 1e-3;
        for (length, samples) in [(32, 700), (33, 555), (35, 35), (6, 101), (4, 3)] {
            let filter = LowPass::new(length, 4);
            let value = |n: usize, k: usize| ((0.3 * n as f64 + k as f64).sin(), (0.07 * n as f64).cos());
            let signals: Vec<Signal> = (0..3).map(|k| (0..samples).map(|n| value(n, k)).collect()).collect();
            let hz = [0.0, 31.0, -7.5];
            let together = filter.shifted(&signals.iter().collect::<Vec<_>>(), &hz, INTERVAL_S);
            let taps: Vec<f64> = filter.taps.as_flattened()[..length].to_vec();
            assert!((taps.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            for (hz, together) in hz.iter().zip(&together) {
                for (k, averages) in together.iter().enumerate() {
                    let starts = (0..).map(|n| n * filter.step).take_while(|start| start + length <= samples);
                    let plain = starts.map(|start| {
                        let terms = taps.iter().enumerate().map(|(n, tap)| {
                            let turn = unit(TAU * hz * INTERVAL_S * (start + n) as f64);
                            let turned = times(turn, value(start + n, k));
                            (tap * turned.0, tap * turned.1)
                        });
                        terms.fold((0.0, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1))
                    });
                    let plain: Vec<Complex> = plain.collect();
                    assert_eq!(averages.len(), plain.len(), "{length} of {samples}");
                    for (a, b) in averages.iter().zip(plain) {
                        // Rounding of some hundred turns and sums.
                        assert!((a.0 - b.0).hypot(a.1 - b.1) < 1e-12, "{length} of {samples}: {a:?} {b:?}");
                    }
                }
            }
        }
    }
}
