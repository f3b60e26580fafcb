//! A test rig: a few bodies, contacts and loads, stepped under watch. Studies of one effect need no bearing.

use anyhow::{Context, Result};
use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides};
use stribeck_mesh::{Mesh, Part, Placed, Rectangle};
use stribeck_solver::{
    Dynamics, Elastic, Force, Model,
    force::NodalLoad,
    statics::{Equilibrator, Statics},
};

/// Out-of-plane thickness of every rig [m].
pub(crate) const THICKNESS: f64 = 0.01;

/// A rig stops by the same limits as a run (`guards` of the scene's defaults): imbalance over the peak energy …
const ENERGY_STOP: f64 = 0.25;
/// … area of an element over that at rest …
const AREA_STOP: f64 = 0.2;
/// … penetration over the length of a facet.
const PENETRATION_STOP: f64 = 1.0;

/// E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³.
pub(crate) fn steel() -> Elastic {
    Elastic::new(208e9, 0.3, 7800.0).expect("steel is a possible material")
}

/// A rectangle from its lower left corner [m].
pub(crate) fn rectangle([x0, y0]: [f64; 2], size: [f64; 2], cells: [usize; 2]) -> Result<Part> {
    let [columns, rows] = cells;
    Ok(Rectangle { x0, y0, width: size[0], height: size[1], columns, rows }.part()?)
}

/// Bodies, and which of their surfaces may touch.
#[derive(Default)]
pub(crate) struct Plan {
    mesh: Mesh,
    pub(crate) placed: Vec<Placed>,
    surfaces: Vec<(String, stribeck_mesh::Surface, f64)>,
    pairs: Vec<PairSpec>,
}

impl Plan {
    /// Adds a body; returns its number.
    pub(crate) fn add(&mut self, part: &Part) -> usize {
        let name = format!("body {}", self.placed.len());
        self.placed.push(self.mesh.add(name, part));
        self.placed.len() - 1
    }

    /// Lets the surface `one` of body `a` and `other` of body `b` touch.
    pub(crate) fn touch(
        &mut self,
        (a, one): (usize, &str),
        (b, other): (usize, &str),
        law: Law,
        method: Method,
    ) {
        let [first, second] = [(a, one), (b, other)].map(|(body, name)| {
            let surface = self.nodes(body, name).clone();
            let [p, q] = surface.facet(0).map(|n| n as usize);
            let facet = (self.mesh.x[p] - self.mesh.x[q]).hypot(self.mesh.y[p] - self.mesh.y[q]);
            self.surfaces.push((format!("{name} of body {body}"), surface, facet));
            self.surfaces.len() - 1
        });
        self.pairs.push(PairSpec { first, second, law, method, sides: Sides::Both });
    }

    /// The nodes of a named surface.
    pub(crate) fn nodes(&self, body: usize, name: &str) -> &stribeck_mesh::Surface {
        self.placed[body].surface(name).expect("the generator of this part names this surface")
    }

    /// The model, still to be changed.
    pub(crate) fn model(&self, material: Elastic) -> Result<Model> {
        Ok(Model::new(self.mesh.clone(), material, THICKNESS)?)
    }

    /// Lays the model out.
    pub(crate) fn lay_out(&self, model: &Model) -> Result<Rig> {
        let dynamics = Dynamics::new(model, &vec![true; model.mesh.x.len()], 1)?;
        let slots = |nodes: &[u32]| -> Vec<u32> {
            nodes.iter().map(|&n| dynamics.layout().slot_of_node[n as usize]).collect()
        };
        let (x, y) = (&dynamics.state.x, &dynamics.state.y);
        let surfaces = self.surfaces.iter().map(|(name, s, _)| {
            stribeck_contact::Surface::new(name.clone(), slots(&s.nodes), s.closed, x, y)
        });
        let surfaces = surfaces.collect::<Result<Vec<_>, _>>()?;
        let contacts = Contacts::new(surfaces, &self.pairs, THICKNESS, x, y)?;
        let facet = self.surfaces.iter().map(|s| s.2).fold(f64::INFINITY, f64::min);
        let bodies: Vec<Vec<u32>> = model
            .mesh
            .bodies
            .iter()
            .map(|b| b.nodes.clone().map(|n| dynamics.layout().slot_of_node[n]).collect())
            .collect();
        Ok(Rig {
            dynamics,
            contacts,
            load: NodalLoad::default(),
            pushes: Vec::new(),
            bodies,
            facet,
            start: None,
            peak: 0.0,
            worst: 0.0,
        })
    }
}

