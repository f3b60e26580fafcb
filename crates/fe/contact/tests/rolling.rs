//! A roller pressed on a flat and into a raceway: does the force see where facets and nodes are?
//!
//! The middle of a disc is held at a fixed approach while the disc takes the positions of rolling over one
//! facet, each in static equilibrium. The centre does not move with the force, as it would under a constant
//! load: the ripple is the largest that any rolling could show.

mod common;

use common::*;
use stribeck_contact::{Contacts, Law, Method, Smoothing};
use stribeck_mesh::{Annulus, Part};
use stribeck_solver::{Force, NodeMotion, force::NodalLoad, state::NodeForces};

/// The paper's roller and outer raceway [m].
const RADIUS: f64 = 9e-3;
const RACEWAY: f64 = 0.1;
const FACETS: usize = 112;

/// Edge of a facet [m].
const SIZE: f64 = std::f64::consts::TAU * RADIUS / FACETS as f64;

/// Approach of the roller's middle [m]: about 0.58 kN a millimetre of length.
const APPROACH: f64 = 13e-6;

/// How contact is modelled.
#[derive(Clone, Copy)]
struct Recipe {
    smooth: bool,
    points: usize,
    /// Penalty in elastic moduli over the element's size [-].
    penalty: f64,
    /// [m].
    onset: f64,
}

const CHORDS: Recipe = Recipe { smooth: false, points: 4, penalty: 1.0, onset: 0.0 };
const CURED: Recipe = Recipe { smooth: true, points: 12, penalty: 0.7, onset: 0.5e-6 };

#[derive(Clone, Copy, PartialEq)]
enum Ground {
    Flat,
    Raceway,
}

/// The ground's part, turned or shifted by `shift` facets under the roller, and the roller's centre.
fn ground(kind: Ground, shift: f64) -> (Part, &'static str, [f64; 2]) {
    match kind {
        Ground::Flat => {
            let width = 32.0 * SIZE;
            let corner = [-0.5 * width + shift * SIZE, -0.5 * width];
            (rectangle(corner, width, 0.5 * width, 32, 16), "top", [0.0, RADIUS - APPROACH])
        }
        Ground::Raceway => {
            let facets = 1257;
            let start_angle = std::f64::consts::TAU * (-0.25 + shift / facets as f64);
            let (inner_radius, outer_radius) = (RACEWAY, RACEWAY + 6e-3);
            let ring =
                Annulus { inner_radius, outer_radius, facets, layers: 12, start_angle, grooves: Vec::new() };
            (ring.part().expect("a ring"), "inner", [0.0, RADIUS - RACEWAY - APPROACH])
        }
    }
}

/// Force on the roller [N/m] when it has rolled on by `turn` facets and the ground's nodes have moved by
/// `shift`.
fn force(kind: Ground, recipe: Recipe, turn: f64, shift: f64) -> f64 {
    let mut scene = Scene::default();
    let (part, surface, centre) = ground(kind, shift);
    let round = disc(RADIUS, FACETS, SIZE).rotated(std::f64::consts::TAU * (turn / FACETS as f64 - 0.25));
    let roller = scene.add("roller", &round.translated(centre[0], centre[1]), "rim");
    let ground = scene.add("ground", &part, surface);
    let law = Law::penalty(recipe.penalty * steel().youngs_modulus() / SIZE);
    let law = law.and_then(|law| law.with_onset(recipe.onset)).expect("a possible law");
    scene.pair(roller, ground, law, Method::Integrated { points: recipe.points });
    let mut model = scene.model();
    for n in 0..model.mesh.x.len() {
        let (x, y) = (model.mesh.x[n], model.mesh.y[n]);
        let held = match kind {
            _ if model.mesh.bodies[roller].nodes.contains(&n) => (x - centre[0]).hypot(y - centre[1]) < 2e-3,
            Ground::Flat => y < -15.9 * SIZE,
            // The rest of the ring stays as it is.
            Ground::Raceway => x.hypot(y) > RACEWAY + 5.9e-3 || y > 0.0 || x.abs() > 0.02,
        };
        if held {
            model.motion[n] = NodeMotion::Held;
        }
    }
    let (mut d, mut contacts) = if recipe.smooth {
        let flat = if kind == Ground::Flat { Smoothing::Facet } else { Smoothing::Arc { centre: [0.0; 2] } };
        scene.lay_out_smooth(&model, &[(Smoothing::Arc { centre }, true), (flat, true)])
    } else {
        scene.lay_out(&model)
    };
    let bodies = [roller, ground].map(|b| (format!("body {b}"), of_body(&d, &model, b)));
    let mut load = NodalLoad::new(Vec::new());
    preload(&mut d, &mut contacts, &mut load, bodies.to_vec(), &[1e-6, 1e-7, 1e-8, 0.0], 1e-4);
    pressed(&d, &mut contacts) / THICKNESS
}

fn pressed(d: &stribeck_solver::Dynamics, contacts: &mut Contacts) -> f64 {
    contacts.set_preload(None);
    let n = d.state.x.len();
    contacts.accumulate(d.moment(), &mut NodeForces { fx: vec![0.0; n].into(), fy: vec![0.0; n].into() });
    contacts.resultants().next().expect("one pair").force[1]
}

/// Largest minus smallest force over the mean, rolling over one facet.
fn ripple(kind: Ground, recipe: Recipe, positions: usize) -> f64 {
    // Steps of the golden section meet neither the spacing of points nor that of nodes.
    let place = |i: usize| (0.618_033_988_75 * i as f64).fract();
    let forces: Vec<f64> = (0..positions).map(|i| force(kind, recipe, place(i), place(i))).collect();
    let mean = forces.iter().sum::<f64>() / positions as f64;
    let (low, high) = forces.iter().fold((f64::MAX, f64::MIN), |(l, h), &f| (l.min(f), h.max(f)));
    (high - low) / mean
}

#[test]
fn behaves_facets_do_not_act_on_a_rolling_roller() {
    // The target of the project.
    const LARGEST: f64 = 1e-3;
    for kind in [Ground::Flat, Ground::Raceway] {
        let found = ripple(kind, CURED, 8);
        assert!(found < LARGEST, "the force changes by {found:e} of itself");
    }
    // The same roller on chords: 9 %.
    let chords = ripple(Ground::Flat, CHORDS, 4);
    assert!(chords > 0.05, "chords: {chords:e}");
}
