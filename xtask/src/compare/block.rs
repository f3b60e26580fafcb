//! The problem: a free steel block in plane strain with a smooth velocity field, and our solution of it.

use std::f64::consts::PI;
use std::path::Path;

use anyhow::Result;
use serde::Serialize;
use stribeck_mesh::{Mesh, Rectangle};
use stribeck_solver::{Dynamics, Elastic, Model};

use super::measure::Problem;
use super::peers::ROUNDING;
use super::program::{About, Program, Time, timed, write_json};

/// Numbers of the problem in SI units; the names are those of `fixtures/peers/problem.py`.
#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct Block {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Edge of a square [m].
    pub(super) size: f64,
    pub(super) thickness: f64,
    pub(super) youngs_modulus: f64,
    pub(super) poissons_ratio: f64,
    pub(super) density: f64,
    pub(super) time_step: f64,
    /// Largest component of the starting velocity [m/s].
    pub(super) speed: f64,
}

impl Block {
    /// Squares of 0.5 mm. The step is below the critical one of every element here (60 ns with full
    /// integration).
    pub(super) fn new(columns: usize, rows: usize) -> Self {
        Self {
            columns,
            rows,
            size: 0.5e-3,
            thickness: 0.02,
            youngs_modulus: 200e9,
            poissons_ratio: 0.3,
            density: 7850.0,
            time_step: 50e-9,
            speed: 1.0,
        }
    }

    pub(super) fn elements(&self) -> usize {
        self.columns * self.rows
    }

    /// Starting velocity [m/s] at a place [m].
    fn velocity(&self, x: f64, y: f64) -> [f64; 2] {
        let (x, y) = (x / (self.columns as f64 * self.size), y / (self.rows as f64 * self.size));
        let down = (PI * y).cos();
        [self.speed * (2.0 * PI * x).cos() * down, self.speed * (PI * x).cos() * down]
    }

    fn mesh(&self) -> Result<Mesh> {
        let (width, height) = (self.columns as f64 * self.size, self.rows as f64 * self.size);
        let Self { columns, rows, .. } = *self;
        let mut mesh = Mesh::new();
        mesh.add("block", &Rectangle { x0: 0.0, y0: 0.0, width, height, columns, rows }.part()?);
        Ok(mesh)
    }
}

/// How the nodes are numbered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Numbering {
    /// Row by row: strips.
    Rows,
    /// At random: every element gathers.
    Random,
}

/// Our solver on one thread.
#[derive(Debug)]
pub(super) struct Ours {
    about: About,
    dynamics: Dynamics,
    /// Slot of each node, row by row.
    slots: Vec<usize>,
    start: Vec<[f64; 2]>,
}

impl Ours {
    /// Lays the block out and sets it in motion.
    pub(super) fn new(block: &Block, numbering: Numbering) -> Result<Self> {
        let mut mesh = block.mesh()?;
        let nodes = mesh.x.len();
        let start: Vec<[f64; 2]> = mesh.x.iter().zip(&mesh.y).map(|(x, y)| [*x, *y]).collect();
        let number = match numbering {
            Numbering::Rows => (0..nodes).collect(),
            Numbering::Random => shuffled(nodes),
        };
        for (place, &n) in start.iter().zip(&number) {
            [mesh.x[n], mesh.y[n]] = *place;
        }
        mesh.quads.iter_mut().for_each(|q| *q = q.map(|n| number[n as usize] as u32));

        let steel = Elastic::new(block.youngs_modulus, block.poissons_ratio, block.density)?;
        let model = Model::new(mesh, steel, block.thickness)?;
        let mut dynamics = Dynamics::new(&model, &vec![false; nodes], 1)?;
        dynamics.set_time_step(block.time_step)?;
        let slots: Vec<usize> = number.iter().map(|&n| dynamics.layout().slot_of_node[n] as usize).collect();
        for (&slot, &[x, y]) in slots.iter().zip(&start) {
            [dynamics.state.vx[slot], dynamics.state.vy[slot]] = block.velocity(x, y);
        }
        let program = match numbering {
            Numbering::Rows => "Stribeck",
            Numbering::Random => "Stribeck, random node numbers",
        };
        let about = About {
            program: program.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            element: "one-point, total Lagrangian".to_owned(),
        };
        Ok(Self { about, dynamics, slots, start })
    }
}

impl Program for Ours {
    fn about(&self) -> &About {
        &self.about
    }

    fn run(&mut self, steps: usize) -> Result<Time> {
        Ok(timed(|| (0..steps).for_each(|_| self.dynamics.step(&mut []))))
    }

    fn displacements(&mut self) -> Result<Vec<f64>> {
        let s = &self.dynamics.state;
        let of = |(&slot, [x, y]): (&usize, &[f64; 2])| [s.x[slot] - x, s.y[slot] - y];
        Ok(self.slots.iter().zip(&self.start).flat_map(of).collect())
    }
}

/// The numbers below `n` in an order without pattern, always the same (Knuth's linear congruential
/// generator).
fn shuffled(n: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..n).collect();
    let mut noise = 1_u64;
    for i in (1..n).rev() {
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        order.swap(i, (noise >> 33) as usize % (i + 1));
    }
    order
}

/// The problem, written where the scripts can read it.
pub(super) fn problem(block: &Block, folder: &Path) -> Result<Problem> {
    let elements = block.elements();
    let file = folder.join(format!("block-{elements}.json"));
    write_json(&file, block)?;
    let text = format!(
        "A free block of steel in plane strain, {} × {} squares of 0.5 mm, central differences of {:.0} ns, \
         lumped mass, no contact, started by a smooth velocity field of {} m/s.",
        block.columns,
        block.rows,
        1e9 * block.time_step,
        block.speed
    );
    Ok(Problem {
        title: format!("Block of {elements} quads"),
        text,
        elements,
        file,
        checks: [100, 1000],
        ours: Box::new(Ours::new(block, Numbering::Rows)?),
        also: vec![(Box::new(Ours::new(block, Numbering::Random)?), ROUNDING)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patch_node_numbers_do_not_change_the_motion() {
        let block = Block::new(20, 12);
        let run = |numbering| -> Result<Vec<f64>> {
            let mut ours = Ours::new(&block, numbering)?;
            ours.run(100)?;
            ours.displacements()
        };
        let rows = run(Numbering::Rows).expect("a block in rows");
        let random = run(Numbering::Random).expect("a block without rows");
        let worst = rows.iter().zip(&random).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let size = rows.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        assert!(size > 1e-8 && worst < ROUNDING * size, "{worst:e} of {size:e}");
    }
}
