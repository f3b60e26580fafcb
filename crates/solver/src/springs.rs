//! The springs and dashpots of structural damping in motion: where they are, how fast their bodies turn, what
//! they hold and lose (THEORY §2.8).

use crate::{
    dynamics::{DampedBody, Dynamics, Springs},
    error::{Error, check},
    kernel::{
        mass_sums::{LaneSums, MassSums, lane_sums},
        structural_damping::{BranchSteps, SpringEnergies},
        tile::{Tile, TileStructural, Turn},
    },
    state::SpringState,
    structural_damping::StructuralDamping,
};
use stribeck_simd::{field::Field, lanes::LANES};

/// Steps from one measurement of spins to the next, bodies turn at a steady pace; and most steps from one
/// measurement of losses to the next.
const MEASURE_EVERY: u64 = 32;

/// Measurements of losses in the shortest relaxation time τ. Dashpots lose most to vibrations of 1/(2πτ),
/// whose loss swings twice a cycle: once in πτ.
const MEASUREMENTS: f64 = 6.0;

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
        self.tiles.iter_mut().zip(marks).for_each(|(tile, mark)| tile.structural = mark);
        let branches = damping.map_or(0, |d| d.branches().len());
        let zeros = || Field::zeros(self.layout().len());
        let stretch = (0..branches).map(|_| [zeros(), zeros()]).collect();
        self.springs = damping.map(|damping| Springs {
            damping: damping.clone(),
            bodies: chosen().map(|&body| DampedBody { places: self.layout().places(body) }).collect(),
            measure: false,
        });
        self.state.springs = SpringState { stretch, ..SpringState::default() };
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

    /// Has the next step measure what springs hold.
    pub fn measure_springs(&mut self) {
        self.springs.iter_mut().for_each(|springs| springs.measure = true);
    }

    /// Heat of the dashpots since the start and energy of the springs, at the positions before the last step,
    /// which must have measured it [J].
    pub fn structural_loss(&self) -> f64 {
        let SpringState { lost, held, .. } = &self.state.springs;
        lost.at_last_positions() + held
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
            if let Some(s) = tile.structural.as_mut().filter(|_| tile.turn != Turn::Elsewhere) {
                s.sums = lane_sums(&s.mass, &self.state, tile.slots.clone());
            }
        };
        self.share_out(&mut tiles, &|tile| tile.slots.len(), &add_up);
        self.share_sums(&mut tiles, |tile| tile.structural.as_mut().map(|s| &mut s.sums));
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

    /// Tells the tiles how fast their bodies turn.
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

    /// Steps from one measurement of losses to the next.
    fn losses_every(&self) -> u64 {
        let branches = self.structural_damping().map_or(&[][..], |damping| damping.branches());
        let shortest = branches.iter().map(|b| b.relaxation_time).fold(f64::INFINITY, f64::min);
        ((shortest / (MEASUREMENTS * self.time_step())) as u64).clamp(1, MEASURE_EVERY)
    }

    /// What the branches do in the step at hand.
    pub(crate) fn branch_steps(&mut self) -> BranchSteps {
        let (due, dt) = (self.state.step.is_multiple_of(self.losses_every()), self.time_step());
        let Some(springs) = &mut self.springs else { return BranchSteps::default() };
        let measure = std::mem::take(&mut springs.measure) || due;
        let moving = std::mem::replace(&mut self.state.springs.moving, true);
        BranchSteps::new(springs.damping.branches(), if moving { dt } else { 0.0 }, measure)
    }

    /// Adds what dashpots lose in a step, 2E/τ, which a step that measures has found anew.
    pub(crate) fn count_structural_loss(&mut self, measured: bool, energies: SpringEnergies) {
        let (every, dt) = (self.losses_every(), self.time_step());
        let due = self.state.step.is_multiple_of(every);
        let Some(springs) = &self.springs else { return };
        let SpringState { lost, held, .. } = &mut self.state.springs;
        if measured {
            *held = energies.iter().sum();
        }
        if due {
            let branches = energies.iter().zip(springs.damping.branches());
            let power: f64 = branches.map(|(energy, b)| 2.0 * energy / b.relaxation_time).sum();
            lost.count(dt * power, every);
        } else {
            lost.repeat();
        }
    }
}
