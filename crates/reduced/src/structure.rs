//! Outer ring and housing as a reduction sees them: in natural modes, or as one piece (THEORY §9.1).

use stribeck_solver::{
    state::NodeForces,
    statics::{Modes, SmallMotions, Spring},
};

/// Outer ring and housing, and how they move.
pub(crate) enum Structure {
    /// In their natural modes.
    Elastic { motions: Box<SmallMotions>, modes: Modes, slots: Vec<u32> },
    /// As one piece that does not turn: the square root of its mass [√kg].
    Rigid { root_mass: f64, slots: Vec<u32> },
}

impl Structure {
    /// ω² of each mode [rad²/s²].
    pub(crate) fn squares(&self) -> &[f64] {
        match self {
            Self::Elastic { modes, .. } => &modes.squares,
            Self::Rigid { .. } => &[0.0; 2],
        }
    }

    /// Shapes at a slot [1/√kg], filled up to `padded` modes: x of all, then y.
    pub(crate) fn shape_at(&self, slot: u32, padded: usize) -> Vec<f64> {
        let mut shape = vec![0.0; 2 * padded];
        match self {
            Self::Elastic { motions, modes, .. } => {
                if let Some(at) = motions.equation(slot) {
                    for (k, mode) in modes.shapes.iter().enumerate() {
                        (shape[k], shape[padded + k]) = (mode[at], mode[at + 1]);
                    }
                }
            }
            Self::Rigid { root_mass, .. } => {
                (shape[0], shape[padded + 1]) = (1.0 / root_mass, 1.0 / root_mass)
            }
        }
        shape
    }

    /// What forces by slot do to each mode [N/√kg].
    pub(crate) fn generalised(&self, force: &NodeForces, padded: usize) -> Vec<f64> {
        let mut sums = vec![0.0; padded];
        match self {
            Self::Elastic { motions, modes, slots } => {
                let field = field(motions, slots, force);
                for (sum, mode) in sums.iter_mut().zip(&modes.shapes) {
                    *sum = mode.iter().zip(&field).map(|(u, f)| u * f).sum();
                }
            }
            Self::Rigid { root_mass, slots } => {
                for &slot in slots {
                    sums[0] += force.fx[slot as usize] / root_mass;
                    sums[1] += force.fy[slot as usize] / root_mass;
                }
            }
        }
        sums
    }

    /// What springs of a direction in every slot do to each mode, a unit of stretch, and what a unit of each mode stretches them by
    /// [1/√kg].
    pub(crate) fn stretch(&self, spring: &Spring, padded: usize) -> Vec<f64> {
        let mut stretch = vec![0.0; padded];
        for (&slot, along) in spring.slots.iter().zip(spring.direction.chunks_exact(2)) {
            let shape = self.shape_at(slot, padded);
            let (x, y) = shape.split_at(padded);
            stretch.iter_mut().zip(x).zip(y).for_each(|((s, x), y)| *s += along[0] * x + along[1] * y);
        }
        stretch
    }

    /// Displacements of slots `at` [m] by forces, beyond the modes.
    pub(crate) fn residual(&mut self, force: &NodeForces, at: &[u32]) -> Vec<[f64; 2]> {
        let Self::Elastic { motions, modes, slots } = self else { return vec![[0.0; 2]; at.len()] };
        let mut moved = field(motions, slots, force);
        residual(motions, modes, &mut moved);
        at.iter().map(|&n| motions.equation(n).map_or([0.0; 2], |at| [moved[at], moved[at + 1]])).collect()
    }

    /// As [`flexibility`], beyond the modes.
    pub(crate) fn flexibility(
        &mut self,
        nodes: &[u32],
        slot_of: &dyn Fn(u32) -> u32,
        direction: &dyn Fn(u32) -> [f64; 2],
    ) -> Vec<Vec<f64>> {
        match self {
            Self::Elastic { motions, modes, .. } => {
                flexibility(motions, Some(modes), nodes, slot_of, direction)
            }
            Self::Rigid { .. } => vec![vec![0.0; nodes.len()]; nodes.len()],
        }
    }
}

/// Forces by slot as a field.
fn field(motions: &SmallMotions, slots: &[u32], force: &NodeForces) -> Vec<f64> {
    let mut field = vec![0.0; motions.equations()];
    for &slot in slots {
        // Nodes of a body that moves as one piece share their equations.
        if let Some(at) = motions.equation(slot) {
            field[at] += force.fx[slot as usize];
            field[at + 1] += force.fy[slot as usize];
        }
    }
    field
}

/// Turns forces into the displacements that the modes do not hold: (K + σM)⁻¹ (1 − MΦΦᵀ) f.
fn residual(motions: &mut SmallMotions, modes: &Modes, field: &mut [f64]) {
    let mass = motions.mass().to_vec();
    let shares: Vec<f64> =
        modes.shapes.iter().map(|m| m.iter().zip(&*field).map(|(u, f)| u * f).sum()).collect();
    for (mode, share) in modes.shapes.iter().zip(&shares) {
        for ((f, u), m) in field.iter_mut().zip(mode).zip(&mass) {
            *f -= share * m * u;
        }
    }
    motions.solve(field);
    for mode in &modes.shapes {
        let share: f64 = mode.iter().zip(&*field).zip(&mass).map(|((u, w), m)| u * w * m).sum();
        field.iter_mut().zip(mode).for_each(|(w, u)| *w -= share * u);
    }
}

/// Displacement of node i along its direction by a unit force on node j along its own, beyond the modes [m/N].
pub(crate) fn flexibility(
    motions: &mut SmallMotions,
    modes: Option<&Modes>,
    nodes: &[u32],
    slot_of: &dyn Fn(u32) -> u32,
    direction: &dyn Fn(u32) -> [f64; 2],
) -> Vec<Vec<f64>> {
    let at: Vec<Option<usize>> = nodes.iter().map(|&n| motions.equation(slot_of(n))).collect();
    let along: Vec<[f64; 2]> = nodes.iter().map(|&n| direction(n)).collect();
    let mut columns = Vec::new();
    for (at_load, [nx, ny]) in at.iter().zip(&along) {
        let mut unit = vec![0.0; motions.equations()];
        if let Some(at) = at_load {
            (unit[*at], unit[*at + 1]) = (*nx, *ny);
        }
        match modes {
            Some(modes) => residual(motions, modes, &mut unit),
            None => motions.solve(&mut unit),
        }
        let seen = at
            .iter()
            .zip(&along)
            .map(|(at, [nx, ny])| at.map_or(0.0, |at| nx * unit[at] + ny * unit[at + 1]));
        columns.push(seen.collect::<Vec<f64>>());
    }
    (0..nodes.len()).map(|i| columns.iter().map(|column| column[i]).collect()).collect()
}
