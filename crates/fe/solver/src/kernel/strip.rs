//! The kernel over a strip: element forces, sums at nodes, and the motion of the row that the strip
//! completes, in one pass; neighbours are computed side by side in vectors (PERFORMANCE.md).

use std::ops::Range;

use pulp::{Simd, WithSimd};

use crate::{
    element::{CornerForces, Stiffness},
    kernel::{
        advance::{Damping, Nodes, Step, Undamped, advance},
        quad_forms::QuadMetric,
        tile::{Strip, Tile},
        varying_references::VaryingReferences,
    },
};
use stribeck_simd::lanes::{LANES, Vector};

/// Adds the forces of one strip that completes its lower row, and moves that row.
#[inline(always)]
pub(crate) fn moving_strip<S: Simd, D: Damping>(
    simd: S,
    strip: &Strip,
    varying: &VaryingReferences,
    stiffness: &Stiffness<Vector<S>>,
    nodes: &mut Nodes<'_>,
    step: &Step<S>,
    heat: &mut Vector<S>,
) {
    run::<S, D, true>(simd, strip, varying, stiffness, nodes, step, heat);
}

/// Adds the forces of one strip [N] and moves nothing. A call of its own: it is compiled once for an
/// instruction set, and not again for each kind of damping.
pub(crate) struct StripForces<'a, 'b> {
    pub(crate) strip: &'a Strip,
    pub(crate) tile: &'a Tile,
    pub(crate) nodes: &'a mut Nodes<'b>,
    /// Whether the data read next is prefetched.
    pub(crate) fetch: bool,
}

impl WithSimd for StripForces<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { strip, tile, nodes, fetch } = self;
        let k = &tile.stiffness.of(Vector::all(simd, 0.0));
        let heat = &mut Vector::all(simd, 0.0);
        let step = &Step::still(simd, fetch);
        run::<S, Undamped, false>(simd, strip, &tile.varying, k, nodes, step, heat);
    }
}

/// Forces of a group of elements on their right corners: (x, y) of the lower row and minus that of the upper
/// one.
type Right<S> = [[Vector<S>; 2]; 2];

/// Elements before those that are alike, those, and elements after them.
#[inline(always)]
fn run<S: Simd, D: Damping, const COMPLETES: bool>(
    simd: S,
    strip: &Strip,
    varying: &VaryingReferences,
    stiffness: &Stiffness<Vector<S>>,
    nodes: &mut Nodes<'_>,
    step: &Step<S>,
    heat: &mut Vector<S>,
) {
    let nodes = &mut nodes.alike::<D>();
    let len = Vector::<S>::LEN;
    let [low, _, _, high] = strip.corners.map(|c| c as usize);
    // Checked once, so that the compiler drops the check in every group.
    let elements = strip.len as u32 as usize;
    let last = elements - elements % len;
    assert!(low.max(high) + last + len < nodes.x.len(), "the last group of a strip lies within its tile");
    let same = strip.metric.of(Vector::all(simd, 0.0));
    let before = Each { references: varying, start: strip.varying, skipped: 0 };
    let after = Each { skipped: strip.alike.len(), ..before };
    let Range { start, end } = strip.alike.start..strip.alike.end.min(last);
    let rows = [low, high];
    let right = [[Vector::all(simd, 0.0); 2]; 2];
    let right =
        groups::<S, D, _, COMPLETES>(simd, &before, 0..start, rows, right, stiffness, nodes, step, heat);
    let right =
        groups::<S, D, _, COMPLETES>(simd, &same, start..end, rows, right, stiffness, nodes, step, heat);
    let right =
        groups::<S, D, _, COMPLETES>(simd, &after, end..last, rows, right, stiffness, nodes, step, heat);
    // The remaining elements, and the node at the right end.
    let rest = elements - last;
    let [f1, f2, f3, f4] = if strip.alike.end == elements {
        same.at(simd, nodes, rows, last, stiffness)
    } else {
        after.at(simd, nodes, rows, last, stiffness)
    };
    let forces = [first(f1, rest), first(f2, rest), first(f3, rest), first(f4, rest)];
    let at = [low + last, high + last];
    group::<S, D, COMPLETES, true>(simd, forces, nodes, at, rest + 1, right, step, heat);
}

/// Whole groups of elements; returns the forces of the last one on its right corners.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // the arrays of one kernel
fn groups<S: Simd, D: Damping, R: References<S>, const COMPLETES: bool>(
    simd: S,
    references: &R,
    elements: Range<usize>,
    [low, high]: [usize; 2],
    mut right: Right<S>,
    stiffness: &Stiffness<Vector<S>>,
    nodes: &mut Nodes<'_>,
    step: &Step<S>,
    heat: &mut Vector<S>,
) -> Right<S> {
    let len = Vector::<S>::LEN;
    // `elements.step_by(len)` would hide the end from the compiler, which then looks for overflows in
    // every group.
    let mut e = elements.start;
    while e < elements.end {
        // Once for a line of cache.
        if step.fetch && e & (LANES - len) == 0 {
            nodes.fetch(low + e, high + e, COMPLETES);
            references.fetch(e);
        }
        let forces = references.at(simd, nodes, [low, high], e, stiffness);
        right =
            group::<S, D, COMPLETES, false>(simd, forces, nodes, [low + e, high + e], len, right, step, heat);
        e += len;
    }
    right
}

