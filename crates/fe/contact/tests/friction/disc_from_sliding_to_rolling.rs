//! A rigid disc set down without spin slides, spins up and ends rolling.
//!
//! Kleppner and Kolenkow, *An Introduction to Mechanics* (2014), chapter 7.
//!
//! # Goal
//!
//! Friction and rotation together; rolling without slip on a polygon.
//!
//! # Mesh
//!
//! ```text
//!            .─.
//!          ╱     ╲   v₀ →
//!         (   r   )          disc of 256 facets, r = 20 mm       ↓ g
//!          ╲     ╱
//!            '─'
//!   ┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬
//!   └┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┘  80 × 1 cells of 1 mm
//!    ▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧
//! ```
//!
//! # Boundary conditions
//!
//! The disc is rigid and starts touching the floor; all nodes of the floor are held.
//!
//! # Parameters
//!
//! v₀ = 0.15 m/s, µ = 0.3, g = 9.81 m/s², penalty 10¹³ Pa/m, damping ratio 0.3, steps of 1 µs, four contact
//! points a facet.
//!
//! # Expected
//!
//! Sliding, the disc slows down by µ g. Friction passes through the contact, about which the angular momentum
//! m v r + I ω is kept, so that it ends rolling at v₀ r²/(r² + I/m), 2/3 v₀ for a full disc, whatever µ is.

use stribeck_contact::{Law, Method};
use stribeck_testing::{assert_close, ledger};

use crate::common::*;
use crate::{G, OnFloor};

/// A polygon rolls over its corners; 256 of them lift it by 1.5 µm, 0.2 % of its energy, and make it rock,
/// which the mean over ten milliseconds leaves a part of.
const ROLLING: f64 = 0.01;

/// Sliding, the normal force swings about the weight after the disc is set down.
const SLIDING: f64 = 0.02;

#[test]
fn analytic_from_sliding_to_rolling() {
    let (radius, speed, friction) = (0.02, 0.15, 0.3);
    let law = Law::penalty(1e13)
        .and_then(|l| l.with_friction(friction))
        .and_then(|l| l.with_damping(0.3, 10.0))
        .expect("a possible law");
    let part = disc(radius, 256, 1.5e-3).translated(0.0, radius);
    let mut s = OnFloor::new(&part, "rim", law, Method::Integrated { points: 4 }, [0.0, -G]);
    let mass = s.mass();
    let body = s.d.rigid_motion(&of_body(&s.d, &s.model, 0));
    s.d.launch_rigid(0, [speed, 0.0], 0.0);
    s.run(0.01);
    assert_close(s.velocity()[0], speed - friction * G * 0.01, SLIDING, "speed while it slides");
    s.run(0.02);
    let expected = speed * radius * radius / (radius * radius + body.inertia / mass);
    assert_close(expected, 2.0 / 3.0 * speed, ROLLING, "this polygon against a disc");
    let (from, angle) = (s.centre()[0], s.d.rigid[0].angle);
    s.run(0.01);
    let (way, turn) = (s.centre()[0] - from, s.d.rigid[0].angle - angle);
    let source = "v₀ r²/(r² + I/m)";
    ledger::compare("from sliding to rolling, speed", source, "m/s", way / 0.01, expected, ROLLING);
    assert_close(-turn * radius, way, ROLLING, "it rolls without slip, clockwise to the right");
}
