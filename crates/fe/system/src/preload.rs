//! The staged preload: static equilibrium under loads, gravity and contact, before the first step (THEORY
//! §3).

use stribeck_solver::{
    Behaviour,
    statics::{Equilibrator, Statics, Undecided},
};

use crate::{error::Error, names::nodes_of, system::System};

/// Unbalanced force allowed on the worst node, as a share of the load.
const TOLERANCE: f64 = 1e-7;

/// Contacts that change sides for ever keep a preload from its tolerance. Where less than this share of the
/// load is unbalanced on the worst node, or on a body that moves as one piece, it is accepted with a note.
const ENOUGH: f64 = 1e-2;

/// Stages before the last need not be exact: this multiple of the tolerance will do.
const ROUGH: f64 = 1e4;

/// Most iterations of a stage.
const ITERATIONS: usize = 80;

/// How to find equilibrium. Elastic bodies move, and those that turn at a prescribed rate, without turning;
/// rigid ones stay where they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Preload {
    /// The load that tolerances are shares of [N]; `None` takes the sum of all loads and weights.
    pub load: Option<f64>,
    /// Gaps over which the contact law is rounded, stage by stage [m]; the last stage, zero, is the law
    /// itself. Over such a gap contact acts on bodies that nothing touches yet, and they settle.
    pub softness: Vec<f64>,
    /// A body moves at most this far as a whole in one iteration [m].
    pub longest_step: f64,
    /// Motions left to inertia.
    pub undecided: Vec<UndecidedMotion>,
    /// Acceleration of each node in the motion that follows [m/s²] (d'Alembert); empty for none.
    pub acceleration: Vec<[f64; 2]>,
}

impl Default for Preload {
    fn default() -> Self {
        Self {
            load: None,
            softness: vec![2e-6, 2e-7, 2e-8, 2e-9, 0.0],
            longest_step: 2e-5,
            undecided: Vec::new(),
            acceleration: Vec::new(),
        }
    }
}

/// A rigid motion of one body that statics cannot decide.
#[derive(Debug, Clone, PartialEq)]
pub struct UndecidedMotion {
    /// Number of the body in the mesh.
    pub body: usize,
    /// Translation along this direction, if any.
    pub along: Option<[f64; 2]>,
    /// Rotation about the centre of mass.
    pub rotation: bool,
}

/// How a preload ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settled {
    /// Force that is left on the worst node [N] where the tolerance was not reached; the motion then begins
    /// with a little ringing.
    pub unbalanced: Option<f64>,
}

impl System {
    /// Moves the bodies to static equilibrium under loads, gravity and contact, over ever sharper contact
    /// laws. Velocities and time stay.
    ///
    /// # Errors
    /// When a stage ends far from equilibrium or the stiffness matrix cannot be factorised.
    pub fn settle(&mut self, preload: &Preload) -> Result<Settled, Error> {
        let load = preload.load.unwrap_or_else(|| self.loads_and_weights());
        // Bodies that nothing pushes have no load to be exact against.
        let load = if load > 0.0 { load } else { 1.0 };
        let moving = self.names.bodies.iter().enumerate();
        let moving = moving.filter(|(b, _)| self.behaviour[*b] != Behaviour::Rigid);
        let undecided = preload.undecided.iter().map(|motion| Undecided {
            slots: self.body_slots(motion.body),
            along: motion.along,
            rotation: motion.rotation,
        });
        let mut acceleration = Vec::new();
        if !preload.acceleration.is_empty() {
            acceleration.resize(self.dynamics.state.x.len(), [0.0; 2]);
            let nodes = self.names.bodies.iter().flat_map(nodes_of);
            nodes.zip(&preload.acceleration).for_each(|(n, a)| acceleration[self.slot(n)] = *a);
        }
        let statics = Statics {
            bodies: moving.map(|(b, body)| (body.name.clone(), self.body_slots(b))).collect(),
            undecided: undecided.collect(),
            acceleration,
            longest_step: preload.longest_step,
            tolerance: TOLERANCE * load,
            iterations: ITERATIONS,
        };
        self.forces.films.iter_mut().for_each(|films| films.set_preload(true));
        let settled = self.go_through_stages(&preload.softness, &statics, load);
        if let Some(contacts) = &mut self.forces.contacts {
            contacts.set_preload(None);
        }
        self.forces.films.iter_mut().for_each(|films| films.set_preload(false));
        self.balance.reference = None;
        settled
    }

    fn go_through_stages(
        &mut self,
        softness: &[f64],
        statics: &Statics,
        load: f64,
    ) -> Result<Settled, Error> {
        let mut solver = Equilibrator::new(&self.dynamics);
        let mut settled = Settled { unbalanced: None };
        // Without contact there is nothing to round.
        let sharp = [0.0];
        let stages = if self.forces.contacts.is_some() { softness } else { &sharp };
        for &softness in stages {
            if let Some(contacts) = &mut self.forces.contacts {
                contacts.set_preload(Some(softness));
            }
            let rough = if softness > 0.0 { ROUGH } else { 1.0 };
            let statics = Statics { tolerance: rough * statics.tolerance, ..statics.clone() };
            match solver.equilibrate(&mut self.dynamics, &mut [&mut self.forces], &statics) {
                Ok(_) => settled.unbalanced = None,
                // A stage on the way may end a little short: the next one goes on from there.
                Err(stribeck_solver::Error::NoEquilibrium { residual_n, .. })
                    if residual_n <= ENOUGH * load =>
                {
                    settled.unbalanced = Some(residual_n);
                }
                Err(error) => return Err(error.into()),
            }
        }
        Ok(settled)
    }

    /// Sum of the magnitudes of all loads and weights [N].
    fn loads_and_weights(&self) -> f64 {
        let [gx, gy] = self.dynamics.gravity();
        let loads: f64 =
            self.forces.loads.iter().map(|load| load.magnitude() * load.memory.factor.abs()).sum();
        loads + libm::hypot(gx, gy) * self.dynamics.mass().iter().sum::<f64>()
    }
}
