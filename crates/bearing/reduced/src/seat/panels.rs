//! Panels of the seat in a step: which of them open, close and slip, with the resulting tensions and modal
//! forces.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use super::{
    Passes, SeatState, Springs,
    responses::RollerResponses,
    sums::{add_all, listed},
};
use crate::row::Row;

/// Masks of every other panel of a row, beginning with the first and with the second. The number of panels is
/// odd, so that the masks of a mirrored seat are mirrored.
const EVERY_OTHER: [Row; 2] =
    [Row([1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0]), Row([0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0])];

impl Springs {
    /// Begins a step: opening and slip are extrapolated from the last one, which leaves few sweeps. Returns
    /// the springs that have moved by that, a bit for each.
    #[inline(always)]
    pub(super) fn extrapolate<S: Simd>(&self, simd: S, panels: &mut SeatState) -> u128 {
        let zero = Vector::all(simd, 0.0);
        let mut moved = 0;
        for at in (0..2 * self.padded).step_by(Vector::<S>::LEN) {
            let (now, before) =
                (Vector::load(simd, &panels.open, at), Vector::load(simd, &panels.before, at));
            let mut next = now + (now - before);
            if let Some(closed) = self.closed.get(at / LANES) {
                next = next.max(Vector::load(simd, closed, at % LANES));
            }
            let by = next - now;
            now.store(&mut panels.before, at);
            next.store(&mut panels.open, at);
            moved |= u128::from(zero.bits_below(by.max(-by))) << at;
        }
        moved
    }

    /// Tensions at the coordinates `q` of the modes under the rollers' forces, less those released before
    /// this step and by the springs that have `moved` since, a bit for each; across the seat beyond the
    /// preload.
    #[inline(always)]
    pub(super) fn tensions<S: Simd>(
        &self,
        simd: S,
        panels: &SeatState,
        moved: u128,
        q: &[f64],
        responses: &mut RollerResponses,
        tension: &mut [Row],
    ) {
        let lost = panels.lost.as_chunks::<LANES>().0;
        for ((tension, at_preload), lost) in tension.iter_mut().zip(&self.at_preload).zip(lost) {
            for at in vector_starts(simd) {
                let less = Vector::load(simd, at_preload, at) + Vector::load(simd, lost, at);
                (-less).store(tension, at);
            }
        }
        let modes = q.iter().copied().enumerate().take(self.by_mode.len() / tension.len());
        add_all(simd, tension, &self.by_mode, modes);
        let rollers = responses.rollers.iter().map(|roller| roller.force).enumerate();
        add_all(simd, tension, &responses.by, rollers);
        add_all(simd, tension, &self.by_rollers, responses.fixed.iter().copied());
        let moves = listed(&mut responses.moves, moved, |spring| panels.before[spring] - panels.open[spring]);
        add_all(simd, tension, &self.stiffness, moves);
    }

    /// Passes over the panels until no tension would change any more, some springs having `moved` already, a
    /// bit for each; returns the heat [J].
    #[inline(always)]
    pub(super) fn settle<S: Simd>(
        &self,
        simd: S,
        panels: &mut SeatState,
        mut moved: u128,
        tension: &mut [Row],
        responses: &mut RollerResponses,
        passes: Passes,
    ) -> f64 {
        // Every other panel at once: neighbours then use the results of those between them.
        let mut quiet = 0;
        for half in 0..2 * passes.most {
            let (these, far) = self.release(
                simd,
                panels,
                tension,
                &mut responses.moves,
                &EVERY_OTHER[half % 2],
                passes.still,
            );
            moved |= these;
            quiet = if far { 0 } else { quiet + 1 };
            if half % 2 == 1 {
                self.update_forces(simd, panels, tension, responses);
            }
            if quiet == 2 {
                break;
            }
        }
        self.accumulate(simd, panels, &mut responses.moves, moved);
        let mut heat = Vector::all(simd, 0.0);
        let slips = panels.open.as_chunks::<LANES>().0.iter().zip(panels.before.as_chunks::<LANES>().0);
        for (tension, (open, before)) in tension.iter().zip(slips).skip(self.padded / LANES) {
            for at in vector_starts(simd) {
                let slip = Vector::load(simd, open, at) - Vector::load(simd, before, at);
                heat = slip.times_plus(Vector::load(simd, tension, at), heat);
            }
        }
        heat.sum()
    }

