//! One pass over a tile: element forces, then each finished row of nodes moves while it is still in cache
//! (THEORY §2.3; cost in PERFORMANCE.md).

use pulp::{Arch, Simd, WithSimd};

use crate::{
    kernel::{
        advance::{
            Counted, Damped, Damping, Nodes, Step, StepParameters, Undamped, WithHeld, WithStiffness,
            advance_row, gain, rotate,
        },
        fields::TileFields,
        frames::LaneFrames,
        gather::Gathered,
        stiffness_damping::{Extrapolate, Extrapolated},
        strip::{StripForces, moving_strip},
        structural_damping::{Evaluate, Evaluation, HeldWork},
        tile::Tile,
    },
    model::NodeMotion,
};
use stribeck_simd::{field::Field, lanes::Vector, threads::Met};

/// Memory of one thread for the tile at hand.
#[derive(Debug, Clone)]
pub(crate) struct Scratch {
    /// Forces on the nodes of the tile at hand; all zero between tiles.
    fx: Field,
    fy: Field,
    /// Where elements see the nodes, with stiffness damping, and what evaluates branches of structural
    /// damping; empty without both.
    pub(crate) extrapolated: Extrapolated,
    /// Where this thread, the first of two, met the other.
    pub(crate) met: Met,
}

impl Scratch {
    pub(crate) fn new(slots: usize) -> Self {
        Self {
            fx: Field::zeros(slots),
            fy: Field::zeros(slots),
            extrapolated: Extrapolated::default(),
            met: Met::default(),
        }
    }
}

/// Energies of a step [J], each from half a step before to half a step after the positions' time.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StepEnergies {
    /// Work of prescribed motion.
    pub(crate) work: f64,
    /// Heat of damping; zero where it is not counted.
    pub(crate) heat: f64,
    /// Of forces that structural damping holds; zero in steps that do not evaluate them.
    pub(crate) held: HeldWork,
}

impl std::ops::Add for StepEnergies {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { work: self.work + other.work, heat: self.heat + other.heat, held: self.held + other.held }
    }
}

/// Computes the forces of one tile and takes its nodes one step on.
pub(crate) fn sweep(
    tile: &Tile,
    mut fields: TileFields<'_>,
    scratch: &mut Scratch,
    parameters: StepParameters,
    evaluation: Option<&Evaluation>,
) -> StepEnergies {
    let arch = Arch::new();
    let mut held = HeldWork::default();
    if let Some(evaluation) = evaluation.filter(|_| tile.structural.is_some()) {
        let (fields, scratch) = (fields.again(), &mut scratch.extrapolated);
        held = arch.dispatch(Evaluate { tile, fields, scratch, parameters, evaluation });
    }
    if !sees_ahead(tile, &parameters) {
        return StepEnergies { held, ..arch.dispatch(Sweep { tile, fields, scratch, parameters }) };
    }
    // The first pass reads all of a tile: there is nothing left to prefetch.
    let parameters = StepParameters { fetch: false, ..parameters };
    let extrapolated = &mut scratch.extrapolated;
    let before = arch.dispatch(Extrapolate { tile, fields: fields.again(), extrapolated, parameters });
    let mut energies = arch.dispatch(Sweep { tile, fields: fields.again(), scratch, parameters });
    if parameters.count_heat {
        energies.heat +=
            0.5 * parameters.dt * (before + scratch.extrapolated.power(tile.own, fields.vx, fields.vy));
    }
    energies
}

/// Whether elements of the tile see other positions than those of the nodes.
fn sees_ahead(tile: &Tile, parameters: &StepParameters) -> bool {
    tile.elastic && parameters.beta > 0.0
}

/// A sweep to be compiled for each instruction set and kind of damping.
struct Sweep<'a> {
    tile: &'a Tile,
    fields: TileFields<'a>,
    scratch: &'a mut Scratch,
    parameters: StepParameters,
}

