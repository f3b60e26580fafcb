//! Structural damping: elements see each node where stretched springs would pull it, so that their forces
//! hold those of the springs (THEORY §2.8); and the energy of the springs.

use std::ops::Range;

use pulp::{Simd, WithSimd};

use crate::{
    kernel::{
        advance::{Step, StepParameters},
        fields::TileFields,
        frames::LaneFrames,
        stiffness_damping::{Extrapolated, tile_forces},
        tile::{Tile, TileStructural},
    },
    structural_damping::{Branch, MAX_BRANCHES},
};
use stribeck_simd::lanes::{LANES, Number, Vector};

/// Energy of the springs of each branch [J].
pub(crate) type SpringEnergies = [f64; MAX_BRANCHES];

/// What the branches do in a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct BranchSteps {
    all: [BranchStep; MAX_BRANCHES],
    count: usize,
    /// Whether the energy of springs is measured in this step.
    pub(crate) measure: bool,
}

/// One of them: u becomes `keep` u + `gain` v, and elements see nodes `share` u ahead.
#[derive(Debug, Clone, Copy, Default)]
struct BranchStep {
    keep: f64,
    gain: f64,
    share: f64,
}

impl BranchSteps {
    /// Steps of `dt` [s]: u' = v − u/τ, exact for a velocity that is constant in a step.
    pub(crate) fn new(branches: &[Branch], dt: f64, measure: bool) -> Self {
        let mut steps = Self { count: branches.len(), measure, ..Self::default() };
        for (to, &Branch { stiffness, relaxation_time }) in steps.all.iter_mut().zip(branches) {
            let lost = -(-dt / relaxation_time).exp_m1();
            *to = BranchStep { keep: 1.0 - lost, gain: relaxation_time * lost, share: stiffness };
        }
        steps
    }
}

/// Takes the springs of a tile a step on and finds where its elements see the nodes. Ghosts must have
/// positions and velocities.
pub(crate) struct Stretch<'a> {
    pub(crate) tile: &'a Tile,
    pub(crate) fields: TileFields<'a>,
    pub(crate) seen: &'a mut Extrapolated,
    pub(crate) parameters: StepParameters,
    pub(crate) branches: &'a BranchSteps,
}

impl WithSimd for Stretch<'_> {
    /// Zero where they are not measured.
    type Output = SpringEnergies;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> SpringEnergies {
        let Self { tile, fields, seen, parameters, branches } = self;
        let mut energies = SpringEnergies::default();
        let Some(structural) = &tile.structural else { return energies };
        let TileFields { x, y, vx, vy, stretch, .. } = fields;
        let n = tile.slots.len();
        let Extrapolated { x: seen_x, y: seen_y, fx, fy } = seen;
        let (seen_x, seen_y) = (&mut seen_x[..n], &mut seen_y[..n]);
        let nodes = [&*x, &*y, &*vx, &*vy];
        let [[ax, ay], [bx, by], [cx, cy]] = stretch;
        let all = 0..x.len();
        let to = [&mut *seen_x, &mut *seen_y];
        stretch_nodes(
            simd,
            structural,
            nodes,
            [[&mut *ax, &mut *ay], [&mut *bx, &mut *by], [&mut *cx, &mut *cy]],
            to,
            branches,
            all,
        );
        if !branches.measure {
            return energies;
        }
        // ½ g u·K u, with K u the change of the elastic forces by a displacement u. Steps that measure see
        // their nodes anew afterwards, to the same bits.
        let k = &tile.stiffness.of(Vector::all(simd, 0.0));
        let step = &Step::new(simd, &parameters, 0.0, &LaneFrames::REST);
        let (fx, fy) = (&mut fx[..n], &mut fy[..n]);
        fx.fill(0.0);
        fy.fill(0.0);
        tile_forces(simd, tile, k, [&mut *x, &mut *y, &mut *vx, &mut *vy], [&mut *fx, &mut *fy], step);
        let springs = [[&*ax, &*ay], [&*bx, &*by], [&*cx, &*cy]];
        let springs = &springs[..branches.count];
        for (energy, [ux, uy]) in energies.iter_mut().zip(springs) {
            *energy = work(fx, ux, tile.own) + work(fy, uy, tile.own);
        }
        for ((energy, [ux, uy]), BranchStep { share, .. }) in
            energies.iter_mut().zip(springs).zip(&branches.all)
        {
            for (to, at, u) in [(&mut *seen_x, &*x, ux), (&mut *seen_y, &*y, uy)] {
                copy(at, to);
                displace(simd, to, 1.0, u);
            }
            fx.fill(0.0);
            fy.fill(0.0);
            let seen = [&mut *seen_x, &mut *seen_y, &mut *vx, &mut *vy];
            tile_forces(simd, tile, k, seen, [&mut *fx, &mut *fy], step);
            *energy = 0.5 * share * (*energy - work(fx, ux, tile.own) - work(fy, uy, tile.own));
        }
        copy(x, seen_x);
        copy(y, seen_y);
        for ([ux, uy], BranchStep { share, .. }) in springs.iter().zip(&branches.all) {
            displace(simd, seen_x, *share, ux);
            displace(simd, seen_y, *share, uy);
        }
        energies
    }
}

