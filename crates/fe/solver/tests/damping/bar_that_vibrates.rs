//! Mass damping makes a bar's vibration decay.
//!
//! THEORY §2.6.
//!
//! # Goal
//!
//! The decay of a mode, whatever its frequency is.
//!
//! # Mesh
//!
//! ```text
//!      ▽  ▽  ▽  ▽         ▽  ▽  ▽
//!     ┌──┬──┬──┬── … ──┬──┬──┐
//!     └──┴──┴──┴── … ──┴──┴──┘    40 squares of 1 mm
//!      △  △  △  △         △  △  △
//!     x = 0                  x = L
//!
//!     vx(x) at the start: cos(π x/L)
//! ```
//!
//! # Boundary conditions
//!
//! All nodes are held in y (uniaxial strain); both ends are free in x. The bar vibrates in its first
//! longitudinal mode.
//!
//! # Parameters
//!
//! L = 40 mm, 10 mm/s at the ends, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; α = 0.02 ω, which is one per cent of
//! critical damping, relative to the bar's own rigid motion; 30 periods in steps of 0.9 of the critical one.
//!
//! # Expected
//!
//! The amplitude of a lightly damped oscillator falls as exp(−α t/2), its energy as exp(−α t).

use std::f64::consts::{PI, TAU};

use stribeck_solver::{NodeMotion, damping::Frame};
use stribeck_testing::assert_close;

use crate::common::*;
use crate::{damp, step_and_count};

/// Damping takes kinetic energy only, so within a period the energy falls in two steps about the mean, 2 % of
/// an exponent of four.
const EXPONENT: f64 = 0.02;

#[test]
fn analytic_mass_damping_decays_a_vibration() {
    let (columns, length) = (40, 0.04);
    let mut model = body(&rectangle(length, 1e-3, columns, 1));
    model.motion.fill(NodeMotion::HeldY);
    let mut d = ready(&model, 0.9);
    // One per cent of critical, over 30 periods.
    let omega = PI * steel().dilatational_speed() / length;
    let rate = 0.02 * omega;
    damp(&mut d, rate, Frame::OwnMotion);
    for s in massive(&d) {
        d.state.vx[s] = 0.01 * (PI * d.state.x[s] / length).cos();
    }
    let [start, _] = step_and_count(&mut d);
    let steps = (30.0 * TAU / omega / d.time_step()) as usize;
    run(&mut d, &mut [], steps);
    let [left, _] = step_and_count(&mut d);
    let span = (steps + 1) as f64 * d.time_step();
    assert_close((left / start).ln(), -rate * span, EXPONENT, "logarithm of the energy left");
}