impl WithSimd for Sweep<'_> {
    type Output = StepEnergies;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> StepEnergies {
        let stiffness = sees_ahead(self.tile, &self.parameters);
        let holds = self.tile.structural.is_some();
        match (&self.tile.damping, self.parameters.count_heat) {
            (None, _) if holds => self.run::<S, WithHeld<Undamped>>(simd),
            (Some(_), true) if holds => self.run::<S, WithHeld<Counted>>(simd),
            (Some(_), false) if holds => self.run::<S, WithHeld<Damped>>(simd),
            (None, _) if stiffness => self.run::<S, WithStiffness<Undamped>>(simd),
            (Some(_), true) if stiffness => self.run::<S, WithStiffness<Counted>>(simd),
            (Some(_), false) if stiffness => self.run::<S, WithStiffness<Damped>>(simd),
            (None, _) => self.run::<S, Undamped>(simd),
            (Some(_), true) => self.run::<S, Counted>(simd),
            (Some(_), false) => self.run::<S, Damped>(simd),
        }
    }
}

impl Sweep<'_> {
    #[inline(always)]
    fn run<S: Simd, D: Damping>(self, simd: S) -> StepEnergies {
        let Self { tile, fields, scratch, parameters } = self;
        let StepParameters { dt, gravity, .. } = parameters;
        let (rate, frames) = tile.damping.as_ref().map_or((0.0, &LaneFrames::REST), |d| (d.rate, &d.frames));
        let step = &Step::new(simd, &parameters, rate, frames);
        let stiffness = &tile.stiffness.of(Vector::all(simd, 0.0));
        let TileFields { x, y, vx, vy, fx: outer_x, fy: outer_y, branches } = fields;
        let held = if D::HOLDS { branches.held } else { Default::default() };
        let [held_x, held_y] = held.map(|field| &*field);
        let n = tile.slots.len();
        let (fx, fy) = (&mut scratch.fx[..n], &mut scratch.fy[..n]);
        for run in &tile.loaded {
            for (force, outer) in [(&mut *fx, &mut *outer_x), (&mut *fy, &mut *outer_y)] {
                // Runs are mostly too short for a call.
                for (force, outer) in force[run.clone()].iter_mut().zip(&mut outer[run.clone()]) {
                    *force = std::mem::take(outer);
                }
            }
        }
        let (x, y, own_x, own_y) = if D::STIFFNESS {
            (&mut scratch.extrapolated.x[..n], &mut scratch.extrapolated.y[..n], x, y)
        } else {
            (x, y, &mut [][..], &mut [][..])
        };
        simd.vectorize(Gathered { tile, x, y, fx, fy });
        let mass = tile.damping.as_ref().map_or(&[][..], |d| &d.mass);
        let step_over_mass = &tile.step_over_mass;
        let mut nodes = Nodes { x, y, own_x, own_y, vx, vy, fx, fy, held_x, held_y, step_over_mass, mass };
        let mut finish = tile.finish.iter().peekable();
        let (mut work, mut heat) = (0.0, Vector::all(simd, 0.0));
        for done in 0..=tile.strips.len() {
            while let Some(f) = finish.next_if(|f| f.after == done) {
                let free = match f.motion {
                    NodeMotion::Free => [1.0, 1.0],
                    NodeMotion::HeldX => [0.0, 1.0],
                    NodeMotion::HeldY => [1.0, 0.0],
                    NodeMotion::Held => [0.0, 0.0],
                    NodeMotion::Rotating { centre, rate } => {
                        let gain = gain(tile.damping.as_ref().map_or(0.0, |d| d.rate), dt);
                        work += rotate::<D>(&mut nodes, f.nodes.clone(), centre, rate, dt, gain, gravity);
                        continue;
                    }
                };
                advance_row::<S, D>(simd, &mut nodes, f.nodes.clone(), tile.congruent, free, step, &mut heat);
            }
            match tile.strips.get(done) {
                Some(s) if s.completes => {
                    moving_strip::<S, D>(simd, s, &tile.varying, stiffness, &mut nodes, step, &mut heat);
                }
                Some(strip) => {
                    let (nodes, fetch) = (&mut nodes, step.fetch);
                    simd.vectorize(StripForces { strip, tile, nodes, fetch });
                }
                None => {}
            }
        }
        fx[tile.own..].fill(0.0);
        fy[tile.own..].fill(0.0);
        StepEnergies { work, heat: step.heat(heat), ..StepEnergies::default() }
    }
}

