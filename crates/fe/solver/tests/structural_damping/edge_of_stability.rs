//! The critical time step of structural damping is that of stiffer elements.
//!
//! THEORY §2.8, (2.38).
//!
//! # Goal
//!
//! Nothing grows just below the predicted step, and the highest mode does just above it.
//!
//! # Mesh
//!
//! ```text
//!     ┌─┬─┬─┬─┐
//!     ├─┼─┼─┼─┤    4 × 3 squares of 1 mm
//!     ├─┼─┼─┼─┤
//!     └─┴─┴─┴─┘
//! ```
//!
//! # Boundary conditions
//!
//! None; velocities of noise up to 1 mm/s.
//!
//! # Parameters
//!
//! E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; one branch of g = 0.1 or 0.5, its relaxation time 3 to 300 critical
//! steps; 6000 steps.
//!
//! # Expected
//!
//! Stable up to Δt₀/√(1 + g).

use stribeck_solver::structural_damping::Branch;
use stribeck_testing::{Noise, assert_close};

use crate::common::*;
use crate::damp;

/// The search for the largest eigenvalue stops at most this far above it.
const BOUND: f64 = 2e-3;

/// Below the edge: the step is known within 0.1 %, half the error of the eigenvalue.
const STABLE: f64 = 0.999;

/// Above it by more than the bound of the eigenvalue.
const UNSTABLE: f64 = 1.004;

#[test]
fn analytic_the_edge_of_stability_is_that_of_the_stiffer_elements() {
    let model = body(&rectangle(4e-3, 3e-3, 4, 3));
    let undamped = lay_out(&model).critical_time_step(&[], 0.0).time_step;
    for (stiffness, over_step) in [(0.1, 300.0), (0.5, 30.0), (0.5, 3.0)] {
        let branch = Branch { stiffness, relaxation_time: over_step * undamped };
        let mut d = lay_out(&model);
        damp(&mut d, branch, vec![0], 1.0);
        assert_close(d.time_step(), undamped / (1.0 + stiffness).sqrt(), BOUND, "critical step");
        let edge = undamped / (1.0 + stiffness).sqrt();
        let largest = |factor: f64| {
            let mut d = lay_out(&model);
            damp(&mut d, branch, vec![0], 1.0);
            d.set_time_step(factor * edge).expect("a positive time step");
            let mut noise = Noise::new(6);
            for n in massive(&d) {
                (d.state.vx[n], d.state.vy[n]) = (1e-3 * noise.uniform(), 1e-3 * noise.uniform());
            }
            run(&mut d, &mut [], 6000);
            let speeds = massive(&d).into_iter().map(|n| d.state.vx[n].abs());
            speeds.map(|v| if v.is_nan() { f64::INFINITY } else { v }).fold(0.0, f64::max)
        };
        let (below, above) = (largest(STABLE), largest(UNSTABLE));
        assert!(below < 3e-3, "{branch:?}: {below:e} m/s below the limit");
        assert!(above > 1.0, "{branch:?}: {above:e} m/s above the limit");
    }
}
