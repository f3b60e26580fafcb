//! Small motions of some bodies about their present positions: stiffness, mass, and solutions with a factor
//! that serves for many right-hand sides. The basis of natural modes and flexibilities.

use super::{
    factor::Factor,
    matrix::Matrix,
    tangent::{elastic, scatter},
    unknowns::Unknowns,
};
use crate::{dynamics::Dynamics, error::Error, force::RankOne};

/// K and M of some bodies with springs between them, and a factor of K + σM.
///
/// Fields of displacements and forces hold two numbers an unknown node, x before y
/// ([`SmallMotions::equation`]); components that are held stay in them, have no mass and do not move.
pub struct SmallMotions {
    unknowns: Unknowns,
    stiffness: Matrix,
    factor: Factor,
    mass: Vec<f64>,
    shift: f64,
}

impl std::fmt::Debug for SmallMotions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SmallMotions").field("equations", &self.mass.len()).finish_non_exhaustive()
    }
}

/// A spring between nodes, as [`RankOne`] but with its own memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// Slots; one may appear more than once.
    pub slots: Vec<u32>,
    /// Direction, (x, y) of each node in turn.
    pub direction: Vec<f64>,
    /// Stiffness [N/m].
    pub stiffness: f64,
}

impl From<RankOne<'_>> for Spring {
    fn from(piece: RankOne<'_>) -> Self {
        Self { slots: piece.nodes.to_vec(), direction: piece.direction.to_vec(), stiffness: piece.stiffness }
    }
}

impl SmallMotions {
    /// Of the bodies whose slots are given, elastic or moving as one piece whose turn is prescribed, at the
    /// present positions of `dynamics`. `shift` σ [rad²/s²] makes the matrix
    /// definite where bodies can move as a whole.
    ///
    /// # Errors
    /// When K + σM cannot be factorised.
    pub fn new(dynamics: &Dynamics, slots: &[u32], springs: &[Spring], shift: f64) -> Result<Self, Error> {
        let mut unknowns = Unknowns::of_slots(dynamics, slots);
        let couplings: Vec<[u32; 2]> = springs
            .iter()
            .flat_map(|s| {
                let others = |i: usize| s.slots[..i].iter().copied();
                s.slots
                    .iter()
                    .enumerate()
                    .flat_map(move |(i, &a)| others(i).map(move |b| [a.max(b), a.min(b)]))
            })
            .collect();
        let graph = unknowns.graph(dynamics, &couplings);
        unknowns.reorder(dynamics, &graph);
        let mut stiffness = Matrix::new(&unknowns.graph(dynamics, &couplings));
        elastic(&unknowns, dynamics, &mut stiffness);
        for spring in springs {
            let along = &spring.direction;
            let block = |i: usize, j: usize| {
                let [of_row, of_column] = [&along[2 * i..2 * i + 2], &along[2 * j..2 * j + 2]];
                [0, 1].map(|a| {
                    [spring.stiffness * of_row[a] * of_column[0], spring.stiffness * of_row[a] * of_column[1]]
                })
            };
            // Every pair of its nodes is in the pattern.
            scatter(&unknowns, &spring.slots, block, &mut stiffness, |_| ());
        }
        let mut mass = vec![0.0; 2 * unknowns.slots.len()];
        for (slot, node) in unknowns.moving() {
            let at = &mut mass[2 * node..2 * node + 2];
            for (mass, free) in at.iter_mut().zip(unknowns.free[node]) {
                *mass += if free { dynamics.mass()[slot] } else { 0.0 };
            }
        }
        let elastic = stiffness.values.clone();
        for (n, pair) in mass.chunks_exact(2).enumerate() {
            let [x, y] = [shift * pair[0], shift * pair[1]];
            // A node's own block is in the pattern.
            let _ = stiffness.add(n as u32, n as u32, [[x, 0.0], [0.0, y]]);
        }
        let mut factor = Factor::new(&stiffness, Vec::new())?;
        factor.compute(&stiffness)?;
        stiffness.values = elastic;
        Ok(Self { unknowns, stiffness, factor, mass, shift })
    }

    /// Length of a field.
    pub fn equations(&self) -> usize {
        self.mass.len()
    }

    /// Where the x of a slot stands in a field, its y following; `None` for one that is not part of it or
    /// held altogether.
    pub fn equation(&self, slot: u32) -> Option<usize> {
        self.unknowns.of(slot).map(|node| 2 * node)
    }

    /// Masses [kg]; zero where a component is held.
    pub fn mass(&self) -> &[f64] {
        &self.mass
    }

    /// The shift σ [rad²/s²].
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// K u [N] of displacements [m].
    pub fn stiffness_times(&self, u: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; u.len()];
        self.stiffness.times(u, &mut force);
        for (force, mass) in force.iter_mut().zip(&self.mass) {
            if *mass == 0.0 {
                *force = 0.0;
            }
        }
        force
    }

    /// Solves (K + σM) u = f in place for one field or several, one after another, which takes less time than
    /// one by one; values for held components are ignored.
    pub fn solve(&mut self, fields: &mut [f64]) {
        for field in fields.chunks_exact_mut(self.mass.len()) {
            for (value, mass) in field.iter_mut().zip(&self.mass) {
                if *mass == 0.0 {
                    *value = 0.0;
                }
            }
        }
        self.factor.solve(fields, self.mass.len());
    }
}