#[cfg(test)]
mod tests {
    use pulp::Scalar;
    use stribeck_mesh::{Disc, Mesh, Rectangle};

    use super::*;
    use crate::{
        Dynamics, Elastic, Model,
        element::{quad_forces, triangle_forces},
    };

    const STEP: f64 = 1e-6;
    const GRAVITY: [f64; 2] = [1e5, -2e5];

    /// What kind of element a block has.
    #[derive(Debug, Clone, Copy)]
    enum Cells {
        Alike,
        AlikeButForSome,
        Different,
        Numbered,
    }

    fn block(columns: usize, rows: usize, cells: Cells) -> Mesh {
        let (width, height) = (1e-3 * columns as f64, 1e-3 * rows as f64);
        let rectangle = Rectangle { x0: 0.0, y0: 0.0, width, height, columns, rows };
        let mut part = rectangle.part().expect("a possible rectangle");
        let nodes = part.x.len();
        for n in 0..nodes {
            let column = n % (columns + 1);
            let moves = match cells {
                Cells::Alike | Cells::Numbered => false,
                Cells::AlikeButForSome => column < 3 || column + 2 > columns,
                Cells::Different => true,
            };
            if moves {
                part.x[n] += 1e-4 * (1.7 * n as f64).sin();
                part.y[n] += 1e-4 * (2.3 * n as f64).cos();
            }
        }
        if let Cells::Numbered = cells {
            // Neighbours far from each other: no strips.
            let (stride, nodes) = (7, nodes as u32);
            let far = |n: u32| n * stride % nodes;
            assert!(!nodes.is_multiple_of(stride), "every node has a number of its own");
            let (x, y) = (part.x.clone(), part.y.clone());
            for n in 0..nodes {
                (part.x[far(n) as usize], part.y[far(n) as usize]) = (x[n as usize], y[n as usize]);
            }
            part.quads.iter_mut().for_each(|q| *q = q.map(far));
        }
        let mut mesh = Mesh::new();
        mesh.add("block", &part);
        mesh
    }

    fn discs(count: usize) -> Mesh {
        let disc = Disc { radius: 9e-3, facets: 40, size: 1.5e-3, rotation: 0.1 };
        let disc = disc.part().expect("a possible disc");
        let mut mesh = Mesh::new();
        for i in 0..count {
            mesh.add(format!("disc {i}"), &disc.translated(0.02 * i as f64, 0.0));
        }
        mesh
    }

    fn in_lanes(sweep: Sweep<'_>, lanes: usize) -> StepEnergies {
        #[cfg(target_arch = "x86_64")]
        match (lanes, pulp::x86::V3::try_new(), pulp::x86::V4::try_new()) {
            (4, Some(avx2), _) => return Simd::vectorize(avx2, sweep),
            (8, _, Some(avx512)) => return Simd::vectorize(avx512, sweep),
            _ => {}
        }
        sweep.with_simd(Scalar)
    }