/// A rig in motion.
pub(crate) struct Rig {
    pub(crate) dynamics: Dynamics,
    pub(crate) contacts: Contacts,
    load: NodalLoad,
    /// Slots and total force [N] of each loaded side.
    pushes: Vec<(Vec<u32>, [f64; 2])>,
    /// Slots of each body.
    pub(crate) bodies: Vec<Vec<u32>>,
    facet: f64,
    start: Option<f64>,
    peak: f64,
    /// Largest imbalance so far over the peak energy [-].
    pub(crate) worst: f64,
}

/// Energies at one moment [J].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Energies {
    pub(crate) kinetic: f64,
    /// In the model and gone from it, less what came in.
    pub(crate) balance: f64,
}

impl Rig {
    /// Slot of a mesh node.
    pub(crate) fn slot(&self, node: u32) -> usize {
        self.dynamics.layout().slot_of_node[node as usize] as usize
    }

    /// Sets the time step to `factor` of what a run would call critical.
    pub(crate) fn set_step(&mut self, factor: f64) -> Result<()> {
        let first = self.dynamics.critical_time_step(&[&self.contacts], 0.0).time_step;
        let critical = self.dynamics.critical_time_step(&[&self.contacts], factor * first).time_step;
        Ok(self.dynamics.set_time_step(factor * critical)?)
    }

    /// Adds a velocity [m/s] to a body.
    pub(crate) fn launch(&mut self, body: usize, [vx, vy]: [f64; 2]) {
        for &n in &self.bodies[body] {
            self.dynamics.state.vx[n as usize] += vx;
            self.dynamics.state.vy[n as usize] += vy;
        }
    }

    /// Gives every node a random velocity of up to `speed` [m/s]: every mode is excited.
    pub(crate) fn stir(&mut self, speed: f64) {
        let mut seed = 11_u64;
        let mut noise = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for &n in self.bodies.iter().flatten() {
            self.dynamics.state.vx[n as usize] += speed * noise();
            self.dynamics.state.vy[n as usize] += speed * noise();
        }
    }

    /// Fastest node [m/s]; infinite when one is no number.
    pub(crate) fn fastest(&self) -> f64 {
        let s = &self.dynamics.state;
        let speeds = self.bodies.iter().flatten().map(|&n| s.vx[n as usize].hypot(s.vy[n as usize]));
        speeds.fold(0.0, |a, b| if b.is_nan() { f64::INFINITY } else { a.max(b) })
    }

    /// Brings the bodies to equilibrium under load and contact, to `tolerance` [N] on the worst node.
    pub(crate) fn settle(&mut self, tolerance: f64) -> Result<()> {
        let bodies = self.bodies.iter().enumerate().map(|(i, b)| (format!("body {i}"), b.clone())).collect();
        let statics = Statics {
            bodies,
            undecided: Vec::new(),
            acceleration: Vec::new(),
            longest_step: 2e-5,
            tolerance,
            iterations: 80,
        };
        let mut solver = Equilibrator::new(&self.dynamics);
        for softness in [4e-6, 1e-6, 2e-7, 4e-8, 8e-9, 2e-9, 0.0] {
            self.contacts.set_preload(Some(softness));
            let rough = if softness > 0.0 { 1e3 } else { 1.0 };
            let statics = Statics { tolerance: rough * tolerance, ..statics.clone() };
            solver.equilibrate(&mut self.dynamics, &mut [&mut self.load, &mut self.contacts], &statics)?;
        }
        self.contacts.set_preload(None);
        self.load.supplied = 0.0;
        Ok(())
    }

    pub(crate) fn step(&mut self) {
        self.dynamics.step(&mut [&mut self.load, &mut self.contacts]);
    }

