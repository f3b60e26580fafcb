//! Loads on nodes that may be scaled as time goes on.

use serde::{Deserialize, Serialize};
use stribeck_solver::{
    Force,
    state::{Energy, Moment, NodeForces},
};

/// Forces on nodes, all scaled by one factor.
#[derive(Debug)]
pub(crate) struct Load {
    pub(crate) name: String,
    /// Slot and force [N] at a factor of one.
    pushes: Vec<(u32, f64, f64)>,
    pub(crate) memory: LoadMemory,
}

/// State of a load from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct LoadMemory {
    /// Scale factor of the forces [-], now and in the step before.
    pub(crate) factor: f64,
    before: f64,
    /// Work done since the start [J].
    pub(crate) supplied: f64,
}

impl Load {
    pub(crate) fn new(name: String, pushes: Vec<(u32, f64, f64)>) -> Self {
        Self { name, pushes, memory: LoadMemory { factor: 1.0, before: 1.0, supplied: 0.0 } }
    }

    /// Σ of the magnitudes at a factor of one [N].
    pub(crate) fn magnitude(&self) -> f64 {
        self.pushes.iter().map(|(_, fx, fy)| libm::hypot(*fx, *fy)).sum()
    }
}

impl Force for Load {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        let LoadMemory { factor, before, supplied } = &mut self.memory;
        // The velocity times the step is the displacement since the last call. The force at its beginning was
        // the previous one, at its end it is the present one: the leapfrog scheme conserves energy with their
        // mean.
        let mean = 0.5 * (*before + *factor);
        for &(slot, fx, fy) in &self.pushes {
            let n = slot as usize;
            force.fx[n] += *factor * fx;
            force.fy[n] += *factor * fy;
            *supplied += at.dt * (mean * fx * at.vx[n] + mean * fy * at.vy[n]);
        }
        *before = *factor;
    }

    fn energy(&self) -> Energy {
        Energy { supplied: self.memory.supplied, ..Energy::default() }
    }
}
