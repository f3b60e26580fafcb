//! The tangent stiffness of bodies, contact and holds, and its factor.

use super::{
    Statics,
    factor::Factor,
    hold::hold,
    matrix::Matrix,
    residual::Residual,
    stiffness::{quad, triangle},
    unknowns::Unknowns,
};
use crate::{dynamics::Dynamics, error::Error, force::Force};

/// Mass-proportional stiffness [1/s²] along the path of an undecided motion while the iteration runs.
const TRACK_HOLD: f64 = 1e10;

/// The same for a motion that is a rotation alone: a ring bends at lower frequencies than a disc.
const TURN_HOLD: f64 = 1e7;

/// New contacts may fill the factor to this multiple of its size; beyond it the nodes are reordered.
const FILL: f64 = 1.1;

/// Tangent stiffness over a pattern that holds every contact so far.
#[derive(Default)]
pub(super) struct Tangent {
    /// Pairs of slots that contact has coupled.
    couplings: Vec<[u32; 2]>,
    laid_out: Option<LaidOut>,
    /// Entries of the factor when the nodes were ordered.
    ordered: Option<usize>,
}

struct LaidOut {
    matrix: Matrix,
    /// Values of the bodies' own stiffness.
    elastic: Vec<f64>,
    factor: Factor,
}

impl Tangent {
    /// Factorises the tangent stiffness at the present positions.
    pub(super) fn factorise(
        &mut self,
        unknowns: &mut Unknowns,
        d: &Dynamics,
        forces: &[&mut dyn Force],
        statics: &Statics,
        residual: &Residual,
    ) -> Result<(), Error> {
        if self.laid_out.is_none() {
            self.couplings = couplings(d, forces);
        }
        let mut memory = Vec::new();
        loop {
            let laid_out = match self.laid_out.take() {
                Some(laid_out) => laid_out,
                None => self.lay_out(unknowns, d, std::mem::take(&mut memory))?,
            };
            let laid_out = self.laid_out.insert(laid_out);
            laid_out.matrix.values.copy_from_slice(&laid_out.elastic);
            let missing = contact(unknowns, d, forces, &mut laid_out.matrix);
            if missing.is_empty() {
                holds(unknowns, d, statics, residual, &mut laid_out.matrix);
                return laid_out.factor.compute(&laid_out.matrix);
            }
            self.couplings.extend(missing);
            self.couplings.sort_unstable();
            self.couplings.dedup();
            memory = self.laid_out.take().map(|laid_out| laid_out.factor.into_memory()).unwrap_or_default();
        }
    }

    /// One Newton step for the present residual, a displacement [m] of each unknown.
    pub(super) fn step(
        &mut self,
        unknowns: &Unknowns,
        d: &Dynamics,
        statics: &Statics,
        residual: &Residual,
    ) -> Vec<[f64; 2]> {
        let force = unknowns.slots.iter().zip(&unknowns.free).flat_map(|(&slot, free)| {
            let [x, y] = [residual.force.fx[slot as usize], residual.force.fy[slot as usize]];
            [if free[0] { x } else { 0.0 }, if free[1] { y } else { 0.0 }]
        });
        let mut step: Vec<f64> = force.collect();
        if let Some(laid_out) = &mut self.laid_out {
            let unknowns = step.len();
            laid_out.factor.solve(&mut step, unknowns);
        }
        let (pairs, _) = step.as_chunks::<2>();
        let mut step = pairs.to_vec();
        for motion in &statics.undecided {
            motion.take_from_step(d, &mut step, unknowns);
        }
        step
    }

    /// Pattern, order of elimination and elastic stiffness, in the memory of a factor that is done with.
    fn lay_out(
        &mut self,
        unknowns: &mut Unknowns,
        d: &Dynamics,
        mut memory: Vec<f64>,
    ) -> Result<LaidOut, Error> {
        let mut graph = unknowns.graph(d, &self.couplings);
        if let Some(before) = self.ordered {
            let matrix = Matrix::new(&graph);
            let factor = Factor::new(&matrix, memory)?;
            if factor.entries() as f64 <= FILL * before as f64 {
                return Ok(LaidOut::new(matrix, factor, unknowns, d));
            }
            memory = factor.into_memory();
        }
        unknowns.reorder(d, &graph);
        graph = unknowns.graph(d, &self.couplings);
        let matrix = Matrix::new(&graph);
        let factor = Factor::new(&matrix, memory)?;
        self.ordered = Some(factor.entries());
        Ok(LaidOut::new(matrix, factor, unknowns, d))
    }
}

impl LaidOut {
    fn new(mut matrix: Matrix, factor: Factor, unknowns: &Unknowns, d: &Dynamics) -> Self {
        elastic(unknowns, d, &mut matrix);
        let elastic = matrix.values.clone();
        Self { matrix, elastic, factor }
    }
}

