//! Rows of points on one facet of a spline: whole vectors of them against facets of another spline.
//!
//! The points of a facet mostly have their feet on one or two facets of the other surface, already known from
//! the step before. Every lane takes the coefficients of its own; a correction of third order from the foot
//! on the chord finds the foot on the curve, a second one where that is not enough. Lanes whose foot is not
//! found by then, or lies beyond the facet's ends, are left for [`single_points`](super::single_points).

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector};
use stribeck_solver::state::Moment;

use super::{
    law::{LawKernel, PointState, Totals},
    row::{Outcome, Row},
};
use crate::moving_facet::MovingFacet;
use stribeck_surface::{
    Surface,
    facet::Facet,
    foot::Push,
    patch::{FOUND, Patch, choose_all, spread, within_patch},
    plane::{choose, choose_each, force_of},
    polynomial::{Coefficients, Polynomial},
    spline_facet::SplineFacet,
};

/// Corrections of a foot at most; on meshes that resolve their curves one is enough.
const CORRECTIONS: usize = 3;

/// A facet in motion, each lane its own.
struct MovingPatch<V: Simd> {
    patch: Patch<Vector<V>>,
    motion: Polynomial<Vector<V>, 4>,
}

impl<V: Simd> MovingPatch<V> {
    /// The same facet in all lanes.
    #[inline(always)]
    fn spread(simd: V, facet: &MovingFacet<SplineFacet>) -> Self {
        let zero = Vector::all(simd, 0.0);
        Self { patch: facet.facet.patch.spread(zero), motion: spread(&facet.motion, zero) }
    }

    /// `yes` where the flag is one, `no` where it is zero.
    #[inline(always)]
    fn chosen(flag: Vector<V>, yes: &Self, no: &Self) -> Self {
        Self {
            patch: Patch::chosen(flag, &yes.patch, &no.patch),
            motion: choose_all(flag, &yes.motion, &no.motion),
        }
    }
}

/// One or two facets of the primary surface that points have their feet on, kept from one facet of points to
/// the next: their forces are added to the nodes when others follow.
pub(crate) struct OtherPatches<V: Simd> {
    facets: [Option<LoadedPatch<V>>; 2],
}

/// A facet of the primary surface and the forces on it, lane by lane.
#[derive(Clone, Copy)]
struct LoadedPatch<V: Simd> {
    facet: MovingFacet<SplineFacet>,
    forces: Polynomial<Vector<V>, 4>,
}

impl<V: Simd> OtherPatches<V> {
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self { facets: [None; 2] }
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
        let facet =
            |loaded: &Option<LoadedPatch<V>>| loaded.as_ref().map(|loaded| loaded.facet.facet.number());
        if let Some(place) = self.facets.iter().position(|loaded| facet(loaded) == Some(wanted)) {
            return place;
        }
        let place = usize::from(facet(&self.facets[0]) == Some(kept));
        if let Some(loaded) = &mut self.facets[place] {
            loaded.flush(primary, push);
        }
        let facet = MovingFacet::new(SplineFacet::new(primary, at.x, at.y, wanted), primary, at);
        self.facets[place] = Some(LoadedPatch { facet, forces: Polynomial::zero(Vector::all(simd, 0.0)) });
        place
    }

    /// Hands all forces over to the nodes.
    #[inline(always)]
    pub(crate) fn flush(&mut self, primary: &Surface, push: &mut Vec<Push>) {
        for loaded in self.facets.iter_mut().flatten() {
            loaded.flush(primary, push);
        }
    }
}

impl<V: Simd> LoadedPatch<V> {
    #[inline(always)]
    fn flush(&mut self, primary: &Surface, push: &mut Vec<Push>) {
        self.facet.push_all(&sums(&self.forces));
        self.facet.flush(primary, push);
    }
}

/// Sums over the lanes.
#[inline(always)]
fn sums<V: Simd>(Polynomial(forces): &Polynomial<Vector<V>, 4>) -> Polynomial<f64, 4> {
    let mut sums = [[0.0; 2]; 4];
    for k in 0..4 {
        sums[k] = [forces[k][0].sum(), forces[k][1].sum()];
    }
    Polynomial(sums)
}

