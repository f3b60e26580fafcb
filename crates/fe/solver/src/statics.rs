//! Static equilibrium under loads and contact, the start of a run without ringing (THEORY §3).
//!
//! Newton's method on the positions with a sparse Cholesky factorisation. Bodies that nothing holds yet are
//! slowed by a mass-proportional term as large as their own unbalanced force asks for, which vanishes at
//! equilibrium. Motions that statics cannot decide (of a cylinder that rolls freely) are left to inertia:
//! their unbalanced force is spread over the mass as in a free fall, so nothing rings when the run begins.

mod factor;
mod graph;
mod hold;
mod matrix;
mod modes;
mod residual;
mod small_motions;
mod stiffness;
mod tangent;
mod unknowns;

pub use modes::{Modes, modes_below};
pub use small_motions::{SmallMotions, Spring};

use residual::Residual;
use tangent::Tangent;
use unknowns::Unknowns;

use crate::{dynamics::Dynamics, error::Error, force::Force};

/// A rigid motion of one body that statics leaves alone.
#[derive(Debug, Clone)]
pub struct Undecided {
    /// Slots of the body.
    pub slots: Vec<u32>,
    /// Translation along this direction, if any.
    pub along: Option<[f64; 2]>,
    /// Rotation about the centre of mass.
    pub rotation: bool,
}

/// The problem.
#[derive(Debug, Clone)]
pub struct Statics {
    /// Slots of each body that finds its place, with its name: elastic ones, and those that move as one piece
    /// without turning.
    pub bodies: Vec<(String, Vec<u32>)>,
    /// Motions left to inertia.
    pub undecided: Vec<Undecided>,
    /// Acceleration of each slot in the motion that follows [m/s²] (d'Alembert); empty for none.
    pub acceleration: Vec<[f64; 2]>,
    /// Farthest that a body may move as a whole in one iteration [m].
    pub longest_step: f64,
    /// Unbalanced force allowed on the worst node [N].
    pub tolerance: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// How the iteration went.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equilibrium {
    /// Newton iterations.
    pub iterations: usize,
    /// Largest unbalanced force on a node [N].
    pub residual: f64,
}

/// Finds static equilibria of one model; the order of elimination and the memory serve all of them.
pub struct Equilibrator {
    unknowns: Unknowns,
    tangent: Tangent,
}

impl std::fmt::Debug for Equilibrator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Equilibrator").field("nodes", &self.unknowns.slots.len()).finish_non_exhaustive()
    }
}

/// A factorisation serves until an iteration leaves more than this share of the unbalanced force.
const GOOD_ENOUGH: f64 = 0.6;

impl Equilibrator {
    /// Numbers the unknowns.
    pub fn new(dynamics: &Dynamics) -> Self {
        Self { unknowns: Unknowns::new(dynamics), tangent: Tangent::default() }
    }

    /// Moves the nodes of `dynamics`, the model of [`Equilibrator::new`], to static equilibrium. The step and
    /// time stay; velocities are not used.
    ///
    /// # Errors
    /// When the iteration does not converge or the matrix cannot be factorised.
    pub fn equilibrate(
        &mut self,
        dynamics: &mut Dynamics,
        forces: &mut [&mut dyn Force],
        statics: &Statics,
    ) -> Result<Equilibrium, Error> {
        let solved = self.iterate(dynamics, forces, statics);
        dynamics.follow_nodes();
        solved
    }

    fn iterate(
        &mut self,
        dynamics: &mut Dynamics,
        forces: &mut [&mut dyn Force],
        statics: &Statics,
    ) -> Result<Equilibrium, Error> {
        let mut residual = Residual::new(dynamics);
        residual.evaluate(dynamics, forces, statics, &self.unknowns);
        let mut iterations = 0;
        let mut before = 0.0;
        loop {
            let (worst, at) = residual.worst(&self.unknowns);
            if worst <= statics.tolerance {
                return Ok(Equilibrium { iterations, residual: worst });
            }
            if iterations == statics.iterations || !worst.is_finite() {
                return Err(no_equilibrium(dynamics, statics, iterations, worst, at));
            }
            let old = iterations > 0 && worst <= GOOD_ENOUGH * before;
            if !old {
                self.tangent.factorise(&mut self.unknowns, dynamics, forces, statics, &residual)?;
            }
            let mut step = self.tangent.step(&self.unknowns, dynamics, statics, &residual);
            let too_far = |[x, y]: &[f64; 2]| libm::hypot(*x, *y) > statics.longest_step;
            if old && step.iter().any(too_far) {
                // A body was held for a smaller force than it has now.
                self.tangent.factorise(&mut self.unknowns, dynamics, forces, statics, &residual)?;
                step = self.tangent.step(&self.unknowns, dynamics, statics, &residual);
            }
            dynamics.search_along(forces, statics, &mut residual, &self.unknowns, &step);
            before = worst;
            iterations += 1;
        }
    }
}

impl Dynamics {
    /// Moves the nodes to static equilibrium, see [`Equilibrator::equilibrate`].
    ///
    /// # Errors
    /// When the iteration does not converge or the matrix cannot be factorised.
    pub fn equilibrate(
        &mut self,
        forces: &mut [&mut dyn Force],
        statics: &Statics,
    ) -> Result<Equilibrium, Error> {
        Equilibrator::new(self).equilibrate(self, forces, statics)
    }

    /// Goes along `step` to where the residual no longer points along it.
    fn search_along(
        &mut self,
        forces: &mut [&mut dyn Force],
        statics: &Statics,
        residual: &mut Residual,
        unknowns: &Unknowns,
        step: &[[f64; 2]],
    ) {
        let start: Vec<[f64; 2]> =
            unknowns.moving().map(|(slot, _)| [self.state.x[slot], self.state.y[slot]]).collect();
        let slope0 = residual.along(unknowns, step);
        let (mut low, mut slope_low) = (0.0, slope0);
        let (mut factor, mut high) = (1.0, f64::INFINITY);
        for _ in 0..12 {
            for ((slot, i), [x, y]) in unknowns.moving().zip(&start) {
                self.state.x[slot] = x + factor * step[i][0];
                self.state.y[slot] = y + factor * step[i][1];
            }
            residual.evaluate(self, forces, statics, unknowns);
            let slope = residual.along(unknowns, step);
            // The potential is convex along a line: its slope falls through zero once.
            if slope.abs() <= 0.5 * slope0.abs() || (slope > 0.0 && high.is_infinite()) {
                return;
            }
            if slope < 0.0 {
                high = factor;
                let secant = low + (factor - low) * slope_low / (slope_low - slope);
                factor = secant.clamp(low + 0.1 * (high - low), high - 0.1 * (high - low));
            } else {
                low = factor;
                slope_low = slope;
                factor = 0.5 * (low + high);
            }
        }
    }
}

fn no_equilibrium(d: &Dynamics, statics: &Statics, iterations: usize, residual_n: f64, slot: usize) -> Error {
    let body = statics.bodies.iter().find(|(_, slots)| slots.contains(&(slot as u32)));
    Error::NoEquilibrium {
        iterations,
        residual_n,
        allowed_n: statics.tolerance,
        body: body.map_or_else(String::new, |(name, _)| name.clone()),
        x_mm: 1e3 * d.state.x[slot],
        y_mm: 1e3 * d.state.y[slot],
        advice: "check that the load can reach a support through bodies that touch; try a smaller load, a \
            softer contact or a start without preload",
    }
}
