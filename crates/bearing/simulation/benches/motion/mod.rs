//! The scene that is measured: bodies that turn and roll while the load closes the clearance.

use stribeck_scene::scene::Scene;
use stribeck_simulation::bearing::assembly::{Assembly, BearingSystem};

/// Steps that close the clearance: 40 µm at the acceleration of 50 kN on 2 kg, in steps of 35 ns, and as long
/// again.
pub(crate) const CLOSING: usize = 4000;

/// A part of the critical step of elements and contact that leaves room for changes.
const FACTOR: f64 = 0.9;

pub(crate) fn bearing(scene: &Scene, threads: usize) -> (BearingSystem, usize) {
    let scene = &scene.resolve();
    let assembly = Assembly::new(scene).expect("a scene that can be meshed");
    let elements = assembly.model.mesh.elements();
    let mut bearing = assembly.build(scene, threads).expect("a scene that can be laid out");
    bearing.system.set_time_step_factor(FACTOR).expect("a positive time step");

    let k = &assembly.kinematics;
    let system = &mut bearing.system;
    let mut turn = |body: usize, about: [f64; 2], orbit: f64, spin: f64| {
        for n in system.nodes_of(body) {
            let [x, y] = system.position(n);
            let (x, y) = (x - about[0], y - about[1]);
            system.set_velocity(n, [-orbit * about[1] - spin * y, orbit * about[0] + spin * x]);
        }
    };
    turn(bearing.inner, [0.0; 2], 0.0, k.shaft_rad_s);
    let mesh = &assembly.model.mesh;
    for roller in &bearing.rollers {
        let centre = roller.centre as usize;
        turn(roller.body, [mesh.x[centre], mesh.y[centre]], k.cage_rad_s, k.roller_rad_s);
    }
    if let Some(cage) = bearing.cage {
        bearing.system.launch(cage, [0.0; 2], k.cage_rad_s);
    }
    (bearing, elements)
}