    /// Velocities [m/s] after a step of every tile in `lanes` lanes, and by the sum over all elements one by
    /// one.
    fn velocities(mesh: Mesh, lanes: usize) -> [Vec<f64>; 2] {
        let steel = Elastic::new(200e9, 0.3, 7850.0).expect("a possible material");
        let mut model = Model::new(mesh, steel, 0.02).expect("a possible model");
        model.gravity = GRAVITY;
        let nodes = model.mesh.x.len();
        let loaded: Vec<bool> = (0..nodes).map(|n| n % 3 == 0).collect();
        let mut d = Dynamics::new(&model, &loaded, 1).expect("a possible model");
        d.set_time_step(STEP).expect("a positive step");
        let mut load = [vec![0.0; d.layout().len()], vec![0.0; d.layout().len()]];
        for n in 0..nodes {
            let (slot, at) = (d.layout().slot_of_node[n] as usize, n as f64);
            d.state.x[slot] += 1e-6 * (0.7 * at).sin();
            d.state.y[slot] += 1e-6 * (1.1 * at).cos();
            (d.state.vx[slot], d.state.vy[slot]) = ((1.9 * at).sin(), (0.3 * at).cos());
            if loaded[n] {
                (load[0][slot], load[1][slot]) = (1e4 * (0.9 * at).sin(), 1e4 * (1.3 * at).cos());
            }
        }
        let mut force = load.clone();
        let (x, y) = (d.state.x.to_vec(), d.state.y.to_vec());
        let mut push = |slot: usize, f: [f64; 2]| {
            force[0][slot] += f[0];
            force[1][slot] += f[1];
        };
        let elements = d.elements();
        let stiffness = &elements.bodies[0].stiffness;
        for (c, q) in &elements.quads {
            let c = c.map(|slot| slot as usize);
            let forces = quad_forces(c.map(|n| x[n]), c.map(|n| y[n]), q, stiffness);
            c.into_iter().zip(forces).for_each(|(slot, f)| push(slot, f));
        }
        for (c, t) in &elements.triangles {
            let c = c.map(|slot| slot as usize);
            let [f, g] = triangle_forces(c.map(|n| x[n]), c.map(|n| y[n]), t, stiffness);
            c.into_iter().zip([f, g, [-f[0] - g[0], -f[1] - g[1]]]).for_each(|(slot, f)| push(slot, f));
        }
        let slots: Vec<usize> = d.layout().slot_of_node.iter().map(|&slot| slot as usize).collect();
        let after = |v: &[f64], k: usize, slot: usize| {
            v[slot] + STEP * (force[k][slot] / d.mass()[slot] + GRAVITY[k])
        };
        let expected =
            slots.iter().flat_map(|&slot| [after(&d.state.vx, 0, slot), after(&d.state.vy, 1, slot)]);
        let expected = expected.collect();

        let parameters = StepParameters {
            dt: STEP,
            gravity: GRAVITY,
            beta: 0.0,
            since_placed: 0.0,
            count_heat: false,
            fetch: true,
            back: false,
        };
        let layout = d.layout().clone();
        [&mut d.state.x, &mut d.state.y].into_iter().for_each(|field| layout.copy_to_ghosts(field));
        let [mut fx, mut fy] = load;
        for tile in &d.tiles {
            let mut scratch = Scratch::new(tile.slots.len());
            let own = tile.slots.clone();
            let fields = TileFields {
                x: &mut d.state.x[own.clone()],
                y: &mut d.state.y[own.clone()],
                vx: &mut d.state.vx[own.clone()],
                vy: &mut d.state.vy[own.clone()],
                fx: &mut fx[own.clone()],
                fy: &mut fy[own],
                branches: Default::default(),
            };
            in_lanes(Sweep { tile, fields, scratch: &mut scratch, parameters }, lanes);
        }
        let found = slots.iter().flat_map(|&slot| [d.state.vx[slot], d.state.vy[slot]]).collect();
        [found, expected]
    }

    /// Strips, gathered elements and congruent bodies give nodes the forces that elements give one by one,
    /// whatever the instruction set: rows of every length modulo the lanes, elements alike, different, and
    /// alike but for the ends.
    #[test]
    fn invariant_sweeps_sum_the_same_forces_in_any_number_of_lanes() {
        // Rounding of forces that cancel; a missing or doubled corner changes velocities by some m/s.
        const ROUNDING: f64 = 1e-8;
        let kinds = [Cells::Alike, Cells::AlikeButForSome, Cells::Different, Cells::Numbered];
        let lengths = [1, 4, 7, 8, 9, 15, 16, 17, 24, 31, 40, 100];
        let blocks = kinds
            .into_iter()
            .flat_map(|cells| lengths.map(|n| (format!("{cells:?}, {n}"), block(n, 3, cells))));
        let discs = [1, 2, 7, 8, 9].map(|n| (format!("{n} discs"), discs(n)));
        for (name, mesh) in blocks.chain(discs) {
            for lanes in [1, 4, 8] {
                let [found, expected] = velocities(mesh.clone(), lanes);
                for (i, (v, w)) in found.iter().zip(&expected).enumerate() {
                    assert!(
                        (v - w).abs() < ROUNDING,
                        "{name}, {lanes} lanes: component {i} is {v}, not {w} m/s"
                    );
                }
            }
        }
    }
}
