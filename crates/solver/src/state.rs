//! What changes in time, and the forces of one step.

use serde::{Deserialize, Serialize};

use crate::springs::SpringState;
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

/// What a force sees of the state: positions at `time`, velocities half a step before.
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
