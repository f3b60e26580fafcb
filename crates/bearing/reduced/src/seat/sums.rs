//! Sums of multiples of rows, in vectors.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::row::{Numbers, Row};

/// Adds a multiple of some rows to others.
#[inline(always)]
pub(super) fn add<S: Simd>(simd: S, to: &mut [Row], rows: &[Row], times: f64) {
    let times = Vector::all(simd, times);
    for (row, to) in rows.iter().zip(to) {
        for at in vector_starts(simd) {
            let had = Vector::load(simd, to, at);
            Vector::load(simd, row, at).times_plus(times, had).store(to, at);
        }
    }
}

/// Adds multiples of columns of `rows` to sums, four rows at a time, which stay in registers meanwhile.
#[inline(always)]
pub(super) fn add_all<S: Simd, R: AsMut<[f64]>, N: Numbers>(
    simd: S,
    sums: &mut [R],
    rows: &[N],
    times: impl Iterator<Item = (usize, f64)> + Clone,
) {
    let count = sums.len();
    let (fours, rest) = sums.as_chunks_mut::<4>();
    let mut first = 0;
    for [a, b, c, d] in fours {
        let [a, b, c, d] = [a.as_mut(), b.as_mut(), c.as_mut(), d.as_mut()];
        for at in vector_starts(simd) {
            let (mut in_a, mut in_b) = (Vector::load(simd, a, at), Vector::load(simd, b, at));
            let (mut in_c, mut in_d) = (Vector::load(simd, c, at), Vector::load(simd, d, at));
            for (column, times) in times.clone() {
                let [of_a, of_b, of_c, of_d] = &rows[count * column + first..].as_chunks::<4>().0[0];
                let times = Vector::all(simd, times);
                in_a = of_a.load(simd, at).times_plus(times, in_a);
                in_b = of_b.load(simd, at).times_plus(times, in_b);
                in_c = of_c.load(simd, at).times_plus(times, in_c);
                in_d = of_d.load(simd, at).times_plus(times, in_d);
            }
            in_a.store(a, at);
            in_b.store(b, at);
            in_c.store(c, at);
            in_d.store(d, at);
        }
        first += 4;
    }
    for sum in rest {
        let sum = sum.as_mut();
        for at in vector_starts(simd) {
            let mut in_sum = Vector::load(simd, sum, at);
            for (column, times) in times.clone() {
                let row = &rows[count * column + first];
                in_sum = row.load(simd, at).times_plus(Vector::all(simd, times), in_sum);
            }
            in_sum.store(sum, at);
        }
        first += 1;
    }
}

/// Lists springs, a bit for each, with how far each of them moves, so that they can be iterated over several
/// times.
#[inline(always)]
pub(super) fn listed(
    list: &mut Vec<(usize, f64)>,
    moved: u128,
    by: impl Fn(usize) -> f64,
) -> impl Iterator<Item = (usize, f64)> + Clone {
    list.clear();
    for (half, first) in [(moved as u64, 0), ((moved >> u64::BITS) as u64, u64::BITS)] {
        let mut rest = half;
        while rest != 0 {
            let spring = (first + rest.trailing_zeros()) as usize;
            list.push((spring, by(spring)));
            rest &= rest - 1;
        }
    }
    list.iter().copied()
}

/// Sum of the products of some rows with others.
#[inline(always)]
pub(super) fn dot<S: Simd, N: Numbers>(simd: S, rows: &[N], others: &[[f64; LANES]]) -> f64 {
    let mut sum = Vector::all(simd, 0.0);
    for (row, other) in rows.iter().zip(others) {
        for at in vector_starts(simd) {
            sum = row.load(simd, at).times_plus(Vector::load(simd, other, at), sum);
        }
    }
    sum.sum()
}
