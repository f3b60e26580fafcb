//! The kernels for elements outside strips: a few at a time wherever their nodes lie, or the same element of
//! congruent bodies at a time.

use pulp::{Simd, WithSimd};

use crate::{
    element::{Stiffness, any_triangle_forces, triangle_forces},
    kernel::{
        batch::{BATCH, Corners, corner_vectors, scatter},
        tile::{CongruentRun, Tile},
    },
};
use stribeck_simd::lanes::{LANES, Vector};

/// Adds the forces [N] of a tile's elements outside strips. A call of its own: it is compiled once for an
/// instruction set, and not again for each kind of damping.
pub(crate) struct Gathered<'a> {
    pub(crate) tile: &'a Tile,
    pub(crate) x: &'a [f64],
    pub(crate) y: &'a [f64],
    pub(crate) fx: &'a mut [f64],
    pub(crate) fy: &'a mut [f64],
}

impl WithSimd for Gathered<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { tile, x, y, fx, fy } = self;
        let k = &tile.stiffness.of(Vector::all(simd, 0.0));
        if tile.congruent {
            congruent_elements(simd, tile, k, x, y, fx, fy);
        } else {
            single_elements(simd, tile, k, x, y, fx, fy);
        }
    }
}

/// The gather path: quadrilaterals in groups, triangles one by one.
#[inline(always)]
fn single_elements<S: Simd>(
    simd: S,
    tile: &Tile,
    k: &Stiffness<Vector<S>>,
    x: &[f64],
    y: &[f64],
    fx: &mut [f64],
    fy: &mut [f64],
) {
    let (mut xs, mut ys): (Corners, Corners) = ([[0.0; BATCH]; 4], [[0.0; BATCH]; 4]);
    for (batch, elements) in tile.quads.chunks(BATCH).enumerate() {
        for (l, corners) in elements.iter().enumerate() {
            for c in 0..4 {
                xs[c][l] = x[corners[c] as usize];
                ys[c][l] = y[corners[c] as usize];
            }
        }
        for at in (0..elements.len()).step_by(Vector::<S>::LEN) {
            let references = tile.varying.group(simd, tile.first_gathered, batch * BATCH + at);
            let forces = references.forces(corner_vectors(simd, &xs, at), corner_vectors(simd, &ys, at), k);
            for c in 0..4 {
                forces[c][0].store(&mut xs[c], at);
                forces[c][1].store(&mut ys[c], at);
            }
        }
        scatter(elements.iter(), [&xs, &ys], fx, fy);
    }
    for (corners, reference) in &tile.triangles {
        let c = corners.map(|c| c as usize);
        let [f1, f2] = triangle_forces(c.map(|c| x[c]), c.map(|c| y[c]), reference, &tile.stiffness);
        fx[c[0]] += f1[0];
        fy[c[0]] += f1[1];
        fx[c[1]] += f2[0];
        fy[c[1]] += f2[1];
        fx[c[2]] -= f1[0] + f2[0];
        fy[c[2]] -= f1[1] + f2[1];
    }
}

#[inline(always)]
fn add<S: Simd>(simd: S, v: &mut [f64], at: usize, f: Vector<S>) {
    (Vector::load(simd, v, at) + f).store(v, at);
}

/// Forces of a tile of congruent bodies, the same element of some bodies at a time.
#[inline(always)]
fn congruent_elements<S: Simd>(
    simd: S,
    tile: &Tile,
    k: &Stiffness<Vector<S>>,
    x: &[f64],
    y: &[f64],
    fx: &mut [f64],
    fy: &mut [f64],
) {
    for lane in (0..LANES).step_by(Vector::<S>::LEN) {
        for run in &tile.runs {
            congruent_quads(simd, tile, run, lane, x, y, fx, fy);
        }
        for (corners, reference) in &tile.triangles {
            let c = corners.map(|c| c as usize + lane);
            let xs = [Vector::load(simd, x, c[0]), Vector::load(simd, x, c[1]), Vector::load(simd, x, c[2])];
            let ys = [Vector::load(simd, y, c[0]), Vector::load(simd, y, c[1]), Vector::load(simd, y, c[2])];
            let [f1, f2] = any_triangle_forces(xs, ys, reference, k);
            for (v, i) in [(&mut *fx, 0), (&mut *fy, 1)] {
                add(simd, v, c[0], f1[i]);
                add(simd, v, c[1], f2[i]);
                add(simd, v, c[2], -(f1[i] + f2[i]));
            }
        }
    }
}

/// A run of quadrilaterals each of which has its left side in common with the one before: what both do to
/// those two nodes stays in registers.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // the arrays of one kernel
fn congruent_quads<S: Simd>(
    simd: S,
    tile: &Tile,
    run: &CongruentRun,
    lane: usize,
    x: &[f64],
    y: &[f64],
    fx: &mut [f64],
    fy: &mut [f64],
) {
    let zero = [Vector::all(simd, 0.0); 2];
    let [mut low, mut high] = run.left;
    let (mut a, mut d) = (node(simd, x, y, low as usize + lane), node(simd, x, y, high as usize + lane));
    let (mut on_low, mut minus_high) = (zero, zero);
    for ([next_low, next_high], metric) in &tile.quads_of_runs[run.quads.clone()] {
        let (b, c) =
            (node(simd, x, y, *next_low as usize + lane), node(simd, x, y, *next_high as usize + lane));
        let [f1, f2, minus_f3, f4] =
            metric.of(a[0]).forces([a[0], b[0], c[0], d[0]], [a[1], b[1], c[1], d[1]]);
        let (l, h) = (low as usize + lane, high as usize + lane);
        add(simd, fx, l, on_low[0] + f1[0]);
        add(simd, fy, l, on_low[1] + f1[1]);
        add(simd, fx, h, f4[0] - minus_high[0]);
        add(simd, fy, h, f4[1] - minus_high[1]);
        (on_low, minus_high) = (f2, minus_f3);
        (low, high) = (*next_low, *next_high);
        (a, d) = (b, c);
    }
    let (l, h) = (low as usize + lane, high as usize + lane);
    add(simd, fx, l, on_low[0]);
    add(simd, fy, l, on_low[1]);
    add(simd, fx, h, -minus_high[0]);
    add(simd, fy, h, -minus_high[1]);
}

#[inline(always)]
fn node<S: Simd>(simd: S, x: &[f64], y: &[f64], at: usize) -> [Vector<S>; 2] {
    [Vector::load(simd, x, at), Vector::load(simd, y, at)]
}
