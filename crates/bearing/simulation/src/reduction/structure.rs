//! Outer ring and housing: in natural modes with their residual flexibility, or as one piece (THEORY §9.1).

use faer::{Accum, Mat, MatMut, MatRef, Par, linalg::matmul::matmul};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::{ModelScene, ReducedScene, Scene};
use stribeck_solver::{
    Dynamics,
    state::NodeForces,
    statics::{Modes, SmallMotions, Spring, modes_below},
};

use crate::error::Error;
use crate::reduction::extraction::{Extraction, Preload};

/// Shift of the factorised matrix K + σM [rad²/s²]: (2π · 200 Hz)², far above rounding and far below the
/// lowest mode that bends.
pub(crate) const SHIFT: f64 = 1.6e6;

/// Frequency below which a scene keeps modes [kHz].
pub(crate) fn modes_khz(scene: &Scene) -> f64 {
    match &scene.model {
        ModelScene::Reduced(reduced) => reduced.modes_khz,
        ModelScene::Full => ReducedScene::default().modes_khz,
    }
}

/// Outer ring and housing, and how they move.
pub(crate) enum Structure {
    /// In their natural modes.
    Elastic { motions: Box<SmallMotions>, modes: Modes, slots: Vec<u32> },
    /// As one piece that does not turn: the square root of its mass [√kg].
    Rigid { root_mass: f64, slots: Vec<u32> },
}

impl Structure {
    /// The modes of outer ring and housing on the springs of a preload.
    pub(crate) fn of(
        scene: &ResolvedScene,
        extraction: &Extraction,
        preload: &Preload,
        dynamics: &Dynamics,
    ) -> Result<Self, Error> {
        let slots = extraction.slots(&extraction.nodes.structure);
        if scene.written.housing.is_rigid() {
            return Ok(Self::Rigid { root_mass: extraction.structure_mass.sqrt(), slots });
        }
        let springs = [&preload.seat[..], &preload.suspension].concat();
        let mut motions = SmallMotions::new(dynamics, &slots, &springs, SHIFT)?;
        let modes = modes_below(&mut motions, 1e3 * modes_khz(&scene.written))?;
        Ok(Self::Elastic { motions: Box::new(motions), modes, slots })
    }

    /// ω² of each mode [rad²/s²].
    pub(crate) fn squares(&self) -> &[f64] {
        match self {
            Self::Elastic { modes, .. } => &modes.squares,
            Self::Rigid { .. } => &[0.0; 2],
        }
    }

