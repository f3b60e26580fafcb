//! Eight rollers side by side: loaded from the state before some steps, and written back after them.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Vector};

use super::Rollers;
use crate::{
    contact::penetration::Penetration,
    contact::raceway::Raceway,
    contact::round::RoundParts,
    contact::segments::Segments,
    oil::{BlockFilms, Lubrication},
    row::{Row, Rows, lanes, of_one},
    state::State,
};

/// Eight rollers; where there are fewer, those that are missing rest beside the bearing.
#[derive(Debug, Clone, Default)]
#[repr(align(64))]
pub(crate) struct Block {
    /// The first of them.
    pub(crate) first: usize,
    /// How many there are, a bit for each, and one for each.
    pub(crate) count: usize,
    pub(crate) bits: u64,
    pub(crate) present: Row,
    /// Those whose rims are round, a bit for each.
    pub(crate) round: u64,
    /// Centres [m], their velocities [m/s], angles [rad] and angular velocities [rad/s].
    pub(crate) centre: Rows,
    pub(crate) velocity: Rows,
    pub(crate) angle: Row,
    pub(crate) spin: Row,
    /// Directions of vertex 0.
    pub(crate) turned: Rows,
    /// Radii of the circles around them [m].
    pub(crate) top: Row,
    /// By how much their radii exceed those of their rims [m].
    pub(crate) larger: Row,
    /// From the bearing's centre [m], and the direction there.
    pub(crate) distance: Row,
    pub(crate) radial: Rows,
    /// The direction in the frame of the outer raceway, both ends of the facet that it goes through there,
    /// and for whom these are known.
    pub(crate) along: Rows,
    pub(crate) ends: [Rows; 2],
    pub(crate) placed: u64,
    /// The place on the outer raceway: facet and share of its second vertex; one over the angle that the
    /// facet takes [1/rad]; displacement there [m], velocity [m/s], and change of the displacement with the
    /// angle [m/rad].
    pub(crate) facet: [u32; LANES],
    pub(crate) share: Row,
    pub(crate) per_angle: Row,
    pub(crate) by: Rows,
    pub(crate) moving: Rows,
    pub(crate) tilt: Rows,
    /// Largest displacement of the raceway under them since these were known [m].
    pub(crate) drift: Row,
    /// Parts of that motion: by the modes, as of [`Bearing::moved`], and by the seat at both vertices, roller
    /// by roller in parts, and summed.
    pub(crate) parts_of_motion: [[Row; 8]; LANES],
    pub(crate) moved: [Row; 8],
    /// At outer and inner raceway.
    pub(crate) contacts: [RacewayContacts; 2],
    /// Films of oil; none without oil.
    pub(crate) films: BlockFilms,
    /// At the two walls of each pocket.
    pub(crate) walls: [Walls; 2],
    /// Forces by outer raceway, inner raceway and cage in this step [N], and their moment [N m].
    pub(crate) force: [Rows; 3],
    pub(crate) moment: Row,
    /// By how much their outward speeds exceed those at which dampers take energy [m/s].
    pub(crate) shadow: Row,
    /// Forces that neither raceway nor cage takes up [N]: towards smaller displacement of the outer raceway
    /// (THEORY (9.5a)), and by oil that is pushed along.
    pub(crate) downhill: Rows,
    /// The forces, summed over the steps since the last sample.
    pub(crate) sums: [Rows; 3],
}

