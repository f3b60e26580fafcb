//! Structural damping in motion: when its branch is evaluated, how fast damped bodies turn, what springs
//! hold and dashpots lose (THEORY §2.8).

use crate::{
    dynamics::{DampedBody, Dynamics, Springs},
    energies::ElasticEnergy,
    error::{Error, check},
    kernel::{
        mass_sums::{LaneSums, MassSums, lane_sums},
        structural_damping::{Evaluation, HeldWork},
        tile::{Tile, TileStructural},
    },
    state::{SpringState, State},
    structural_damping::StructuralDamping,
};
use stribeck_simd::{field::Field, lanes::LANES};

/// Steps from one measurement of spins to the next: bodies turn at a steady pace.
const MEASURE_EVERY: u64 = 128;

impl Dynamics {
    /// Sets the structural damping of elastic bodies, or none; replaces an earlier one. Its springs are
    /// relaxed where the bodies are now. It shortens the critical time step (THEORY §2.8).
    ///
    /// # Errors
    /// When there is stiffness damping; when a body is not in the mesh, or does not deform, or when of bodies
    /// of one shape some are damped and others are not: congruent bodies lie side by side in memory.
    pub fn set_structural_damping(&mut self, damping: Option<&StructuralDamping>) -> Result<(), Error> {
        let chosen = || damping.iter().flat_map(|d| d.bodies());
        let damped = |body: &usize| chosen().any(|b| b == body);
        let beta = self.stiffness_damping();
        let alone = damping.is_none() || beta == 0.0;
        check("stiffness damping [s]", beta, alone, "zero beside structural damping")?;
        for &body in chosen() {
            let known = self.elements().bodies.iter().any(|elastic| elastic.body == body);
            check("body with structural damping", body as f64, known, "the number of a body that deforms")?;
        }
        for tile in &self.layout().tiles {
            let odd = tile.bodies.iter().find(|body| damped(body) != damped(&tile.bodies[0]));
            let body = odd.map_or(0.0, |&body| body as f64);
            let allowed = "damped if all bodies of its shape are";
            check("body with structural damping", body, odd.is_none(), allowed)?;
        }
        let marks: Vec<Option<TileStructural>> = self
            .tiles
            .iter()
            .zip(&self.layout().tiles)
            .map(|(tile, layout)| {
                let mass = || self.mass()[tile.slots.clone()].iter().copied().collect();
                let new = || TileStructural { mass: mass(), sums: LaneSums::default(), spin: [0.0; LANES] };
                layout.bodies.iter().any(damped).then(new)
            })
            .collect();
        let before = self.structural_damping().map_or(1.0, |damping| damping.stiffening(f64::INFINITY));
        let after = damping.map_or(1.0, |damping| damping.stiffening(f64::INFINITY));
        for (tile, mark) in self.tiles.iter_mut().zip(marks) {
            let [from, to] = [(before, &tile.structural), (after, &mark)]
                .map(|(factor, damped)| if damped.is_some() { factor } else { 1.0 });
            if from != to {
                tile.stiffen(to / from);
            }
            tile.structural = mark;
        }
        let slots = if damping.is_some() { self.layout().len() } else { 0 };
        let path = damping.map(|_| [Field::zeros(slots), Field::zeros(slots)]);
        let held = [Field::zeros(slots), Field::zeros(slots)];
        self.springs = damping.map(|damping| Springs {
            damping: damping.clone(),
            bodies: chosen().map(|&body| DampedBody { places: self.layout().places(body) }).collect(),
        });
        self.state.springs = SpringState { path, held, ..SpringState::default() };
        self.make_room_to_see_ahead();
        Ok(())
    }

    /// The structural damping, if there is one.
    pub fn structural_damping(&self) -> Option<&StructuralDamping> {
        self.springs.as_ref().map(|springs| &springs.damping)
    }

    /// What structural damping multiplies the stiffness of each slot's elements by when they move fast [-].
    pub(crate) fn stiffening(&self) -> Vec<f64> {
        let mut factor = vec![1.0; self.layout().len()];
        if let Some(damping) = self.structural_damping() {
            let stiff = damping.stiffening(f64::INFINITY);
            let damped = self.tiles.iter().filter(|tile| tile.structural.is_some());
            damped.for_each(|tile| factor[tile.slots.clone()].fill(stiff));
        }
        factor
    }

