//! Fourth stage: forces on rollers, group by group, and their motion.

use pulp::Simd;
use stribeck_simd::lanes::LANES;

use crate::{
    bearing::Bearing,
    cage::pocket::PlacedCage,
    oil::FilmStep,
    roller_force::RollerForce,
    rollers::{block::Block, row::of_one},
    state::State,
    step::{
        Scratch,
        drive::Drive,
        sums::{Sums, Tally},
    },
};

impl Bearing {
    /// Forces of raceways, oil and cage on all rollers, which move under them. Returns the forces of rollers on the cage: two components
    /// [N] and the moment about its centre of mass [N m].
    #[inline(always)]
    pub(crate) fn advance_rollers<S: Simd>(
        &self,
        simd: S,
        state: &mut State,
        scratch: &mut Scratch,
        drive: &Drive,
        tally: &mut Tally,
    ) -> [f64; 3] {
        let placed = PlacedCage::of(state, self.reduction.cage.map_or([0.0; 2], |cage| cage.1));
        let mut on_cage = [0.0; 3];
        let mut sums = Sums::<S>::new(simd);
        let farthest = self.farthest(simd, &scratch.modes, state.seat.as_ref());
        for b in 0..scratch.blocks.len() {
            let block = &mut scratch.blocks[b];
            let seat = state.seat.as_ref();
            self.locate_on_raceways(simd, &scratch.modes, seat, farthest, block, drive.rings());
            let Block { first, top, bits, contacts, .. } = block;
            // One code for both raceways: the step's instructions fill the first cache anyway.
            for (raceway, contacts) in [&self.outer, &self.inner].into_iter().zip(contacts) {
                self.normal_forces(simd, raceway, *first, top, *bits, contacts, &mut scratch.parts);
            }
            self.push_rollers(simd, block, drive, &mut sums);
            let by_film = self.push_by_oil(state, block, drive, tally);
            self.push_modes(simd, scratch, b, by_film);
            let block = &mut scratch.blocks[b];
            for (raceway, contacts) in [&self.outer, &self.inner].into_iter().zip(&block.contacts) {
                scratch.deepest = scratch.deepest.max(Self::deepest(contacts));
                if tally.last {
                    self.stored_in_contacts(raceway, contacts, &mut tally.stored);
                }
            }
            block.force[2] = Default::default();
            if let Some(cage) = &self.cage {
                let by_walls = self.in_pockets(simd, cage, &cage.wall_rows[b], placed, block, tally);
                for (sum, part) in on_cage.iter_mut().zip(by_walls) {
                    *sum += part;
                }
            }
            self.move_rollers(simd, block, tally.last, &mut sums);
        }
        tally.add(&sums, drive, self.time_step);
        on_cage
    }

    /// Adds the forces of oil films to those on a group of rollers. Returns normal forces [N] and stiffnesses [N/m] of the films at the
    /// outer raceway.
    #[inline(always)]
    fn push_by_oil(
        &self,
        state: &mut State,
        block: &mut Block,
        drive: &Drive,
        tally: &mut Tally,
    ) -> [[f64; LANES]; 2] {
        let (Some(oil), Some(films)) = (&self.oil, &mut state.films) else { return [[0.0; LANES]; 2] };
        let dt = self.time_step;
        let step = FilmStep { step: state.steps, dt, last: tally.last, felt: self.seat.is_some() };
        let by_oil = self.add_film_forces(oil, films, block, drive.rings(), step);
        tally.stored.contact += by_oil.stored;
        for (ring, moment) in drive.rings().into_iter().zip(by_oil.drive) {
            tally.spent.drive += ring.map_or(0.0, |ring| dt * ring.rate * moment);
        }
        [by_oil.normal, by_oil.stiffness]
    }

    /// Adds the forces of a group of rollers to those on the modes, and keeps what sensors and seat respond to beyond the modes.
    #[inline(always)]
    fn push_modes<S: Simd>(&self, simd: S, scratch: &mut Scratch, b: usize, by_film: [[f64; LANES]; 2]) {
        let block = &scratch.blocks[b];
        for lane in 0..block.count {
            let (facet, share) = (block.facet[lane], block.share[lane]);
            let force = of_one(&block.force[0], lane);
            if force != [0.0; 2] {
                self.press(simd, &self.raceway_point(facet as usize, share), force, &mut scratch.modes);
            }
            let force = block.contacts[0].normal[lane] + by_film[0][lane];
            let roller = &mut scratch.roller_forces[block.first + lane];
            let stiffness = block.contacts[0].stiffness(self.penalty, lane) + by_film[1][lane];
            *roller = RollerForce { growth: force - roller.force, force, stiffness, ..*roller };
        }
    }
}
