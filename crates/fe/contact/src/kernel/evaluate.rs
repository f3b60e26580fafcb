//! One evaluation of a pass: the active facets, their points first in vectors, then the remaining ones one by
//! one.

use pulp::{Simd, WithSimd};
use stribeck_simd::lanes::{LANES, Number, Vector};
use stribeck_solver::state::Moment;

use super::{
    chord_band::ChordBand,
    law::{LawKernel, Totals},
    patch_row::OtherPatches,
    row::{Outcome, Row},
    single_points::SinglePoints,
};
use crate::{
    memory::{Arrangement, Candidate, Histories, Memory},
    moving_facet::MovingFacet,
    pass_law::{PACE_KEPT, PassLaw},
    points::{FEW_POINTS, Points},
};
use stribeck_surface::{Surface, chord::ChordFacet, facet::Facet, foot::Push, spline_facet::SplineFacet};

/// Arguments of an evaluation, which is compiled for each instruction set.
pub(crate) struct Evaluation<'a> {
    pub(crate) memory: &'a mut Memory,
    pub(crate) points: &'a Points,
    pub(crate) arrangement: Arrangement,
    pub(crate) secondary: &'a Surface,
    pub(crate) primary: &'a Surface,
    /// Deeper penetrations than this are not contacts but other sides of a body [m].
    pub(crate) deepest: f64,
    pub(crate) at: &'a Moment<'a>,
    pub(crate) law: &'a PassLaw,
    pub(crate) push: &'a mut Vec<Push>,
}

/// Its results besides the forces.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    /// Force on the secondary body [N].
    pub(crate) force: [f64; 2],
    /// Elastic energy [J].
    pub(crate) stored: f64,
    /// Heat of friction in the last step [J].
    pub(crate) friction: f64,
    /// Heat of damping in the last step [J].
    pub(crate) damping: f64,
    /// Deepest effective penetration [m]; zero where nothing acts.
    pub(crate) penetration: f64,
    /// About how long it took, in units of some ten nanoseconds.
    pub(crate) work: usize,
}

/// How rows of points on facets of one kind are done in vectors, against facets of the same kind.
trait RowFacet: Facet {
    /// Forces on the other surface may wait in `others`; the moving facet is stored in `own` where it was
    /// computed.
    fn touch_row<V: Simd, const MEMORY: bool>(
        simd: V,
        row: Row<'_>,
        own: &mut Option<MovingFacet<Self>>,
        others: &mut OtherPatches<V>,
        law: &LawKernel<Vector<V>>,
        totals: &mut Totals<Vector<V>>,
        push: &mut Vec<Push>,
    ) -> Outcome;
}

impl RowFacet for ChordFacet {
    #[inline(always)]
    fn touch_row<V: Simd, const MEMORY: bool>(
        simd: V,
        row: Row<'_>,
        _own: &mut Option<MovingFacet<Self>>,
        _others: &mut OtherPatches<V>,
        law: &LawKernel<Vector<V>>,
        totals: &mut Totals<Vector<V>>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        row.touch_chords::<V, MEMORY>(simd, law, totals, push)
    }
}

impl RowFacet for SplineFacet {
    #[inline(always)]
    fn touch_row<V: Simd, const MEMORY: bool>(
        simd: V,
        row: Row<'_>,
        own: &mut Option<MovingFacet<Self>>,
        others: &mut OtherPatches<V>,
        law: &LawKernel<Vector<V>>,
        totals: &mut Totals<Vector<V>>,
        push: &mut Vec<Push>,
    ) -> Outcome {
        let facet = Self::new(row.secondary, row.at.x, row.at.y, row.candidate.facet as usize);
        let own = own.insert(MovingFacet::new(facet, row.secondary, row.at));
        row.touch_patches::<V, MEMORY>(simd, own, others, law, totals, push)
    }
}

