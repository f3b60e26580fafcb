//! An elastic disc bounces to and fro between two plates.
//!
//! # Goal
//!
//! Energy over many collisions: errors of single ones must not add up in one direction.
//!
//! # Mesh
//!
//! ```text
//!    ▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧
//!   ┌┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┐   20 × 2 cells of 1 mm
//!   └┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┘
//!            .─.              gap 20 µm
//!          (     )   ↕        disc of 32 facets, r = 5 mm
//!            '─'              gap 20 µm
//!   ┌┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┬┐
//!   └┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┴┘   20 × 2 cells of 1 mm
//!    ▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧▧
//! ```
//!
//! # Boundary conditions
//!
//! All nodes of the plates are held. The disc starts in the middle at 0.5 m/s downwards.
//!
//! # Parameters
//!
//! E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; a penalty as stiff as 1 mm of steel, four contact points a facet,
//! neither friction nor damping; half of the critical time step; 100 contacts.
//!
//! # Expected
//!
//! Nothing is lost.

use stribeck_contact::Method;
use stribeck_solver::NodeMotion;

use crate::common::*;
use crate::penalty;

/// Each time a contact point closes or opens the energy changes at random by parts of a per mille.
const BOUNCES: f64 = 5e-3;

#[test]
fn conserves_energy_over_a_hundred_bounces() {
    let (radius, gap) = (5e-3, 20e-6);
    let mut scene = Scene::default();
    let disc_body = scene.add("disc", &disc(radius, 32, 1e-3), "rim");
    let floor = rectangle([-0.01, -radius - gap - 2e-3], 0.02, 2e-3, 20, 2);
    let ceiling = rectangle([-0.01, radius + gap], 0.02, 2e-3, 20, 2);
    let plates = [scene.add("floor", &floor, "top"), scene.add("ceiling", &ceiling, "bottom")];
    for plate in plates {
        scene.pair(disc_body, plate, penalty(1e-3), Method::Integrated { points: 4 });
    }
    let mut model = scene.model();
    for plate in plates {
        model.motion[model.mesh.bodies[plate].nodes.clone()].fill(NodeMotion::Held);
    }
    let (mut d, mut contacts) = scene.lay_out(&model);
    set_step(&mut d, &contacts, 0.5);
    let body = of_body(&d, &model, disc_body);
    launch(&mut d, &body, [0.0, -0.5]);
    let start = step_and_balance(&mut d, &mut contacts).mechanical;
    let (mut bounces, mut touching, mut worst) = (0, false, 0.0_f64);
    while bounces < 100 {
        let now = step_and_balance(&mut d, &mut contacts);
        worst = worst.max((now.mechanical - start).abs() / start);
        let touches = contacts.resultants().any(|r| r.force[1] != 0.0);
        bounces += usize::from(touches && !touching);
        touching = touches;
        assert!(d.state.time < 0.1, "only {bounces} bounces");
    }
    assert!(worst < BOUNCES, "the energy is off by {worst:e}");
}
