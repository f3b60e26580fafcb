//! A rigid disc bounces on a floor without loss.
//!
//! Kleppner and Kolenkow, *An Introduction to Mechanics* (2014), chapter 5.
//!
//! # Goal
//!
//! Flight and contact by turns: contact sets in and ends without energy from nowhere.
//!
//! # Mesh
//!
//! ```text
//!            .─.
//!          (     )    disc of 64 facets, r = 5 mm          ↓ g
//!            '─'
//!              ↕ h = 0.1 mm
//!   ┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬
//!   └┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┘   80 × 1 cells of 1 mm
//!    ▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧
//! ```
//!
//! # Boundary conditions
//!
//! The disc is rigid and falls from rest, a corner downwards; all nodes of the floor are held.
//!
//! # Parameters
//!
//! g = 9.81 m/s², penalty 10¹² Pa/m, neither friction nor damping, steps of 1 µs, contact points at nodes.
//!
//! # Expected
//!
//! It falls for √(2h/g), comes back to h, and each flight between two contacts lasts 2 √(2h/g).

use stribeck_contact::{Law, Method};
use stribeck_testing::{assert_close, ledger};

use crate::common::*;
use crate::{G, OnFloor, STEP};

/// Time is counted in steps, and a contact sets in within one: 1 µs of 4.5 ms, at either end of the fall.
const FALL: f64 = 1e-3;

/// As the fall, and the energy of a spring that sets in within a step.
const FLIGHT: f64 = 2e-3;

/// It bounces on a corner, an unstable place: rounding grows a thousandfold in each bounce, but to nothing
/// yet [rad/s].
const SPIN: f64 = 1e-3;

#[test]
fn analytic_bouncing_disc() {
    let (radius, height) = (5e-3, 0.1e-3);
    let part = disc(radius, 64, 0.5e-3).translated(0.0, radius + height);
    let law = Law::penalty(1e12).expect("a positive stiffness");
    let mut s = OnFloor::new(&part, "rim", law, Method::Collocated, [0.0, -G]);
    let (mut lifts, mut lands, mut highest, mut touching) = (Vec::new(), Vec::new(), 0.0_f64, false);
    while lands.len() < 4 {
        s.run(STEP);
        let touches = s.contacts.resultants().any(|r| r.force[1] > 0.0);
        if touches && !touching {
            lands.push(s.d.state.time);
        } else if touching && !touches {
            lifts.push(s.d.state.time);
        }
        touching = touches;
        if !lifts.is_empty() {
            highest = highest.max(s.centre()[1] - radius);
        }
        assert!(s.d.state.time < 0.1, "it stopped bouncing: {lands:?}");
    }
    let fall = (2.0 * height / G).sqrt();
    ledger::compare("bouncing disc, first fall", "√(2h/g)", "s", lands[0], fall, FALL);
    for (lift, land) in lifts.iter().zip(&lands[1..]) {
        assert_close(land - lift, 2.0 * fall, FLIGHT, "flight");
    }
    ledger::compare("bouncing disc, height of the rebound", "energy", "m", highest, height, FLIGHT);
    assert!(s.d.rigid[0].spin.abs() < SPIN, "{:?}", s.d.rigid[0]);
}