impl WithSimd for Evaluation<'_> {
    type Output = Sum;

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) -> Sum {
        // The kinds of curves, and whether points have a history, are decided once a pass; the loop over
        // points is compiled for each case.
        let memory = self.memory.history.is_some();
        match [self.secondary, self.primary].map(|surface| surface.spline().is_some()) {
            [false, false] if memory => self.evaluate::<V, ChordFacet, ChordFacet, true>(simd),
            [false, false] => self.evaluate::<V, ChordFacet, ChordFacet, false>(simd),
            [true, true] if memory => self.evaluate::<V, SplineFacet, SplineFacet, true>(simd),
            [true, true] => self.evaluate::<V, SplineFacet, SplineFacet, false>(simd),
            [false, true] => self.evaluate::<V, ChordFacet, SplineFacet, true>(simd),
            [true, false] => self.evaluate::<V, SplineFacet, ChordFacet, true>(simd),
        }
    }
}

impl Evaluation<'_> {
    /// Evaluates in the widest vectors that this processor has.
    #[cfg(not(test))]
    pub(crate) fn dispatch(self) -> Sum {
        pulp::Arch::new().dispatch(self)
    }

    /// In as many lanes as a test asks for.
    #[cfg(test)]
    pub(crate) fn dispatch(self) -> Sum {
        tests::dispatch(self)
    }

    #[inline(always)]
    fn evaluate<V: Simd, S: RowFacet, P: Facet, const MEMORY: bool>(self, simd: V) -> Sum {
        let Self { memory, points, arrangement, secondary, primary, deepest, at, law: pass_law, push } = self;
        let Memory { nearest, searched, inactive_until, pace, candidates, idle_until, history } = memory;
        let mut no_history = Histories::default();
        let now = at.step.saturating_sub(*searched) as f64;
        *pace *= PACE_KEPT;
        // Chords against chords and splines against splines, with the law itself: many points at a time.
        let flat = secondary.is_flat() && primary.is_flat();
        let splines = secondary.spline().is_some() && primary.spline().is_some();
        let together = pass_law.together && pass_law.softness == 0.0 && (flat || splines);
        let zero = Vector::all(simd, 0.0);
        let law = LawKernel::new(zero, pass_law, pass_law.thickness, at.dt, deepest, now, *pace);
        let (mut totals, mut others) = (Totals::none(zero), OtherPatches::none());
        let (mut work, mut first_active) = (0, u64::MAX);
        let mut facets = Facets {
            single: SinglePoints::<S, P> {
                secondary,
                primary,
                at,
                law: pass_law,
                deepest,
                now,
                pace: *pace,
                points,
                stride: arrangement.stride(),
                own: None,
                found: None,
                other: None,
                totals: Totals::none(0.0),
            },
            searched: *searched,
            force: [0.0; 2],
        };
        if let (true, Arrangement::Bands { .. }) = (together, arrangement) {
            for group in candidates.chunks_mut(Vector::<V>::LEN) {
                let active_from = group.iter().fold(u64::MAX, |first, c| first.min(c.active_from));
                if at.step < active_from {
                    first_active = first_active.min(active_from);
                    continue;
                }
                let outcome = {
                    let history = history.as_mut().unwrap_or(&mut no_history);
                    let band = ChordBand { points, candidates: group, nearest, inactive_until, history };
                    band.touch::<V, MEMORY>(simd, &law, now, primary, at, &mut totals, push)
                };
                work += 15 * points.most;
                let force = &mut facets.force;
                *force = [force[0] + outcome.force[0], force[1] + outcome.force[1]];
                let left_over = outcome.left.iter().fold(0, |all, left| all | left);
                let mut soonest = [0.0; LANES];
                outcome.soonest.store(&mut soonest, 0);
                for (l, candidate) in group.iter_mut().enumerate() {
                    if left_over >> l & 1 == 1 {
                        let left = (0..FEW_POINTS).fold(0, |bits, k| bits | (outcome.left[k] >> l & 1) << k);
                        let touched = outcome.touched >> l & 1 == 1;
                        let outcome = Outcome { touched, left, force: [0.0; 2] };
                        facets.finish(simd, candidate, outcome, nearest, inactive_until, history, push);
                    } else {
                        candidate.active_from = if outcome.touched >> l & 1 == 1 {
                            0
                        } else {
                            facets.searched.saturating_add(soonest[l] as u64)
                        };
                    }
                    first_active = first_active.min(candidate.active_from);
                }
            }
        } else {
            for candidate in candidates.iter_mut() {
                if at.step >= candidate.active_from {
                    let mut outcome = Outcome::default();
                    if together {
                        let history = history.as_mut().unwrap_or(&mut no_history);
                        let row = Row {
                            candidate,
                            points,
                            nearest,
                            inactive_until,
                            history,
                            secondary,
                            primary,
                            at,
                            now,
                        };
                        let own = &mut facets.single.own;
                        outcome =
                            S::touch_row::<V, MEMORY>(simd, row, own, &mut others, &law, &mut totals, push);
                        work += if outcome.touched { 20 } else { 10 };
                    } else {
                        let (first, stride) = (candidate.first as usize, arrangement.stride());
                        let active = (0..candidate.pattern.points as usize)
                            .filter(|k| inactive_until[first + k * stride] < now + 1.0);
                        outcome.left = active.fold(0, |bits, k| bits | 1 << k);
                        work += 4;
                    }
                    work += 5 * outcome.left.count_ones() as usize;
                    facets.finish(simd, candidate, outcome, nearest, inactive_until, history, push);
                }
                first_active = first_active.min(candidate.active_from);
            }
        }
        facets.single.flush(push);
        others.flush(primary, push);
        let single = &facets.single.totals;
        *pace = facets.single.pace.max(totals.pace.largest());
        *idle_until = first_active;
        Sum {
            force: facets.force,
            stored: single.stored + totals.stored.sum(),
            friction: single.friction + totals.friction.sum(),
            damping: single.damping + totals.damping.sum(),
            penetration: single.penetration.max(totals.penetration.largest()),
            work,
        }
    }
}

