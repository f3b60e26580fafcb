//! Forces on the modes: of the preload, of load and weight, and of dampers beside the springs of a housing.

use stribeck_reduced::modal::{
    Seat,
    reduction::{Frame, Load},
};
use stribeck_scene::{housing::HousingScene, resolved::ResolvedScene};
use stribeck_solver::{state::NodeForces, statics::Spring};

use crate::reduction::{
    extraction::{Extraction, Preload},
    raceway::{RacewayNode, taken_back},
    structure::Structure,
};

/// Forces on each mode [N/√kg].
pub(crate) struct Loads {
    /// All that do not depend on the rollers, at the preload.
    pub(crate) constant: Vec<f64>,
    /// Load and weight.
    pub(crate) external: Vec<f64>,
    pub(crate) load: Load,
}

impl Loads {
    /// At a preload under the load `force` [N], where rollers press on the raceway with `rollers`.
    pub(crate) fn of(
        structure: &Structure,
        preload: &Preload,
        raceway: &[RacewayNode],
        seat: Option<&Seat>,
        rollers: &NodeForces,
        (force, padded): (f64, usize),
    ) -> Self {
        let modes = structure.squares().len();
        let mut by_rollers = structure.generalised(rollers, padded);
        for (vertex, node) in raceway.iter().enumerate() {
            let back = taken_back(seat, modes, vertex);
            by_rollers.iter_mut().zip(back).for_each(|(sum, back)| *sum -= node.force * back);
        }
        let unbalanced = structure.generalised(&preload.all, padded);
        let load = &preload.load;
        let turned = NodeForces { fx: load.fy.iter().map(|fy| -fy).collect(), fy: load.fx.clone() };
        Self {
            constant: unbalanced.iter().zip(&by_rollers).map(|(all, rollers)| all - rollers).collect(),
            external: structure.generalised(&preload.outside, padded),
            load: Load {
                force,
                along: structure.generalised(load, padded),
                across: structure.generalised(&turned, padded),
            },
        }
    }
}

/// Forces on each mode by a unit velocity of every mode [1/s], row by row, of the dampers beside the springs
/// of a housing; empty without them.
pub(crate) fn dampers(
    scene: &ResolvedScene,
    structure: &Structure,
    preload: &Preload,
    padded: usize,
) -> Vec<f64> {
    let HousingScene::Springs(housing) = &scene.written.housing else { return Vec::new() };
    // Each spring has its damper, in the same proportion.
    let ratio = 1e-6 * housing.damping_n_s_m / housing.stiffness_n_um;
    let mut sums = vec![0.0; padded * padded];
    let add = |spring: &Spring| {
        let stretch = structure.stretch(spring, padded);
        for (row, a) in sums.chunks_exact_mut(padded).zip(&stretch) {
            row.iter_mut().zip(&stretch).for_each(|(sum, b)| *sum += ratio * spring.stiffness * a * b);
        }
    };
    preload.suspension.iter().for_each(add);
    sums
}

/// The frame around the springs of a housing.
pub(crate) fn frame(extraction: &Extraction, structure: &Structure, padded: usize) -> Option<Frame> {
    let (mass, node) = extraction.frame?;
    Some(Frame { mass, shape: structure.shape_at(extraction.slot(node), padded) })
}
