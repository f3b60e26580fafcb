//! Structural damping gives each mode of a bar the ratio of its branch.
//!
//! THEORY §2.8; the logarithmic decrement is 2πζ, Géradin and Rixen, *Mechanical Vibrations* (2015), §3.1.
//!
//! # Goal
//!
//! Damping ratio and frequency of modes within and beside the band for which the branch is fitted.
//!
//! # Mesh
//!
//! ```text
//!      ▽  ▽  ▽  ▽         ▽  ▽  ▽
//!     ┌──┬──┬──┬── … ──┬──┬──┐
//!     └──┴──┴──┴── … ──┴──┴──┘    128 squares of 2 mm
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
//! L = 256 mm, k = 1, 2, 4, 8; 10 mm/s at the ends, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; a branch for a
//! ratio of 0.01 from 10 to 100 kHz; 12 cycles in steps of half the critical one.
//!
//! # Expected
//!
//! Decay and frequency are the root of s² + ω₀² (1 + g sτ/(1 + sτ)) = 0 near iω₀.

use std::f64::consts::{PI, TAU};

use stribeck_solver::{NodeMotion, structural_damping::StructuralDamping};
use stribeck_testing::{assert_close, ledger};

use crate::common::*;
use crate::{damp, ring_down, root};

/// Peaks of the amplitude, and the ratio's own change with the mesh's lower frequency.
const RATIO: f64 = 0.02;

/// 16 elements to half a wave lower ω by (π/16)²/24 = 0.16 %.
const FREQUENCY: f64 = 0.005;

/// The band's ratio is that of a small loss factor: stiffness itself rises by 4ζ/π over a factor of e in
/// frequency.
const PROMISED: f64 = 0.02;

#[test]
fn analytic_structural_damping_of_a_bar_is_that_of_the_branch() {
    let (columns, length) = (128, 0.256);
    let mut model = body(&rectangle(length, 2e-3, columns, 1));
    model.motion.fill(NodeMotion::HeldY);
    let speed = steel().dilatational_speed();
    for k in [1, 2, 4, 8] {
        let wave = k as f64 * PI / length;
        let mut d = lay_out(&model);
        let fit = StructuralDamping::over_band(0.01, [1e4, 1e5], vec![0]).expect("a possible band");
        damp(&mut d, fit.branch(), vec![0], 0.5);
        let shape: Vec<[f64; 2]> = d.state.x.iter().map(|x| [0.01 * (wave * x).cos(), 0.0]).collect();
        let [omega, ratio] = ring_down(&mut d, &shape, wave * speed, 12.0);
        let source = "root of s² + ω₀²(1 + g sτ/(1 + sτ)), THEORY §2.8";
        let [decay, expected] = root(fit.branch(), wave * speed);
        let quantity = format!("bar, structural damping, ratio of mode {k}");
        ledger::compare(&quantity, source, "-", ratio, decay / expected, RATIO);
        let quantity = format!("bar, structural damping, frequency of mode {k}");
        ledger::compare(&quantity, source, "rad/s", omega, expected, FREQUENCY);
        assert_close(decay / expected, fit.ratio(expected / TAU), PROMISED, "half the loss factor");
    }
}
