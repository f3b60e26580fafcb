//! The problem with contact: a disc at rest between a block that is held below and one that comes down.

use std::path::Path;

use anyhow::{Context, Result};
use serde::Serialize;
use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Surface};
use stribeck_mesh::{Disc, Mesh, Placed, Rectangle};
use stribeck_solver::{Dynamics, Elastic, Force, Model, NodeMotion};

use super::measure::Problem;
use super::program::{About, Program, Time, timed, write_json};

/// Radius of the disc [m], edge of an element [m], width and height of the blocks [m].
const RADIUS: f64 = 9e-3;
const SIZE: f64 = 0.5e-3;
const WIDTH: f64 = 20e-3;
const HEIGHT: f64 = 10e-3;

const THICKNESS: f64 = 0.02;
const YOUNGS_MODULUS: f64 = 200e9;
const POISSONS_RATIO: f64 = 0.3;
const DENSITY: f64 = 7850.0;

/// Gap between disc and blocks at the start [m], and speed of the upper block [m/s]: the blow takes about 40
/// µs and flattens the disc by 10 µm.
const GAP: f64 = 1e-7;
const SPEED: f64 = 1.0;

/// Part of the critical step of elements and contact.
const FACTOR: f64 = 0.8;

/// Names are those of `fixtures/peers/problem.py`.
#[derive(Debug, Serialize)]
struct Squeeze<'a> {
    x: &'a [f64],
    y: &'a [f64],
    quads: &'a [[u32; 4]],
    triangles: &'a [[u32; 3]],
    vy: Vec<f64>,
    held: Vec<usize>,
    disc: &'a [u32],
    lower: &'a [u32],
    upper: &'a [u32],
    thickness: f64,
    youngs_modulus: f64,
    poissons_ratio: f64,
    density: f64,
    time_step: f64,
    penalty: f64,
}

/// Our solver on one thread, with collocated contact: nodes of each surface against facets of the other.
struct Ours {
    about: About,
    dynamics: Dynamics,
    contacts: Contacts,
    slots: Vec<usize>,
    start: Vec<[f64; 2]>,
}

impl Program for Ours {
    fn about(&self) -> &About {
        &self.about
    }

    fn run(&mut self, steps: usize) -> Result<Time> {
        let Self { dynamics, contacts, .. } = self;
        Ok(timed(|| (0..steps).for_each(|_| dynamics.step(&mut [contacts]))))
    }

    fn displacements(&mut self) -> Result<Vec<f64>> {
        let s = &self.dynamics.state;
        let of = |(&slot, [x, y]): (&usize, &[f64; 2])| [s.x[slot] - x, s.y[slot] - y];
        Ok(self.slots.iter().zip(&self.start).flat_map(of).collect())
    }
}

