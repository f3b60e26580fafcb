//! Mass damping on an orbit acts on a disc's velocity across it, and on all motion that is not rigid.
//!
//! THEORY §2.6.
//!
//! # Goal
//!
//! The frame of damping of a body that runs around a centre: running and spin stay, drift and deformation
//! fall.
//!
//! # Mesh
//!
//! ```text
//!                    ↖ orbit
//!                  .─.   ↗ drift
//!                (  ↺  )            disc of 24 facets, r = 10 mm
//!             ╱    '─'
//!          ╱  R = 0.5 m
//!       +
//!     centre
//! ```
//!
//! # Boundary conditions
//!
//! None. The disc runs about the centre, spins about itself, drifts outwards and stretches.
//!
//! # Parameters
//!
//! Orbit 20 rad/s, spin −150 rad/s, drift 3 m/s, stretch 40/s along x and −40/s along y; α = 10⁶/s; one step
//! of 0.9 of the critical one, in which nothing else pushes.
//!
//! # Expected
//!
//! Orbit and spin stay; drift and stretch fall by (1 − αΔt/2)/(1 + αΔt/2).

use stribeck_solver::damping::Frame;

use crate::common::*;
use crate::{all, damp, disc_at};

/// The unsymmetric mesh gives the stretch a little angular momentum, which the frame takes for spin: 5e-6 m/s
/// at the rim, where a stretch of 40/s is 0.4 m/s [m/s].
const SPEED: f64 = 2e-5;

#[test]
fn analytic_mass_damping_on_an_orbit_takes_the_velocity_across_it() {
    let mut d = ready(&disc_at(0.3, 0.4), 0.9);
    let (orbit, spin, drift, rate) = (20.0, -150.0, 3.0, 1e6);
    damp(&mut d, rate, Frame::Tangential { centre: [0.0; 2] });
    // The centre of mass; that of a mesh of cells of all shapes is not quite that of the circle.
    let [cx, cy] = d.rigid_motion(&all(&d)).centre;
    let radius = cx.hypot(cy);
    let half = 0.5 * rate * d.time_step();
    let keep = (1.0 - half) / (1.0 + half);
    let mut expected = Vec::new();
    for n in massive(&d) {
        let (x, y) = (d.state.x[n], d.state.y[n]);
        let u = [-orbit * cy - spin * (y - cy), orbit * cx + spin * (x - cx)];
        // The drift and a stretch, which carries neither momentum nor angular momentum.
        let off = [drift * cx / radius + 40.0 * (x - cx), drift * cy / radius - 40.0 * (y - cy)];
        (d.state.vx[n], d.state.vy[n]) = (u[0] + off[0], u[1] + off[1]);
        expected.push([u[0] + keep * off[0], u[1] + keep * off[1]]);
    }
    d.step(&mut []);
    for (n, v) in massive(&d).into_iter().zip(expected) {
        let off = (d.state.vx[n] - v[0]).hypot(d.state.vy[n] - v[1]);
        assert!(off < SPEED, "slot {n}: {off:e} m/s");
    }
}
