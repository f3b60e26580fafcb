//! Bodies that move as one piece, and the rigid part of the motion of bodies that do not.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::{
    model::Behaviour,
    state::{NodeForces, State},
};

/// Place and motion of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct RigidState {
    /// Centre of mass [m].
    pub centre: [f64; 2],
    /// Rotation since the start [rad], counter-clockwise positive.
    pub angle: f64,
    /// Velocity of the centre [m/s], half a step earlier.
    pub velocity: [f64; 2],
    /// Angular velocity [rad/s], half a step earlier.
    pub spin: f64,
}

/// Constant data of a rigid body.
#[derive(Debug, Clone)]
pub(crate) struct RigidBody {
    pub(crate) body: usize,
    /// Angular velocity that it keeps whatever pushes on it [rad/s]; `None` for one that turns freely.
    turning: Option<f64>,
    /// Rate at which its centre is braked [1/s].
    braking: f64,
    pub(crate) slots: Range<usize>,
    /// Node positions relative to the centre of mass at angle zero [m].
    arm: Vec<[f64; 2]>,
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
}

impl RigidBody {
    /// From node positions and masses in `slots`.
    pub(crate) fn new(
        body: usize,
        behaviour: Behaviour,
        slots: Range<usize>,
        x: &[f64],
        y: &[f64],
        mass: &[f64],
    ) -> (Self, RigidState) {
        let total: f64 = mass[slots.clone()].iter().sum();
        let moment = |v: &[f64]| slots.clone().map(|n| mass[n] * v[n]).sum::<f64>() / total;
        let centre = [moment(x), moment(y)];
        let arm: Vec<[f64; 2]> = slots.clone().map(|n| [x[n] - centre[0], y[n] - centre[1]]).collect();
        let inertia =
            slots.clone().zip(&arm).map(|(n, a)| mass[n] * (a[0] * a[0] + a[1] * a[1])).sum::<f64>();
        let (turning, braking) = match behaviour {
            Behaviour::Turning { rate, braking } => (Some(rate), braking),
            Behaviour::Elastic | Behaviour::Rigid => (None, 0.0),
        };
        let state = RigidState { centre, spin: turning.unwrap_or(0.0), ..RigidState::default() };
        (Self { body, turning, braking, slots, arm, mass: total, inertia }, state)
    }

    /// Another rate [rad/s] for a body that turns at a prescribed one.
    pub(crate) fn set_turning_rate(&mut self, rate: f64) {
        self.turning.iter_mut().for_each(|old| *old = rate);
    }

    /// Whether it turns at a prescribed rate.
    pub(crate) fn turns(&self) -> bool {
        self.turning.is_some()
    }

    /// One step under the forces on its nodes and gravity; moves the nodes. Returns the work of its drive, less
    /// what its damper takes [J].
    pub(crate) fn advance(
        &self,
        at: &mut RigidState,
        state: &mut State,
        forces: &mut NodeForces,
        dt: f64,
        gravity: [f64; 2],
    ) -> f64 {
        let (mut fx, mut fy, mut torque) = (0.0, 0.0, 0.0);
        for n in self.slots.clone() {
            let (px, py) = (forces.fx[n], forces.fy[n]);
            if px != 0.0 || py != 0.0 {
                fx += px;
                fy += py;
                torque += (state.x[n] - at.centre[0]) * py - (state.y[n] - at.centre[1]) * px;
                forces.fx[n] = 0.0;
                forces.fy[n] = 0.0;
            }
        }
        let taken = self.accelerate(at, [fx / self.mass + gravity[0], fy / self.mass + gravity[1]], dt);
        let driven = match self.turning {
            Some(rate) => {
                let before = std::mem::replace(&mut at.spin, rate);
                // What drives it works against what pushes on it, and speeds it up.
                0.5 * (before + rate) * (self.inertia * (rate - before) - dt * torque)
            }
            None => {
                at.spin += dt * torque / self.inertia;
                0.0
            }
        };
        at.centre[0] += dt * at.velocity[0];
        at.centre[1] += dt * at.velocity[1];
        at.angle += dt * at.spin;
        self.place(at, state, dt);
        driven - taken
    }