    /// Opens those of some panels that would be in tension, and slips those beyond the limit of friction, all
    /// at once. Returns which springs have moved, a bit for each, and whether that changed a tension by more
    /// than `still` [N].
    #[inline(always)]
    pub(super) fn release<S: Simd>(
        &self,
        simd: S,
        panels: &mut SeatState,
        tension: &mut [Row],
        moves: &mut Vec<(usize, f64)>,
        these: &Row,
        still: f64,
    ) -> (u128, bool) {
        let all = |value: f64| Vector::all(simd, value);
        let (zero, friction) = (all(0.0), all(self.friction));
        let groups = self.padded / LANES;
        let (mut moved, mut far) = (0_u128, 0);
        let mut changes = [0.0; u128::BITS as usize];
        for across in 0..groups {
            let along = groups + across;
            for at in vector_starts(simd) {
                let of = |rows: &[Row], n: usize| Vector::load(simd, &rows[n], at);
                let gap = |of: &[f64], n: usize| Vector::load(simd, of, LANES * n + at);
                let these = Vector::load(simd, these, at);
                let pulls = of(tension, across) - of(&self.pressed, across);
                let had = gap(&panels.open, across);
                let opens =
                    pulls.times_plus(of(&self.per_own, across), had).max(of(&self.closed, across)) - had;
                let loses = opens * of(&self.own, across);
                // Slip from the position before the step, by the excess over the limit of friction: otherwise
                // panels that slip first would slip too far.
                let limit = friction * (loses - pulls).max(zero);
                let was = gap(&panels.open, along);
                let held = (was - gap(&panels.before, along)) * of(&self.own, along);
                let holding = of(tension, along) + held;
                let gives = holding - holding.min(limit).max(-limit) - held;
                let slips = these * (gives * of(&self.per_own, along));
                let opens = these * opens;
                let most = these * loses.max(-loses).max(gives.max(-gives));
                (had + opens).store(&mut panels.open, LANES * across + at);
                (was + slips).store(&mut panels.open, LANES * along + at);
                (-opens).store(&mut changes, LANES * across + at);
                (-slips).store(&mut changes, LANES * along + at);
                let opening = zero.bits_below(opens.max(-opens));
                let slipping = zero.bits_below(slips.max(-slips));
                moved |= u128::from(opening) << (LANES * across + at);
                moved |= u128::from(slipping) << (LANES * along + at);
                far |= all(still).bits_below(most);
            }
        }
        let moves = listed(moves, moved, |spring| changes[spring]);
        add_all(simd, tension, &self.stiffness, moves);
        (moved, far != 0)
    }

    /// Effects of the springs that have opened and slipped in this step, a bit for each: loss of all
    /// tensions, and modal forces.
    #[inline(always)]
    pub(super) fn accumulate<S: Simd>(
        &self,
        simd: S,
        panels: &mut SeatState,
        moves: &mut Vec<(usize, f64)>,
        moved: u128,
    ) {
        let SeatState { open, before, lost, push, .. } = panels;
        let moves = listed(moves, moved, |spring| open[spring] - before[spring]);
        add_all(simd, lost.as_chunks_mut::<LANES>().0, &self.stiffness, moves.clone());
        add_all(simd, push.as_chunks_mut::<LANES>().0, &self.by_spring, moves);
    }

    /// Energy of the seat beyond that of one that holds, less the work of rollers [J].
    #[inline(always)]
    pub(super) fn stored<S: Simd>(&self, simd: S, panels: &SeatState, tension: &[Row]) -> f64 {
        let (zero, half) = (Vector::all(simd, 0.0), Vector::all(simd, 0.5));
        let (open, lost) = (panels.open.as_chunks::<LANES>().0, panels.lost.as_chunks::<LANES>().0);
        let mut sum = zero;
        for (n, (open, lost)) in open.iter().zip(lost).enumerate() {
            for at in vector_starts(simd) {
                let pressed = match self.pressed.get(n) {
                    Some(pressed) => Vector::load(simd, pressed, at),
                    None => zero,
                };
                let held = half.times_plus(Vector::load(simd, lost, at), Vector::load(simd, &tension[n], at));
                sum = Vector::load(simd, open, at).times_plus(pressed - held, sum);
            }
        }
        sum.sum()
    }
}
