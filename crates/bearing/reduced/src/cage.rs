//! The cage as a reduced bearing has it: a rigid body with the walls of its pockets.

pub(crate) mod pocket;

mod corner;
mod flat;

use crate::modal::{
    compliance::{Compliance, Curve},
    parameters::Pockets,
};
use stribeck_simd::lanes::LANES;

use crate::{row::Rows, state::State, tally::Tally};
use corner::Corner;

/// The cage as a rigid body with corners and walls.
#[derive(Debug, Clone)]
pub(crate) struct Cage {
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
    /// Centre of mass at the start [m].
    pub(crate) centre: [f64; 2],
    /// Two walls for each roller: the one behind it, clockwise, and the one before it, seen from the centre
    /// of mass.
    pub(crate) walls: Vec<[Wall; 2]>,
    /// The same, of eight rollers side by side.
    pub(crate) wall_rows: Vec<[WallRows; 2]>,
    /// The inner and the outer end of each wall.
    pub(crate) corners: [Corner; 2],
    /// Whether rollers stand between the ends of the walls, not at one of them.
    pub(crate) has_flats: bool,
    /// Compliance of a roller on a wall.
    pub(crate) curve: Curve,
}

/// A wall from its inner to its outer end, with the normal that points into the pocket.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wall {
    pub(crate) inner: [f64; 2],
    /// From the inner to the outer end [m], and the same over its square [1/m].
    pub(crate) edge: [f64; 2],
    pub(crate) per_length: [f64; 2],
    pub(crate) normal: [f64; 2],
}

/// One wall of each of eight rollers: as of one.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct WallRows {
    pub(crate) inner: Rows,
    pub(crate) edge: Rows,
    pub(crate) per_length: Rows,
    pub(crate) normal: Rows,
}

impl WallRows {
    /// Of eight rollers or fewer.
    fn of(walls: &[[Wall; 2]]) -> [Self; 2] {
        [0, 1].map(|side| {
            let mut rows = Self::default();
            for (lane, wall) in walls.iter().map(|both| both[side]).enumerate() {
                for c in 0..2 {
                    rows.inner[c][lane] = wall.inner[c];
                    rows.edge[c][lane] = wall.edge[c];
                    rows.per_length[c][lane] = wall.per_length[c];
                    rows.normal[c][lane] = wall.normal[c];
                }
            }
            rows
        })
    }
}

impl Wall {
    fn new([a, b]: [[f64; 2]; 2], normal: [f64; 2]) -> Self {
        let edge = [b[0] - a[0], b[1] - a[1]];
        let square = edge[0] * edge[0] + edge[1] * edge[1];
        Self { inner: a, edge, per_length: [edge[0] / square, edge[1] / square], normal }
    }
}

impl Cage {
    /// From its pockets, mass and moment of inertia and centre of mass. `compliance` is that of a roller on a
    /// wall.
    pub(crate) fn new(
        pockets: &Pockets,
        [mass, inertia]: [f64; 2],
        centre: [f64; 2],
        compliance: &Compliance,
    ) -> Self {
        let ([inner, outer], half, path) = (pockets.ends, pockets.half_width, pockets.path);
        let walls: Vec<[Wall; 2]> = pockets
            .angles
            .iter()
            .map(|angle| {
                let (s, c) = libm::sincos(*angle);
                let wall = |side: f64| {
                    let end = |radius: f64| {
                        let along = (radius * radius - half * half).sqrt();
                        // Ahead of the pocket's axis, counter-clockwise, with side +1.
                        [along * c - side * half * s - centre[0], along * s + side * half * c - centre[1]]
                    };
                    Wall::new([end(inner), end(outer)], [side * s, -side * c])
                };
                [wall(-1.0), wall(1.0)]
            })
            .collect();
        // On the x axis, with the wall on the side of +y.
        let corners = [inner, outer].map(|radius: f64| {
            let along = (radius * radius - half * half).sqrt();
            Corner::new([along - path, half], pockets.facet, pockets.points_per_facet)
        });
        let wall_rows = walls.chunks(LANES).map(WallRows::of).collect();
        let [before, behind] = [inner, outer].map(|radius: f64| (radius * radius - half * half).sqrt());
        let has_flats = before < path && path < behind;
        Self { mass, inertia, centre, walls, wall_rows, corners, has_flats, curve: compliance.curve() }
    }

    /// Moves in a step of `dt` [s] under the forces of all rollers [N], their moment [N m] and its weight.
    #[inline(always)]
    pub(crate) fn advance(
        &self,
        dt: f64,
        gravity: f64,
        on_cage: [f64; 3],
        state: &mut State,
        tally: &mut Tally,
    ) {
        let old = state.cage_velocity;
        let acceleration =
            [on_cage[0] / self.mass, on_cage[1] / self.mass - gravity, on_cage[2] / self.inertia];
        let new: [f64; 3] = std::array::from_fn(|c| old[c] + dt * acceleration[c]);
        tally.spent.external -= 0.5 * dt * gravity * self.mass * (old[1] + new[1]);
        if tally.last {
            tally.stored.kinetic +=
                0.5 * (self.mass * (old[0] * new[0] + old[1] * new[1]) + self.inertia * old[2] * new[2]);
        }
        state.cage_velocity = new;
        for (coordinate, v) in state.cage.iter_mut().zip(new) {
            *coordinate += dt * v;
        }
    }
}
