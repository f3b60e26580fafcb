//! One step of the reduced bearing, and many of them in the instruction set of the processor (THEORY §9.4).
//!
//! Rollers are taken eight at a time: work common to all is done in vectors, facet-dependent work roller by
//! roller.

mod raceway_motion;
mod rollers;
mod scratch;

use pulp::{Arch, Simd, WithSimd};

use crate::{
    bearing::Bearing,
    drive::{Drive, LoadChange},
    modes::Modes,
    state::State,
    tally::Tally,
};
pub use scratch::Scratch;

/// Some steps; with `last` their energies are kept.
struct Interval<'a> {
    bearing: &'a Bearing,
    state: &'a mut State,
    scratch: &'a mut Scratch,
    steps: usize,
    last: bool,
}

impl WithSimd for Interval<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for _ in 0..self.steps {
            self.bearing.step(simd, self.state, self.scratch, self.last);
        }
        if self.last {
            let Scratch { roller_forces, modes, now, .. } = self.scratch;
            self.bearing.sensors.measure(simd, self.state, roller_forces, &modes.tension, now);
        }
    }
}

impl Bearing {
    /// Takes `steps` steps; with `last` their energies are in `scratch` afterwards.
    pub(crate) fn advance(&self, state: &mut State, scratch: &mut Scratch, steps: usize, last: bool) {
        Arch::new().dispatch(Interval { bearing: self, state, scratch, steps, last });
    }

    /// One step: forces at the positions, then velocities, then positions (THEORY §2.3).
    #[inline(always)]
    fn step<S: Simd>(&self, simd: S, state: &mut State, scratch: &mut Scratch, last: bool) {
        let dt = self.time_step;
        let mut tally = Tally { last, ..Tally::default() };
        let drive = self.operation.drive(state.steps, dt, state.shaft);
        let load = LoadChange::new(&self.reduction.load, drive.load);
        self.load_modes(simd, state, scratch, &load);
        if last {
            let Scratch { roller_forces, modes, before, .. } = scratch;
            self.sensors.measure(simd, state, roller_forces, &modes.tension, before);
        }
        self.follow_rollers(simd, scratch, &drive);
        let shaft = scratch.frame.as_mut().map(|frame| frame.advance(dt));
        self.settle_seat(simd, state, scratch, &mut tally);
        let mut on_cage = self.advance_rollers(simd, state, scratch, &drive, &mut tally);
        if let Some(frame) = &mut scratch.frame {
            frame.keep(&scratch.blocks);
        }
        if let (Some(housing), Some(shaft)) = (&self.housing, shaft) {
            let damping = self.structure.mass_damping;
            housing.push(dt, damping, shaft, state, &mut scratch.modes, &mut tally);
        }
        self.structure.advance(simd, dt, &self.reduction, state, &scratch.modes, &load, &mut tally);
        if let Some(cage) = &self.cage {
            let before = state.cage_velocity;
            if let Some(frame) = &scratch.frame {
                frame.pull_cage(cage, &mut on_cage);
            }
            cage.advance(dt, self.rollers.gravity, on_cage, state, &mut tally);
            if let Some(frame) = &scratch.frame {
                tally.spent.external += frame.work_on_cage(cage, before, state.cage_velocity, dt);
            }
        }
        state.shaft += dt * drive.inner.rate;
        tally.enter(state, dt);
        state.steps += 1;
        scratch.summed += 1;
        if last {
            scratch.energy = tally.stored;
        }
    }

    /// First stage: prestress, load and dampers push on the modes.
    #[inline(always)]
    fn load_modes<S: Simd>(&self, simd: S, state: &State, scratch: &mut Scratch, load: &LoadChange<'_>) {
        scratch.modes.begin(state, &self.reduction.constant);
        for (share, load) in load.shares() {
            let push = scratch.modes.push.iter_mut().flat_map(|row| row.iter_mut());
            push.zip(load).for_each(|(push, load)| *push += share * load);
        }
        if !self.structure.dampers.is_empty() {
            self.structure.resist(simd, &mut scratch.modes);
        }
    }

    /// Second stage: finds the facets of the outer raceway under all rollers.
    #[inline(always)]
    fn follow_rollers<S: Simd>(&self, simd: S, scratch: &mut Scratch, drive: &Drive) {
        for block in &mut scratch.blocks {
            self.follow_facets(simd, block, drive.outer);
            // A roller presses where it is now: the seat's displacement under it and the work of both depend
            // on that place.
            let forces = &mut scratch.roller_forces[block.first..block.first + block.count];
            for ((force, facet), share) in forces.iter_mut().zip(&block.facet).zip(block.share.iter()) {
                (force.facet, force.share) = (*facet, *share);
            }
        }
    }

    /// Third stage: panels of the seat open, close and slip under modes and rollers.
    #[inline(always)]
    fn settle_seat<S: Simd>(&self, simd: S, state: &mut State, scratch: &mut Scratch, tally: &mut Tally) {
        let (Some(seat), Some(seat_state)) = (&self.seat, &mut state.seat) else { return };
        let Modes { push, tension, responses, .. } = &mut scratch.modes;
        let forces = &scratch.roller_forces;
        let [heat, stored] =
            seat.respond(simd, seat_state, &state.q, forces, responses, [push, tension], tally.last);
        tally.spent.heat[0] += 2.0 * heat / self.time_step;
        tally.stored.strain += stored;
    }
}
