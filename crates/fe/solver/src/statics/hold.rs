//! How firmly bodies that nothing holds yet are held while the iteration runs.

use crate::{dynamics::Dynamics, rigid::RigidMotion, state::NodeForces};

/// Least mass-proportional stiffness [1/s²]: keeps the matrix definite where nothing else does.
const LEAST_HOLD: f64 = 1e5;

/// Mass-proportional stiffness [1/s²] that keeps a body's unbalanced resultant from moving it farther than
/// `step`.
pub(super) fn hold(d: &Dynamics, slots: &[u32], force: &NodeForces, step: f64) -> f64 {
    let s = &d.state;
    let body = RigidMotion::of(
        slots.iter().map(|&n| (d.mass()[n as usize], [s.x[n as usize], s.y[n as usize]], [0.0; 2])),
    );
    let (mut fx, mut fy, mut torque) = (0.0, 0.0, 0.0);
    for &n in slots {
        let n = n as usize;
        let [free_x, free_y] = d.free_components(n);
        let (px, py) = (if free_x { force.fx[n] } else { 0.0 }, if free_y { force.fy[n] } else { 0.0 });
        fx += px;
        fy += py;
        torque += (s.x[n] - body.centre[0]) * py - (s.y[n] - body.centre[1]) * px;
    }
    let gyration = (body.inertia / body.mass).sqrt();
    let push = (libm::hypot(fx, fy)).max(torque.abs() / gyration);
    (push / (body.mass * step)).max(LEAST_HOLD)
}