/// Adds what couples the nodes of a piece, block by block; calls `missing` for slots that have no place.
pub(super) fn scatter(
    unknowns: &Unknowns,
    slots: &[u32],
    block: impl Fn(usize, usize) -> [[f64; 2]; 2],
    matrix: &mut Matrix,
    mut missing: impl FnMut([u32; 2]),
) {
    for (i, &row) in slots.iter().enumerate() {
        let Some(r) = unknowns.of(row) else { continue };
        for (j, &column) in slots.iter().enumerate() {
            let Some(c) = unknowns.of(column).filter(|&c| r >= c) else { continue };
            let mut block = block(i, j);
            for (a, of_row) in block.iter_mut().enumerate() {
                for (b, value) in of_row.iter_mut().enumerate() {
                    if !(unknowns.free[r][a] && unknowns.free[c][b]) {
                        *value = 0.0;
                    }
                }
            }
            if !matrix.add(r as u32, c as u32, block) {
                missing([row, column]);
            }
        }
    }
}

/// Adds the stiffness of all elements; a held component gets a one.
pub(super) fn elastic(unknowns: &Unknowns, d: &Dynamics, matrix: &mut Matrix) {
    let (x, y) = (&d.state.x, &d.state.y);
    let corner = |n: u32| [x[n as usize], y[n as usize]];
    let elements = d.elements();
    // Every pair of corners is in the pattern.
    let present = |_| ();
    for body in &elements.bodies {
        for (nodes, reference) in &elements.quads[body.quads.clone()] {
            let stiffness = quad(nodes.map(corner), reference, &body.stiffness);
            scatter(unknowns, nodes, |i, j| stiffness.block(i, j), matrix, present);
        }
        for (nodes, reference) in &elements.triangles[body.triangles.clone()] {
            let stiffness = triangle(nodes.map(corner), reference, &body.stiffness);
            scatter(unknowns, nodes, |i, j| stiffness.block(i, j), matrix, present);
        }
    }
    for (i, free) in unknowns.free.iter().enumerate() {
        let [x, y] = free.map(|f| if f { 0.0 } else { 1.0 });
        let _ = matrix.add(i as u32, i as u32, [[x, 0.0], [0.0, y]]);
    }
}

/// Pairs of slots that forces couple.
fn couplings(d: &Dynamics, forces: &[&mut dyn Force]) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for f in forces {
        f.tangent(&d.state.x, &d.state.y, &mut |piece| {
            for (i, &a) in piece.nodes.iter().enumerate() {
                pairs.extend(piece.nodes[..i].iter().map(|&b| [a.max(b), a.min(b)]));
            }
        });
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Adds what forces contribute; returns pairs of slots that have no place in the pattern.
fn contact(
    unknowns: &Unknowns,
    d: &Dynamics,
    forces: &[&mut dyn Force],
    matrix: &mut Matrix,
) -> Vec<[u32; 2]> {
    let mut missing = Vec::new();
    for f in forces {
        f.tangent(&d.state.x, &d.state.y, &mut |piece| {
            let (k, along) = (piece.stiffness, piece.direction);
            let block = |i: usize, j: usize| {
                let [of_row, of_column] = [&along[2 * i..2 * i + 2], &along[2 * j..2 * j + 2]];
                [0, 1].map(|a| [k * of_row[a] * of_column[0], k * of_row[a] * of_column[1]])
            };
            scatter(unknowns, piece.nodes, block, matrix, |[a, b]| missing.push([a.max(b), a.min(b)]));
        });
    }
    missing
}

/// Adds what holds bodies and motions while the iteration runs.
fn holds(unknowns: &Unknowns, d: &Dynamics, statics: &Statics, residual: &Residual, matrix: &mut Matrix) {
    // A node's own block is in the pattern.
    let present = |_| ();
    for (_, slots) in &statics.bodies {
        let hold = hold(d, slots, &residual.force, statics.longest_step);
        for &slot in slots {
            let k = hold * d.mass()[slot as usize];
            scatter(unknowns, &[slot], |_, _| [[k, 0.0], [0.0, k]], matrix, present);
        }
    }
    for motion in &statics.undecided {
        let centre = motion.centre(d);
        // Springs along the path hold translation and rotation without resisting anything across it. They
        // must be soft against the body's elasticity, or they would hide it from the iteration.
        for &slot in &motion.slots {
            let n = slot as usize;
            let ([x, y], hold) = match motion.along {
                Some(along) => (along, TRACK_HOLD),
                None => {
                    let r = [d.state.x[n] - centre[0], d.state.y[n] - centre[1]];
                    let length = libm::hypot(r[0], r[1]).max(f64::MIN_POSITIVE);
                    ([-r[1] / length, r[0] / length], TURN_HOLD)
                }
            };
            let k = hold * d.mass()[n];
            scatter(
                unknowns,
                &[slot],
                |_, _| [[k * x * x, k * x * y], [k * x * y, k * y * y]],
                matrix,
                present,
            );
        }
    }
}