/// The problem, written where the scripts can read it.
pub(super) fn problem(folder: &Path) -> Result<Problem> {
    let mut mesh = Mesh::new();
    let facets = 4 * (std::f64::consts::TAU * RADIUS / SIZE / 4.0).floor() as usize;
    let disc = mesh.add("disc", &Disc { radius: RADIUS, facets, size: SIZE, rotation: 0.0 }.part()?);
    let (columns, rows) = ((WIDTH / SIZE).round() as usize, (HEIGHT / SIZE).round() as usize);
    let block =
        Rectangle { x0: -0.5 * WIDTH, y0: 0.0, width: WIDTH, height: HEIGHT, columns, rows }.part()?;
    let lower = mesh.add("lower block", &block.translated(0.0, -RADIUS - GAP - HEIGHT));
    let upper = mesh.add("upper block", &block.translated(0.0, RADIUS + GAP));
    let touching = [facing(&disc, "rim")?, facing(&lower, "top")?, facing(&upper, "bottom")?];

    let mut model = Model::new(mesh, Elastic::new(YOUNGS_MODULUS, POISSONS_RATIO, DENSITY)?, THICKNESS)?;
    let held: Vec<usize> = facing(&lower, "bottom")?.nodes.iter().map(|&n| n as usize).collect();
    held.iter().for_each(|&n| model.motion[n] = NodeMotion::Held);
    let mut loaded = vec![false; model.mesh.x.len()];
    touching.iter().flat_map(|s| &s.nodes).for_each(|&n| loaded[n as usize] = true);
    let mut dynamics = Dynamics::new(&model, &loaded, 1)?;
    let slots: Vec<usize> = dynamics.layout().slot_of_node.iter().map(|&s| s as usize).collect();
    let penalty = YOUNGS_MODULUS / SIZE;
    let mut contacts = contacts(&dynamics, touching, penalty)?;
    let forces: [&dyn Force; 1] = [&contacts];
    let time_step = FACTOR * dynamics.critical_time_step(&forces, 0.0).time_step;
    dynamics.set_time_step(time_step)?;
    let falling = model.mesh.bodies[upper.body].nodes.clone();
    let vy: Vec<f64> = (0..slots.len()).map(|n| if falling.contains(&n) { -SPEED } else { 0.0 }).collect();
    slots.iter().zip(&vy).for_each(|(&slot, &v)| dynamics.state.vy[slot] = v);
    // Contact is looked for from the first step on.
    contacts.set_preload(None);

    let mesh = &model.mesh;
    let file = folder.join("squeeze.json");
    let squeeze = Squeeze {
        x: &mesh.x,
        y: &mesh.y,
        quads: &mesh.quads,
        triangles: &mesh.triangles,
        vy,
        held,
        disc: &touching[0].nodes,
        lower: &touching[1].nodes,
        upper: &touching[2].nodes,
        thickness: THICKNESS,
        youngs_modulus: YOUNGS_MODULUS,
        poissons_ratio: POISSONS_RATIO,
        density: DENSITY,
        time_step,
        penalty,
    };
    write_json(&file, &squeeze)?;
    let about = About {
        program: "Stribeck".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        element: "one-point, total Lagrangian; node-to-segment".to_owned(),
    };
    let start = mesh.x.iter().zip(&mesh.y).map(|(x, y)| [*x, *y]).collect();
    let elements = mesh.elements();
    let text = format!(
        "A disc of 18 mm between two blocks of 20 × 10 mm, elements of 0.5 mm ({} quads, {} triangles); the \
         lower block is held, the upper one comes down with {SPEED} m/s. Frictionless penalty contact (E / \
         0.5 mm), nodes of either side against facets of the other; steps of {:.2} ns. Contact is part of \
         the time per element.",
        mesh.quads.len(),
        mesh.triangles.len(),
        1e9 * time_step
    );
    Ok(Problem {
        title: format!("Disc between two blocks, {elements} elements"),
        text,
        elements,
        file,
        checks: [1000, 4000],
        ours: Box::new(Ours { about, dynamics, contacts, slots, start }),
        also: Vec::new(),
    })
}

fn facing<'a>(placed: &'a Placed, name: &str) -> Result<&'a stribeck_mesh::Surface> {
    placed.surface(name).with_context(|| format!("a generator no longer names its surface `{name}`"))
}

/// The disc against both blocks.
fn contacts(d: &Dynamics, touching: [&stribeck_mesh::Surface; 3], penalty: f64) -> Result<Contacts> {
    let (x, y) = (&d.state.x, &d.state.y);
    let mut surfaces = Vec::new();
    for (name, surface) in ["disc", "lower block", "upper block"].into_iter().zip(touching) {
        let slots = surface.nodes.iter().map(|&n| d.layout().slot_of_node[n as usize]).collect();
        surfaces.push(Surface::new(name, slots, surface.closed, x, y)?);
    }
    let law = Law::penalty(penalty)?;
    let pair = |second| PairSpec { first: 0, second, law, method: Method::Collocated, sides: Sides::Both };
    Ok(Contacts::new(surfaces, &[pair(1), pair(2)], THICKNESS, x, y)?)
}