    /// Accelerates and brakes the centre over a step. Returns what the damper takes [J].
    fn accelerate(&self, at: &mut RigidState, acceleration: [f64; 2], dt: f64) -> f64 {
        // By the mean velocity over the step, so that no rate is unstable.
        let h = 0.5 * self.braking * dt;
        let mut squares = 0.0;
        for (v, a) in at.velocity.iter_mut().zip(acceleration) {
            let new = if self.braking == 0.0 { *v + dt * a } else { ((1.0 - h) * *v + dt * a) / (1.0 + h) };
            squares += (0.5 * (*v + new)).powi(2);
            *v = new;
        }
        dt * self.braking * self.mass * squares
    }

    /// Puts the body where its nodes are, which have been moved without turning.
    #[cfg(feature = "statics")]
    pub(crate) fn follow_nodes(&self, at: &mut RigidState, state: &State) {
        let (s, c) = libm::sincos(at.angle);
        let (n, a) = (self.slots.start, self.arm[0]);
        at.centre = [state.x[n] - (c * a[0] - s * a[1]), state.y[n] - (s * a[0] + c * a[1])];
    }

    /// Puts the nodes where the body is, a time step later.
    pub(crate) fn place(&self, at: &RigidState, state: &mut State, dt: f64) {
        let (s, c) = libm::sincos(at.angle);
        let slots = self.slots.clone();
        let (x, y) = (&mut state.x[slots.clone()], &mut state.y[slots.clone()]);
        let (vx, vy) = (&mut state.vx[slots.clone()], &mut state.vy[slots]);
        let rate = 1.0 / dt;
        for ((((a, x), y), vx), vy) in self.arm.iter().zip(x).zip(y).zip(vx).zip(vy) {
            let new = [at.centre[0] + c * a[0] - s * a[1], at.centre[1] + s * a[0] + c * a[1]];
            (*vx, *vy) = (rate * (new[0] - *x), rate * (new[1] - *y));
            [*x, *y] = new;
        }
    }

    /// Upper bound of ω² [rad²/s²] when each node has at most the stiffness `bound` [N/m].
    ///
    /// The largest eigenvalue of translation and rotation together is at most the sum of the two alone.
    pub(crate) fn frequency_bound(&self, at: &RigidState, state: &State, bound: &[f64]) -> f64 {
        let (mut translation, mut rotation) = (0.0, 0.0);
        for n in self.slots.clone() {
            let r = [state.x[n] - at.centre[0], state.y[n] - at.centre[1]];
            translation += bound[n];
            rotation += bound[n] * (r[0] * r[0] + r[1] * r[1]);
        }
        translation / self.mass + if self.turns() { 0.0 } else { rotation / self.inertia }
    }

    /// Kinetic energy [J] at the time of the positions, from the half steps before and after.
    pub(crate) fn kinetic(&self, before: &RigidState, after: &RigidState) -> f64 {
        let [u, v] = [before.velocity, after.velocity];
        0.5 * self.mass * (u[0] * v[0] + u[1] * v[1]) + 0.5 * self.inertia * before.spin * after.spin
    }
}

/// The rigid part of a body's motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RigidMotion {
    /// Mass [kg].
    pub mass: f64,
    /// Centre of mass [m].
    pub centre: [f64; 2],
    /// Its velocity [m/s].
    pub velocity: [f64; 2],
    /// Moment of inertia about the centre of mass [kg m²].
    pub inertia: f64,
    /// Angular velocity that carries the body's angular momentum [rad/s].
    pub spin: f64,
}

impl RigidMotion {
    /// Sums over nodes `(mass, x, y, vx, vy)`.
    pub fn of(nodes: impl Iterator<Item = (f64, [f64; 2], [f64; 2])> + Clone) -> Self {
        let mut sum = [0.0; 5];
        for (m, p, v) in nodes.clone() {
            sum[0] += m;
            sum[1] += m * p[0];
            sum[2] += m * p[1];
            sum[3] += m * v[0];
            sum[4] += m * v[1];
        }
        let mass = sum[0];
        let centre = [sum[1] / mass, sum[2] / mass];
        let velocity = [sum[3] / mass, sum[4] / mass];
        let (mut inertia, mut momentum) = (0.0, 0.0);
        for (m, p, v) in nodes {
            let r = [p[0] - centre[0], p[1] - centre[1]];
            let u = [v[0] - velocity[0], v[1] - velocity[1]];
            inertia += m * (r[0] * r[0] + r[1] * r[1]);
            momentum += m * (r[0] * u[1] - r[1] * u[0]);
        }
        Self { mass, centre, velocity, inertia, spin: momentum / inertia }
    }
}
