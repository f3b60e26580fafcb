//! The whole state in time: a system continued from it takes the same steps to the bit.

use serde::{Deserialize, Serialize};
use stribeck_contact::{ContactState, Contacts, FilmState, Films};
use stribeck_solver::snapshot::Snapshot as MotionSnapshot;

use crate::{error::Error, forces::Forces, guards::Seen, ledger::Balance, load::LoadMemory, system::System};

/// The state in time. Bodies, pairs, limits, the time step and damping are no part of it; of forces added by
/// [`Plan::force`](crate::Plan::force) it holds the values that they save themselves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    motion: MotionSnapshot,
    contacts: Option<ContactState>,
    films: Option<FilmState>,
    loads: Vec<LoadMemory>,
    further: Vec<Vec<f64>>,
    balance: Balance,
    seen: Seen,
}

impl Snapshot {
    /// Steps taken until then.
    pub fn step(&self) -> u64 {
        self.motion.step()
    }
}

impl System {
    /// The present state.
    pub fn snapshot(&self) -> Snapshot {
        let (contacts, films) = self.contact_states();
        Snapshot {
            motion: self.dynamics.snapshot(),
            contacts,
            films,
            loads: self.forces.loads.iter().map(|load| load.memory).collect(),
            further: self.forces.further.iter().map(|(_, force)| force.memory()).collect(),
            balance: *self.balance(),
            seen: *self.seen(),
        }
    }

    /// Continues from a snapshot of a system of the same plan. Set the time step and damping before.
    ///
    /// # Errors
    /// When the snapshot has other nodes, bodies, contacts or loads; nothing is changed then.
    pub fn restore(&mut self, from: Snapshot) -> Result<(), Error> {
        let Snapshot { motion, contacts, films, loads, further, balance, seen } = from;
        if loads.len() != self.forces.loads.len() {
            return Err(Error::OtherSystem { what: "loads" });
        }
        if further.len() != self.forces.further.len() {
            return Err(Error::OtherSystem { what: "forces" });
        }
        let (own_contacts, own_films) = self.contact_states();
        let own_further: Vec<Vec<f64>> =
            self.forces.further.iter().map(|(_, force)| force.memory()).collect();
        let refused = if !self.restore_contacts(contacts) {
            Some(Error::OtherSystem { what: "contacts" })
        } else if !self.restore_films(films) {
            Some(Error::OtherSystem { what: "films" })
        } else if !self.recall(&further) {
            Some(Error::OtherSystem { what: "forces" })
        } else {
            self.dynamics.restore(motion).err().map(Error::from)
        };
        if let Some(refused) = refused {
            self.restore_contacts(own_contacts);
            self.restore_films(own_films);
            self.recall(&own_further);
            return Err(refused);
        }
        self.forces.loads.iter_mut().zip(loads).for_each(|(load, memory)| load.memory = memory);
        (self.balance, self.seen) = (balance, seen);
        Ok(())
    }

    /// False when a force cannot restore the values.
    fn recall(&mut self, further: &[Vec<f64>]) -> bool {
        let mut forces = self.forces.further.iter_mut().zip(further);
        forces.all(|((_, force), memory)| force.recall(memory))
    }

    fn contact_states(&self) -> (Option<ContactState>, Option<FilmState>) {
        let Forces { contacts, films, .. } = &self.forces;
        (contacts.as_ref().map(Contacts::state), films.as_ref().map(Films::state))
    }

    /// False when the state is that of other contacts, which stay as they are then.
    fn restore_contacts(&mut self, state: Option<ContactState>) -> bool {
        match (&mut self.forces.contacts, state) {
            (Some(own), Some(state)) => own.restore(state),
            (None, None) => true,
            _ => false,
        }
    }

    /// The same for films.
    fn restore_films(&mut self, state: Option<FilmState>) -> bool {
        match (&mut self.forces.films, state) {
            (Some(own), Some(state)) => own.restore(&state),
            (None, None) => true,
            _ => false,
        }
    }
}
