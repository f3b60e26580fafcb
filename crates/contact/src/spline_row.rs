//! Many points of one facet of a spline against facets of another spline at a time.
//!
//! The points of a facet mostly have their feet on one or two facets of the other surface, already known from the step
//! before. Every lane takes the coefficients of its own; two of Newton's corrections from the foot on the chord find the
//! foot on the curve. Lanes that this does not bring to rest, or brings beyond the facet's ends, are left for the loop
//! over single points.

use pulp::Simd;
use stribeck_solver::{
    lanes::{LANES, Number, Vector},
    state::Moment,
};

use crate::{
    pass::Weights,
    patch_row::{Curve, Lanes, pick, slide, totals},
    row::{Against, MOST_POINTS, Row, mark},
    shape::{Push, Shape, Side},
    spline::Patch,
    surface::Surface,
    touch::Sum,
    touch_row::{Law, Touching, Work},
};

/// One or two facets of the primary surface that points have their feet on, kept from one facet of points to the next:
/// what acts on them is handed to the nodes when others come.
pub(crate) struct Feet<V: Simd> {
    facets: [Option<Met<V>>; 2],
    law: Law<V>,
    work: Work<V>,
}

/// A facet of the primary surface and the forces on it, lane by lane.
#[derive(Clone, Copy)]
struct Met<V: Simd> {
    side: Side<Patch>,
    forces: Curve<V>,
}

impl<V: Simd> Feet<V> {
    #[inline(always)]
    pub(crate) fn new(simd: V, w: &Weights, dt: f64) -> Self {
        Self { facets: [None; 2], law: Law::new(simd, w, dt), work: Work::none(simd) }
    }

    /// Makes facet `wanted` one of the two, in the place of one that is not `kept`; returns its place.
    #[inline(always)]
    fn take(
        &mut self,
        simd: V,
        wanted: usize,
        kept: usize,
        primary: &Surface,
        at: &Moment<'_>,
        push: &mut Vec<Push>,
    ) -> usize {
        let facet = |met: &Option<Met<V>>| met.as_ref().map(|met| met.side.shape.facet());
        if let Some(place) = self.facets.iter().position(|met| facet(met) == Some(wanted)) {
            return place;
        }
        let place = usize::from(facet(&self.facets[0]) == Some(kept));
        if let Some(met) = &mut self.facets[place] {
            met.flush(primary, push);
        }
        let side = Side::new(Patch::new(primary, at.x, at.y, wanted), primary, at);
        self.facets[place] = Some(Met { side, forces: [[Vector::all(simd, 0.0); 2]; 4] });
        place
    }

    /// Hands all forces over to the nodes, and the sums to the pass.
    #[inline(always)]
    pub(crate) fn flush(&mut self, primary: &Surface, sum: &mut Sum, push: &mut Vec<Push>) {
        if self.facets.iter().any(Option::is_some) {
            self.work.add_to(sum);
        }
        for met in self.facets.iter_mut().flatten() {
            met.flush(primary, push);
        }
    }
}

impl<V: Simd> Met<V> {
    #[inline(always)]
    fn flush(&mut self, primary: &Surface, push: &mut Vec<Push>) {
        self.side.push_all(&totals(&self.forces));
        self.side.flush(primary, push);
    }
}

