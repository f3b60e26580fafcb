//! The scene that is measured: bodies that turn and roll while the load closes the clearance.

use stribeck_bearing::assembly::{Assembly, Machine};
use stribeck_scene::scene::Scene;

/// Steps that close the clearance: 40 µm at the acceleration of 50 kN on 2 kg, in steps of 35 ns, and as long again.
pub(crate) const CLOSING: usize = 4000;

/// A part of the critical step of elements and contact that leaves room for changes.
const FACTOR: f64 = 0.9;

/// The scene in motion.
pub(crate) fn machine(scene: &Scene, threads: usize) -> (Machine, usize) {
    let assembly = Assembly::new(scene).expect("a scene that can be meshed");
    let elements = assembly.model.mesh.elements();
    let mut machine = assembly.machine(scene, threads).expect("a scene that can be laid out");
    let critical = machine.dynamics.critical_time_step(&[&machine.contacts], 0.0).time_step;
    machine.dynamics.set_time_step(FACTOR * critical).expect("a positive time step");

    let k = &assembly.kinematics;
    let state = &mut machine.dynamics.state;
    let mut turn = |slots: &[u32], about: [f64; 2], orbit: f64, spin: f64| {
        for n in slots.iter().map(|&n| n as usize) {
            let (x, y) = (state.x[n] - about[0], state.y[n] - about[1]);
            state.vx[n] = -orbit * about[1] - spin * y;
            state.vy[n] = orbit * about[0] + spin * x;
        }
    };
    turn(&machine.inner, [0.0; 2], 0.0, k.shaft_rad_s);
    let centres: Vec<[f64; 2]> = {
        let d = &machine.dynamics.state;
        machine.rollers.iter().map(|r| [d.x[r.centre as usize], d.y[r.centre as usize]]).collect()
    };
    let state = &mut machine.dynamics.state;
    for (roller, [cx, cy]) in machine.rollers.iter().zip(centres) {
        for n in roller.all.iter().map(|&n| n as usize) {
            let (x, y) = (state.x[n] - cx, state.y[n] - cy);
            state.vx[n] = -k.cage_rad_s * cy - k.roller_rad_s * y;
            state.vy[n] = k.cage_rad_s * cx + k.roller_rad_s * x;
        }
    }
    if let Some(cage) = machine.cage {
        machine.dynamics.launch_rigid(cage, [0.0; 2], k.cage_rad_s);
    }
    (machine, elements)
}
