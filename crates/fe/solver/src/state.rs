//! The state in time, and the forces of one step.

use serde::{Deserialize, Serialize};

use stribeck_simd::field::Field;

/// Everything that changes in time. Node fields are flat arrays, one value a slot (see [`crate::layout`]).
///
/// Velocities belong to the half step before `time` (leapfrog, THEORY §2.3).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct State {
    /// Steps taken.
    pub step: u64,
    /// Time of the positions [s].
    pub time: f64,
    /// Positions [m].
    pub x: Field,
    /// Positions [m].
    pub y: Field,
    /// Velocities, half a step earlier [m/s].
    pub vx: Field,
    /// Velocities, half a step earlier [m/s].
    pub vy: Field,
    /// Springs of structural damping.
    pub springs: SpringState,
}

/// State of the springs and dashpots of structural damping.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SpringState {
    /// Positions through the low-pass of the branch (x, y) [m], one value a slot, at the last evaluation.
    pub(crate) path: Option<[Field; 2]>,
    /// Forces that nodes are pushed with until the next evaluation (x, y) [N], rounded to single precision:
    /// every step reads them.
    pub(crate) held: [Field<f32>; 2],
    /// Angular velocity of each damped body when it was last measured [rad/s]; empty before.
    pub(crate) spins: Vec<f64>,
    /// Step of the last evaluation; none before the first.
    pub(crate) evaluated: Option<u64>,
    /// Step of the next one.
    pub(crate) next: u64,
    /// Work of the held forces until half a step before the last evaluation, and the sum of the present ones
    /// times positions there [J].
    pub(crate) work: f64,
    pub(crate) taken_up: f64,
    /// Elastic energy of the damped bodies at the start [J].
    pub(crate) at_start: Option<f64>,
    /// Heat and energy of the springs when they were last asked for [J].
    pub(crate) loss: f64,
}

/// Energy counted step by step [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Accumulated {
    /// Up to half a step after the positions' time.
    pub(crate) total: f64,
    /// Of the last step, half of which lies after the positions' time.
    pub(crate) last: f64,
}

impl Accumulated {
    pub(crate) fn add(&mut self, step: f64) {
        self.total += step;
        self.last = step;
    }

    /// Adds to the last step.
    pub(crate) fn add_to_step(&mut self, more: f64) {
        self.total += more;
        self.last += more;
    }

    /// Up to the time of the positions before the last step [J].
    pub fn at_last_positions(&self) -> f64 {
        self.total - 0.5 * self.last
    }
}

/// The part of the state that a force reads: positions at `time`, velocities half a step before.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// Steps taken.
    pub step: u64,
    /// Time [s].
    pub time: f64,
    /// Time step [s].
    pub dt: f64,
    /// Positions [m].
    pub x: &'a [f64],
    /// Positions [m].
    pub y: &'a [f64],
    /// Velocities [m/s].
    pub vx: &'a [f64],
    /// Velocities [m/s].
    pub vy: &'a [f64],
}

/// Forces on nodes from everything but the elements [N], one value a slot.
///
/// Only the nodes announced as loaded when the model was laid out are read; a force on another is lost.
#[derive(Debug, Clone, Default)]
pub struct NodeForces {
    /// Force [N].
    pub fx: Field,
    /// Force [N].
    pub fy: Field,
}

impl NodeForces {
    /// No force on `n` slots.
    pub fn zeros(n: usize) -> Self {
        Self { fx: Field::zeros(n), fy: Field::zeros(n) }
    }
}

/// Energy of one force since the start [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energy {
    /// Recoverable energy stored now.
    pub stored: f64,
    /// Energy turned into heat by friction.
    pub friction: f64,
    /// Energy turned into heat by damping.
    pub damping: f64,
    /// Work done on the model from outside.
    pub supplied: f64,
}

impl std::iter::Sum for Energy {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |sum, energy| Self {
            stored: sum.stored + energy.stored,
            friction: sum.friction + energy.friction,
            damping: sum.damping + energy.damping,
            supplied: sum.supplied + energy.supplied,
        })
    }
}
