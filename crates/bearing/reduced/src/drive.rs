//! First stage of a step: speeds of the rings, and the load.

use crate::modal::{Parameters, parameters::Speeds, reduction::Load};
use pulp::Simd;
use stribeck_simd::lanes::Vector;
use stribeck_theory::duty::Duty;

use crate::plane::{Rotation, Vec2};

/// Speeds and load of one step.
#[derive(Clone, Copy)]
pub(crate) struct Drive {
    pub(crate) outer: Option<RingRotation>,
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

/// Load beyond that of the preload: shares of it that are not zero, and the force of a share of one on each
/// mode.
pub(crate) struct LoadChange<'a>(pub(crate) [(f64, &'a [f64]); 2]);

impl<'a> LoadChange<'a> {
    /// Along the load and a quarter of a turn ahead of it, in shares of it.
    #[inline(always)]
    pub(crate) fn new(load: &'a Load, [along, across]: [f64; 2]) -> Self {
        Self([(along, &load.along), (across, &load.across)])
    }

    /// Shares that are not zero, with the forces of one on each mode.
    #[inline(always)]
    pub(crate) fn shares(&self) -> impl Iterator<Item = (f64, &'a [f64])> {
        self.0.into_iter().filter(|(share, _)| *share != 0.0)
    }

    /// Power at the velocities of the modes [W].
    #[inline(always)]
    pub(crate) fn power(&self, v: &[f64]) -> f64 {
        let of = |load: &[f64]| v.iter().zip(load).map(|(v, load)| v * load).sum::<f64>();
        self.shares().map(|(share, load)| share * of(load)).sum()
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Operation {
    /// Angular velocities at the start.
    pub(crate) speeds: Speeds,
    outer_turns: bool,
    /// Speeds and load, where they change.
    pub(crate) duty: Option<Duty>,
    /// Load at the start and at the preload [N].
    pub(crate) load_at_start: f64,
    preload: f64,
    /// Whether no load acts, because a shaft that is moved brings it.
    pub(crate) released: bool,
}

impl Operation {
    pub(crate) fn new(parameters: &Parameters, preload: f64) -> Self {
        let Parameters { speeds, outer_turns, duty, load_at_start, .. } = parameters;
        Self {
            speeds: *speeds,
            outer_turns: *outer_turns,
            duty: duty.clone(),
            load_at_start: *load_at_start,
            preload,
            released: false,
        }
    }

    /// Load beyond that of the preload at a time [s], along it and a quarter of a turn ahead, in shares of
    /// it.
    #[inline(always)]
    pub(crate) fn load_change(&self, time: f64) -> [f64; 2] {
        if self.released {
            return [-1.0, 0.0];
        }
        let Some(duty) = &self.duty else { return [0.0; 2] };
        let per = 1.0 / self.preload;
        [duty.load_n(time) * per - 1.0, duty.load_across_n(time).map_or(0.0, |across| across * per)]
    }

    /// Speeds and load of a step of `dt` [s], after these steps, with the inner ring at the angle `shaft`
    /// [rad].
    #[inline(always)]
    pub(crate) fn drive(&self, steps: u64, dt: f64, shaft: f64) -> Drive {
        let now = steps as f64 * dt;
        let (mut rate, mut outer_rate) = (self.speeds.shaft, self.speeds.outer);
        let mut outer_angle = outer_rate * dt * steps as f64;
        if let Some(duty) = &self.duty {
            rate = duty.mean_shaft_rad_s(now, now + dt);
            if self.outer_turns {
                (outer_rate, outer_angle) = (duty.mean_outer_rad_s(now, now + dt), duty.outer_rad(now));
            }
        }
        Drive {
            outer: self
                .outer_turns
                .then(|| RingRotation { rate: outer_rate, turned: Rotation::by(outer_angle) }),
            inner: RingRotation { rate, turned: Rotation::by(shaft) },
            load: self.load_change(now),
        }
    }
}