/// Contacts of eight rollers with a raceway, in the frame of its outline.
#[derive(Debug, Clone, Default)]
pub(crate) struct RacewayContacts {
    /// From the state: normal force of the last step and its growth [N], elastic
    /// slip [m], drag and damping force [N] and damping moment [N m], facets of roller and raceway.
    pub(crate) force: Row,
    pub(crate) growth: Row,
    pub(crate) slip: Row,
    pub(crate) passive: [Row; 3],
    pub(crate) hints: [[u32; 2]; LANES],
    /// Centre, its distance from that of the raceway, the direction of the roller's vertex 0, and that to the
    /// contact, in the frame of the roller, too.
    pub(crate) centre: Rows,
    pub(crate) distance: Row,
    pub(crate) spin: Rows,
    pub(crate) d: Rows,
    pub(crate) own: Rows,
    /// Circle that nothing of the raceway stands out from there [m], and the depth between the circles around
    /// both.
    pub(crate) bound: Row,
    pub(crate) most: Row,
    /// Those that may touch, and on arcs those of them that are round.
    pub(crate) near: u64,
    pub(crate) near_round: u64,
    pub(crate) segments: [Segments; LANES],
    pub(crate) pieces: RoundParts,
    /// How much of ragged edges is gone where the rollers meet them [m].
    pub(crate) ragged: Row,
    /// Start of the search for the force: a force [N] and its root, the deflection of the bodies at it [m],
    /// the derivative of that [m/N], and how far from its middle the contact may reach [m].
    pub(crate) start: Row,
    pub(crate) root: Row,
    pub(crate) shift: Row,
    pub(crate) flexibility: Row,
    pub(crate) reach: Row,
    /// The piece of the compliance there, as of [`crate::modal::compliance::Curve::piece_at`].
    pub(crate) knot: Row,
    pub(crate) first: Row,
    pub(crate) slope: Row,
    pub(crate) next: Row,
    /// Its result: normal force [N], and the penetration at it.
    pub(crate) normal: Row,
    pub(crate) overlap: Penetration<Row>,
}

impl RacewayContacts {
    /// Looks up the pieces of the compliance on which the roots of the forces of some contacts lie.
    #[inline(always)]
    pub(crate) fn look_up(&mut self, raceway: &Raceway, these: u64) {
        for lane in lanes(these) {
            let [knot, first, slope, next] = raceway.curve.piece_at(self.root[lane]);
            (self.knot[lane], self.first[lane]) = (knot, first);
            (self.slope[lane], self.next[lane]) = (slope, next);
        }
    }

    /// Stiffness of one contact as the raceway recedes and the roller stays [N/m].
    #[inline(always)]
    pub(crate) fn stiffness(&self, penalty: f64, lane: usize) -> f64 {
        let own = penalty * self.overlap.length[lane];
        if self.normal[lane] > 0.0 { own / (1.0 + own * self.flexibility[lane]) } else { 0.0 }
    }
}

/// Contacts of eight rollers with a wall of their pockets: elastic slip [m], drag and damping force [N].
#[derive(Debug, Clone, Default)]
pub(crate) struct Walls {
    pub(crate) slip: Row,
    pub(crate) passive: Rows,
}

impl Block {
    /// The rollers from `first` on, with their constant data.
    pub(crate) fn new(rollers: &Rollers, raceways: &[Raceway; 2], first: usize) -> Self {
        let count = (rollers.count - first).min(LANES);
        let mut block = Self { first, count, bits: (1 << count) - 1, ..Self::default() };
        // Those that are missing keep clear of both raceways.
        block.centre[0] = Row([raceways[0].bound; LANES]);
        block.drift = Row([f64::INFINITY; LANES]);
        for (contacts, raceway) in block.contacts.iter_mut().zip(raceways) {
            contacts.bound = Row([raceway.bound; LANES]);
        }
        for lane in 0..count {
            block.present[lane] = 1.0;
            let rim = rollers.rim(first + lane);
            block.top[lane] = rim.top;
            block.larger[lane] = rollers.larger[first + lane];
            block.round |= u64::from(rim.is_round) << lane;
        }
        block
    }

    /// Sums up how the outer raceway moves under each of the rollers.
    #[inline(always)]
    pub(crate) fn sum_motion<S: Simd>(&mut self, simd: S) {
        for (n, to) in self.moved.iter_mut().enumerate() {
            Vector::store_sums(simd, self.parts_of_motion.each_ref().map(|pose| &pose[n][..]), &mut to.0);
        }
    }

