//! A rigid block slides on a floor until friction has stopped it.
//!
//! Coulomb's law, THEORY §4.3.
//!
//! # Goal
//!
//! Friction while a body slides, the instant at which it sticks, and the heat.
//!
//! # Mesh
//!
//! ```text
//!           v →
//!       ┌┬┬┬┬┬┬┬┬┬┐
//!       ├┼┼┼┼┼┼┼┼┼┤   10 × 5 cells, 10 × 5 mm         ↓ g
//!       └┴┴┴┴┴┴┴┴┴┘
//!   ┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬
//!   └┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┘   80 × 1 cells of 1 mm
//!    ▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧
//! ```
//!
//! # Boundary conditions
//!
//! The block is rigid and starts as deep in the floor as its weight presses it; all nodes of the floor are
//! held.
//!
//! # Parameters
//!
//! v = 0.2 m/s, µ = 0.2, g = 9.81 m/s², penalty 10¹¹ Pa/m, damping ratio 0.5, steps of 1 µs; contact points
//! at nodes and integrated.
//!
//! # Expected
//!
//! It stops after v²/(2 µ g), in the time v/(µ g), its energy ½ m v² turned into heat; then it stays.

use stribeck_solver::Force;
use stribeck_testing::assert_close;

use crate::common::*;
use crate::{G, block};

/// A tenth of the speed is a difference of two that the springs of normal contact make swing by some per
/// mille.
const SPEED: f64 = 0.02;

/// The block swings on its tangential springs as it comes to rest, within some micrometres of 10 mm.
const WAY: f64 = 0.005;

/// The damping of the normal springs, and the last swing, take energy too.
const HEAT: f64 = 0.01;

/// The swing of the tangential springs after the stop [m].
const SWING: f64 = 1e-7;

#[test]
fn analytic_block_slides_to_a_stop() {
    let (speed, friction) = (0.2, 0.2);
    for method in METHODS {
        let mut s = block(friction, method, 0.0);
        s.d.launch_rigid(0, [speed, 0.0], 0.0);
        let from = s.centre()[0];
        s.run(0.9 * speed / (friction * G));
        assert_close(s.velocity()[0], 0.1 * speed, SPEED, "speed left after nine tenths of the time");
        s.run(0.3 * speed / (friction * G));
        let stopped = s.centre()[0];
        assert_close(stopped - from, speed * speed / (2.0 * friction * G), WAY, "way to stop");
        let energy = 0.5 * s.mass() * speed * speed;
        assert_close(s.contacts.energy().friction, energy, HEAT, "heat of friction");
        s.run(0.05);
        assert!((s.centre()[0] - stopped).abs() < SWING, "it creeps by {:e} m", s.centre()[0] - stopped);
    }
}
