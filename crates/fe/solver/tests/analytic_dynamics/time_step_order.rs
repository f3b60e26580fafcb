//! A bar vibrates in its first longitudinal mode; halving the time step quarters the error.
//!
//! THEORY §2.3: central differences are of second order.
//!
//! # Goal
//!
//! The observed order of the time integration, on a mesh that stays the same.
//!
//! # Mesh
//!
//! ```text
//!    ▽   ▽   ▽   ▽                ▽   ▽   ▽
//!   17──18──19──20── …        ──31──32──33
//!    │   │   │   │                │   │   │    1 mm, one row
//!    0───1───2───3── …        ──14──15──16  → displacement
//!    △   △   △   △                △   △   △
//!    x = 0                        x = L
//!
//!   vx(x) at the start:  → →  →  ·  ←  ← ←
//! ```
//!
//! 16 squares of 1 mm.
//!
//! # Boundary conditions
//!
//! All nodes are held in y (uniaxial strain); both ends are free in x. The bar starts undeformed at vx = v
//! cos(π x/L): the acceleration is zero then, so this is the velocity half a step earlier too.
//!
//! # Parameters
//!
//! L = 16 mm, v = 10 mm/s, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; three quarters of a period in steps of 0.8,
//! 0.4 and 0.2 of the critical one.
//!
//! # Expected
//!
//! Against the end's displacement with a step 32 times shorter than the first, errors fall fourfold with each
//! halving.

use std::f64::consts::PI;

use stribeck_solver::NodeMotion;
use stribeck_testing::orders;

use crate::common::*;

/// The term of fourth order adds a little to the coarsest step; the reference's own error, 1/64 of the
/// finest, adds the rest.
const ORDERS: std::ops::Range<f64> = 1.9..2.2;

#[test]
fn converges_time_step_second_order() {
    let (columns, length) = (16, 0.016);
    let mut model = body(&rectangle(length, 1e-3, columns, 1));
    model.motion.fill(NodeMotion::HeldY);
    let critical = lay_out(&model).critical_time_step(&[], 0.0).time_step;
    let steps = (1.5 * length / steel().dilatational_speed() / (0.8 * critical)).ceil() as usize;
    let end = |refined: usize| {
        let mut d = lay_out(&model);
        d.set_time_step(0.8 * critical / refined as f64).expect("a positive time step");
        for s in massive(&d) {
            d.state.vx[s] = 0.01 * (PI * d.state.x[s] / length).cos();
        }
        run(&mut d, &mut [], steps * refined);
        d.state.x[slot(&d, columns)] - length
    };
    let exact = end(32);
    let errors = [1, 2, 4].map(|refined| (end(refined) - exact).abs());
    for order in orders(&errors) {
        assert!(ORDERS.contains(&order), "order {order}, errors {errors:?} m of {exact:e} m");
    }
}
