//! Structural damping: the branch answers to the nodes' path through a low-pass, and its forces are held from
//! one evaluation to the next, some steps later (THEORY §2.8).

use pulp::{Simd, WithSimd};

use crate::{
    kernel::{
        advance::StepParameters,
        fields::{BranchFields, TileFields},
        stiffness_damping::{Extrapolated, tile_forces},
        tile::{Tile, TileStructural},
    },
    structural_damping::Branch,
};
use stribeck_simd::lanes::{LANES, Number, Vector};

/// Action of the branch in a step that evaluates it: its path q becomes `keep` q + (1 − `keep`) x, and stands
/// for its spring half a step back: (1 + `back`) q − `back` x.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Evaluation {
    /// Zero where springs are relaxed where the nodes are now: nothing is held yet.
    keep: f64,
    back: f64,
    /// g/(1 + g): the stiffened elements of a tile times this are the springs of the branch.
    share: f64,
    /// Time since the last evaluation, and from now to the middle of the steps until the next [s].
    since: f64,
    middle: f64,
}

impl Evaluation {
    /// `since` steps of `dt` [s] after the last evaluation, none for the first one, and `until` before the
    /// next.
    pub(crate) fn new(branch: Branch, dt: f64, since: Option<u64>, until: u64) -> Self {
        let Branch { stiffness, relaxation_time } = branch;
        let passed = since.map_or(0.0, |steps| steps as f64 * dt);
        Self {
            keep: since.map_or(0.0, |_| libm::exp(-passed / relaxation_time)),
            back: 0.5 * libm::expm1(dt / relaxation_time),
            share: stiffness / (1.0 + stiffness),
            since: passed,
            middle: 0.5 * (until - 1) as f64 * dt,
        }
    }
}

/// Evaluates the branch of a tile. Ghosts must have positions.
pub(crate) struct Evaluate<'a> {
    pub(crate) tile: &'a Tile,
    pub(crate) fields: TileFields<'a>,
    pub(crate) scratch: &'a mut Extrapolated,
    pub(crate) parameters: StepParameters,
    pub(crate) evaluation: &'a Evaluation,
}

/// What forces that are held have done [J]: they work over the way from half a step before an evaluation to
/// half a step before the next. Sums over nodes of force times position there; a shift adds nothing, because
/// the forces of all elements are in balance.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct HeldWork {
    /// Of the forces that were held until now.
    pub(crate) released: f64,
    /// Of the forces that are held from now on.
    pub(crate) taken_up: f64,
}

impl std::ops::Add for HeldWork {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { released: self.released + other.released, taken_up: self.taken_up + other.taken_up }
    }
}

impl WithSimd for Evaluate<'_> {
    type Output = HeldWork;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> HeldWork {
        let Self { tile, fields, scratch, parameters, evaluation } = self;
        let Some(structural) = &tile.structural else { return HeldWork::default() };
        let TileFields { x, y, vx, vy, branches, .. } = fields;
        let BranchFields { path, held: [held_x, held_y] } = branches;
        let (n, half) = (tile.slots.len(), 0.5 * parameters.dt);
        let (ways_x, ways_y) = ([&*x, &*vx], [&*y, &*vy]);
        let released = virial(held_x, ways_x, half, tile.own) + virial(held_y, ways_y, half, tile.own);
        let Extrapolated { x: seen_x, y: seen_y, fx, fy } = scratch;
        let (seen_x, seen_y) = (&mut seen_x[..n], &mut seen_y[..n]);
        follow(simd, structural, [x, y], path, [&mut *seen_x, &mut *seen_y], evaluation);
        let (fx, fy) = (&mut fx[..n], &mut fy[..n]);
        fx.fill(0.0);
        fy.fill(0.0);
        tile_forces(simd, tile, [seen_x, seen_y, vx, vy], [&mut *fx, &mut *fy], parameters.fetch);
        for (held, force) in [(&mut *held_x, fx), (&mut *held_y, fy)] {
            for (held, force) in held.iter_mut().zip(force) {
                *held = (-evaluation.share * *force) as f32;
            }
        }
        let (ways_x, ways_y) = ([&*x, &*vx], [&*y, &*vy]);
        let taken_up = virial(held_x, ways_x, half, tile.own) + virial(held_y, ways_y, half, tile.own);
        HeldWork { released, taken_up }
    }
}

/// Sum of forces on the first `own` nodes times where these were a time `half` [s] ago [J].
#[inline(always)]
fn virial(force: &[f32], [at, v]: [&[f64]; 2], half: f64, own: usize) -> f64 {
    let mut columns = [0.0; LANES];
    let whole = own - own % LANES;
    for first in (0..whole).step_by(LANES) {
        let group = first..first + LANES;
        let (force, at, v) = (&force[group.clone()], &at[group.clone()], &v[group]);
        for l in 0..LANES {
            columns[l] += f64::from(force[l]) * (at[l] - half * v[l]);
        }
    }
    let rest: f64 = (whole..own).map(|n| f64::from(force[n]) * (at[n] - half * v[n])).sum();
    columns.iter().sum::<f64>() + rest
}

/// Takes the path of the branch to the present, and says where its springs pull from.
///
/// Paths turn with the bodies: a rigid motion then leads to one and the same shift of all nodes, which gives
/// no force.
#[inline(always)]
fn follow<S: Simd>(
    simd: S,
    structural: &TileStructural,
    [x, y]: [&[f64]; 2],
    [path_x, path_y]: [&mut [f64]; 2],
    [seen_x, seen_y]: [&mut [f64]; 2],
    &Evaluation { keep, back, since, middle, .. }: &Evaluation,
) {
    let turned = |time: f64| {
        let angles = structural.spin.map(|spin| spin * time);
        (angles.map(libm::cos), angles.map(libm::sin))
    };
    let ((cos, sin), (cos_ahead, sin_ahead)) = (turned(since), turned(middle));
    let [kept, new] = [keep, 1.0 - keep].map(|share| Vector::all(simd, share));
    let [from_path, from_node] = [1.0 + back, -back].map(|w| Vector::all(simd, w));
    // A tile's slots are whole lines of cache.
    for i in (0..x.len()).step_by(Vector::<S>::LEN) {
        let lane = i % LANES;
        let (c, s) = (Vector::load(simd, &cos, lane), Vector::load(simd, &sin, lane));
        let (x, y) = (Vector::load(simd, x, i), Vector::load(simd, y, i));
        let (px, py) = (Vector::load(simd, path_x, i), Vector::load(simd, path_y, i));
        let qx = kept.times_plus(c.times_plus(px, -(s * py)), new * x);
        let qy = kept.times_plus(s.times_plus(px, c * py), new * y);
        qx.store(path_x, i);
        qy.store(path_y, i);
        let (ux, uy) = (from_path.times_plus(qx, from_node * x), from_path.times_plus(qy, from_node * y));
        let (c, s) = (Vector::load(simd, &cos_ahead, lane), Vector::load(simd, &sin_ahead, lane));
        c.times_plus(ux, -(s * uy)).store(seen_x, i);
        s.times_plus(ux, c * uy).store(seen_y, i);
    }
}
