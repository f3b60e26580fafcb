//! Mass damping relative to rest brakes a block in flight.
//!
//! THEORY §2.6.
//!
//! # Goal
//!
//! The rate at which damping takes velocity, step by step.
//!
//! # Mesh
//!
//! ```text
//!     ┌┬┬┬┐
//!     ├┼┼┼┤  → v      10 × 10 mm, 4 × 4 cells
//!     ├┼┼┼┤
//!     └┴┴┴┘
//! ```
//!
//! # Boundary conditions
//!
//! None; the whole block starts at v.
//!
//! # Parameters
//!
//! v₀ = 2 m/s, α = 30 000/s; 1000 steps of 0.9 of the critical one.
//!
//! # Expected
//!
//! v = v₀ exp(−α t). A step takes (1 − αΔt/2)/(1 + αΔt/2) for exp(−αΔt), which is off by (αΔt)²/12 of the
//! exponent.

use stribeck_solver::damping::Frame;
use stribeck_testing::assert_close;

use crate::common::*;
use crate::{all, damp};

/// The error known in closed form, and a tenth of it for the terms of higher order.
const OF_THE_KNOWN_ERROR: f64 = 1.1;

#[test]
fn analytic_mass_damping_brakes_a_flight() {
    let mut d = ready(&body(&rectangle(0.01, 0.01, 4, 4)), 0.9);
    let rate = 3e4;
    damp(&mut d, rate, Frame::Rest);
    d.state.vx.fill(2.0);
    run(&mut d, &mut [], 1000);
    let expected = 2.0 * (-rate * d.state.time).exp();
    let share = (rate * d.time_step()).powi(2) / 12.0 * rate * d.state.time;
    assert_close(d.rigid_motion(&all(&d)).velocity[0], expected, OF_THE_KNOWN_ERROR * share, "speed");
}
