//! The state of a reduced run, the content of its checkpoint.

use serde::{Deserialize, Serialize};

use crate::{oil::Films, seat::SeatState};

/// Positions at one time, velocities half a step earlier.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Coordinates of the modes [√kg m] from the preload.
    pub q: Vec<f64>,
    /// Their velocities [√kg m/s].
    pub v: Vec<f64>,
    /// Stretches of the springs of each branch of the structural damping.
    pub branches: Vec<Vec<f64>>,
    /// Centres of the rollers [m].
    pub x: Vec<f64>,
    /// Centres of the rollers [m].
    pub y: Vec<f64>,
    /// Their velocities [m/s].
    pub vx: Vec<f64>,
    /// Their velocities [m/s].
    pub vy: Vec<f64>,
    /// Angles of rollers since the start [rad], and the directions of their vertices 0, turned
    /// step by step.
    pub angle: Vec<f64>,
    /// Cosines and sines of these.
    pub turned: Vec<[f64; 2]>,
    /// Their angular velocities [rad/s].
    pub spin: Vec<f64>,
    /// Elastic slip at the outer and the inner raceway [m].
    pub slip: [Vec<f64>; 2],
    /// Elastic slip at the two walls of each pocket [m].
    pub wall_slip: Vec<[f64; 2]>,
    /// Drag, damping force [N] and damping moment [N m] of the last step at both raceways: half of their work
    /// is counted then.
    pub passive: [Vec<[f64; 3]>; 2],
    /// Drag and damping force of the last step at the two walls of each pocket [N].
    pub wall_passive: Vec<[[f64; 2]; 2]>,
    /// Normal forces of the last step at both raceways [N].
    pub force: [Vec<f64>; 2],
    /// Growth of these forces in the last step [N], with which the next search is extrapolated.
    pub growth: [Vec<f64>; 2],
    /// Facets of roller and raceway found last, at both raceways.
    pub hints: [Vec<[u32; 2]>; 2],
    /// Displacement of the cage's centre of mass [m] and its angle [rad].
    pub cage: [f64; 3],
    /// Their velocities.
    pub cage_velocity: [f64; 3],
    /// Angle of the inner ring [rad].
    pub shaft: f64,
    /// Work since the start.
    pub work: Work,
    /// Opening and slip of the seat; `None` without a seat.
    pub seat: Option<SeatState>,
    /// Films of oil; `None` without any.
    pub films: Option<Films>,
    /// Steps taken.
    pub steps: u64,
}

/// Work since the start [J]. Pairs are sums over steps, and of the last step alone, half of which lies behind
/// the positions.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Work {
    /// Against friction, in all contacts.
    pub friction: f64,
    /// Against contact damping.
    pub contact_damping: f64,
    /// Against mass, stiffness and structural damping.
    pub damping: [f64; 2],
    /// Of load and gravity.
    pub external: [f64; 2],
    /// Of the drive.
    pub drive: [f64; 2],
}

/// Adds the work of a step.
#[inline(always)]
pub(crate) fn count(sum: &mut [f64; 2], step: f64) {
    *sum = [sum[0] + step, step];
}

/// Work up to the positions before the last step.
pub(crate) fn at_positions(sum: [f64; 2]) -> f64 {
    sum[0] - 0.5 * sum[1]
}

/// Energies at the positions before a step [J].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Stored {
    pub(crate) kinetic: f64,
    pub(crate) strain: f64,
    pub(crate) contact: f64,
    /// The part of `contact` in springs of friction: no heat yet.
    pub(crate) sticking: f64,
}

/// Energy that goes in or out in one step [J].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Spent {
    /// Twice the power against friction and contact damping [W] (2.24).
    pub(crate) heat: [f64; 2],
    /// Work of load and gravity.
    pub(crate) external: f64,
    /// Work of the drive.
    pub(crate) drive: f64,
    /// Against mass, stiffness and structural damping.
    pub(crate) damped: f64,
}
