//! A rigid block on a slope above the angle of friction slides down.
//!
//! Coulomb's law, THEORY §4.3.
//!
//! # Goal
//!
//! Steady sliding: friction is the limit, against the motion.
//!
//! # Mesh
//!
//! ```text
//!      y                       In axes along the slope:
//!      │      ┌┬┬┬┬┬┬┬┬┬┐
//!      │      ├┼┼┼┼┼┼┼┼┼┤   10 × 5 cells, 10 × 5 mm      g sin α →
//!      │      └┴┴┴┴┴┴┴┴┴┘                                g cos α ↓
//!      └──┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬ → x, downhill
//!         └┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┘   80 × 1 cells of 1 mm
//!          ▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧
//! ```
//!
//! # Boundary conditions
//!
//! The block is rigid and starts at rest as deep in the floor as its weight presses it; all nodes of the
//! floor are held.
//!
//! # Parameters
//!
//! α = 16°, µ = 0.2, g = 9.81 m/s², penalty 10¹¹ Pa/m, damping ratio 0.5, steps of 1 µs; contact points at
//! nodes and integrated.
//!
//! # Expected
//!
//! a = g (sin α − µ cos α), over 50 ms after the first 10.

use stribeck_contact::Method;
use stribeck_testing::ledger;

use crate::common::*;
use crate::{G, block};

/// The normal force still swings a little about the weight, and friction with it.
const ACCELERATION: f64 = 0.005;

#[test]
fn analytic_block_slides_above_the_angle_of_friction() {
    let slope = 16_f64.to_radians();
    let (expected, span) = (G * (slope.sin() - 0.2 * slope.cos()), 0.05);
    for method in METHODS {
        let mut s = block(0.2, method, slope);
        s.run(0.01);
        let (v, t) = (s.velocity()[0], s.d.state.time);
        s.run(span);
        let found = (s.velocity()[0] - v) / (s.d.state.time - t);
        let how = if method == Method::Collocated { "collocated" } else { "integrated" };
        let source = "g (sin α − µ cos α)";
        let quantity = format!("block on a slope, acceleration, {how}");
        ledger::compare(&quantity, source, "m/s²", found, expected, ACCELERATION);
    }
}