    /// Elastic energy of the elements at the present positions [J]; adds up the energy of the springs and the
    /// heat of the dashpots until then. As [`Dynamics::step`], to be called from within the pool.
    ///
    /// All that a branch takes is the work of its forces: elements are stiffer by g, which is the change
    /// of an energy, and the rest is the work of the forces that are held.
    pub fn measure_elastic_energy(&mut self) -> ElasticEnergy {
        let Some(share) = self.structural_damping().map(|d| d.stiffening(f64::INFINITY) - 1.0) else {
            return self.elastic_energy();
        };
        let [all, damped] = self.energies_with_damped();
        let energy = damped.strain + damped.hourglass;
        let (held, State { x, y, .. }) = (&self.state.springs.held, &self.state);
        let along = |n: usize| f64::from(held[0][n]) * x[n] + f64::from(held[1][n]) * y[n];
        let own = self.tiles.iter().filter(|tile| tile.structural.is_some());
        let mut parts: Vec<_> = own.map(|t| (t.slots.start..t.slots.start + t.own, 0.0)).collect();
        self.share_out(&mut parts, &|(own, _)| own.len(), &|(own, sum)| *sum = own.clone().map(along).sum());
        let now: f64 = parts.iter().map(|(_, sum)| sum).sum();
        let springs = &mut self.state.springs;
        let at_start = *springs.at_start.get_or_insert(energy);
        springs.loss = share * (energy - at_start) - springs.work - (now - springs.taken_up);
        all
    }

    /// Elastic energy of all bodies and of the damped ones [J].
    fn energies_with_damped(&self) -> [ElasticEnergy; 2] {
        let damped = self.structural_damping().map_or(&[][..], StructuralDamping::bodies);
        self.elastic_energies(|body| damped.contains(&body))
    }

    /// Heat of the dashpots since the start and energy of the springs [J], at the positions of the last
    /// [`Dynamics::measure_elastic_energy`].
    pub fn structural_loss(&self) -> f64 {
        self.state.springs.loss
    }

    /// Measures now and then, before a step, how fast damped bodies turn.
    pub(crate) fn measure_spins(&mut self) {
        let due = self.state.step.is_multiple_of(MEASURE_EVERY) || self.state.springs.spins.is_empty();
        if self.springs.is_none() || !due {
            return;
        }
        let mut tiles = std::mem::take(&mut self.tiles);
        let mut spins = std::mem::take(&mut self.state.springs.spins);
        let add_up = |tile: &mut Tile| {
            if let Some(s) = &mut tile.structural {
                s.sums = lane_sums(&s.mass, &self.state, tile.slots.clone());
            }
        };
        self.share_out(&mut tiles, &|tile| tile.slots.len(), &add_up);
        spins.clear();
        for body in self.springs.iter().flat_map(|springs| &springs.bodies) {
            let mut sums = MassSums::default();
            for &(tile, lane) in &body.places {
                tiles[tile].structural.iter().for_each(|s| sums += s.sums[lane]);
            }
            spins.push(sums.motion().spin);
        }
        (self.tiles, self.state.springs.spins) = (tiles, spins);
        self.hand_out_spins();
    }

    /// Sets the spins of the bodies in their tiles.
    pub(crate) fn hand_out_spins(&mut self) {
        let bodies = self.springs.iter().flat_map(|springs| &springs.bodies);
        for (body, &spin) in bodies.zip(&self.state.springs.spins) {
            for &(tile, lane) in &body.places {
                if let Some(s) = &mut self.tiles[tile].structural {
                    s.spin[lane] = spin;
                }
            }
        }
    }

    /// Action of the branch in the present step, if it is evaluated in it.
    pub(crate) fn evaluation(&mut self) -> Option<Evaluation> {
        let (step, dt) = (self.state.step, self.time_step());
        let damping = &self.springs.as_ref().filter(|_| step >= self.state.springs.next)?.damping;
        let until = damping.steps_until_next(dt, step);
        let since = self.state.springs.evaluated.map(|last| step - last);
        let evaluation = Evaluation::new(damping.branch(), dt, since, until);
        if self.state.springs.at_start.is_none() {
            let [_, damped] = self.energies_with_damped();
            self.state.springs.at_start = Some(damped.strain + damped.hourglass);
        }
        (self.state.springs.evaluated, self.state.springs.next) = (Some(step), step + until);
        Some(evaluation)
    }
}

impl SpringState {
    /// Adds the energies of an evaluation.
    pub(crate) fn count(&mut self, held: HeldWork) {
        self.work += held.released - self.taken_up;
        self.taken_up = held.taken_up;
    }
}
