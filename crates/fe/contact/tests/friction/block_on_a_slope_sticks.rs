//! A rigid block on a slope below the angle of friction stays where it is.
//!
//! Coulomb's law, THEORY §4.3.
//!
//! # Goal
//!
//! Sticking without creep.
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
//! α = 10°, µ = 0.2, which holds up to arctan µ = 11.3°; g = 9.81 m/s², penalty 10¹¹ Pa/m, damping ratio 0.5,
//! steps of 1 µs; contact points at nodes and integrated.
//!
//! # Expected
//!
//! After a swing to twice the static stretch of its tangential springs, which have 0.8 of the penalty, the
//! block stays.

use crate::common::*;
use crate::{G, STIFFNESS, block};

/// Speed that a tenth of a second of swinging may leave [m/s]; one of sliding under a hundredth of the weight
/// leaves ten times as much.
const SPEED: f64 = 1e-3;

#[test]
fn analytic_block_sticks_below_the_angle_of_friction() {
    for method in METHODS {
        let mut s = block(0.2, method, 10_f64.to_radians());
        s.run(0.05);
        let (early, [vx, _]) = (s.centre()[0], s.velocity());
        // The weight comes on suddenly: the springs swing to twice their static stretch before it settles.
        let stretch = steel().density() * 5e-3 * G / (0.8 * STIFFNESS);
        assert!(early - 5e-3 < 10.0 * stretch, "{method:?}: it has slid {:e} m", early - 5e-3);
        s.run(0.1);
        // A tenth of a second of sliding under a hundredth of the weight would be half a millimetre.
        assert!(
            (s.centre()[0] - early).abs() < 2.0 * stretch,
            "{method:?}: creep {:e} m",
            s.centre()[0] - early
        );
        assert!(vx.abs() < SPEED);
    }
}
