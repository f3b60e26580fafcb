//! Stiffness damping makes the modes of a bar decay the faster, the higher they are.
//!
//! THEORY §2.7; Géradin and Rixen, *Mechanical Vibrations* (2015), §3.1.
//!
//! # Goal
//!
//! The decay rate of modes over three octaves.
//!
//! # Mesh
//!
//! ```text
//!      ▽  ▽  ▽  ▽         ▽  ▽  ▽
//!     ┌──┬──┬──┬── … ──┬──┬──┐
//!     └──┴──┴──┴── … ──┴──┴──┘    64 squares of 1 mm
//!      △  △  △  △         △  △  △
//!     x = 0                  x = L
//!
//!     vx(x) at the start: cos(kπ x/L)
//! ```
//!
//! # Boundary conditions
//!
//! All nodes are held in y (uniaxial strain); both ends are free in x. The bar vibrates in one longitudinal
//! mode.
//!
//! # Parameters
//!
//! L = 64 mm, k = 1, 2, 4, 8; 10 mm/s at the ends, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; β such that the
//! first mode has 0.2 % of critical damping and the eighth 1.6 %; 20 periods in steps of half the critical
//! one.
//!
//! # Expected
//!
//! A mode of the angular frequency ω has ζ = βω/2: its energy falls as exp(−βω² t).

use std::f64::consts::{PI, TAU};

use stribeck_solver::NodeMotion;
use stribeck_testing::ledger;

use crate::common::*;
use crate::{damp, step_and_count};

/// Eight elements to half a wave lower ω² by (π/8)²/12 = 1.3 % for k = 8; damping acts on kinetic energy,
/// twice a period, and half a step late.
const RATE: f64 = 0.02;

#[test]
fn analytic_stiffness_damping_of_a_bar_grows_with_frequency() {
    let (columns, length) = (64, 0.064);
    let mut model = body(&rectangle(length, 1e-3, columns, 1));
    model.motion.fill(NodeMotion::HeldY);
    for k in [1, 2, 4, 8] {
        let wave = k as f64 * PI / length;
        let omega = wave * steel().dilatational_speed();
        let mut d = lay_out(&model);
        // The first mode has 0.2 % of critical, the eighth 1.6 %.
        let beta = 2.0 * 0.002 / (PI / length * steel().dilatational_speed());
        damp(&mut d, beta, 0.5);
        for s in massive(&d) {
            d.state.vx[s] = 0.01 * (wave * d.state.x[s]).cos();
        }
        let [start, _] = step_and_count(&mut d);
        let steps = (20.0 * TAU / omega / d.time_step()) as usize;
        run(&mut d, &mut [], steps);
        let [left, _] = step_and_count(&mut d);
        let rate = (start / left).ln() / ((steps + 1) as f64 * d.time_step());
        let quantity = format!("bar, stiffness damping of mode {k}");
        let source = "ζ = βω/2, Géradin and Rixen 2015, §3.1";
        ledger::compare(&quantity, source, "1/s", rate, beta * omega * omega, RATE);
    }
}
