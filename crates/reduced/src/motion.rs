//! A reduced bearing as the time loop drives it: samples, ledger, guards, checkpoint.

use serde::{Deserialize, Serialize};
use stribeck_bearing::{error::Error, recorder::Tacho, time_loop};
use stribeck_scene::{run_info::RunInfo, scene::Scene};
use stribeck_system::{Balance, Ledger, Scale};

use crate::{
    bearing::Bearing,
    guards::{Guards, LedgerError},
    recorder::Memory,
    state::{State, at_positions},
    step::Scratch,
};

/// A reduced bearing in motion.
#[derive(Debug)]
pub struct Motion {
    bearing: Bearing,
    saved: Saved,
    scratch: Scratch,
    guards: Guards,
    row: Vec<f64>,
    off: LedgerError,
    tacho: Tacho,
}

/// What a checkpoint holds of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// Positions and velocities.
    pub state: State,
    memory: Memory,
    balance: Balance,
}

impl Saved {
    /// Before the first step.
    pub fn first(bearing: &Bearing, state: State) -> Self {
        Self { memory: bearing.first_memory(&state), state, balance: Balance::default() }
    }

    /// Whether it may belong to this bearing.
    pub(crate) fn fits(&self, bearing: &Bearing) -> bool {
        let (n, r, s) = (bearing.rollers, bearing.reduction.padded, &self.state);
        let of_rollers = [
            &s.x,
            &s.y,
            &s.vx,
            &s.vy,
            &s.angle,
            &s.spin,
            &s.slip[0],
            &s.slip[1],
            &s.force[0],
            &s.force[1],
            &s.growth[0],
            &s.growth[1],
        ];
        of_rollers.iter().all(|v| v.len() == n)
            && s.turned.len() == n
            && s.wall_slip.len() == n
            && s.wall_passive.len() == n
            && s.passive.iter().all(|p| p.len() == n)
            && s.hints.iter().all(|h| h.len() == n)
            && [&s.q, &s.v].iter().all(|v| v.len() == r)
            && s.branches.len() == bearing.branches.len()
            && s.branches.iter().all(|v| v.len() == r)
            && match (&bearing.seat, &s.seat) {
                (Some(seat), Some(hold)) => seat.fits(hold, r, n),
                (seat, hold) => seat.is_none() && hold.is_none(),
            }
            && match (&bearing.oil, &s.films) {
                (Some(oil), Some(films)) => oil.fits(films, &bearing.rim_of),
                (oil, films) => oil.is_none() && films.is_none(),
            }
            && self.memory.fits(bearing)
    }
}

impl Motion {
    /// A bearing that goes on from `saved`.
    pub fn new(scene: &Scene, bearing: Bearing, saved: Saved) -> Self {
        let mut scratch = Scratch::new(&bearing);
        scratch.load(&saved.state);
        Self {
            bearing,
            saved,
            scratch,
            guards: Guards::new(scene),
            row: Vec::new(),
            off: LedgerError::default(),
            tacho: Tacho::of(scene),
        }
    }

    fn ledger(&self) -> Ledger {
        let (w, e) = (&self.saved.state.work, &self.scratch.energy);
        Ledger {
            time: (self.saved.state.steps - 1) as f64 * self.bearing.time_step,
            kinetic: e.kinetic,
            strain: e.strain,
            contact: e.contact,
            friction: w.friction - e.sticking,
            damping: at_positions(w.damping),
            contact_damping: w.contact_damping,
            external: at_positions(w.external),
            drive: at_positions(w.drive),
            film: self.saved.state.films.as_ref().map_or(0.0, |films| films.heat),
            ..Ledger::default()
        }
    }
}

impl time_loop::Motion for Motion {
    type Saved = Saved;

    fn interval(&mut self, steps: usize) -> Result<Ledger, Error> {
        let Self { bearing, saved: Saved { state, memory, .. }, scratch, row, tacho, .. } = self;
        scratch.begin(bearing, state.steps / steps as u64);
        bearing.advance(state, scratch, steps - 1, false);
        bearing.advance(state, scratch, 1, true);
        scratch.show(state);
        bearing.row(state, scratch, memory, row);
        row.extend(tacho.sample(state.steps as f64 * bearing.time_step));
        let mut ledger = self.ledger();
        self.saved.balance.begin_or_enter(&mut ledger, Scale::StrainEnergy);
        self.off = LedgerError::of(&ledger);
        Ok(ledger)
    }

    fn row(&mut self) -> &[f64] {
        &self.row
    }

    fn steps(&self) -> u64 {
        self.saved.state.steps
    }

    fn time(&self) -> f64 {
        self.saved.state.steps as f64 * self.bearing.time_step
    }

    fn balance(&self) -> [f64; 2] {
        [self.saved.balance.peak_strain, self.saved.balance.largest_error]
    }

    fn look(&mut self, info: &mut RunInfo) -> Option<String> {
        self.guards.look(info, &self.saved.state, self.off, self.scratch.deepest)
    }

    fn saved(&self) -> Saved {
        let mut saved = self.saved.clone();
        self.scratch.store(&mut saved.state);
        saved
    }
}