    /// Replaces the modes by linear combinations of them: those of each new mode are a column of `turned`,
    /// `squares` are their ω².
    pub(crate) fn turn(&mut self, turned: MatRef<'_, f64>, squares: Vec<f64>) {
        let Self::Elastic { modes, .. } = self else { return };
        let n = modes.shapes.first().map_or(0, Vec::len);
        let old = Mat::from_fn(n, modes.shapes.len(), |at, mode| modes.shapes[mode][at]);
        let new = product(old.as_ref(), turned);
        let shapes = (0..new.ncols()).map(|mode| new.col_as_slice(mode).to_vec()).collect();
        *modes = Modes { shapes, squares };
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

    /// Generalised forces of forces by slot on each mode [N/√kg].
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

    /// Stretch of a spring by a unit of each mode [1/√kg], which is also the generalised force of a unit
    /// tension.
    pub(crate) fn stretch(&self, spring: &Spring, padded: usize) -> Vec<f64> {
        let mut stretch = vec![0.0; padded];
        for (&slot, along) in spring.slots.iter().zip(spring.direction.chunks_exact(2)) {
            let shape = self.shape_at(slot, padded);
            let (x, y) = shape.split_at(padded);
            stretch.iter_mut().zip(x).zip(y).for_each(|((s, x), y)| *s += along[0] * x + along[1] * y);
        }
        stretch
    }

    /// Residual displacements, beyond the modes, of slots `at` [m] by each of some forces.
    pub(crate) fn residuals(&mut self, forces: &[NodeForces], at: &[u32]) -> Vec<Vec<[f64; 2]>> {
        let Self::Elastic { motions, modes, slots } = self else {
            return vec![vec![[0.0; 2]; at.len()]; forces.len()];
        };
        let fields: Vec<Vec<f64>> = forces.iter().map(|force| field(motions, slots, force)).collect();
        let seen = |motions: &SmallMotions, moved: &[f64]| -> Vec<[f64; 2]> {
            let of = |n: &u32| motions.equation(*n).map_or([0.0; 2], |at| [moved[at], moved[at + 1]]);
            at.iter().map(of).collect()
        };
        each_response(motions, Some(modes), &fields, &seen)
    }

    /// Residual flexibility, beyond the modes: see [`flexibility`].
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

/// Applies `seen` to the displacements by each of some fields of forces; with modes, to the residual ones, (K
/// + σM)⁻¹ (1 − MΦΦᵀ) f. Eight fields at a time, because modes and factor are larger than a cache.
fn each_response<T>(
    motions: &mut SmallMotions,
    modes: Option<&Modes>,
    fields: &[Vec<f64>],
    seen: &dyn Fn(&SmallMotions, &[f64]) -> T,
) -> Vec<T> {
    let n = motions.equations();
    let mass = motions.mass().to_vec();
    let shapes = modes.map(|modes| {
        let shapes = Mat::from_fn(n, modes.shapes.len(), |at, mode| modes.shapes[mode][at]);
        let momenta = Mat::from_fn(n, modes.shapes.len(), |at, mode| mass[at] * modes.shapes[mode][at]);
        (shapes, momenta)
    });
    let mut all = Vec::with_capacity(fields.len());
    for fields in fields.chunks(AT_ONCE) {
        let mut moved = fields.concat();
        let take_out = |moved: &mut [f64], by: &Mat<f64>, of: &Mat<f64>| {
            let moved = MatMut::from_column_major_slice_mut(moved, n, fields.len());
            let shares = product(of.transpose(), moved.as_ref());
            matmul(moved, Accum::Add, by.as_ref(), shares.as_ref(), -1.0, Par::Seq);
        };
        if let Some((shapes, momenta)) = &shapes {
            take_out(&mut moved, momenta, shapes);
        }
        motions.solve(&mut moved);
        if let Some((shapes, momenta)) = &shapes {
            take_out(&mut moved, shapes, momenta);
        }
        all.extend(moved.chunks_exact(n).map(|moved| seen(motions, moved)));
    }
    all
}

/// Fields that are solved at once.
const AT_ONCE: usize = 8;

/// a b, with the same bits on any number of threads.
pub(crate) fn product(a: MatRef<'_, f64>, b: MatRef<'_, f64>) -> Mat<f64> {
    let mut product = Mat::zeros(a.nrows(), b.ncols());
    matmul(product.as_mut(), Accum::Replace, a, b, 1.0, Par::Seq);
    product
}

/// Displacement of node i along its direction by a unit force on node j along its own, beyond the modes
/// [m/N].
pub(crate) fn flexibility(
    motions: &mut SmallMotions,
    modes: Option<&Modes>,
    nodes: &[u32],
    slot_of: &dyn Fn(u32) -> u32,
    direction: &dyn Fn(u32) -> [f64; 2],
) -> Vec<Vec<f64>> {
    let at: Vec<Option<usize>> = nodes.iter().map(|&n| motions.equation(slot_of(n))).collect();
    let along: Vec<[f64; 2]> = nodes.iter().map(|&n| direction(n)).collect();
    let unit = |(at, [nx, ny]): (&Option<usize>, &[f64; 2])| {
        let mut unit = vec![0.0; motions.equations()];
        if let Some(at) = at {
            (unit[*at], unit[*at + 1]) = (*nx, *ny);
        }
        unit
    };
    let units: Vec<Vec<f64>> = at.iter().zip(&along).map(unit).collect();
    let seen = |_: &SmallMotions, moved: &[f64]| -> Vec<f64> {
        at.iter()
            .zip(&along)
            .map(|(at, [nx, ny])| at.map_or(0.0, |at| nx * moved[at] + ny * moved[at + 1]))
            .collect()
    };
    let columns = each_response(motions, modes, &units, &seen);
    (0..nodes.len()).map(|i| columns.iter().map(|column| column[i]).collect()).collect()
}

#[cfg(test)]
mod tests {
    use stribeck_mesh::{Annulus, Mesh};
    use stribeck_solver::{Dynamics, Elastic, Model, statics::modes_below};
    use stribeck_testing::ledger::compare;

    use super::*;

    const FACETS: usize = 96;

    /// The paper's outer ring, free, and the slots of its nodes.
    fn ring() -> (Dynamics, Vec<u32>) {
        let ring = Annulus {
            inner_radius: 0.1,
            outer_radius: 0.11,
            facets: FACETS,
            layers: 3,
            start_angle: 0.0,
            grooves: Vec::new(),
        };
        let mut mesh = Mesh::new();
        mesh.add("ring", &ring.part().expect("a ring"));
        let steel = Elastic::new(208e9, 0.3, 7800.0).expect("steel");
        let model = Model::new(mesh, steel, 0.03).expect("a model");
        let loaded = vec![false; model.mesh.x.len()];
        let dynamics = Dynamics::new(&model, &loaded, 1).expect("a ring can move");
        let slots = 0..dynamics.state.x.len() as u32;
        let slots = slots.filter(|&slot| dynamics.mass()[slot as usize] > 0.0).collect();
        (dynamics, slots)
    }

    /// Slot of the raceway's node in a direction of the x axis.
    fn on_raceway(dynamics: &Dynamics, slots: &[u32], side: f64) -> u32 {
        let off = |slot: &u32| {
            let slot = *slot as usize;
            (dynamics.state.x[slot] - 0.1 * side).hypot(dynamics.state.y[slot])
        };
        *slots.iter().min_by(|a, b| off(a).total_cmp(&off(b))).expect("a ring has nodes")
    }

    /// Two opposite forces from within on a free ring: modal plus residual displacement under one of them
    /// equals the full static one, however few modes there are, and the residual falls with their number.
    #[test]
    fn converges_a_static_deflection_is_that_of_all_elements() {
        const TOLERANCE: f64 = 1e-3;
        let (dynamics, slots) = ring();
        let [right, left] = [1.0, -1.0].map(|side| on_raceway(&dynamics, &slots, side));
        let mut force = NodeForces::zeros(dynamics.state.x.len());
        (force.fx[right as usize], force.fx[left as usize]) = (1.0, -1.0);

        // All elements: K u = f, by what K + σM leaves over. The load has no part in rigid motions.
        let mut motions = SmallMotions::new(&dynamics, &slots, &[], SHIFT).expect("definite with the shift");
        let load = field(&motions, &slots, &force);
        let mut whole = vec![0.0; motions.equations()];
        for _ in 0..40 {
            let mut left: Vec<f64> =
                load.iter().zip(motions.stiffness_times(&whole)).map(|(f, k)| f - k).collect();
            motions.solve(&mut left);
            whole.iter_mut().zip(&left).for_each(|(u, more)| *u += more);
        }
        let at = motions.equation(right).expect("it moves");
        let whole = whole[at];

        let mut beyond_before = f64::INFINITY;
        for khz in [2.0, 5.0, 15.0, 30.0] {
            let mut motions =
                SmallMotions::new(&dynamics, &slots, &[], SHIFT).expect("definite with the shift");
            let modes = modes_below(&mut motions, 1e3 * khz).expect("modes");
            // Three rigid motions, which the load does not move.
            let elastic = modes.shapes.iter().zip(&modes.squares).skip(3);
            let by_modes: f64 = elastic
                .map(|(shape, square)| {
                    let push: f64 = shape.iter().zip(&load).map(|(u, f)| u * f).sum();
                    shape[at] * push / square
                })
                .sum();
            let slots = slots.clone();
            let mut structure = Structure::Elastic { motions: Box::new(motions), modes, slots };
            let beyond = structure.residuals(std::slice::from_ref(&force), &[right])[0][0][0];
            compare(
                &format!("ring under two forces, deflection by modes below {khz} kHz and residual"),
                "all elements: K u = f, own",
                "m",
                by_modes + beyond,
                whole,
                TOLERANCE,
            );
            assert!(beyond > 0.0 && beyond < beyond_before, "{khz} kHz: {beyond}, before {beyond_before}");
            beyond_before = beyond;
        }
        // The remainder is the dent under the force, which waves around the ring hardly represent.
        assert!(beyond_before < 0.5 * whole, "{beyond_before} of {whole}");
    }
}