/// Results of facets once vectors of their points are done.
struct Facets<'a, S: Facet, P: Facet> {
    single: SinglePoints<'a, S, P>,
    /// See [`Memory`].
    searched: u64,
    /// Sum of the forces on the secondary surface [N].
    force: [f64; 2],
}

impl<S: Facet, P: Facet> Facets<'_, S, P> {
    /// Finishes a facet: evaluates the remaining points, adds forces to nodes and finds when it is active
    /// again.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // the state of a pass, field by field
    fn finish<V: Simd>(
        &mut self,
        simd: V,
        candidate: &mut Candidate,
        mut outcome: Outcome,
        nearest: &mut [u32],
        inactive_until: &mut [f64],
        history: &mut Option<Histories>,
        push: &mut Vec<Push>,
    ) {
        if outcome.left != 0 {
            self.single.touch(candidate, &mut outcome, nearest, inactive_until, history, push);
        }
        let force = &mut self.force;
        if let Some(own) = self.single.own.take() {
            own.flush(self.single.secondary, push);
            *force = [force[0] + own.force[0], force[1] + own.force[1]];
        }
        *force = [force[0] + outcome.force[0], force[1] + outcome.force[1]];
        candidate.active_from = 0;
        if outcome.touched {
            return;
        }
        let (first, points) = (candidate.first as usize, candidate.pattern.points as usize);
        let stride = self.single.stride;
        let mut soonest = f64::INFINITY;
        let mut done = 0;
        if stride == 1 {
            let mut of_lanes = Vector::all(simd, soonest);
            while done + Vector::<V>::LEN <= points {
                of_lanes = of_lanes.min(Vector::load(simd, inactive_until, first + done));
                done += Vector::<V>::LEN;
            }
            soonest = of_lanes.smallest();
        }
        for k in done..points {
            soonest = soonest.min(inactive_until[first + k * stride]);
        }
        candidate.active_from = self.searched.saturating_add(soonest as u64);
    }
}

#[cfg(test)]
mod tests;
