//! Many points of one facet of a spline against facets of another spline at a time.
//!
//! The points of a facet mostly have their feet on one or two facets of the other surface, already known from the step
//! before. Every lane takes the coefficients of its own; a correction of third order from the foot on the chord finds the
//! foot on the curve, a second one where that is not enough. Lanes that this does not bring to rest, or brings beyond the
//! facet's ends, are left for the loop over single points.

use pulp::Simd;
use stribeck_simd::lanes::{Number, Vector};
use stribeck_solver::state::Moment;

use crate::{
    patch_row::{Curve, Lanes, pick, slide, totals},
    row::{Outcome, Row},
    shape::{Push, Shape, Side},
    spline::Patch,
    surface::Surface,
    touch_row::{Law, Touching, Work},
};

/// One or two facets of the primary surface that points have their feet on, kept from one facet of points to the next:
/// what acts on them is handed to the nodes when others come.
pub(crate) struct Feet<V: Simd> {
    facets: [Option<Met<V>>; 2],
}

/// A facet of the primary surface and the forces on it, lane by lane.
#[derive(Clone, Copy)]
struct Met<V: Simd> {
    side: Side<Patch>,
    forces: Curve<V>,
}

impl<V: Simd> Feet<V> {
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

    /// Hands all forces over to the nodes.
    #[inline(always)]
    pub(crate) fn flush(&mut self, primary: &Surface, push: &mut Vec<Push>) {
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
    /// Splines against splines: evaluates the points whose feet lie within the facets known for the first and the last of
    /// them, lets those doze that certainly do not touch.
    #[inline(always)]
    pub(crate) fn touch_splines<V: Simd, const MEMORY: bool>(
        self,
        simd: V,
        own: &mut Side<Patch>,
        feet: &mut Feet<V>,
        law: &Law<V>,
        work: &mut Work<V>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        let (open, left) = self.open(simd);
        let mut outcome = Outcome { left, ..Outcome::default() };
        let Some([a, b]) = self.two_facets(left) else { return outcome };
        let Self { candidate, points, nearest, doze, history, primary, at, .. } = self;
        let (range, pattern) = (candidate.range(), candidate.pattern.first as usize);
        let places = [feet.take(simd, a, b, primary, at, push), feet.take(simd, b, a, primary, at, push)];
        let [Some(near), Some(far)] = places.map(|place| feet.facets[place].as_ref()) else { return outcome };
        let (near, far) = (Lanes::of(simd, &near.side), Lanes::of(simd, &far.side));
        let line = Lanes::of(simd, own);
        let zero = Vector::all(simd, 0.0);
        let mut forces = [[zero; 2]; 4];
        for start in (0..range.len()).step_by(Vector::<V>::LEN) {
            let i = range.start + start;
            let (mut is_near, mut is_far) = (0, 0);
            for (l, &facet) in nearest[i..range.end].iter().take(Vector::<V>::LEN).enumerate() {
                is_near |= u64::from(facet as usize == a) << l;
                is_far |= u64::from(facet as usize == b) << l;
            }
            let first = Vector::ones(simd, is_near);
            let to = Lanes::chosen(first, &near, &far);
            let known = Vector::load(simd, &open, start) * Vector::ones(simd, is_near | is_far);
            let of_pattern = pattern + start;
            let place = Vector::load(simd, &points.place, of_pattern);
            let spots = line.spots(place, Vector::load(simd, &points.height, of_pattern));
            let foot = to.foot(spots.at, known);
            let [opening, along] = slide(&line, &spots, &to, &foot);
            let touching = Touching {
                within: foot.held(known),
                gap: foot.gap,
                weight: Vector::load(simd, &points.weight, of_pattern),
                opening,
                along,
                slip: if MEMORY { Vector::load(simd, &history.slip, i) } else { zero },
                damping: if MEMORY { Vector::load(simd, &history.damping, i) } else { zero },
            };
            let acts = law.act::<MEMORY>(&touching, work);
            let (on, apart) = (acts.on.bits() << start, acts.apart.bits() << start);
            outcome.left &= !(on | apart);
            if apart != 0 {
                let dozes = Vector::load(simd, doze, i);
                zero.choose_below(acts.apart, acts.doze, dozes).store(doze, i);
            }
            if on == 0 {
                continue;
            }
            outcome.touched = true;
            if MEMORY {
                acts.slip.store(&mut history.slip, i);
                acts.damping.store(&mut history.damping, i);
            }
            let pair = [acts.pressure, acts.shear];
            let f = foot.force(pair, acts.on);
            spots.push(f, &mut forces);
            let there = foot.push(f, pair, acts.on);
            for (place, lanes) in [(places[0], first), (places[1], first.constant(1.0) - first)] {
                let Some(met) = &mut feet.facets[place] else { continue };
                for (sum, part) in met.forces.iter_mut().zip(&there) {
                    let part = pick(lanes, *part, [zero; 2]);
                    *sum = [sum[0] + part[0], sum[1] + part[1]];
                }
            }
        }
        if outcome.touched {
            own.push_all(&totals(&forces));
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
            if !self.primary.beside_corner[facet] {
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
