//! A pressure wave runs along a bar: its speed on finer and finer meshes against √((λ + 2µ)/ρ).
//!
//! The bar is struck at its left end with a constant pressure. Its front passes the middle of the bar when
//! the particles there have half the speed p/(ρc) of those behind it (Achenbach, *Wave Propagation in Elastic
//! Solids*, 1973, §1.3).
//!
//! `cargo run --release -p stribeck-solver --example bar_wave`

use std::error::Error;

use stribeck_mesh::{Mesh, Rectangle};
use stribeck_solver::{Dynamics, Elastic, Model, NodeMotion, force::NodalLoad};

const LENGTH: f64 = 0.5;
const HEIGHT: f64 = 0.01;
const THICKNESS: f64 = 0.02;
const PRESSURE: f64 = 10e6;

fn main() -> Result<(), Box<dyn Error>> {
    let steel = Elastic::new(208e9, 0.3, 7800.0)?;
    let speed = steel.dilatational_speed();
    println!("elements   step [ns]   speed [m/s]   error to {speed:.1} m/s");
    for columns in [100, 200, 400, 800] {
        let (time_step, arrival) = arrival(steel, columns)?;
        let measured = 0.5 * LENGTH / arrival;
        let error = 100.0 * (measured / speed - 1.0);
        println!("{columns:8}   {:9.1}   {measured:11.1}   {error:+.2} %", time_step * 1e9);
    }
    Ok(())
}

/// Time step [s] of a bar with this number of columns of elements, and the time [s] at which the front is in
/// its middle.
fn arrival(steel: Elastic, columns: usize) -> Result<(f64, f64), Box<dyn Error>> {
    let bar = Rectangle { x0: 0.0, y0: 0.0, width: LENGTH, height: HEIGHT, columns, rows: 2 }.part()?;
    let mut mesh = Mesh::new();
    let placed = mesh.add("bar", &bar);
    let struck = &placed.surface("left").ok_or("a rectangle has a left side")?.nodes;
    let mut model = Model::new(mesh, steel, THICKNESS)?;
    // Its sides are held, so that plane waves run at the speed of an unbounded body.
    model.motion.fill(NodeMotion::HeldY);

    // Nodes that are pushed from outside are announced, then pushed: the force of a facet, a half on each of
    // its ends.
    let mut pushed = vec![false; model.mesh.x.len()];
    struck.iter().for_each(|&n| pushed[n as usize] = true);
    let mut dynamics = Dynamics::new(&model, &pushed, 1)?;
    let slot = |n: u32| dynamics.layout().slot_of_node[n as usize];
    let facet_force = PRESSURE * THICKNESS * HEIGHT / (struck.len() - 1) as f64;
    let share = |i: usize| if i == 0 || i + 1 == struck.len() { 0.5 } else { 1.0 };
    let forces = struck.iter().enumerate().map(|(i, &n)| (slot(n), facet_force * share(i), 0.0));
    let mut blow = NodalLoad::new(forces.collect());
    // Nodes are numbered row by row, from the left.
    let middle = slot((columns / 2) as u32) as usize;

    let critical = dynamics.critical_time_step(&[], 0.0);
    dynamics.set_time_step(0.9 * critical.time_step)?;
    let half = 0.5 * PRESSURE / (steel.density() * steel.dilatational_speed());
    while dynamics.state.vx[middle] < half {
        dynamics.step(&mut [&mut blow]);
    }
    Ok((dynamics.time_step(), dynamics.state.time))
}
