//! One step of the paper's bearing (105 000 elements, 24 rollers), and of its graded version where there is one, on one
//! and two threads: everything, without contact, contact alone.
//!
//! The run's own preload takes a minute; here the load pushes the adapter and the outer ring through the clearance
//! while the rollers already turn, so that about as many contacts carry.

use std::path::Path;

use stribeck_bearing::assembly::{Assembly, Machine};
use stribeck_bearing::scene::Scene;
use stribeck_solver::Force;
use stribeck_solver::state::NodeForces;

/// Steps that close the clearance: 40 µm at the acceleration of 50 kN on 2 kg, in steps of 35 ns, and as long again.
const CLOSING: usize = 4000;

/// A part of the critical step of elements and contact that leaves room for changes.
const FACTOR: f64 = 0.9;

/// The scene in motion.
fn machine(scene: &Scene, threads: usize) -> (Machine, usize) {
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

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/scenes");
    let mut machines = Vec::new();
    for arg in &args {
        let mut parts = arg.split(',');
        let file = base.join(parts.next().unwrap());
        let set: Vec<String> = parts.map(|s| s.to_owned()).collect();
        let scene = Scene::read_with(&file, &set).unwrap();
        let (mut m, elements) = machine(&scene, 1);
        (0..CLOSING).for_each(|_| m.dynamics.step(&mut [&mut m.load, &mut m.contacts]));
        let carrying = m.contacts.resultants().filter(|r| r.penetration > 0.0).count();
        println!("{arg}: {elements} elements, {carrying} pairs carry");
        machines.push((m, elements, Vec::new(), Vec::new()));
    }
    for _ in 0..100 {
        for (m, _, all, none) in &mut machines {
            let Machine { dynamics, contacts, load, .. } = m;
            let t = std::time::Instant::now();
            for _ in 0..20 {
                dynamics.step(&mut [load, contacts]);
            }
            all.push(t.elapsed().as_secs_f64() / 20.0 * 1e6);
            let n = dynamics.state.x.len();
            let mut force = NodeForces::zeros(n);
            let mut at = dynamics.moment();
            contacts.accumulate(at, &mut force);
            let t = std::time::Instant::now();
            for _ in 0..20 {
                at.step += 1;
                contacts.accumulate(at, &mut force);
            }
            none.push(t.elapsed().as_secs_f64() / 20.0 * 1e6);
        }
    }
    for (arg, (_, elements, all, contact)) in args.iter().zip(&mut machines) {
        all.sort_by(f64::total_cmp);
        contact.sort_by(f64::total_cmp);
        println!(
            "{arg}: step min {:.1} quartile {:.1} µs ({:.2} ns/element), contact min {:.1} quartile {:.1}",
            all[0],
            all[25],
            all[0] * 1e3 / *elements as f64,
            contact[0],
            contact[25]
        );
    }
}
