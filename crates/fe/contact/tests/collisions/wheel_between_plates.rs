//! A rigid wheel with a round rim bounces between two plates, and all the way back.
//!
//! # Goal
//!
//! Contact on smooth surfaces over many collisions: forces are the gradient of a potential and have no
//! memory.
//!
//! # Mesh
//!
//! ```text
//!    ▧▧▧▧▧▧▧▧▧
//!   ┌─┬─┬─┬─┐       4 × 1 cells of 1 mm
//!   └─┴─┴─┴─┘
//!      .─.          gap 0.5 µm
//!    (  +  )  ↕     wheel of 32 facets, r = 5 mm; its rim is an arc that moves as a spline
//!      '─'          gap 0.5 µm
//!   ┌─┬─┬─┬─┐
//!   └─┴─┴─┴─┘       4 × 1 cells of 1 mm
//!    ▧▧▧▧▧▧▧▧▧
//! ```
//!
//! # Boundary conditions
//!
//! All nodes of the plates are held. The wheel is rigid and starts in the middle at 0.5 m/s downwards; after
//! 1000 contacts, in flight, its velocity is turned round.
//!
//! # Parameters
//!
//! ρ = 7800 kg/m³; penalty 10¹⁴ Pa/m with a soft onset over 0.2 µm, twelve contact points a facet, neither
//! friction nor damping; a tenth of the critical time step.
//!
//! # Expected
//!
//! The speed in flight stays constant, and after as many steps back the wheel is where it started.

use stribeck_contact::{Law, Method, Smoothing};
use stribeck_solver::{Behaviour, NodeMotion};

use crate::common::*;

/// Largest change of the wheel's energy under central differences at a tenth of the critical step: where
/// within a step the points of contact set in is chance.
const LEAPFROG: f64 = 1e-3;

/// The way back is the way there to the rounding of up to a few million steps [m].
const ROUNDING: f64 = 1e-12;

#[test]
fn conserves_energy_over_a_thousand_bounces_on_curves() {
    let (radius, gap) = (5e-3, 0.5e-6);
    let mut scene = Scene::default();
    let wheel = scene.add("wheel", &disc(radius, 32, 1e-3), "rim");
    let floor = rectangle([-2e-3, -radius - gap - 1e-3], 4e-3, 1e-3, 4, 1);
    let ceiling = rectangle([-2e-3, radius + gap], 4e-3, 1e-3, 4, 1);
    let plates = [scene.add("floor", &floor, "top"), scene.add("ceiling", &ceiling, "bottom")];
    let law = Law::penalty(1e14).and_then(|law| law.with_onset(0.2e-6)).expect("a possible law");
    for plate in plates {
        scene.pair(wheel, plate, law, Method::Integrated { points: 12 });
    }
    let mut model = scene.model();
    model.behaviour[wheel] = Behaviour::Rigid;
    for plate in plates {
        model.motion[model.mesh.bodies[plate].nodes.clone()].fill(NodeMotion::Held);
    }
    let arc = Smoothing::Arc { centre: [0.0; 2] };
    let curves = [(arc, true), (Smoothing::Facet, false), (Smoothing::Facet, false)];
    let (mut d, mut contacts) = scene.lay_out_smooth(&model, &curves);
    set_step(&mut d, &contacts, 0.1);
    let speed = 0.5;
    d.launch_rigid(0, [0.0, -speed], 0.0);
    let start = d.rigid[0].centre;
    let (mut bounces, mut touching, mut worst) = (0, false, 0.0_f64);
    // It ends in flight, where a half step of force makes no difference.
    while bounces < 1000 || touching {
        d.step(&mut [&mut contacts]);
        let touches = contacts.resultants().any(|r| r.force != [0.0; 2]);
        if touches && !touching {
            bounces += 1;
        }
        if !touches {
            let v = d.rigid[0].velocity;
            worst = worst.max(((v[0] * v[0] + v[1] * v[1]) / (speed * speed) - 1.0).abs());
        }
        touching = touches;
        assert!(d.state.step < 3_000_000, "only {bounces} bounces");
    }
    let steps = d.state.step;
    assert!(worst < LEAPFROG, "the energy is off by {worst:e}");
    let [vx, vy] = d.rigid[0].velocity;
    let spin = d.rigid[0].spin;
    d.launch_rigid(0, [-vx, -vy], -spin);
    for _ in 0..steps {
        d.step(&mut [&mut contacts]);
    }
    let end = d.rigid[0].centre;
    let off = (end[0] - start[0]).hypot(end[1] - start[1]);
    assert!(off < ROUNDING, "back at {end:?}, {off:e} m from the start");
}