    /// One step, and the energies at the positions before it.
    pub(crate) fn step_with_energies(&mut self) -> Energies {
        let d = &self.dynamics;
        let (elastic, fall) = (d.elastic_energy(), d.gravity_work());
        let before = d.velocities();
        self.step();
        let d = &self.dynamics;
        let (contact, kinetic) = (self.contacts.energy(), d.kinetic_energy(&before));
        let inside = kinetic + elastic.strain + elastic.hourglass + contact.stored;
        let gone = contact.friction + contact.damping + d.heat.at_last_positions();
        let balance = inside + gone - self.load.supplied - fall - d.drive.at_last_positions();
        let start = *self.start.get_or_insert(balance);
        self.peak = self.peak.max(inside);
        let off = (balance - start).abs() / self.peak.max(f64::MIN_POSITIVE);
        self.worst = self.worst.max(if off.is_finite() { off } else { f64::INFINITY });
        Energies { kinetic, balance: balance - start }
    }

    /// Takes `steps` steps and looks at every `every`-th; the reason to stop, if there is one. `see` gets each look.
    pub(crate) fn run(
        &mut self,
        steps: u64,
        every: u64,
        mut see: impl FnMut(&Rig, &Energies),
    ) -> Option<String> {
        for n in 0..steps {
            if n % every != 0 {
                self.step();
                continue;
            }
            let energies = self.step_with_energies();
            if let Some(reason) = self.guard() {
                return Some(reason);
            }
            see(self, &energies);
        }
        None
    }

    fn guard(&self) -> Option<String> {
        let at = self.dynamics.state.step;
        if self.worst > ENERGY_STOP {
            return Some(if self.worst.is_finite() {
                format!("energy out of balance by {:.0} % at step {at}", 100.0 * self.worst)
            } else {
                format!("no number any more at step {at}")
            });
        }
        let area = self.dynamics.distortion().least_area;
        if area.is_nan() || area < AREA_STOP {
            return Some(format!("an element has {:.0} % of its area left at step {at}", 100.0 * area));
        }
        let depth = self.contacts.resultants().map(|r| r.penetration).fold(0.0, f64::max) / self.facet;
        (depth > PENETRATION_STOP)
            .then(|| format!("penetration of {:.0} % of a facet at step {at}", 100.0 * depth))
    }

    /// Velocity of a body's centre of mass [m/s].
    pub(crate) fn velocity(&self, body: usize) -> [f64; 2] {
        self.dynamics.rigid_motion(&self.bodies[body]).velocity
    }

    /// A total force [N] on a side, spread over its length; adds to the loads.
    pub(crate) fn push(&mut self, nodes: &[u32], total: [f64; 2]) {
        let slots: Vec<u32> = nodes.iter().map(|&n| self.slot(n) as u32).collect();
        self.pushes.push((slots, total));
        self.scale_loads(1.0);
    }

    /// Multiplies all loads, as they were given, by `factor` from now on: 0 removes, −1 reverses them.
    pub(crate) fn scale_loads(&mut self, factor: f64) {
        let supplied = self.load.supplied;
        let (mut slots, x, y) = (Vec::new(), &self.dynamics.state.x, &self.dynamics.state.y);
        for (side, total) in &self.pushes {
            let length = |w: &[u32]| {
                let [a, b] = [w[0] as usize, w[1] as usize];
                (x[b] - x[a]).hypot(y[b] - y[a])
            };
            let whole: f64 = side.windows(2).map(length).sum();
            let mut share = vec![0.0; side.len()];
            for (i, pair) in side.windows(2).enumerate() {
                share[i] += 0.5 * length(pair) / whole;
                share[i + 1] += 0.5 * length(pair) / whole;
            }
            slots.extend(
                side.iter()
                    .zip(share)
                    .map(|(&s, part)| (s, factor * part * total[0], factor * part * total[1])),
            );
        }
        self.load = NodalLoad::new(slots);
        self.load.supplied = supplied;
    }
}

/// A law as stiff as a cell of `size` [m] of `material`, times `scale`.
pub(crate) fn penalty(material: &Elastic, size: f64, scale: f64) -> Result<Law> {
    Law::penalty(scale * material.plane_strain_modulus() / size).context("a penalty stiffness")
}
