//! Models and measurements that several test files share.
#![allow(dead_code, reason = "each test file uses its own part of it")]

use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Smoothing, Surface};
use stribeck_mesh::{Disc, Mesh, Part, Rectangle};
use stribeck_solver::{
    Dynamics, Elastic, Force, Model,
    statics::{Statics, Undecided},
};
use stribeck_testing::Noise;

/// Out-of-plane thickness of every model [m]; an odd one, so that a forgotten factor shows.
pub(crate) const THICKNESS: f64 = 0.007;

/// Both ways of placing contact points.
pub(crate) const METHODS: [Method; 2] = [Method::Collocated, Method::Integrated { points: 3 }];

/// E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³.
pub(crate) fn steel() -> Elastic {
    Elastic::new(208e9, 0.3, 7800.0).expect("steel is a possible material")
}

/// A rectangle from its lower left corner [m].
pub(crate) fn rectangle([x0, y0]: [f64; 2], width: f64, height: f64, columns: usize, rows: usize) -> Part {
    Rectangle { x0, y0, width, height, columns, rows }.part().expect("a rectangle that can be made")
}

/// A disc about the origin whose first rim node lies at the angle 0.
pub(crate) fn disc(radius: f64, facets: usize, size: f64) -> Part {
    Disc { radius, facets, size, rotation: 0.0 }.part().expect("a disc that can be made")
}

/// Bodies of steel and their surfaces, until they are laid out.
#[derive(Default)]
pub(crate) struct Scene {
    mesh: Mesh,
    surfaces: Vec<(String, stribeck_mesh::Surface)>,
    pairs: Vec<PairSpec>,
}

impl Scene {
    /// Adds a body with one contact surface and says which number both have.
    pub(crate) fn add(&mut self, name: &str, part: &Part, surface: &str) -> usize {
        let placed = self.mesh.add(name, part);
        let surface = placed.surface(surface).expect("a surface of that name").clone();
        self.surfaces.push((name.to_owned(), surface));
        placed.body
    }

    /// Lets the surfaces of two bodies touch.
    pub(crate) fn pair(&mut self, first: usize, second: usize, law: Law, method: Method) {
        self.pairs.push(PairSpec { first, second, law, method, sides: Sides::Both });
    }

    /// The model, still to be changed.
    pub(crate) fn model(&self) -> Model {
        Model::new(self.mesh.clone(), steel(), THICKNESS).expect("a positive thickness")
    }

    /// Lays the model out and makes the contacts.
    pub(crate) fn lay_out(&self, model: &Model) -> (Dynamics, Contacts) {
        let d = Dynamics::new(model, &vec![true; model.mesh.x.len()], 1).expect("a model that can run");
        let surfaces = self
            .surfaces
            .iter()
            .map(|(name, s)| {
                let slots = slots(&d, s.nodes.iter().map(|&n| n as usize));
                Surface::new(name, slots, s.closed, &d.state.x, &d.state.y).expect("a surface with facets")
            })
            .collect();
        let contacts = Contacts::new(surfaces, &self.pairs, THICKNESS, &d.state.x, &d.state.y)
            .expect("surfaces and pairs that exist");
        (d, contacts)
    }

    /// The same with curves instead of polylines, which move as splines of their nodes where that is asked
    /// for, and the points of the first surface of each pair alone.
    pub(crate) fn lay_out_smooth(&self, model: &Model, curves: &[(Smoothing, bool)]) -> (Dynamics, Contacts) {
        let d = Dynamics::new(model, &vec![true; model.mesh.x.len()], 1).expect("a model that can run");
        let (x, y) = (&d.state.x, &d.state.y);
        let surfaces = self
            .surfaces
            .iter()
            .zip(curves)
            .map(|((name, s), (smoothing, spline))| {
                let slots = slots(&d, s.nodes.iter().map(|&n| n as usize));
                let surface = Surface::new(name, slots, s.closed, x, y).expect("a surface with facets");
                let surface = surface.smoothed(*smoothing, x, y).expect("fine enough facets");
                if *spline { surface.splined(x, y) } else { surface }
            })
            .collect();
        let one_pass = |pair: &PairSpec| PairSpec { sides: Sides::First, ..*pair };
        let pairs: Vec<PairSpec> = self.pairs.iter().map(one_pass).collect();
        let contacts =
            Contacts::new(surfaces, &pairs, THICKNESS, x, y).expect("surfaces and pairs that exist");
        (d, contacts)
    }
}

/// Sets the time step to `factor` of the critical one of elements and contacts.
pub(crate) fn set_step(d: &mut Dynamics, contacts: &Contacts, factor: f64) {
    // Contact damping enters by the step itself: the second bound is that of the first.
    let first = d.critical_time_step(&[contacts], 0.0).time_step;
    let critical = d.critical_time_step(&[contacts], factor * first).time_step;
    d.set_time_step(factor * critical).expect("a positive time step");
}

