//! A pulse runs along a strip at the speed of pressure waves.
//!
//! Achenbach, *Wave Propagation in Elastic Solids* (1973), §1.3.
//!
//! # Goal
//!
//! The speed at which a longitudinal pulse travels through the mesh, and the area under it, which travels
//! along.
//!
//! # Mesh
//!
//! ```text
//!       pulse u(x, 0)
//!           _
//!          ╱ ╲  → c
//!   ______╱   ╲______________________________________
//!
//!    ▽   ▽   ▽   ▽   ▽   ▽   ▽   ▽   ▽   ▽   ▽   ▽   ▽
//!   401─402─403─ … ────────────────────────────── … ─801
//!    │   │   │   │   │   │   │   │   │   │   │   │   │     1 mm, one row
//!    0───1───2── … ─────────────────────────────── … ─400
//!    △   △   △   △   △   △   △   △   △   △   △   △   △
//!    x = 0         0.1 m: start      0.3 m: end     0.4 m
//! ```
//!
//! 400 squares of 1 mm.
//!
//! # Boundary conditions
//!
//! All nodes are held in y (uniaxial strain); both ends are free in x.
//!
//! # Parameters
//!
//! E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; 0.9 of the critical time step. The pulse is 0.1 µm high and falls to
//! 1/e within 20 mm to either side.
//!
//! # Expected
//!
//! u(x, t) = f(x − c t) with c² = (λ + 2µ)/ρ; its area is height · width · √π.

use std::f64::consts::PI;

use stribeck_solver::NodeMotion;
use stribeck_testing::{assert_close, ledger};

use crate::common::*;

/// A wave of 40 cells, k h = 2π/40, runs (k h)²/24 = 0.1 % slow, less the lead from the time step.
const SPEED: f64 = 1e-3;

/// The velocities at the start are those of the continuum. The difference in the mesh, whose waves are 0.1 %
/// slower, travels the other way as a wave of half that share.
const AREA: f64 = 1e-3;

#[test]
fn analytic_speed_of_a_pressure_wave() {
    let (columns, cell) = (400, 1e-3);
    let mut model = body(&rectangle(columns as f64 * cell, cell, columns, 1));
    model.motion.fill(NodeMotion::HeldY);
    let mut d = ready(&model, 0.9);

    let c = steel().dilatational_speed();
    let (start, width, height) = (0.1, 0.02, 1e-7);
    let pulse = |x: f64, t: f64| height * (-((x - start - c * t) / width).powi(2)).exp();
    let half = 0.5 * d.time_step();
    for n in 0..model.mesh.x.len() {
        let (x, s) = (model.mesh.x[n], slot(&d, n));
        d.state.x[s] += pulse(x, 0.0);
        // ∂u/∂t half a step earlier.
        let xi = (x - start + c * half) / width;
        d.state.vx[s] = 2.0 * c / width * xi * pulse(x, -half);
    }
    let steps = (0.2 / c / d.time_step()) as usize;
    run(&mut d, &mut [], steps);

    let (mut sum, mut moment) = (0.0, 0.0);
    for n in 0..=columns {
        let u = d.state.x[slot(&d, n)] - model.mesh.x[n];
        sum += u;
        moment += u * model.mesh.x[n];
    }
    let speed = (moment / sum - start) / d.state.time;
    let source = "√((λ + 2µ)/ρ): Achenbach 1973, §1.3";
    ledger::compare("speed of a pressure wave of 40 cells", source, "m/s", speed, c, SPEED);
    assert_close(sum * cell, height * width * PI.sqrt(), AREA, "area of the pulse");
}
