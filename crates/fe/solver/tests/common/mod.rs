//! Models and measurements that several test files share.
#![allow(dead_code, reason = "each test file uses its own part of it")]

use stribeck_mesh::{Annulus, Disc, Mesh, Part, Rectangle};
use stribeck_solver::{
    Dynamics, Elastic, Force, Model, NodeMotion,
    snapshot::Snapshot,
    statics::{Equilibrium, Statics},
};
use stribeck_testing::Noise;

/// Out-of-plane thickness of every model [m]; an odd one, so that a forgotten factor shows.
pub(crate) const THICKNESS: f64 = 0.007;

/// E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³.
pub(crate) fn steel() -> Elastic {
    Elastic::new(208e9, 0.3, 7800.0).expect("steel is a possible material")
}

/// A rectangle with its lower left corner in the origin.
pub(crate) fn rectangle(width: f64, height: f64, columns: usize, rows: usize) -> Part {
    Rectangle { x0: 0.0, y0: 0.0, width, height, columns, rows }.part().expect("a rectangle that can be made")
}

/// Nodes on the sides of a rectangle, by its numbers of cells.
pub(crate) fn on_sides(columns: usize, rows: usize) -> impl Iterator<Item = usize> {
    let inside = move |r: usize, c: usize| r > 0 && r < rows && c > 0 && c < columns;
    (0..=rows)
        .flat_map(move |r| (0..=columns).map(move |c| (r, c)))
        .filter(move |&(r, c)| !inside(r, c))
        .map(move |(r, c)| r * (columns + 1) + c)
}

/// Moves the inner nodes of a rectangle by up to `reach` [m] in each direction.
pub(crate) fn distort(part: &mut Part, columns: usize, rows: usize, reach: f64) {
    let mut noise = Noise::new(1);
    let fixed: Vec<usize> = on_sides(columns, rows).collect();
    for n in (0..part.x.len()).filter(|n| !fixed.contains(n)) {
        part.x[n] += reach * noise.uniform();
        part.y[n] += reach * noise.uniform();
    }
}

/// Every quadrilateral as two triangles.
pub(crate) fn split(mut part: Part) -> Part {
    part.triangles = part.quads.drain(..).flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    part
}

pub(crate) fn body(part: &Part) -> Model {
    let mut mesh = Mesh::new();
    mesh.add("body", part);
    Model::new(mesh, steel(), THICKNESS).expect("a positive thickness")
}

/// Lays a model out for one thread; every node may be pushed.
pub(crate) fn lay_out(model: &Model) -> Dynamics {
    Dynamics::new(model, &vec![true; model.mesh.x.len()], 1).expect("a model that can run")
}

/// Lays a model out and sets the time step to `factor` of the critical one without forces.
pub(crate) fn ready(model: &Model, factor: f64) -> Dynamics {
    let mut d = lay_out(model);
    let critical = d.critical_time_step(&[], 0.0).time_step;
    d.set_time_step(factor * critical).expect("a positive time step");
    d
}

pub(crate) fn slots(d: &Dynamics, nodes: impl IntoIterator<Item = usize>) -> Vec<u32> {
    nodes.into_iter().map(|n| d.layout().slot_of_node[n]).collect()
}

pub(crate) fn slot(d: &Dynamics, node: usize) -> usize {
    d.layout().slot_of_node[node] as usize
}

/// Slots that carry mass: no ghosts, no padding.
pub(crate) fn massive(d: &Dynamics) -> Vec<usize> {
    (0..d.mass().len()).filter(|&s| d.mass()[s] > 0.0).collect()
}

/// Takes `n` steps.
pub(crate) fn run(d: &mut Dynamics, forces: &mut [&mut dyn Force], n: usize) {
    for _ in 0..n {
        d.step(forces);
    }
}

/// Linear momentum [kg m/s] and angular momentum about the origin [kg m²/s].
pub(crate) fn momentum(d: &Dynamics) -> [f64; 3] {
    let s = &d.state;
    let mut sum = [0.0; 3];
    for n in massive(d) {
        let (px, py) = (d.mass()[n] * s.vx[n], d.mass()[n] * s.vy[n]);
        sum[0] += px;
        sum[1] += py;
        sum[2] += s.x[n] * py - s.y[n] * px;
    }
    sum
}

/// Energies [J] at the positions before a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Balance {
    pub(crate) kinetic: f64,
    pub(crate) strain: f64,
    pub(crate) hourglass: f64,
    pub(crate) gravity_work: f64,
    pub(crate) drive: f64,
}

