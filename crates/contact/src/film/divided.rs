//! Films of oil, shared out over ranks.

use stribeck_solver::{ranks::Shared, state::Moment};

use stribeck_surface::film::{Layer, Pushed};

use super::{Film, Films, Memory};
use crate::interactions::{Interactions, within_reach};

/// Numbers of a report: heat, force, deflection of the springs, thickness, and the distribution of the force.
const REPORT: usize = 5 + 8;

/// About how long one takes [ns].
const WORK_NS: f64 = 100.0;

impl Films {
    /// Heat of the last step, film by film.
    pub(super) fn count_heat(&mut self) {
        self.films.iter().for_each(|film| self.heat += film.pushed.heat);
    }
}

impl Interactions for Films {
    fn count(&self) -> usize {
        self.films.len()
    }

    fn is_due(&self, _step: u64) -> bool {
        false
    }

    fn look(&mut self, _at: Moment<'_>) {}

    fn reach(&self, which: usize, at: Moment<'_>, slots: &mut Vec<u32>) {
        let Film { round, track, centre, lands, memory, .. } = &self.films[which];
        let both = [&self.surfaces[*track], &self.surfaces[*round]];
        let mut places = memory.places;
        if memory.layer.is_none() {
            let c = *centre as usize;
            places[0] = lands[0].begin(both[0], at.x, at.y, [at.x[c], at.y[c]]);
            let near = lands[0].nearest(both[0], at.x, at.y, [at.x[c], at.y[c]], places[0]);
            places[1] = lands[1].begin(both[1], at.x, at.y, near.at);
        }
        for (surface, place) in both.into_iter().zip(places) {
            let mut marked = vec![false; surface.facets()];
            marked[place.facet as usize] = true;
            let near = within_reach(&marked, surface.closed, surface.slots.len());
            slots.extend(near.map(|vertex| surface.slots[vertex]));
        }
        slots.push(*centre);
    }

    fn work(&self, _which: usize) -> f64 {
        WORK_NS
    }

    fn compute(&mut self, here: Vec<bool>) {
        self.films.iter_mut().zip(here).for_each(|(film, here)| film.here = here);
        self.divided = true;
    }

    fn report_length(&self) -> usize {
        REPORT
    }

    fn report(&self, which: usize, to: &mut Shared) {
        let Film { pushed: Pushed { heat, force, pressed: [depth, dry], .. }, memory, .. } =
            &self.films[which];
        let above = memory.layer.map_or(f64::NAN, |layer| layer.above);
        to.tell([*heat, *force, *depth, *dry, above]);
        to.tell(memory.shares.as_flattened().iter().copied());
    }

    fn hear(&mut self, which: usize, report: &[f64]) {
        let film = &mut self.films[which];
        let &[heat, force, depth, dry, above, ref shares @ ..] = report else { return };
        // The rest of the state stays on the rank that computes the film: its end, its force, whether it is
        // solid.
        film.pushed = Pushed { heat, force, pressed: [depth, dry], ..film.pushed };
        let mut layer = film.memory.layer.unwrap_or(Layer::at(above));
        layer.above = above;
        film.memory.layer = (!above.is_nan()).then_some(layer);
        film.memory.shares.as_flattened_mut().copy_from_slice(shares);
    }

    fn add_up(&mut self) {
        self.count_heat();
    }

    fn memories(&self, which: &[usize]) -> Vec<u8> {
        let memories: Vec<&Memory> = which.iter().map(|&film| &self.films[film].memory).collect();
        postcard::to_allocvec(&memories).unwrap_or_default()
    }

    fn remember(&mut self, which: &[usize], memories: &[u8]) -> bool {
        let Ok(memories) = postcard::from_bytes::<Vec<Memory>>(memories) else { return false };
        if memories.len() != which.len() {
            return false;
        }
        for (&film, memory) in which.iter().zip(&memories) {
            if !self.fits(&self.films[film], memory) {
                return false;
            }
            self.films[film].take_over(memory, &self.surfaces);
        }
        true
    }

    fn nodes(&self) -> Vec<u32> {
        let centres = self.films.iter().map(|film| film.centre);
        self.surfaces.iter().flat_map(|s| s.slots.iter().copied()).chain(centres).collect()
    }
}
