//! Fourth stage: forces on rollers, group by group, and their motion.

use pulp::Simd;
use stribeck_simd::lanes::LANES;

use crate::{
    bearing::Bearing,
    cage::pocket::{InPockets, PlacedCage},
    drive::Drive,
    law::ContactLaw,
    oil::FilmStep,
    roller_force::RollerForce,
    rollers::block::Block,
    row::of_one,
    state::State,
    step::Scratch,
    tally::{Sums, Tally},
};

impl Bearing {
    /// Forces of raceways, oil and cage on all rollers, which move under them. Returns the forces of rollers
    /// on the cage: two components [N] and the moment about its centre of mass [N m].
    #[inline(always)]
    pub(crate) fn advance_rollers<S: Simd>(
        &self,
        simd: S,
        state: &mut State,
        scratch: &mut Scratch,
        drive: &Drive,
        tally: &mut Tally,
    ) -> [f64; 3] {
        let pockets = self.cage.as_ref().map(|cage| InPockets {
            cage,
            placed: PlacedCage::of(state, cage.centre),
            rollers: &self.rollers,
            law: &self.law,
            round: self.raceways[0].sides.are_round(),
        });
        let mut on_cage = [0.0; 3];
        let mut sums = Sums::<S>::new(simd);
        let Scratch { blocks, parts, modes, .. } = &mut *scratch;
        self.locate_on_raceways(simd, modes, state.seat.as_ref(), blocks, drive.rings());
        self.law.normal_forces(simd, &self.rollers, &self.raceways, blocks, parts);
        for block in &mut scratch.blocks {
            self.law.push_rollers(simd, &self.raceways, block, drive, &mut sums);
        }
        for b in 0..scratch.blocks.len() {
            let by_film = self.push_by_oil(simd, state, &mut scratch.blocks[b], drive, tally);
            self.push_modes(simd, scratch, b, by_film);
            let block = &mut scratch.blocks[b];
            for (raceway, contacts) in self.raceways.iter().zip(&block.contacts) {
                scratch.deepest = scratch.deepest.max(ContactLaw::deepest(contacts));
                if tally.last {
                    self.law.stored_in_contacts(raceway, contacts, &mut tally.stored);
                }
            }
            block.force[2] = Default::default();
            if let Some(pockets) = &pockets {
                let by_walls = pockets.push(simd, b, block, tally);
                for (sum, part) in on_cage.iter_mut().zip(by_walls) {
                    *sum += part;
                }
            }
        }
        for block in &mut scratch.blocks {
            let before = scratch.frame.as_ref().map(|frame| frame.pull(&self.rollers, block));
            self.rollers.advance(simd, self.time_step, block, tally.last, &mut sums);
            if let (Some(frame), Some(before)) = (&scratch.frame, before) {
                tally.spent.external += frame.work(&self.rollers, block, before, self.time_step);
            }
        }
        tally.add(&sums, drive, self.time_step);
        on_cage
    }

    /// Adds the forces of oil films to those on a group of rollers. Returns normal forces [N] and stiffnesses
    /// [N/m] of the films at the outer raceway.
    #[inline(always)]
    fn push_by_oil<S: Simd>(
        &self,
        simd: S,
        state: &mut State,
        block: &mut Block,
        drive: &Drive,
        tally: &mut Tally,
    ) -> [[f64; LANES]; 2] {
        let (Some(oil), Some(films)) = (&self.oil, &mut state.films) else { return [[0.0; LANES]; 2] };
        let dt = self.time_step;
        let step = FilmStep { step: state.steps, dt, last: tally.last, felt: self.seat.is_some() };
        let by_oil = oil.add_film_forces(simd, &self.rollers, films, block, drive.rings(), step);
        tally.stored.contact += by_oil.stored;
        let mut moments = by_oil.drive;
        if let Some(resistance) = &self.resistance {
            let thickness = oil.thicknesses(films, block);
            let resisted = resistance.act(simd, block, &thickness, drive.rings());
            films.heat += dt * resisted.power;
            moments = [0, 1].map(|k| moments[k] + resisted.drive[k]);
        }
        for (ring, moment) in drive.rings().into_iter().zip(moments) {
            tally.spent.drive += ring.map_or(0.0, |ring| dt * ring.rate * moment);
        }
        [by_oil.normal, by_oil.stiffness]
    }

    /// Adds the forces of a group of rollers to those on the modes, and stores the forces to which sensors
    /// and seat respond quasi-statically.
    #[inline(always)]
    fn push_modes<S: Simd>(&self, simd: S, scratch: &mut Scratch, b: usize, by_film: [[f64; LANES]; 2]) {
        let block = &scratch.blocks[b];
        for lane in 0..block.count {
            let (facet, share) = (block.facet[lane], block.share[lane]);
            let force = of_one(&block.force[0], lane);
            if force != [0.0; 2] {
                let point = self.structure.raceway_point(facet as usize, share);
                self.structure.press(simd, &point, force, &mut scratch.modes);
            }
            let force = block.contacts[0].normal[lane] + by_film[0][lane];
            let roller = &mut scratch.roller_forces[block.first + lane];
            let stiffness = block.contacts[0].stiffness(self.law.penalty, lane) + by_film[1][lane];
            *roller = RollerForce { growth: force - roller.force, force, stiffness, ..*roller };
        }
    }
}
