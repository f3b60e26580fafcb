//! Points one by one: near ends and corners, on arcs, between chords and splines, in the static preload,
//! wherever vectors of points leave them.

use stribeck_solver::state::Moment;

use super::{
    law::{LawKernel, PointState, Totals},
    row::Outcome,
};
use crate::{
    memory::{Candidate, Histories, NEVER},
    moving_facet::MovingFacet,
    pass_law::PassLaw,
    points::Points,
};
use stribeck_surface::{
    Surface,
    facet::Facet,
    foot::{Push, Sliding},
    narrow_phase::find_foot,
    plane::force_of,
};

/// Points of facets of one kind against facets of another, one by one.
pub(crate) struct SinglePoints<'a, S: Facet, P: Facet> {
    pub(crate) secondary: &'a Surface,
    pub(crate) primary: &'a Surface,
    pub(crate) at: &'a Moment<'a>,
    pub(crate) law: &'a PassLaw,
    /// See [`Evaluation`](super::evaluate::Evaluation).
    pub(crate) deepest: f64,
    /// Steps since the search.
    pub(crate) now: f64,
    /// Fastest that a point of the pass opened or closed of late [m/s].
    pub(crate) pace: f64,
    pub(crate) points: &'a Points,
    /// Distance of a facet's points in memory.
    pub(crate) stride: usize,
    /// The secondary facet at hand in motion, where it was needed.
    pub(crate) own: Option<MovingFacet<S>>,
    /// Facet of the primary surface where the last point was found.
    pub(crate) found: Option<P>,
    /// Consecutive points mostly share a primary facet: its forces wait until another one comes.
    pub(crate) other: Option<MovingFacet<P>>,
    pub(crate) totals: Totals<f64>,
}

impl<S: Facet, P: Facet> SinglePoints<'_, S, P> {
    /// Evaluates the remaining points of a facet.
    #[inline(never)]
    pub(crate) fn touch(
        &mut self,
        candidate: &Candidate,
        outcome: &mut Outcome,
        nearest: &mut [u32],
        inactive_until: &mut [f64],
        history: &mut Option<Histories>,
        push: &mut Vec<Push>,
    ) {
        let Self { secondary, primary, at, law, points, .. } = *self;
        // Weights are areas here, so the law has no thickness.
        let mut kernel = LawKernel::new(0.0, law, 1.0, at.dt, self.deepest, self.now, self.pace);
        let facet =
            || MovingFacet::new(S::new(secondary, at.x, at.y, candidate.facet as usize), secondary, at);
        let own = self.own.get_or_insert_with(facet);
        let mut left = outcome.left;
        while left != 0 {
            let k = left.trailing_zeros();
            let (i, of_pattern) =
                (candidate.first as usize + k as usize * self.stride, (candidate.pattern.first + k) as usize);
            left &= left - 1;
            let point = own.facet.point(points.place[of_pattern], points.height[of_pattern]);
            let area = points.weight[of_pattern] * law.thickness;
            let start = nearest[i] as usize;
            let facet = match &mut self.found {
                Some(facet) if facet.number() == start => facet,
                facet => facet.insert(P::new(primary, at.x, at.y, start)),
            };
            let foot = find_foot(facet, primary, at.x, at.y, point.at);
            let facet = *facet;
            nearest[i] = facet.number() as u32;
            let [slip, damping] = history.as_ref().map_or([0.0; 2], |h| [h.slip[i], h.damping[i]]);
            let mut state = PointState {
                within: 1.0,
                gap: foot.map_or(f64::INFINITY, |foot| foot.gap),
                weight: area,
                sliding: Sliding { opening: 0.0, along: 0.0 },
                slip,
                damping,
            };
            let Some(foot) = foot.filter(|foot| kernel.touches(foot.gap, 1.0) > 0.0) else {
                // Points off both ends of an open surface have no foot; they are looked at after the next
                // search.
                inactive_until[i] = NEVER;
                if let Some(foot) = foot {
                    state.sliding = MovingFacet::new(facet, primary, at).sliding(own.velocity(&point), &foot);
                    kernel.pace = kernel.pace.max(state.sliding.opening.abs());
                    let distance = kernel.distance(foot.gap);
                    inactive_until[i] = kernel.inactive_until(distance, state.sliding);
                }
                if let Some(history) = history.as_mut().filter(|_| slip != 0.0 || damping != 0.0) {
                    outcome.touched = true;
                    kernel.release(&state, &mut self.totals);
                    (history.slip[i], history.damping[i]) = (0.0, 0.0);
                }
                continue;
            };
            outcome.touched = true;
            let other = match &mut self.other {
                Some(moving) if moving.facet.number() == facet.number() => moving,
                last => {
                    if let Some(moving) = last {
                        moving.flush(primary, push);
                    }
                    last.insert(MovingFacet::new(facet, primary, at))
                }
            };
            let [pressure, shear] = if law.softness > 0.0 {
                [law.law.stiffness * area * law.rounded(foot.gap)[0], 0.0]
            } else {
                state.sliding = other.sliding(own.velocity(&point), &foot);
                kernel.pace = kernel.pace.max(state.sliding.opening.abs());
                let acts = match history {
                    Some(history) => {
                        let acts = kernel.act::<true>(&state, &mut self.totals);
                        (history.slip[i], history.damping[i]) = (acts.slip, acts.damping);
                        acts
                    }
                    None => kernel.act::<false>(&state, &mut self.totals),
                };
                [acts.pressure, acts.shear]
            };
            let f = force_of(foot.normal, pressure, shear);
            own.push_point(&point, f);
            other.push_foot(&foot, f, pressure, shear);
        }
        self.pace = kernel.pace;
    }

    /// Hands over forces that wait.
    pub(crate) fn flush(&self, push: &mut Vec<Push>) {
        if let Some(moving) = &self.other {
            moving.flush(self.primary, push);
        }
    }
}
