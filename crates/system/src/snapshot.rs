//! All that changes in time, in one piece: a system continued from it takes the same steps to the bit.

use serde::{Deserialize, Serialize};
use stribeck_contact::{ContactState, Contacts};
use stribeck_solver::snapshot::Snapshot as MotionSnapshot;

use crate::{error::Error, guards::Seen, ledger::Balance, load::LoadMemory, system::System};

/// What changes in time. Bodies, pairs, limits, the time step and damping are no part of it, and neither is what forces
/// added by [`Plan::force`](crate::Plan::force) remember.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    motion: MotionSnapshot,
    contacts: Option<ContactState>,
    loads: Vec<LoadMemory>,
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
    /// What has changed since the start.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            motion: self.dynamics.snapshot(),
            contacts: self.forces.contacts.as_ref().map(Contacts::state),
            loads: self.forces.loads.iter().map(|load| load.memory).collect(),
            balance: *self.balance(),
            seen: *self.seen(),
        }
    }

    /// Continues from a snapshot of a system of the same plan. Set the time step and damping before.
    ///
    /// # Errors
    /// When the snapshot has other nodes, bodies, contacts or loads; nothing is changed then.
    pub fn restore(&mut self, from: Snapshot) -> Result<(), Error> {
        let Snapshot { motion, contacts, loads, balance, seen } = from;
        if loads.len() != self.forces.loads.len() {
            return Err(Error::OtherSystem { what: "loads" });
        }
        let before = self.forces.contacts.as_ref().map(Contacts::state);
        let fits = match (&mut self.forces.contacts, contacts) {
            (Some(own), Some(state)) => own.restore(state),
            (None, None) => true,
            _ => false,
        };
        if !fits {
            return Err(Error::OtherSystem { what: "contacts" });
        }
        if let Err(error) = self.dynamics.restore(motion) {
            if let (Some(own), Some(state)) = (&mut self.forces.contacts, before) {
                own.restore(state);
            }
            return Err(error.into());
        }
        self.forces.loads.iter_mut().zip(loads).for_each(|(load, memory)| load.memory = memory);
        (self.balance, self.seen) = (balance, seen);
        Ok(())
    }
}
