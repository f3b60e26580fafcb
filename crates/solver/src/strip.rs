//! The kernel over a strip: element forces, and the row of nodes that the strip completes moves at once.

use std::ops::Range;

use crate::{
    advance::{Forces, Row, Step, advance},
    element::{QuadMetric, QuadReference, Stiffness, quad_forces},
    lanes::{LANES, Lanes, lanes, lanes_mut},
    tile::{Strip, StripReferences, VaryingReferences},
};

/// Elements of a strip between two passes over its nodes: the corner forces stay in the first-level cache.
pub(crate) const BLOCK: usize = 128;

/// Forces of a block's elements on their corners: (x, y) of left and right corners of the row that the strip completes
/// and of the other row. Right corners are stored one place later, where the next node's left corner is.
pub(crate) type Corners = [[[[f64; BLOCK + 2 * LANES]; 2]; 2]; 2];

/// Fields of a tile, and the forces summed so far.
pub(crate) struct Nodes<'a> {
    pub(crate) x: &'a mut [f64],
    pub(crate) y: &'a mut [f64],
    pub(crate) vx: &'a mut [f64],
    pub(crate) vy: &'a mut [f64],
    pub(crate) fx: &'a mut [f64],
    pub(crate) fy: &'a mut [f64],
    pub(crate) step_over_mass: &'a [f64],
    pub(crate) mass: &'a [f64],
}

impl Nodes<'_> {
    /// The rows from `at` on.
    #[inline(always)]
    pub(crate) fn split(&mut self, at: usize, n: usize) -> (Row<'_>, [&mut [f64]; 2]) {
        let mass = if self.mass.is_empty() { self.mass } else { &self.mass[at..at + n] };
        let row = Row {
            x: &mut self.x[at..at + n],
            y: &mut self.y[at..at + n],
            vx: &mut self.vx[at..at + n],
            vy: &mut self.vy[at..at + n],
            step_over_mass: &self.step_over_mass[at..at + n],
            mass,
        };
        (row, [&mut self.fx[at..at + n], &mut self.fy[at..at + n]])
    }
}

/// Adds the forces of one strip; moves the row that it completes, if it does. Returns the heat of damping [J].
#[inline(always)]
pub(crate) fn strip(
    strip: &Strip,
    varying: &VaryingReferences,
    stiffness: &Stiffness,
    nodes: &mut Nodes<'_>,
    corners: &mut Corners,
    step: &Step<'_>,
) -> f64 {
    // Row 0 is the one that may be completed: corners 1 and 2, or 4 and 3.
    let [row, other] = if strip.completes_upper { [3, 0] } else { [0, 3] };
    let [row, other] = [row, other].map(|c| strip.corners[c] as usize);
    let mut heat = 0.0;
    let mut done = 0;
    for side in corners.iter_mut() {
        side[1][0][0] = 0.0;
        side[1][1][0] = 0.0;
    }
    while done < strip.len {
        let n = (strip.len - done).min(BLOCK);
        let at = strip.corners.map(|c| c as usize + done);
        match strip.references {
            StripReferences::Uniform(q) => {
                block(Same(q), stiffness, nodes, at, n, strip.completes_upper, corners);
            }
            StripReferences::Varying(start) => {
                let each = Each { references: varying, start: start + done };
                block(each, stiffness, nodes, at, n, strip.completes_upper, corners);
            }
        }
        // The node after the last element gets its left corner from the next block.
        let last = done + n == strip.len;
        for side in corners.iter_mut() {
            side[0][0][n] = 0.0;
            side[0][1][n] = 0.0;
        }
        let count = if last { n + 1 } else { n };
        let [own, others] = &*corners;
        {
            let (_, [fx, fy]) = nodes.split(other + done, count);
            add(fx, &others[0][0], &others[1][0]);
            add(fy, &others[0][1], &others[1][1]);
        }
        let (moving, [fx, fy]) = nodes.split(row + done, count);
        if strip.completes {
            heat += advance(moving, Completed { fx, fy, corners: own }, step);
        } else {
            add(fx, &own[0][0], &own[1][0]);
            add(fy, &own[0][1], &own[1][1]);
        }
        for side in corners.iter_mut() {
            side[1][0][0] = side[1][0][n];
            side[1][1][0] = side[1][1][n];
        }
        done += n;
    }
    heat
}

/// Forces on the row that a block completes: what was summed before, and both corners.
struct Completed<'a> {
    fx: &'a mut [f64],
    fy: &'a mut [f64],
    corners: &'a [[[f64; BLOCK + 2 * LANES]; 2]; 2],
}

