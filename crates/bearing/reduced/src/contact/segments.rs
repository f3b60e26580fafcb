//! Parts of one penetration, kept from step to step and evaluated side by side (THEORY §9.3).
//!
//! A part lies between two places where neither roller nor raceway has a vertex. Which facets meet in it
//! changes when vertices pass each other or the middle of the contact, every fifty steps or so; in between
//! only the positions of their vertices are updated, all in vectors.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, fused, vector_starts};

use crate::{
    contact::outline::{Facet, View},
    contact::penetration::{Penetration, Sides, add_between},
    row::Row,
};

/// Most parts of an overlap that are kept.
const MOST: usize = 2 * LANES;

/// Parts of a roller and a raceway with growing u, all of whose facets are plain. Part k from the middle of
/// the contact is in lane k modulo eight, so that sums over all of them are the same wherever the list
/// begins.
#[derive(Debug, Clone, Default)]
#[repr(align(64))]
pub(crate) struct Segments {
    /// x and y of both ends of the roller's facet, then of the raceway's, in the frames of their bodies.
    /// Where there is no part the first one stands again …
    columns: [[f64; MOST]; 8],
    /// … and not one.
    present: [f64; MOST],
    /// Groups of eight; none before the first look.
    groups: usize,
    /// Where the part in the middle of the contact is.
    middle: usize,
}

/// Projection of roller and raceway: d in the frame of each, and the roller's centre in that of the raceway
/// [m].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pose {
    pub(crate) own: [f64; 2],
    pub(crate) d: [f64; 2],
    pub(crate) from: [f64; 2],
}

impl Segments {
    /// The overlap of a roller that is pressed back by `shift` [m], into `found` by parts, in its first
    /// lanes. False where the parts are no longer in this order, the middle has gone on to other facets, or
    /// `reach` [m] goes beyond them.
    #[inline(always)]
    pub(crate) fn penetration<S: Simd>(
        &self,
        simd: S,
        sides: Sides,
        pose: &Pose,
        shift: f64,
        reach: f64,
        found: &mut Penetration<Row>,
    ) -> bool {
        let all = |value: f64| Vector::all(simd, value);
        let zero = all(0.0);
        let (shift, near, far) = (all(shift), all(-reach), all(reach));
        let (own, d) = ([all(pose.own[0]), all(pose.own[1])], [all(pose.d[0]), all(pose.d[1])]);
        let [cx, cy] = [all(pose.from[0]), all(pose.from[1])];
        let mut sum = Penetration::none(zero);
        // All parts may lie on one side of the place searched for.
        let every = (1 << Vector::<S>::LEN) - 1;
        let (mut before, mut behind, mut middle, mut wrong) = (every, every, 0, 0);
        for at in vector_starts(simd) {
            for group in 0..self.groups {
                let at = LANES * group + at;
                let column = |n: usize| Vector::load(simd, &self.columns[n], at);
                let [x0, y0, x1, y1] = [column(0), column(1), column(2), column(3)];
                let [a0, b0, a1, b1] = [column(4), column(5), column(6), column(7)];
                let [roller, raceway] =
                    seen([own, d], [[x0, y0], [a0 - cx, b0 - cy]], [[x1, y1], [a1 - cx, b1 - cy]]);
                let ends = [roller.from.max(raceway.from), roller.to.min(raceway.to)];
                let [u1, u2] = ends;
                wrong |= u2.bits_below(u1);
                before &= near.bits_below(u1);
                behind &= u2.bits_below(far);
                middle |= (zero.bits_below(u2) & !zero.bits_below(u1)) << at;
                let present = Vector::load(simd, &self.present, at);
                add_between(&mut sum, ends, roller, raceway, sides, shift, present);
            }
        }
        sum.store(found, 0);
        wrong == 0 && before != every && behind != every && (middle >> self.middle) & 1 == 1
    }