/// Work of forces over displacements of the first `own` nodes [J].
fn work(force: &[f64], u: &[f64], own: usize) -> f64 {
    force[..own].iter().zip(&u[..own]).map(|(f, u)| f * u).sum()
}

/// Copies positions, as many as there is room for.
fn copy(from: &[f64], to: &mut [f64]) {
    to.copy_from_slice(&from[..to.len()]);
}

/// Moves positions by `share` of displacements.
#[inline(always)]
fn displace<S: Simd>(simd: S, to: &mut [f64], share: f64, u: &[f64]) {
    let share = Vector::all(simd, share);
    for i in (0..to.len()).step_by(Vector::<S>::LEN) {
        share.times_plus(Vector::load(simd, u, i), Vector::load(simd, to, i)).store(to, i);
    }
}

/// Takes the springs of some nodes, whole groups of lanes, a step on and finds where elements see these
/// nodes.
#[inline(always)]
pub(crate) fn stretch_nodes<S: Simd>(
    simd: S,
    structural: &TileStructural,
    nodes: [&[f64]; 4],
    [a, b, c]: [[&mut [f64]; 2]; MAX_BRANCHES],
    seen: [&mut [f64]; 2],
    branches: &BranchSteps,
    which: Range<usize>,
) {
    match branches.count {
        0 => {}
        1 => stretch(simd, structural, nodes, [a], seen, branches, which),
        2 => stretch(simd, structural, nodes, [a, b], seen, branches, which),
        _ => stretch(simd, structural, nodes, [a, b, c], seen, branches, which),
    }
}

/// The same for a number of branches that is known when the program is compiled. Springs are stretched by the
/// velocity relative to a rotation at the spin of each lane's body: a rigid motion is then seen as one and
/// the same shift of all nodes.
#[inline(always)]
fn stretch<S: Simd, const BRANCHES: usize>(
    simd: S,
    structural: &TileStructural,
    [x, y, vx, vy]: [&[f64]; 4],
    mut springs: [[&mut [f64]; 2]; BRANCHES],
    [seen_x, seen_y]: [&mut [f64]; 2],
    steps: &BranchSteps,
    which: Range<usize>,
) {
    // Loops: within a closure the compiler would not use the instruction set of this function.
    let mut each = [[Vector::all(simd, 0.0); 3]; BRANCHES];
    for (to, &BranchStep { keep, gain, share }) in each.iter_mut().zip(&steps.all) {
        *to = [Vector::all(simd, keep), Vector::all(simd, gain), Vector::all(simd, share)];
    }
    // A tile's slots are whole lines of cache.
    for i in which.step_by(Vector::<S>::LEN) {
        let (x, y) = (Vector::load(simd, x, i), Vector::load(simd, y, i));
        let (vx, vy) = (Vector::load(simd, vx, i), Vector::load(simd, vy, i));
        let spin = Vector::load(simd, &structural.spin, i % LANES);
        let (rx, ry) = (spin.times_plus(y, vx), (-spin).times_plus(x, vy));
        let (mut to_x, mut to_y) = (x, y);
        for ([ux, uy], [keep, gain, share]) in springs.iter_mut().zip(&each) {
            let new_x = gain.times_plus(rx, *keep * Vector::load(simd, ux, i));
            let new_y = gain.times_plus(ry, *keep * Vector::load(simd, uy, i));
            new_x.store(ux, i);
            new_y.store(uy, i);
            to_x = share.times_plus(new_x, to_x);
            to_y = share.times_plus(new_y, to_y);
        }
        to_x.store(seen_x, i);
        to_y.store(seen_y, i);
    }
}