impl Forces for Completed<'_> {
    #[inline(always)]
    fn take(&mut self, at: usize) -> (Lanes, Lanes) {
        let [[lx, ly], [rx, ry]] = self.corners;
        let (mut fx, mut fy) =
            (std::mem::take(lanes_mut(self.fx, at)), std::mem::take(lanes_mut(self.fy, at)));
        let (lx, ly, rx, ry) = (lanes(lx, at), lanes(ly, at), lanes(rx, at), lanes(ry, at));
        for k in 0..LANES {
            fx[k] += lx[k] + rx[k];
            fy[k] += ly[k] + ry[k];
        }
        (fx, fy)
    }

    #[inline(always)]
    fn take_one(&mut self, at: usize) -> (f64, f64) {
        let [[lx, ly], [rx, ry]] = self.corners;
        let (fx, fy) = (std::mem::take(&mut self.fx[at]), std::mem::take(&mut self.fy[at]));
        (fx + (lx[at] + rx[at]), fy + (ly[at] + ry[at]))
    }
}

/// Adds left and right corner forces to a row of nodes.
#[inline(always)]
fn add(f: &mut [f64], left: &[f64], right: &[f64]) {
    let n = f.len();
    let (groups, rest) = f.as_chunks_mut::<LANES>();
    let (l, r) = (chunks(left, 0, groups.len()), chunks(right, 0, groups.len()));
    for g in 0..groups.len() {
        for k in 0..LANES {
            groups[g][k] += l[g][k] + r[g][k];
        }
    }
    let done = n - rest.len();
    for (k, f) in rest.iter_mut().enumerate() {
        *f += left[done + k] + right[done + k];
    }
}

/// Corner forces of up to [`BLOCK`] neighbouring elements.
///
/// The last group of lanes may reach beyond the strip: what it computes there falls on places that nobody reads.
#[inline(always)]
fn block<R: References>(
    references: R,
    stiffness: &Stiffness,
    nodes: &Nodes<'_>,
    at: [usize; 4],
    n: usize,
    upper: bool,
    corners: &mut Corners,
) {
    let groups = n.div_ceil(LANES);
    let far = at[0].max(at[1]).max(at[2]).max(at[3]);
    let fit = far + groups * LANES <= nodes.x.len();
    let inside = if fit { groups } else { n / LANES };
    each_group(references, stiffness, nodes.x, nodes.y, at, 0..inside, upper, corners);
    if inside < groups {
        // At the end of the tile the last group is filled up with zeros.
        let mut x = [0.0; 4 * LANES];
        let mut y = [0.0; 4 * LANES];
        let rest = n - inside * LANES;
        for (corner, from) in at.into_iter().enumerate() {
            let (from, to) = (from + inside * LANES, corner * LANES);
            x[to..to + rest].copy_from_slice(&nodes.x[from..from + rest]);
            y[to..to + rest].copy_from_slice(&nodes.y[from..from + rest]);
        }
        let at = [0, LANES, 2 * LANES, 3 * LANES];
        each_group(references.beyond(inside), stiffness, &x, &y, at, inside..groups, upper, corners);
    }
}