/// Brings corner forces of a group of neighbouring elements to the nodes at their left corners; `right` are
/// those of the group before on its right corners. With `LAST`, only the first `n` nodes count.
#[inline(always)]
#[allow(clippy::too_many_arguments)] // the arrays of one kernel
fn group<S: Simd, D: Damping, const COMPLETES: bool, const LAST: bool>(
    simd: S,
    [f1, f2, minus_f3, f4]: CornerForces<Vector<S>>,
    nodes: &mut Nodes<'_>,
    [low, high]: [usize; 2],
    n: usize,
    [right_low, minus_high]: Right<S>,
    step: &Step<S>,
    heat: &mut Vector<S>,
) -> Right<S> {
    let [right_x, right_y] = to_right(minus_f3, minus_high);
    let [fx4, fy4] = [f4[0] - right_x, f4[1] - right_y];
    (Vector::load(simd, nodes.fx, high) + fx4).store(nodes.fx, high);
    (Vector::load(simd, nodes.fy, high) + fy4).store(nodes.fy, high);
    let [right_x, right_y] = to_right(f2, right_low);
    let fx = Vector::load(simd, nodes.fx, low) + (f1[0] + right_x);
    let fy = Vector::load(simd, nodes.fy, low) + (f1[1] + right_y);
    if COMPLETES {
        advance::<S, D, LAST>(simd, nodes, low, 0, n, [fx, fy], [1.0, 1.0], step, heat);
    } else {
        fx.store(nodes.fx, low);
        fy.store(nodes.fy, low);
    }
    [f2, minus_f3]
}

/// Forces [N] on right corners, at the nodes to the right: those of the neighbours on the left.
#[inline(always)]
fn to_right<S: Simd>(right: [Vector<S>; 2], before: [Vector<S>; 2]) -> [Vector<S>; 2] {
    [right[0].shifted_in(before[0]), right[1].shifted_in(before[1])]
}

#[inline(always)]
fn first<S: Simd>(f: [Vector<S>; 2], n: usize) -> [Vector<S>; 2] {
    [f[0].first(n), f[1].first(n)]
}

/// Where a strip's kernel finds the references of a group of elements.
trait References<S: Simd> {
    /// Forces [N] on the corners of the group that begins with element `e` of the strip, whose lower and
    /// upper rows of nodes begin at `row`.
    fn at(
        &self,
        simd: S,
        nodes: &Nodes<'_>,
        row: [usize; 2],
        e: usize,
        k: &Stiffness<Vector<S>>,
    ) -> CornerForces<Vector<S>>;

    /// Fetches those of elements further on than `e`.
    fn fetch(&self, e: usize);
}

/// Values at the corners of a group of neighbours.
#[inline(always)]
fn corners<S: Simd>(simd: S, v: &[f64], [low, high]: [usize; 2], e: usize) -> [Vector<S>; 4] {
    [
        Vector::load(simd, v, low + e),
        Vector::load(simd, v, low + e + 1),
        Vector::load(simd, v, high + e + 1),
        Vector::load(simd, v, high + e),
    ]
}

impl<S: Simd> References<S> for QuadMetric<Vector<S>> {
    #[inline(always)]
    fn at(
        &self,
        simd: S,
        nodes: &Nodes<'_>,
        row: [usize; 2],
        e: usize,
        _: &Stiffness<Vector<S>>,
    ) -> CornerForces<Vector<S>> {
        QuadMetric::forces(self, corners(simd, nodes.x, row, e), corners(simd, nodes.y, row, e))
    }

    #[inline(always)]
    fn fetch(&self, _: usize) {}
}

/// References from group `start` on, of elements of which the first `skipped` have none there.
struct Each<'a> {
    references: &'a VaryingReferences,
    start: usize,
    skipped: usize,
}

impl<S: Simd> References<S> for Each<'_> {
    #[inline(always)]
    fn at(
        &self,
        simd: S,
        nodes: &Nodes<'_>,
        row: [usize; 2],
        e: usize,
        k: &Stiffness<Vector<S>>,
    ) -> CornerForces<Vector<S>> {
        let references = self.references.group(simd, self.start, e - self.skipped);
        references.forces(corners(simd, nodes.x, row, e), corners(simd, nodes.y, row, e), k)
    }

    #[inline(always)]
    fn fetch(&self, e: usize) {
        self.references.fetch(self.start, e - self.skipped);
    }
}