pub(crate) fn slots(d: &Dynamics, nodes: impl IntoIterator<Item = usize>) -> Vec<u32> {
    nodes.into_iter().map(|n| d.layout().slot_of_node[n]).collect()
}

pub(crate) fn of_body(d: &Dynamics, model: &Model, body: usize) -> Vec<u32> {
    slots(d, model.mesh.bodies[body].nodes.clone())
}

pub(crate) fn slot(d: &Dynamics, node: usize) -> usize {
    d.layout().slot_of_node[node] as usize
}

/// Adds a velocity [m/s] to nodes.
pub(crate) fn launch(d: &mut Dynamics, slots: &[u32], [vx, vy]: [f64; 2]) {
    for &n in slots {
        d.state.vx[n as usize] += vx;
        d.state.vy[n as usize] += vy;
    }
}

/// Linear momentum [kg m/s] and angular momentum about the origin [kg m²/s].
pub(crate) fn momentum(d: &Dynamics) -> [f64; 3] {
    let s = &d.state;
    let mut sum = [0.0; 3];
    for (n, m) in d.mass().iter().enumerate().filter(|(_, m)| **m > 0.0) {
        let (px, py) = (m * s.vx[n], m * s.vy[n]);
        sum[0] += px;
        sum[1] += py;
        sum[2] += s.x[n] * py - s.y[n] * px;
    }
    sum
}

/// Energies [J] at the positions before a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Balance {
    /// Kinetic, elastic and stored in contact.
    pub(crate) mechanical: f64,
    /// Turned into heat by friction and by contact damping.
    pub(crate) heat: [f64; 2],
}

/// Takes one step; returns the energies at the positions before it.
pub(crate) fn step_and_balance(d: &mut Dynamics, contacts: &mut Contacts) -> Balance {
    let elastic = d.elastic_energy();
    let fall = d.gravity_work();
    let before = d.velocities();
    d.step(&mut [contacts]);
    let contact = contacts.energy();
    let kinetic = d.kinetic_energy(&before);
    Balance {
        mechanical: kinetic + elastic.strain + elastic.hourglass + contact.stored - fall,
        heat: [contact.friction, contact.damping],
    }
}

/// Brings bodies to static equilibrium with contact, over ever sharper contact laws down to `softness` [m].
pub(crate) fn preload(
    d: &mut Dynamics,
    contacts: &mut Contacts,
    loads: &mut dyn Force,
    bodies: Vec<(String, Vec<u32>)>,
    softness: &[f64],
    tolerance: f64,
) {
    let undecided: Vec<Undecided> = Vec::new();
    let statics = Statics {
        bodies,
        undecided,
        acceleration: Vec::new(),
        longest_step: 2e-5,
        tolerance,
        iterations: 80,
    };
    for &e in softness {
        contacts.set_preload(Some(e));
        let rough = if e > 0.0 { 1e3 } else { 1.0 };
        let statics = Statics { tolerance: rough * tolerance, ..statics.clone() };
        d.equilibrate(&mut [loads, contacts], &statics).expect("a load that reaches its support");
    }
}

/// Σ k (d·u)² over Σ bound |u|², at the worst displacement u that power iteration on bound⁻¹ K finds.
pub(crate) fn worst_share_of_the_bound(contacts: &Contacts, x: &[f64], y: &[f64], seed: u64) -> f64 {
    let mut bound = vec![0.0; x.len()];
    contacts.stiffness_bound(0.0, &mut bound);
    let mut pieces = Vec::new();
    contacts.tangent(x, y, &mut |r| {
        pieces.push((r.nodes.to_vec(), r.direction.to_vec(), r.stiffness));
    });
    let mut noise = Noise::new(seed);
    let mut u: Vec<[f64; 2]> = bound.iter().map(|_| [noise.uniform(), noise.uniform()]).collect();
    let mut worst = 0.0_f64;
    for _ in 0..60 {
        let mut force = vec![[0.0; 2]; u.len()];
        let mut twice = 0.0;
        for (nodes, direction, stiffness) in &pieces {
            let along = |i: usize| direction[i] * u[nodes[i / 2] as usize][i % 2];
            let stretch: f64 = (0..direction.len()).map(along).sum();
            twice += stiffness * stretch * stretch;
            for i in 0..direction.len() {
                force[nodes[i / 2] as usize][i % 2] += stiffness * stretch * direction[i];
            }
        }
        if pieces.is_empty() {
            break;
        }
        let limit: f64 = u.iter().zip(&bound).map(|(u, b)| b * (u[0] * u[0] + u[1] * u[1])).sum();
        worst = worst.max(twice / limit);
        let size = force.as_flattened().iter().fold(f64::MIN_POSITIVE, |m: f64, f| m.max(f.abs()));
        u = force.iter().zip(&bound).map(|(f, b)| [f[0] / (b * size), f[1] / (b * size)]).collect();
    }
    worst
}