/// Corner forces of whole groups of elements, whose first corners are at `at`.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // the arrays of one kernel
fn each_group<R: References>(
    references: R,
    stiffness: &Stiffness,
    x: &[f64],
    y: &[f64],
    at: [usize; 4],
    groups: Range<usize>,
    upper: bool,
    corners: &mut Corners,
) {
    let [first, second] = corners;
    let (low, high) = if upper { (second, first) } else { (first, second) };
    let [[f1x, f1y], [f2x, f2y]] = low;
    let [[f4x, f4y], [f3x, f3y]] = high;
    let (from, n) = (groups.start, groups.len());
    let (x1, y1) = (chunks(x, at[0], n), chunks(y, at[0], n));
    let (x2, y2) = (chunks(x, at[1], n), chunks(y, at[1], n));
    let (x3, y3) = (chunks(x, at[2], n), chunks(y, at[2], n));
    let (x4, y4) = (chunks(x, at[3], n), chunks(y, at[3], n));
    let left = from * LANES;
    let (f1x, f1y) = (chunks_mut(f1x, left, n), chunks_mut(f1y, left, n));
    let (f4x, f4y) = (chunks_mut(f4x, left, n), chunks_mut(f4y, left, n));
    let (f2x, f2y) = (chunks_mut(f2x, left + 1, n), chunks_mut(f2y, left + 1, n));
    let (f3x, f3y) = (chunks_mut(f3x, left + 1, n), chunks_mut(f3y, left + 1, n));
    let references = references.chunks(n);
    for g in 0..n {
        let ([mut r1x, mut r2x, mut r3x, mut r4x], [mut r1y, mut r2y, mut r3y, mut r4y]) =
            ([[0.0; LANES]; 4], [[0.0; LANES]; 4]);
        for l in 0..LANES {
            let px = [x1[g][l], x2[g][l], x3[g][l], x4[g][l]];
            let py = [y1[g][l], y2[g][l], y3[g][l], y4[g][l]];
            let [f1, f2, f3, f4] = R::forces(&references, g, l, px, py, stiffness);
            [r1x[l], r2x[l], r3x[l], r4x[l]] = [f1[0], f2[0], f3[0], f4[0]];
            [r1y[l], r2y[l], r3y[l], r4y[l]] = [f1[1], f2[1], f3[1], f4[1]];
        }
        (f1x[g], f1y[g], f2x[g], f2y[g]) = (r1x, r1y, r2x, r2y);
        (f3x[g], f3y[g], f4x[g], f4y[g]) = (r3x, r3y, r4x, r4y);
    }
}

#[inline(always)]
fn chunks(v: &[f64], at: usize, n: usize) -> &[Lanes] {
    &v[at..at + n * LANES].as_chunks().0[..n]
}

#[inline(always)]
fn chunks_mut(v: &mut [f64], at: usize, n: usize) -> &mut [Lanes] {
    &mut v[at..at + n * LANES].as_chunks_mut().0[..n]
}

/// Where a strip's kernel finds the references of a group of elements.
trait References: Copy {
    type Chunks;
    /// The groups behind the first `inside` ones.
    fn beyond(&self, inside: usize) -> Self;
    /// The first `n` groups.
    fn chunks(&self, n: usize) -> Self::Chunks;
    /// Corner forces [N] of the element in a lane of a group, at positions `x`, `y` [m].
    fn forces(
        chunks: &Self::Chunks,
        group: usize,
        lane: usize,
        x: [f64; 4],
        y: [f64; 4],
        k: &Stiffness,
    ) -> [[f64; 2]; 4];
}

#[derive(Clone, Copy)]
struct Same(QuadMetric);

impl References for Same {
    type Chunks = QuadMetric;

    #[inline(always)]
    fn beyond(&self, _: usize) -> Self {
        *self
    }

    #[inline(always)]
    fn chunks(&self, _: usize) -> QuadMetric {
        self.0
    }

    #[inline(always)]
    fn forces(
        metric: &QuadMetric,
        _: usize,
        _: usize,
        x: [f64; 4],
        y: [f64; 4],
        _: &Stiffness,
    ) -> [[f64; 2]; 4] {
        metric.forces(x, y)
    }
}

/// References from `start` on; the arrays are padded to whole groups at their end (see [`VaryingReferences::pad`]).
#[derive(Clone, Copy)]
struct Each<'a> {
    references: &'a VaryingReferences,
    start: usize,
}

impl<'a> References for Each<'a> {
    type Chunks = [&'a [Lanes]; 7];

    #[inline(always)]
    fn beyond(&self, inside: usize) -> Self {
        Self { start: self.start + inside * LANES, ..*self }
    }

    #[inline(always)]
    fn chunks(&self, n: usize) -> [&'a [Lanes]; 7] {
        let (v, at) = (self.references, self.start);
        [
            chunks(&v.b1x, at, n),
            chunks(&v.b1y, at, n),
            chunks(&v.b2x, at, n),
            chunks(&v.b2y, at, n),
            chunks(&v.s1, at, n),
            chunks(&v.s2, at, n),
            chunks(&v.volume, at, n),
        ]
    }

    #[inline(always)]
    fn forces(
        [b1x, b1y, b2x, b2y, s1, s2, volume]: &[&'a [Lanes]; 7],
        g: usize,
        l: usize,
        x: [f64; 4],
        y: [f64; 4],
        k: &Stiffness,
    ) -> [[f64; 2]; 4] {
        let (b1, b2) = ([b1x[g][l], b1y[g][l]], [b2x[g][l], b2y[g][l]]);
        let q = QuadReference { b1, b2, s1: s1[g][l], s2: s2[g][l], volume: volume[g][l] };
        quad_forces(x, y, &q, k)
    }
}
