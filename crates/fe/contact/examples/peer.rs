//! The problems of `xtask/peers`, solved on one thread for comparison with other programs.
//!
//! `peer block FOLDER COLUMNS ROWS [random]` or `peer squeeze FOLDER`: writes the problem for the others,
//! `FOLDER/NAME.json`, says what it is and then answers lines as `xtask/peers/problem.py` does: `run N` takes
//! steps and answers with their time, `write PATH` saves the displacements.

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::io::BufRead;
use std::time::Instant;

use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Surface};
use stribeck_mesh::{Disc, Mesh, Placed, Rectangle};
use stribeck_solver::{Dynamics, Elastic, Force, Model, NodeMotion};

type Answer<T> = Result<T, Box<dyn Error>>;

/// Edge of an element, out-of-plane thickness [m], Young's modulus [Pa], Poisson's ratio, density [kg/m³].
const SIZE: f64 = 0.5e-3;
const THICKNESS: f64 = 0.02;
const MATERIAL: [f64; 3] = [200e9, 0.3, 7850.0];
/// Fields of all problems; the names are those of `problem.py`.
const FIELDS: &str =
    "\"thickness\": 0.02, \"youngs_modulus\": 200e9, \"poissons_ratio\": 0.3, \"density\": 7850";

struct Ours {
    element: &'static str,
    dynamics: Dynamics,
    contacts: Option<Contacts>,
    /// Slot and place at the start [m] of each node, in the order in which the others have them.
    nodes: Vec<(usize, [f64; 2])>,
}

fn main() -> Answer<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let (program, mut ours) = match words[..] {
        ["block", folder, columns, rows] => {
            ("Stribeck", block(folder, columns.parse()?, rows.parse()?, false)?)
        }
        ["block", folder, columns, rows, "random"] => {
            ("Stribeck, random node numbers", block(folder, columns.parse()?, rows.parse()?, true)?)
        }
        ["squeeze", folder] => ("Stribeck", squeeze(folder)?),
        _ => return Err("peer block FOLDER COLUMNS ROWS [random], or peer squeeze FOLDER".into()),
    };
    println!(
        "@{{\"program\": \"{program}\", \"version\": \"{}\", \"element\": \"{}\"}}",
        env!("CARGO_PKG_VERSION"),
        ours.element
    );
    for line in std::io::stdin().lock().lines() {
        match line?.split_once(' ') {
            Some(("run", steps)) => {
                let (wall, cpu, steps) = (Instant::now(), cpu_s(), steps.parse()?);
                ours.run(steps);
                let wall_s = wall.elapsed().as_secs_f64();
                let cpu_s = cpu.zip(cpu_s()).map_or(wall_s, |(from, to)| to - from);
                println!("@{{\"wall_s\": {wall_s:e}, \"cpu_s\": {cpu_s:e}}}");
            }
            Some(("write", path)) => {
                std::fs::write(path, ours.displacements())?;
                println!("@{{}}");
            }
            _ => break,
        }
    }
    Ok(())
}

impl Ours {
    fn run(&mut self, steps: usize) {
        match &mut self.contacts {
            Some(contacts) => (0..steps).for_each(|_| self.dynamics.step(&mut [&mut *contacts])),
            None => (0..steps).for_each(|_| self.dynamics.step(&mut [])),
        }
    }

    fn displacements(&self) -> Vec<u8> {
        let s = &self.dynamics.state;
        let of = |&(slot, [x, y]): &(usize, [f64; 2])| [s.x[slot] - x, s.y[slot] - y];
        self.nodes.iter().flat_map(of).flat_map(f64::to_le_bytes).collect()
    }
}

/// Processor time of this thread [s], where the system has it.
fn cpu_s() -> Option<f64> {
    // The system brings this number up to date when a thread offers its processor, and else every few
    // milliseconds.
    std::thread::yield_now();
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * text.split_whitespace().next()?.parse::<f64>().ok()?)
}

fn steel() -> Answer<Elastic> {
    let [youngs_modulus, poissons_ratio, density] = MATERIAL;
    Ok(Elastic::new(youngs_modulus, poissons_ratio, density)?)
}

/// A free block with a smooth velocity field, its nodes numbered row by row or at random.
fn block(folder: &str, columns: usize, rows: usize, random: bool) -> Answer<Ours> {
    // Below the critical step of every element compared (60 ns with full integration).
    const STEP: f64 = 50e-9;
    let (width, height) = (columns as f64 * SIZE, rows as f64 * SIZE);
    let mut mesh = Mesh::new();
    mesh.add("block", &Rectangle { x0: 0.0, y0: 0.0, width, height, columns, rows }.part()?);
    let start: Vec<[f64; 2]> = mesh.x.iter().zip(&mesh.y).map(|(x, y)| [*x, *y]).collect();
    let mut number: Vec<usize> = (0..start.len()).collect();
    if random {
        // Knuth's linear congruential generator.
        let mut noise = 1_u64;
        for i in (1..number.len()).rev() {
            noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            number.swap(i, (noise >> 33) as usize % (i + 1));
        }
    }
    for (place, &n) in start.iter().zip(&number) {
        [mesh.x[n], mesh.y[n]] = *place;
    }
    mesh.quads.iter_mut().for_each(|quad| *quad = quad.map(|n| number[n as usize] as u32));
    let mut dynamics = Dynamics::new(&Model::new(mesh, steel()?, THICKNESS)?, &vec![false; start.len()], 1)?;
    dynamics.set_time_step(STEP)?;
    let slots = number.iter().map(|&n| dynamics.layout().slot_of_node[n] as usize);
    let nodes: Vec<(usize, [f64; 2])> = slots.zip(start).collect();
    for &(slot, [x, y]) in &nodes {
        let down = (PI * y / height).cos();
        dynamics.state.vx[slot] = (TAU * x / width).cos() * down;
        dynamics.state.vy[slot] = (PI * x / width).cos() * down;
    }
    let problem = format!(
        "{{\"columns\": {columns}, \"rows\": {rows}, \"size\": {SIZE:e}, \"time_step\": {STEP:e}, \"speed\": 1, {FIELDS}}}"
    );
    std::fs::write(format!("{folder}/block-{}.json", columns * rows), problem)?;
    Ok(Ours { element: "one-point, total Lagrangian", dynamics, contacts: None, nodes })
}