impl Row<'_> {
    /// Evaluates the points whose feet lie within the facet known for the first of them and the next one that differs;
    /// marks those that touch as done and lets the others doze. Returns whether one touches.
    #[inline(always)]
    pub(crate) fn touch_splines<V: Simd>(
        &mut self,
        simd: V,
        own: &mut Side<Patch>,
        feet: &mut Feet<V>,
        done: &mut [bool; MOST_POINTS],
        push: &mut Vec<Push>,
    ) -> bool {
        let Against { primary, at, w, deepest } = self.against;
        let waits =
            |i: &usize| self.doze[*i] <= self.now && !primary.beside_corner[self.nearest[*i] as usize];
        let mut facets = self.range.clone().filter(waits).map(|i| self.nearest[i] as usize);
        let Some(a) = facets.next() else { return false };
        let b = facets.find(|&facet| facet != a).unwrap_or(a);
        let places = [feet.take(simd, a, b, primary, at, push), feet.take(simd, b, a, primary, at, push)];
        let [Some(near), Some(far)] = places.map(|place| feet.facets[place].as_ref()) else { return false };
        let (near, far) = (Lanes::of(simd, &near.side), Lanes::of(simd, &far.side));
        let line = Lanes::of(simd, own);
        let zero = Vector::all(simd, 0.0);
        let (reach, deepest) = (Vector::all(simd, w.reach()), Vector::all(simd, deepest));
        let closing = w.fastest * at.dt;
        let mut forces = [[zero; 2]; 4];
        let mut touched = false;
        for start in (0..self.range.len()).step_by(Vector::<V>::LEN) {
            let n = (self.range.len() - start).min(Vector::<V>::LEN);
            let i = self.range.start + start;
            let [waiting, first] = self.lanes(simd, i, n, [a, b]);
            let to = Lanes::chosen(first, &near, &far);
            let place = Vector::load(simd, &self.points.place, i);
            let spots = line.spots(place, Vector::load(simd, &self.points.height, i));
            let foot = to.foot(spots.at);
            let held = foot.held(waiting);
            let on = foot.gap.choose_below(reach, held, zero);
            let on = (-foot.gap).choose_below(deepest, on, zero);
            self.let_doze(held - on, foot.gap - reach, closing, i, n);
            if !mark(on, n, &mut done[start..]) {
                continue;
            }
            touched = true;
            let [opening, along] = slide(&line, &spots, &to, &foot);
            let weight = Vector::load(simd, &self.points.weight, i);
            let points = Touching { first: i, on, gap: foot.gap, weight, opening, along };
            let acts = feet.law.act(&points, self.history, &mut feet.work);
            let f = foot.force(acts, on);
            spots.push(f, &mut forces);
            let there = foot.push(f, acts, on);
            for (place, lanes) in [(places[0], first), (places[1], first.constant(1.0) - first)] {
                let Some(met) = &mut feet.facets[place] else { continue };
                for (sum, part) in met.forces.iter_mut().zip(&there) {
                    let part = pick(lanes, *part, [zero; 2]);
                    *sum = [sum[0] + part[0], sum[1] + part[1]];
                }
            }
        }
        if touched {
            own.push_all(&totals(&forces));
        }
        touched
    }

    /// One where one of `n` points from `i` on may touch one of two facets, and where that is the first of them.
    #[inline(always)]
    fn lanes<V: Simd>(&self, simd: V, i: usize, n: usize, [a, b]: [usize; 2]) -> [Vector<V>; 2] {
        let (mut waiting, mut first) = ([0.0; LANES], [0.0; LANES]);
        for l in 0..n {
            let facet = self.nearest[i + l] as usize;
            first[l] = f64::from(u8::from(facet == a));
            waiting[l] = f64::from(u8::from(self.doze[i + l] <= self.now && (facet == a || facet == b)));
        }
        [Vector::load(simd, &waiting, 0), Vector::load(simd, &first, 0)]
    }

    /// Points that are apart need not be looked at before they may have come near; those that remember something settle
    /// it one by one.
    #[inline(always)]
    fn let_doze<V: Simd>(&mut self, apart: Vector<V>, gap: Vector<V>, closing: f64, i: usize, n: usize) {
        let (mut flags, mut gaps) = ([0.0; LANES], [0.0; LANES]);
        apart.store(&mut flags, 0);
        gap.store(&mut gaps, 0);
        for l in 0..n {
            if flags[l] != 0.0 && gaps[l] >= 0.0 && self.history.get(i + l).is_none_or(|h| h.is_empty()) {
                self.doze[i + l] = self.now.saturating_add((gaps[l] / closing) as u16);
            }
        }
    }
}
