//! A block hits an equal one at rest: they part after the time in which a wave runs to the far end and back,
//! 2L/c, and the momentum goes over whole (Johnson, *Contact Mechanics*, 1985, §11.1). Printed for both ways
//! of placing contact, on finer and finer meshes.
//!
//! `cargo run --release -p stribeck-contact --example two_blocks`

use std::error::Error;

use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Surface};
use stribeck_mesh::{Mesh, Rectangle};
use stribeck_solver::{Dynamics, Elastic, Model, NodeMotion};

const LENGTH: f64 = 0.1;
const THICKNESS: f64 = 0.02;
const SPEED: f64 = 2.0;

fn main() -> Result<(), Box<dyn Error>> {
    println!("columns   contact at         time/(2L/c)   speeds after [m/s]   energy lost");
    for columns in [25, 50, 100] {
        for (name, method) in
            [("nodes", Method::Collocated), ("3 points a facet", Method::Integrated { points: 3 })]
        {
            let after = collide(columns, method)?;
            let [first, second] = after.speeds;
            let lost = 100.0 * after.energy_lost;
            println!(
                "{columns:7}   {name:16}   {:11.3}   {first:8.3} {second:9.3}   {lost:9.2} %",
                after.contact_time
            );
        }
    }
    Ok(())
}

/// Outcome of a collision.
struct Outcome {
    /// Time in contact, over 2L/c.
    contact_time: f64,
    /// Mean speeds of the blocks [m/s].
    speeds: [f64; 2],
    /// Share of the energy that does not come back as motion of the blocks as a whole: it is left in
    /// vibration.
    energy_lost: f64,
}

fn collide(columns: usize, method: Method) -> Result<Outcome, Box<dyn Error>> {
    let steel = Elastic::new(208e9, 0.3, 7800.0)?;
    let block = Rectangle { x0: 0.0, y0: 0.0, width: LENGTH, height: 0.01, columns, rows: columns / 10 + 1 }
        .part()?;
    let mut mesh = Mesh::new();
    let moving = mesh.add("moving block", &block.translated(-LENGTH - 1e-6, 0.0));
    let resting = mesh.add("resting block", &block);
    let faces = [(&moving, "right"), (&resting, "left")].map(|(body, side)| body.surface(side));
    let faces = [faces[0].ok_or("no right side")?, faces[1].ok_or("no left side")?];
    let mut model = Model::new(mesh, steel, THICKNESS)?;
    // Sides held: plane waves.
    model.motion.fill(NodeMotion::HeldY);

    // Contact pushes on the two faces that meet.
    let mut pushed = vec![false; model.mesh.x.len()];
    faces.iter().flat_map(|face| &face.nodes).for_each(|&n| pushed[n as usize] = true);
    let mut dynamics = Dynamics::new(&model, &pushed, 1)?;
    let layout = dynamics.layout();
    let slots = |nodes: &[u32]| nodes.iter().map(|&n| layout.slot_of_node[n as usize]).collect::<Vec<u32>>();
    let [right, left] = faces.map(|face| slots(&face.nodes));
    let bodies = [0, 1].map(|body| model.mesh.bodies[body].nodes.clone().map(|n| layout.slot_of_node[n]));
    let bodies = bodies.map(|slots| slots.collect::<Vec<u32>>());

    let (x, y) = (&dynamics.state.x, &dynamics.state.y);
    let surfaces = vec![Surface::new("right", right, false, x, y)?, Surface::new("left", left, false, x, y)?];
    // As stiff as one cell.
    let law = Law::penalty(steel.plane_strain_modulus() * columns as f64 / LENGTH)?;
    let pair = PairSpec { first: 0, second: 1, law, method, sides: Sides::Both };
    let mut contacts = Contacts::new(surfaces, &[pair], THICKNESS, x, y)?;
    let critical = dynamics.critical_time_step(&[&contacts], 0.0);
    dynamics.set_time_step(0.9 * critical.time_step)?;

    bodies[0].iter().for_each(|&slot| dynamics.state.vx[slot as usize] = SPEED);
    let round_trip = 2.0 * LENGTH / steel.dilatational_speed();
    let mut touching = 0.0;
    while dynamics.state.time < 1.5 * round_trip {
        dynamics.step(&mut [&mut contacts]);
        if contacts.resultants().any(|pair| pair.force[0] < 0.0) {
            touching += dynamics.time_step();
        }
    }
    let speeds = [0, 1].map(|body| dynamics.rigid_motion(&bodies[body]).velocity[0]);
    let kept = speeds.iter().map(|v| v * v).sum::<f64>() / (SPEED * SPEED);
    Ok(Outcome { contact_time: touching / round_trip, speeds, energy_lost: 1.0 - kept })
}