impl Row<'_> {
    /// Splines against splines: evaluates the points whose feet lie within the facets known for the first and
    /// the last of them; those that cannot touch become inactive for some time.
    #[inline(always)]
    pub(crate) fn touch_patches<V: Simd, const MEMORY: bool>(
        self,
        simd: V,
        own: &mut MovingFacet<SplineFacet>,
        others: &mut OtherPatches<V>,
        law: &LawKernel<Vector<V>>,
        totals: &mut Totals<Vector<V>>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        let (active, left) = self.active(simd);
        let mut outcome = Outcome { left, ..Outcome::default() };
        let Some([a, b]) = self.two_facets(left) else { return outcome };
        let Self { candidate, points, nearest, inactive_until, history, primary, at, .. } = self;
        let (range, pattern) = (candidate.range(), candidate.pattern.first as usize);
        let places = [others.take(simd, a, b, primary, at, push), others.take(simd, b, a, primary, at, push)];
        let [Some(near), Some(far)] = places.map(|place| others.facets[place].as_ref()) else {
            return outcome;
        };
        let (near, far) = (MovingPatch::spread(simd, &near.facet), MovingPatch::spread(simd, &far.facet));
        let line = MovingPatch::spread(simd, own);
        let zero = Vector::all(simd, 0.0);
        let mut forces = Polynomial::zero(zero);
        for start in (0..range.len()).step_by(Vector::<V>::LEN) {
            let i = range.start + start;
            let (mut is_near, mut is_far) = (0, 0);
            for (l, &facet) in nearest[i..range.end].iter().take(Vector::<V>::LEN).enumerate() {
                is_near |= u64::from(facet as usize == a) << l;
                is_far |= u64::from(facet as usize == b) << l;
            }
            let first = Vector::ones(simd, is_near);
            let to = MovingPatch::chosen(first, &near, &far);
            let known = Vector::load(simd, &active, start) * Vector::ones(simd, is_near | is_far);
            let of_pattern = pattern + start;
            let place = Vector::load(simd, &points.place, of_pattern);
            let point = line.patch.point(place, Vector::load(simd, &points.height, of_pattern));
            let (foot, rest) = to.patch.foot(point.at, known, CORRECTIONS);
            let found = rest.choose_below(rest.constant(FOUND), known, zero);
            let state = PointState {
                within: within_patch(foot.place, found),
                gap: foot.gap,
                weight: Vector::load(simd, &points.weight, of_pattern),
                sliding: foot.sliding(point.velocity(&line.motion), &to.motion),
                slip: if MEMORY { Vector::load(simd, &history.slip, i) } else { zero },
                damping: if MEMORY { Vector::load(simd, &history.damping, i) } else { zero },
            };
            let acts = law.act::<MEMORY>(&state, totals);
            let (on, apart) = (acts.on.bits() << start, acts.apart.bits() << start);
            outcome.left &= !(on | apart);
            if apart != 0 {
                let until = Vector::load(simd, inactive_until, i);
                choose(acts.apart, acts.inactive_until, until).store(inactive_until, i);
            }
            if on == 0 {
                continue;
            }
            outcome.touched = true;
            if MEMORY {
                acts.slip.store(&mut history.slip, i);
                acts.damping.store(&mut history.damping, i);
            }
            let f = choose_each(acts.on, force_of(foot.normal, acts.pressure, acts.shear), [zero; 2]);
            point.push(f, &mut forces);
            let mut there = Polynomial::zero(zero);
            foot.push(f, choose(acts.on, foot.lever(acts.pressure, acts.shear), zero), &mut there);
            for (place, lanes) in [(places[0], first), (places[1], first.constant(1.0) - first)] {
                let Some(loaded) = &mut others.facets[place] else { continue };
                loaded.forces.add_all(&choose_all(lanes, &there, &Polynomial::zero(zero)));
            }
        }
        if outcome.touched {
            own.push_all(&sums(&forces));
        }
        outcome
    }

    /// The facets on which the first and the last of the points were found last; none near a corner.
    #[inline(always)]
    fn two_facets(&self, mut left: u64) -> Option<[usize; 2]> {
        let first_point = self.candidate.first as usize;
        let mut first = None;
        while left != 0 {
            let k = if first.is_none() { left.trailing_zeros() } else { left.ilog2() };
            let facet = self.nearest[first_point + k as usize] as usize;
            if !self.primary.beside_corner()[facet] {
                match first {
                    None => {
                        first = Some(facet);
                        continue;
                    }
                    Some(one) => return Some([one, facet]),
                }
            }
            left &= !(1 << k);
        }
        None
    }
}
