//! Response of roller forces to opening and slip of the seat within a step.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use super::{
    SeatState, Springs,
    sums::{add, dot},
};
use crate::{
    roller_force::RollerForce,
    row::{Numbers, Row},
};

/// Contact forces are updated within the step if opening all panels would change them by more than this
/// share. Below it they are extrapolated from the step before, which is stable up to a third.
const RESPONSIVE: f64 = 0.2;

/// Roller forces in a step, and their response to displacement of the seat.
#[derive(Debug, Clone, Default)]
pub(crate) struct RollerResponses {
    pub(super) rollers: Vec<RollerResponse>,
    /// Tensions by a unit force of each, roller by roller.
    pub(super) by: Vec<Row>,
    /// Forces of rollers that do not answer, at the vertices of the raceway, where films make all of them
    /// press [N].
    pub(super) fixed: Vec<(usize, f64)>,
    /// Springs that move, with their displacements: scratch.
    pub(super) moves: Vec<(usize, f64)>,
}

/// Response of one roller.
#[derive(Debug, Clone, Copy)]
pub(super) struct RollerResponse {
    /// Force on the raceway [N].
    pub(super) force: f64,
    /// Expected force, which may be below zero, if the seat under it is displaced by `given` [m].
    expected: f64,
    given: f64,
    /// Decrease of the force as the seat recedes further [N/m]; zero where it is negligible.
    stiffness: f64,
    /// The part of each change that a pass takes.
    part: f64,
}

impl Springs {
    /// Effects of single rollers on the tensions: of a unit force at its place, the force that is expected if
    /// the seat goes on as in the step before, and how much less it presses where the seat gives way by more.
    #[inline(always)]
    pub(super) fn answer<S: Simd>(
        &self,
        simd: S,
        panels: &SeatState,
        rollers: &[RollerForce],
        responses: &mut RollerResponses,
    ) {
        let groups = self.rows();
        responses.rollers.clear();
        responses.fixed.clear();
        responses.by.resize(groups * rollers.len(), Row::default());
        let mut first = 0;
        for roller in rollers.iter().filter(|roller| roller.force != 0.0) {
            let gain = roller.stiffness * self.flexibility[roller.facet as usize];
            let expected = roller.next();
            if self.with_oil && gain <= RESPONSIVE {
                let (facet, of_second) = (roller.facet as usize, roller.share * expected);
                responses.fixed.extend([(facet, expected - of_second), (facet + 1, of_second)]);
                continue;
            }
            let ends = self.ends(roller.facet as usize);
            let (a, b) = (Vector::all(simd, 1.0 - roller.share), Vector::all(simd, roller.share));
            let mut given = Vector::all(simd, 0.0);
            let gaps = panels.open.as_chunks::<LANES>().0;
            let both = ends[0].iter().zip(ends[1]);
            for ((by, gap), (ahead, behind)) in responses.by[first..][..groups].iter_mut().zip(gaps).zip(both)
            {
                for at in vector_starts(simd) {
                    let (ahead, behind) = (ahead.load(simd, at), behind.load(simd, at));
                    let between = ahead.times_plus(a, behind * b);
                    given = Vector::load(simd, gap, at).times_plus(between, given);
                    between.store(by, at);
                }
            }
            first += groups;
            let mut answer =
                RollerResponse { force: expected, expected, given: 0.0, stiffness: 0.0, part: 0.0 };
            if gain > RESPONSIVE {
                // Where panels open a change returns times −gain, where they hold not at all: halfway between
                // the two.
                let part = 1.0 / (1.0 + 0.5 * gain);
                answer = RollerResponse { given: given.sum(), stiffness: roller.stiffness, part, ..answer };
            }
            responses.rollers.push(answer);
        }
    }

    /// Updates the roller forces for the present displacement of the seat.
    #[inline(always)]
    pub(super) fn update_forces<S: Simd>(
        &self,
        simd: S,
        panels: &SeatState,
        tension: &mut [Row],
        responses: &mut RollerResponses,
    ) {
        let RollerResponses { rollers, by, .. } = responses;
        let felt =
            rollers.iter_mut().zip(by.chunks_exact(self.rows())).filter(|(roller, _)| roller.stiffness > 0.0);
        for (roller, by) in felt {
            let further = dot(simd, by, panels.open.as_chunks().0) - roller.given;
            let target = (roller.expected - roller.stiffness * further).max(0.0);
            let force = roller.force + roller.part * (target - roller.force);
            add(simd, tension, by, force - roller.force);
            roller.force = force;
        }
    }
}
