//! First stage: how fast the rings turn, and the forces of load and dampers on the modes.

use pulp::Simd;
use stribeck_simd::lanes::Vector;

use crate::{
    bearing::Bearing,
    plane::{Rotation, Vec2},
    state::State,
    step::Scratch,
};

/// Speeds and load of one step.
#[derive(Clone, Copy)]
pub(crate) struct Drive {
    /// The outer ring, where it turns.
    pub(crate) outer: Option<RingRotation>,
    /// The inner ring.
    pub(crate) inner: RingRotation,
    /// Load beyond that of the preload, along it and a quarter of a turn ahead, in shares of it.
    pub(crate) load: [f64; 2],
}

impl Drive {
    /// Rotations of the outer and the inner ring.
    #[inline(always)]
    pub(crate) fn rings(&self) -> [Option<RingRotation>; 2] {
        [self.outer, Some(self.inner)]
    }
}

/// A ring in rotation.
#[derive(Clone, Copy)]
pub(crate) struct RingRotation {
    /// Angular velocity [rad/s].
    pub(crate) rate: f64,
    /// Angle by which it has turned.
    pub(crate) turned: Rotation,
}

impl RingRotation {
    /// At rest, not turned.
    pub(crate) const STILL: Self = Self { rate: 0.0, turned: Rotation::NONE };

    /// A vector in the frame of the ring.
    #[inline(always)]
    pub(crate) fn back<S: Simd>(self, simd: S, vector: Vec2<Vector<S>>) -> Vec2<Vector<S>> {
        self.turned.side_by_side(simd).back(vector)
    }

    /// A vector that is given in the frame of the ring.
    #[inline(always)]
    pub(crate) fn forth<S: Simd>(self, simd: S, vector: Vec2<Vector<S>>) -> Vec2<Vector<S>> {
        self.turned.side_by_side(simd).forth(vector)
    }
}

impl Bearing {
    /// Speeds and load of the step that begins.
    #[inline(always)]
    pub(crate) fn drive(&self, state: &State) -> Drive {
        let dt = self.time_step;
        let now = state.steps as f64 * dt;
        let (mut rate, mut outer_rate) = (self.speeds.shaft, self.speeds.outer);
        let mut outer_angle = outer_rate * dt * state.steps as f64;
        let mut load = [0.0; 2];
        if let Some(duty) = &self.duty {
            rate = duty.mean_shaft_rad_s(now, now + dt);
            if self.outer_turns {
                (outer_rate, outer_angle) = (duty.mean_outer_rad_s(now, now + dt), duty.outer_rad(now));
            }
            load = self.load_change(duty, now);
        }
        Drive {
            outer: self.outer_turns.then(|| RingRotation { rate: outer_rate, turned: Rotation::by(outer_angle) }),
            inner: RingRotation { rate, turned: Rotation::by(state.shaft) },
            load,
        }
    }

    /// Begins a step of the modes: prestress, load and dampers push on them.
    #[inline(always)]
    pub(crate) fn load_modes<S: Simd>(&self, simd: S, state: &State, scratch: &mut Scratch, drive: &Drive) {
        scratch.modes.begin(state, &self.reduction.constant);
        for (share, load) in self.loads(drive.load) {
            let push = scratch.modes.push.iter_mut().flat_map(|row| row.iter_mut());
            push.zip(load).for_each(|(push, load)| *push += share * load);
        }
        if !self.dampers.is_empty() {
            self.resist(simd, &mut scratch.modes);
        }
    }
}