    /// Rebuilds the list of parts, up to `reach` [m] to either side. None are left where a wall is among
    /// them or there are too many.
    #[inline(always)]
    pub(crate) fn list(&mut self, [roller, raceway]: &[View<'_>; 2], along: bool, reach: f64) {
        self.groups = 0;
        let (mut r, mut w) = (Edge::of(roller, true), Edge::of(raceway, along));
        let mut middle = 0;
        for edge in [&mut r, &mut w] {
            while edge.from > -reach && edge.is_plain() && middle < MOST {
                edge.step(false);
                middle += 1;
            }
        }
        let first = (LANES - middle % LANES) % LANES;
        let place = |part: usize| part / LANES * LANES + (first + part) % LANES;
        let mut parts = 0;
        let mut reached = false;
        self.present = [0.0; MOST];
        // Further parts cost nothing up to a whole vector, and make the list valid for longer.
        while parts < MOST && !(reached && parts % LANES == 0) && r.is_plain() && w.is_plain() {
            let vertices = [r.ends(), w.ends()];
            let columns = vertices.as_flattened().as_flattened();
            for (column, &number) in self.columns.iter_mut().zip(columns) {
                if parts % LANES == 0 {
                    column[parts..parts + LANES].fill(number);
                }
                column[place(parts)] = number;
            }
            self.present[place(parts)] = 1.0;
            parts += 1;
            reached |= r.to.min(w.to) >= reach;
            if r.to <= w.to { r.step(true) } else { w.step(true) }
        }
        if reached {
            self.groups = parts.div_ceil(LANES);
            self.middle = place(middle);
        }
    }
}

/// A facet between its ends: where they are seen, the height of the first, and by how much the last is
/// higher.
struct Projected<N> {
    from: N,
    to: N,
    height: N,
    rise: N,
}

impl<N: Number> Projected<N> {
    #[inline(always)]
    fn of(d: [N; 2], [x0, y0]: [N; 2], [x1, y1]: [N; 2]) -> Self {
        let minus = -d[1];
        let (from, to) = (minus.times_plus(x0, d[0] * y0), minus.times_plus(x1, d[0] * y1));
        let (height, last) = (d[0].times_plus(x0, d[1] * y0), d[0].times_plus(x1, d[1] * y1));
        Self { from, to, height, rise: last - height }
    }

    #[inline(always)]
    fn with(self, slope: N) -> Facet<N> {
        Facet { from: self.from, to: self.to, slope, base: (-slope).times_plus(self.from, self.height) }
    }
}

/// Facets of two bodies as they are seen along d, the first and last ends of which are given from where they
/// are seen.
#[inline(always)]
fn seen<N: Number>(d: [[N; 2]; 2], first: [[N; 2]; 2], last: [[N; 2]; 2]) -> [Facet<N>; 2] {
    let [r, w] = [Projected::of(d[0], first[0], last[0]), Projected::of(d[1], first[1], last[1])];
    // One division for both, because dividing takes longer than all the rest.
    let (of_roller, of_raceway) = (r.to - r.from, w.to - w.from);
    let per = r.to.constant(1.0) / (of_roller * of_raceway);
    let (r_slope, w_slope) = (r.rise * of_raceway * per, w.rise * of_roller * per);
    [r.with(r_slope), w.with(w_slope)]
}

/// A facet while parts are listed, and where it is seen from and to.
struct Edge<'a> {
    view: &'a View<'a>,
    along: bool,
    facet: usize,
    from: f64,
    to: f64,
}

impl<'a> Edge<'a> {
    /// The facet in the middle.
    #[inline(always)]
    fn of(view: &'a View<'a>, along: bool) -> Self {
        let mut edge = Self { view, along, facet: view.facet, from: 0.0, to: 0.0 };
        edge.look();
        edge
    }

    /// Its ends in the frame of its body [m], with growing u.
    #[inline(always)]
    fn ends(&self) -> [[f64; 2]; 2] {
        let outline = self.view.outline;
        let both =
            [self.facet, outline.next(self.facet)].map(|vertex| [outline.x[vertex], outline.y[vertex]]);
        let [a, b] = both;
        if self.along { [a, b] } else { [b, a] }
    }

    /// Sees it by the very numbers that [`Projected`] has.
    #[inline(always)]
    fn look(&mut self) {
        let View { d, from, .. } = *self.view;
        let across = |[x, y]: [f64; 2]| fused(-d[1], x - from[0], d[0] * (y - from[1]));
        [self.from, self.to] = self.ends().map(across);
    }

    #[inline(always)]
    fn step(&mut self, forward: bool) {
        let outline = self.view.outline;
        self.facet =
            if forward == self.along { outline.next(self.facet) } else { outline.before(self.facet) };
        self.look();
    }

    #[inline(always)]
    fn is_plain(&self) -> bool {
        self.view.outline.is_plain(self.facet)
    }
}
