//! Modes of outer ring and adapter in a step, in vectors over modes: motion of the raceway under a roller,
//! modal forces of rollers, and motion of the modes (THEORY §9.3, §9.4).

use crate::modal::{
    Reduction,
    parameters::{Branch, Damping},
};
use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::{
    drive::LoadChange,
    row::{Numbers, Row, Single, closed_in_single, largest_of},
    seat::{RollerResponses, Springs},
    state::State,
    tally::Tally,
};

/// A place on a facet of the outer raceway: the share of its second vertex, and the shapes at both of them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RacewayPoint<'a> {
    pub(crate) share: f64,
    /// Of x and of y, in groups of modes.
    shapes: [[&'a [Single]; 2]; 2],
}

/// Coordinates and velocities of the modes, and the forces on them, in rows.
#[derive(Debug, Clone, Default)]
pub(crate) struct Modes {
    pub(crate) q: Vec<Row>,
    pub(crate) v: Vec<Row>,
    pub(crate) push: Vec<Row>,
    /// Forces of dampers, negative; empty without dampers.
    pub(crate) drag: Vec<Row>,
    /// Tensions of the seat's springs beyond those of the preload [N]; empty where there is no seat.
    pub(crate) tension: Vec<Row>,
    pub(crate) responses: RollerResponses,
}

impl Modes {
    /// Room for those of a structure, in a seat if there is one.
    pub(crate) fn new(structure: &Structure, seat: Option<&Springs>) -> Self {
        let rows = vec![Row::default(); structure.groups];
        let tension = vec![Row::default(); seat.map_or(0, Springs::rows)];
        let drag = if structure.dampers.is_empty() { Vec::new() } else { rows.clone() };
        Self {
            q: rows.clone(),
            v: rows.clone(),
            push: rows,
            drag,
            tension,
            responses: RollerResponses::default(),
        }
    }

    /// Takes coordinates and velocities of a state, and forces to begin with.
    #[inline(always)]
    pub(crate) fn begin(&mut self, state: &State, push: &[f64]) {
        for (rows, values) in [(&mut self.q, &state.q[..]), (&mut self.v, &state.v), (&mut self.push, push)] {
            for (row, values) in rows.iter_mut().zip(values.as_chunks().0) {
                *row = Row(*values);
            }
        }
    }
}

/// Modes of outer ring and housing: tables for a step.
#[derive(Debug, Clone)]
pub(crate) struct Structure {
    /// Groups of modes.
    groups: usize,
    /// Shapes at the vertices of the outer raceway, in rows; the first vertex again after the last one.
    shapes: Vec<Single>,
    /// Whether all of them move alike: the ring is rigid.
    is_rigid: bool,
    /// Largest displacement of any of these vertices by a unit of each mode [1/√kg].
    pub(crate) farthest: Vec<Row>,
    /// Dampers of the housing, in rows: forces on every mode by a unit velocity of each; empty without
    /// dampers.
    pub(crate) dampers: Vec<Row>,
    /// Mass damping [1/s] and stiffness damping [s].
    pub(crate) mass_damping: f64,
    stiffness_damping: f64,
    pub(crate) branches: Vec<Branch>,
}

impl Structure {
    pub(crate) fn new(reduction: &Reduction, damping: &Damping) -> Self {
        Self {
            groups: reduction.padded / LANES,
            shapes: closed_in_single(&reduction.shapes, 2 * reduction.padded / LANES),
            is_rigid: reduction.shapes.chunks_exact(2 * reduction.padded).is_sorted_by(|a, b| a == b),
            farthest: largest_of::<2>(&reduction.shapes, reduction.padded),
            dampers: reduction.dampers.as_chunks::<LANES>().0.iter().copied().map(Row).collect(),
            mass_damping: damping.mass_of_modes,
            stiffness_damping: damping.stiffness,
            branches: damping.branches.clone(),
        }
    }

    /// The place on a facet with this share of its second vertex.
    #[inline(always)]
    pub(crate) fn raceway_point(&self, facet: usize, share: f64) -> RacewayPoint<'_> {
        let groups = self.groups;
        let (first, second) = self.shapes[2 * groups * facet..][..4 * groups].split_at(2 * groups);
        RacewayPoint { share, shapes: [first.split_at(groups).into(), second.split_at(groups).into()] }
    }

    /// How the raceway of a rigid ring moves with the modes: as [`Self::moved`], summed.
    #[inline(always)]
    pub(crate) fn rigidly_moved<S: Simd>(&self, simd: S, modes: &Modes) -> Option<[f64; 6]> {
        if !self.is_rigid {
            return None;
        }
        let [x, y, vx, vy, ..] = self.moved(simd, &self.raceway_point(0, 0.0), modes);
        Some([x.sum(), y.sum(), vx.sum(), vy.sum(), 0.0, 0.0])
    }

    /// How the raceway moves with the modes at a place, in parts to be summed: displacement [m], velocity
    /// [m/s], and by how much more the second vertex of its facet is displaced than the first [m]. Both
    /// vertices are summed over all modes, and the points between follow.
    #[inline(always)]
    pub(crate) fn moved<S: Simd>(&self, simd: S, point: &RacewayPoint<'_>, modes: &Modes) -> [Vector<S>; 6] {
        let groups = self.groups;
        let [[ax, ay], [bx, by]] = point.shapes;
        let (q, v) = (&modes.q[..groups], &modes.v[..groups]);
        let zero = Vector::all(simd, 0.0);
        let (mut first, mut second) = ([zero; 4], [zero; 4]);
        let (ahead, behind) = (ax.iter().zip(ay), bx.iter().zip(by));
        for (((q, v), (ax, ay)), (bx, by)) in q.iter().zip(v).zip(ahead).zip(behind) {
            for at in vector_starts(simd) {
                let (q, v) = (Vector::load(simd, q, at), Vector::load(simd, v, at));
                let (x, y) = (ax.load(simd, at), ay.load(simd, at));
                first[0] = x.times_plus(q, first[0]);
                first[1] = y.times_plus(q, first[1]);
                first[2] = x.times_plus(v, first[2]);
                first[3] = y.times_plus(v, first[3]);
                let (x, y) = (bx.load(simd, at), by.load(simd, at));
                second[0] = x.times_plus(q, second[0]);
                second[1] = y.times_plus(q, second[1]);
                second[2] = x.times_plus(v, second[2]);
                second[3] = y.times_plus(v, second[3]);
            }
        }
        let share = Vector::all(simd, point.share);
        let [dx, dy] = [second[0] - first[0], second[1] - first[1]];
        let [vx, vy] = [second[2] - first[2], second[3] - first[3]];
        [
            share.times_plus(dx, first[0]),
            share.times_plus(dy, first[1]),
            share.times_plus(vx, first[2]),
            share.times_plus(vy, first[3]),
            dx,
            dy,
        ]
    }

    /// Adds the modal forces by a roller on which the raceway presses with `force` at a place.
    #[inline(always)]
    pub(crate) fn press<S: Simd>(
        &self,
        simd: S,
        point: &RacewayPoint<'_>,
        force: [f64; 2],
        modes: &mut Modes,
    ) {
        let groups = self.groups;
        let [[ax, ay], [bx, by]] = point.shapes;
        let push = &mut modes.push[..groups];
        let [first, second] = [point.share - 1.0, -point.share];
        let (fx, fy) = (Vector::all(simd, first * force[0]), Vector::all(simd, first * force[1]));
        let (sx, sy) = (Vector::all(simd, second * force[0]), Vector::all(simd, second * force[1]));
        let (ahead, behind) = (ax.iter().zip(ay), bx.iter().zip(by));
        for ((push, (ax, ay)), (bx, by)) in push.iter_mut().zip(ahead).zip(behind) {
            for at in vector_starts(simd) {
                let here = ax.load(simd, at).times_plus(fx, Vector::load(simd, push, at));
                let here = ay.load(simd, at).times_plus(fy, here);
                let there = bx.load(simd, at) * sx;
                let there = by.load(simd, at).times_plus(sy, there);
                (here + there).store(push, at);
            }
        }
    }

    /// Forces of the housing's dampers at the velocities of the modes, into `push`; `drag` keeps them.
    #[inline(always)]
    pub(crate) fn resist<S: Simd>(&self, simd: S, modes: &mut Modes) {
        let Modes { v, push, drag, .. } = modes;
        let columns = self.dampers.chunks_exact(drag.len());
        drag.fill(Row::default());
        for (column, v) in columns.zip(v.iter().flat_map(|row| row.iter())) {
            let v = Vector::all(simd, *v);
            for (drag, column) in drag.iter_mut().zip(column) {
                for at in vector_starts(simd) {
                    let sum = Vector::load(simd, column, at).times_plus(v, Vector::load(simd, drag, at));
                    sum.store(drag, at);
                }
            }
        }
        for (push, drag) in push.iter_mut().zip(drag.iter()) {
            for (push, drag) in push.iter_mut().zip(drag.iter()) {
                *push -= drag;
            }
        }
    }

    /// Modes move in a step of `dt` [s] under the forces `push`, with `load` beyond that of the preload.
    #[expect(
        clippy::too_many_arguments,
        reason = "what a step reads and what it changes, each borrowed by itself"
    )]
    #[inline(always)]
    pub(crate) fn advance<S: Simd>(
        &self,
        simd: S,
        dt: f64,
        reduction: &Reduction,
        state: &mut State,
        modes: &Modes,
        load: &LoadChange<'_>,
        tally: &mut Tally,
    ) {
        let Tally { last, stored: energy, spent } = tally;
        let r = reduction.padded;
        let h = 0.5 * self.mass_damping * dt;
        spent.external += 0.5 * dt * load.power(&state.v);
        for (branch, stretch) in self.branches.iter().zip(&mut state.branches) {
            let e = libm::exp(-dt / branch.relaxation_time);
            for (u, v) in stretch.iter_mut().zip(&state.v) {
                *u = e * *u + branch.relaxation_time * (1.0 - e) * v;
            }
        }
        let all = |value: f64| Vector::all(simd, value);
        let (kept, gain) = (all((1.0 - h) / (1.0 + h)), all(dt / (1.0 + h)));
        let (alpha, beta, half, step) = (all(2.0 * h / dt), all(self.stiffness_damping), all(0.5), all(dt));
        let squares = &reduction.squares[..r];
        let (external, constant) = (&reduction.external[..r], &reduction.constant[..r]);
        let mut sums = [all(0.0); 4];
        for at in (0..r).step_by(Vector::<S>::LEN) {
            let (q, v) = (Vector::load(simd, &state.q, at), Vector::load(simd, &state.v, at));
            let square = Vector::load(simd, squares, at);
            let mut ahead = beta * v;
            for (branch, stretch) in self.branches.iter().zip(&state.branches) {
                ahead = all(branch.stiffness).times_plus(Vector::load(simd, stretch, at), ahead);
            }
            let a = (-square).times_plus(q + ahead, Vector::load(simd, &modes.push[at / LANES], at % LANES));
            let new = kept.times_plus(v, gain * a);
            let mean = half * (v + new);
            let outside = Vector::load(simd, external, at);
            sums[0] = mean.times_plus(outside, sums[0]);
            sums[1] = alpha.times_plus(mean, square * ahead).times_plus(mean, sums[1]);
            if let Some(drag) = modes.drag.get(at / LANES) {
                sums[1] = mean.times_plus(Vector::load(simd, drag, at % LANES), sums[1]);
            }
            if *last {
                sums[2] = v.times_plus(new, sums[2]);
                let held = outside - Vector::load(simd, constant, at);
                sums[3] = (half * square).times_plus(q, held).times_plus(q, sums[3]);
            }
            new.store(&mut state.v, at);
            step.times_plus(new, q).store(&mut state.q, at);
        }
        spent.external += dt * sums[0].sum();
        spent.external += 0.5 * dt * load.power(&state.v);
        spent.damped += dt * sums[1].sum();
        if *last {
            energy.kinetic += 0.5 * sums[2].sum();
            energy.strain += reduction.strain + sums[3].sum();
        }
    }
}