    /// Takes the rollers from a state, with their films where there is oil.
    pub(crate) fn load(&mut self, rollers: &Rollers, oil: Option<&Lubrication>, state: &State) {
        if let (Some(oil), Some(films)) = (oil, &state.films) {
            self.films = oil.block_films(&rollers.rim_of, films, [self.first, self.count]);
        }
        for lane in 0..self.count {
            let i = self.first + lane;
            let of = |column: &mut Row, value: f64| column[lane] = value;
            of(&mut self.centre[0], state.x[i]);
            of(&mut self.centre[1], state.y[i]);
            of(&mut self.velocity[0], state.vx[i]);
            of(&mut self.velocity[1], state.vy[i]);
            of(&mut self.angle, state.angle[i]);
            of(&mut self.spin, state.spin[i]);
            of(&mut self.turned[0], state.turned[i][0]);
            of(&mut self.turned[1], state.turned[i][1]);
            for (k, contacts) in self.contacts.iter_mut().enumerate() {
                of(&mut contacts.force, state.force[k][i]);
                of(&mut contacts.growth, state.growth[k][i]);
                of(&mut contacts.slip, state.slip[k][i]);
                for (column, value) in contacts.passive.iter_mut().zip(state.passive[k][i]) {
                    of(column, value);
                }
                contacts.hints[lane] = state.hints[k][i];
            }
            self.facet[lane] = state.hints[0][i][1];
            for (side, walls) in self.walls.iter_mut().enumerate() {
                of(&mut walls.slip, state.wall_slip[i][side]);
                for (column, value) in walls.passive.iter_mut().zip(state.wall_passive[i][side]) {
                    of(column, value);
                }
            }
        }
    }

    /// Begins a sample, of which `anew` is a roller: its direction is taken from its angle, because turning
    /// it step by step rounds.
    pub(crate) fn begin(&mut self, rollers: &Rollers, anew: usize) {
        self.sums = Default::default();
        // A resumed run begins here: it has no pieces, and the facets of the outer raceway that rollers are
        // over, not those where pieces were listed last.
        self.contacts.iter_mut().for_each(|contacts| contacts.pieces.forget());
        for lane in lanes(self.bits) {
            self.contacts[0].hints[lane][1] = self.facet[lane];
        }
        if (self.first..self.first + self.count).contains(&anew) {
            let lane = anew - self.first;
            let (s, c) = libm::sincos(self.angle[lane] + rollers.starts[anew].vertex_angle);
            (self.turned[0][lane], self.turned[1][lane]) = (c, s);
        }
    }

    /// Writes to the state the sampled quantities: positions, angles, normal forces and films.
    pub(crate) fn show(&self, state: &mut State) {
        let (of, n) = (self.first..self.first + self.count, self.count);
        let columns = [
            (&mut state.x, &self.centre[0]),
            (&mut state.y, &self.centre[1]),
            (&mut state.angle, &self.angle),
        ];
        let forces = state.force.iter_mut().zip(self.contacts.iter().map(|contacts| &contacts.force));
        for (column, row) in columns.into_iter().chain(forces) {
            column[of.clone()].copy_from_slice(&row[..n]);
        }
        if let Some(films) = &mut state.films {
            self.films.store(self.first, n, films);
        }
    }

    /// Leaves the rollers to a state.
    pub(crate) fn store(&self, state: &mut State) {
        self.show(state);
        for lane in 0..self.count {
            let i = self.first + lane;
            [state.vx[i], state.vy[i]] = [self.velocity[0][lane], self.velocity[1][lane]];
            state.spin[i] = self.spin[lane];
            state.turned[i] = of_one(&self.turned, lane);
            for (k, contacts) in self.contacts.iter().enumerate() {
                state.growth[k][i] = contacts.growth[lane];
                state.slip[k][i] = contacts.slip[lane];
                state.passive[k][i] = contacts.passive.map(|column| column[lane]);
                state.hints[k][i] = contacts.hints[lane];
            }
            // As `begin` has it.
            state.hints[0][i][1] = self.facet[lane];
            for (side, walls) in self.walls.iter().enumerate() {
                state.wall_slip[i][side] = walls.slip[lane];
                state.wall_passive[i][side] = walls.passive.map(|column| column[lane]);
            }
        }
    }
}
