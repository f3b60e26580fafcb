//! Mass-proportional damping, relative to the rigid motion of each body or to rest (THEORY §2.6).

use crate::{dynamics::Dynamics, rigid::RigidMotion};

/// Mass-proportional damping, applied now and then as the exact decay over the time that has passed: between two
/// applications it costs nothing.
#[derive(Debug, Clone)]
pub struct MassDamping {
    /// Rate α [1/s]; 2·ζ·ω gives the damping ratio ζ at the angular frequency ω.
    pub rate: f64,
    /// Relative to the rigid motion of each body (rolling is not braked) or to rest.
    pub relative: bool,
    /// Slots of each damped body.
    pub bodies: Vec<Vec<u32>>,
    /// Energy turned into heat so far [J].
    pub dissipated: f64,
}

impl MassDamping {
    /// Lets the velocities decay over `span` [s].
    pub fn apply(&mut self, dynamics: &mut Dynamics, span: f64) {
        let keep = (-self.rate * span).exp();
        for slots in &self.bodies {
            let motion = if self.relative { dynamics.rigid_motion(slots) } else { RigidMotion::default() };
            let mut taken = 0.0;
            for &n in slots {
                let n = n as usize;
                let rigid = motion.velocity_at([dynamics.state.x[n], dynamics.state.y[n]]);
                let before = [dynamics.state.vx[n], dynamics.state.vy[n]];
                let after =
                    [rigid[0] + keep * (before[0] - rigid[0]), rigid[1] + keep * (before[1] - rigid[1])];
                let squares = before[0] * before[0] + before[1] * before[1]
                    - (after[0] * after[0] + after[1] * after[1]);
                taken += 0.5 * dynamics.mass()[n] * squares;
                dynamics.state.vx[n] = after[0];
                dynamics.state.vy[n] = after[1];
            }
            self.dissipated += taken;
        }
    }
}
