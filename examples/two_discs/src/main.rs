//! A steel disc at 1 m/s strikes an equal one at rest: force between them, highest stress, momentum.

use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Surface};
use stribeck_mesh::{Disc, Mesh};
use stribeck_solver::{Dynamics, Elastic, Model, Stress};

const RADIUS: f64 = 0.01;
const THICKNESS: f64 = 0.01;
const SPEED: f64 = 1.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let disc = Disc { radius: RADIUS, facets: 180, size: 4e-4, rotation: 0.0 }.part()?;
    let mut mesh = Mesh::new();
    let striking = mesh.add("striking", &disc.translated(-2.0 * RADIUS - 1e-6, 0.0));
    let resting = mesh.add("resting", &disc);
    let steel = Elastic::new(208e9, 0.3, 7800.0)?;
    let model = Model::new(mesh, steel, THICKNESS)?;

    let rims = [&striking, &resting].map(|placed| &placed.surface("rim").expect("a disc has a rim").nodes);
    let mut loaded = vec![false; model.mesh.x.len()];
    rims.into_iter().flatten().for_each(|&n| loaded[n as usize] = true);
    let mut dynamics = Dynamics::new(&model, &loaded, 1)?;

    let slot = |n: u32| dynamics.layout().slot_of_node[n as usize];
    let (x, y) = (&dynamics.state.x, &dynamics.state.y);
    let surface = |name: &str, nodes: &[u32]| Surface::new(name, nodes.iter().map(|&n| slot(n)).collect(), true, x, y);
    let surfaces = vec![surface("striking rim", rims[0])?, surface("resting rim", rims[1])?];
    // As stiff as a cell of the mesh.
    let law = Law::penalty(steel.plane_strain_modulus() / 4e-4)?;
    let pair = PairSpec { first: 0, second: 1, law, method: Method::Collocated, sides: Sides::Both };
    let mut contacts = Contacts::new(surfaces, &[pair], THICKNESS, x, y)?;

    let critical = dynamics.critical_time_step(&[&contacts], 0.0);
    dynamics.set_time_step(0.7 * critical.time_step)?;
    let bodies = [0, 1].map(|body| -> Vec<u32> {
        model.mesh.bodies[body].nodes.clone().map(|n| dynamics.layout().slot_of_node[n]).collect()
    });
    bodies[0].iter().for_each(|&n| dynamics.state.vx[n as usize] = SPEED);
    let before = dynamics.rigid_motion(&bodies[0]);

    let (mut peak, mut stress, mut touching) = (0.0_f64, 0.0_f64, 0.0);
    while dynamics.state.time < 1e-4 {
        dynamics.step(&mut [&mut contacts]);
        let force = contacts.resultants().map(|pair| -pair.force[0]).sum::<f64>();
        if force > 0.0 {
            touching += dynamics.time_step();
        }
        if force > peak {
            peak = force;
            stress = highest_stress(&model, &dynamics, &steel);
        }
    }
    let after = [0, 1].map(|body| dynamics.rigid_motion(&bodies[body]));
    let momentum: f64 = after.iter().map(|body| body.mass * body.velocity[0]).sum();
    println!("contact force   {:.1} N at most, for {:.1} µs", peak, 1e6 * touching);
    println!("stress          {:.0} MPa by von Mises at that time", 1e-6 * stress);
    println!("velocities      {:.3} and {:.3} m/s", after[0].velocity[0], after[1].velocity[0]);
    println!("momentum        {:+.1e} of what it was", momentum / (before.mass * SPEED) - 1.0);
    Ok(())
}

/// Highest von Mises stress of all quadrilaterals [Pa].
fn highest_stress(model: &Model, dynamics: &Dynamics, steel: &Elastic) -> f64 {
    let mesh = &model.mesh;
    let slot = |n: u32| dynamics.layout().slot_of_node[n as usize] as usize;
    let of = |corners: &[u32; 4]| {
        let reference = corners.map(|n| [mesh.x[n as usize], mesh.y[n as usize]]);
        let now = corners.map(|n| [dynamics.state.x[slot(n)], dynamics.state.y[slot(n)]]);
        Stress::of(steel, &reference, &now).von_mises()
    };
    mesh.quads.iter().map(of).fold(0.0, f64::max)
}