/// A disc at rest between a block that is held below and one that comes down: the blow takes about 40 µs and
/// flattens the disc by 10 µm. Nodes of each surface against facets of the other.
fn squeeze(folder: &str) -> Answer<Ours> {
    const RADIUS: f64 = 9e-3;
    const WIDTH: f64 = 20e-3;
    const HEIGHT: f64 = 10e-3;
    const GAP: f64 = 1e-7;
    const SPEED: f64 = 1.0;
    // Part of the critical step of elements and contact.
    const FACTOR: f64 = 0.8;
    let mut mesh = Mesh::new();
    let facets = 4 * (TAU * RADIUS / SIZE / 4.0).floor() as usize;
    let disc = mesh.add("disc", &Disc { radius: RADIUS, facets, size: SIZE, rotation: 0.0 }.part()?);
    let (columns, rows) = ((WIDTH / SIZE).round() as usize, (HEIGHT / SIZE).round() as usize);
    let block =
        Rectangle { x0: -0.5 * WIDTH, y0: 0.0, width: WIDTH, height: HEIGHT, columns, rows }.part()?;
    let lower = mesh.add("lower block", &block.translated(0.0, -RADIUS - GAP - HEIGHT));
    let upper = mesh.add("upper block", &block.translated(0.0, RADIUS + GAP));
    let touching = [facing(&disc, "rim")?, facing(&lower, "top")?, facing(&upper, "bottom")?];

    let mut model = Model::new(mesh, steel()?, THICKNESS)?;
    let held = &facing(&lower, "bottom")?.nodes;
    held.iter().for_each(|&n| model.motion[n as usize] = NodeMotion::Held);
    let mut loaded = vec![false; model.mesh.x.len()];
    touching.iter().flat_map(|s| &s.nodes).for_each(|&n| loaded[n as usize] = true);
    let mut dynamics = Dynamics::new(&model, &loaded, 1)?;
    let slots: Vec<usize> = dynamics.layout().slot_of_node.iter().map(|&s| s as usize).collect();
    let penalty = MATERIAL[0] / SIZE;
    let mut surfaces = Vec::new();
    for (name, surface) in ["disc", "lower block", "upper block"].into_iter().zip(touching) {
        let nodes = surface.nodes.iter().map(|&n| dynamics.layout().slot_of_node[n as usize]).collect();
        surfaces.push(Surface::new(name, nodes, surface.closed, &dynamics.state.x, &dynamics.state.y)?);
    }
    let law = Law::penalty(penalty)?;
    let pair = |second| PairSpec { first: 0, second, law, method: Method::Collocated, sides: Sides::Both };
    let (x, y) = (&dynamics.state.x, &dynamics.state.y);
    let mut contacts = Contacts::new(surfaces, &[pair(1), pair(2)], THICKNESS, x, y)?;
    let forces: [&dyn Force; 1] = [&contacts];
    let time_step = FACTOR * dynamics.critical_time_step(&forces, 0.0).time_step;
    dynamics.set_time_step(time_step)?;
    let falling = model.mesh.bodies[upper.body].nodes.clone();
    let vy: Vec<f64> = (0..slots.len()).map(|n| if falling.contains(&n) { -SPEED } else { 0.0 }).collect();
    slots.iter().zip(&vy).for_each(|(&slot, &v)| dynamics.state.vy[slot] = v);
    // Contact is looked for from the first step on.
    contacts.set_preload(None);

    let (mesh, [disc, lower, upper]) = (&model.mesh, touching.map(|surface| &surface.nodes));
    let problem = format!(
        "{{\"x\": {:?}, \"y\": {:?}, \"quads\": {:?}, \"triangles\": {:?}, \"vy\": {vy:?}, \"held\": {held:?}, \
         \"disc\": {disc:?}, \"lower\": {lower:?}, \"upper\": {upper:?}, \"time_step\": {time_step:e}, \
         \"penalty\": {penalty:e}, {FIELDS}}}",
        mesh.x, mesh.y, mesh.quads, mesh.triangles
    );
    std::fs::write(format!("{folder}/squeeze.json"), problem)?;
    let nodes = slots.into_iter().zip(mesh.x.iter().zip(&mesh.y).map(|(x, y)| [*x, *y])).collect();
    let element = "one-point, total Lagrangian; node-to-segment";
    Ok(Ours { element, dynamics, contacts: Some(contacts), nodes })
}

fn facing<'a>(placed: &'a Placed, name: &str) -> Answer<&'a stribeck_mesh::Surface> {
    placed.surface(name).ok_or_else(|| format!("a generator no longer names its surface `{name}`").into())
}