impl Balance {
    /// Kinetic and elastic energy [J].
    pub(crate) fn mechanical(&self) -> f64 {
        self.kinetic + self.strain + self.hourglass
    }
}

/// Takes one step; returns the energies at the positions before it.
pub(crate) fn step_and_balance(d: &mut Dynamics, forces: &mut [&mut dyn Force]) -> Balance {
    let (elastic, gravity_work) = (d.elastic_energy(), d.gravity_work());
    let before = d.velocities();
    d.step(forces);
    Balance {
        kinetic: d.kinetic_energy(&before),
        strain: elastic.strain,
        hourglass: elastic.hourglass,
        gravity_work,
        drive: d.drive.at_last_positions(),
    }
}

/// Mechanical energy and heat of damping [J] at the positions before a step, which it takes.
pub(crate) fn step_and_count(d: &mut Dynamics) -> [f64; 2] {
    let now = step_and_balance(d, &mut []);
    [now.mechanical(), d.heat.at_last_positions()]
}

/// Static equilibrium of one body whose nodes are `slots`; `tolerance` is the unbalanced force allowed [N].
pub(crate) fn equilibrate(
    d: &mut Dynamics,
    forces: &mut [&mut dyn Force],
    acceleration: Vec<[f64; 2]>,
    tolerance: f64,
) -> Result<Equilibrium, stribeck_solver::Error> {
    let all = massive(d).into_iter().map(|s| s as u32).collect();
    let statics = Statics {
        bodies: vec![("body".to_owned(), all)],
        undecided: Vec::new(),
        acceleration,
        longest_step: 1e-3,
        tolerance,
        iterations: 40,
    };
    d.equilibrate(forces, &statics)
}

/// Rings and discs that are large enough for several tiles, strips of both kinds, triangles and congruent
/// bodies.
pub(crate) fn workshop() -> Model {
    let mut mesh = Mesh::new();
    let ring = Annulus {
        inner_radius: 0.1,
        outer_radius: 0.11,
        facets: 1200,
        layers: 10,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let ring = mesh.add("ring", &ring.part().expect("a ring"));
    for i in 0..3 {
        let disc = Disc { radius: 0.01, facets: 24, size: 3e-3, rotation: 0.0 }.part().expect("a disc");
        mesh.add(format!("disc {i}"), &disc.translated(0.03 * i as f64, 0.0));
    }
    let mut block = rectangle(0.02, 0.01, 9, 5);
    distort(&mut block, 9, 5, 3e-4);
    mesh.add("block", &block.translated(0.0, 0.2));
    let mut model = Model::new(mesh, steel(), THICKNESS).expect("a positive thickness");
    let nodes = model.mesh.bodies[ring.body].nodes.clone();
    // The bore of the ring is driven.
    for n in nodes {
        if model.mesh.x[n].hypot(model.mesh.y[n]) < 0.1001 {
            model.motion[n] = NodeMotion::Rotating { centre: [0.0; 2], rate: 50.0 };
        }
    }
    model
}

/// Gives every node that may move a velocity up to `speed` [m/s].
pub(crate) fn shake(d: &mut Dynamics, speed: f64) {
    let mut noise = Noise::new(6);
    for n in massive(d) {
        (d.state.vx[n], d.state.vy[n]) = (speed * noise.uniform(), speed * noise.uniform());
    }
}

/// Fails unless two threads, and one that stops and goes on from a snapshot, come to the same bits as one;
/// returns the state they start from. `made` is given the number of threads.
pub(crate) fn assert_threads_and_interruptions_change_no_bit(made: impl Fn(usize) -> Dynamics) -> Snapshot {
    let mut one = made(1);
    assert!(one.layout().len() > 12_000, "{} slots fill several tiles", one.layout().len());
    shake(&mut one, 0.1);
    let start = one.snapshot();
    run(&mut one, &mut [], 60);
    let mut two = made(2);
    two.restore(start.clone()).expect("the same model");
    let pool = micropool::ThreadPoolBuilder::default().num_threads(1).build();
    pool.install(|| run(&mut two, &mut [], 60));
    assert!(one.snapshot() == two.snapshot(), "threads change bits");
    let mut parts = made(1);
    parts.restore(start.clone()).expect("the same model");
    run(&mut parts, &mut [], 23);
    let saved = parts.snapshot();
    let mut rest = made(1);
    rest.restore(saved).expect("the same model");
    run(&mut rest, &mut [], 37);
    assert!(one.snapshot() == rest.snapshot(), "an interruption changes bits");
    start
}
