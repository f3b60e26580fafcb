//! One system over ranks: which rank computes which interaction of surfaces, and when results are known on
//! all.
//!
//! Between two ledgers a rank has its own tiles, the nodes that its interactions read, and the results of
//! every interaction. A ledger, and so a sample and a checkpoint, begins and ends with the whole state
//! gathered on every rank.

use std::sync::Arc;

use stribeck_contact::Interactions;
use stribeck_solver::ranks::Ranks;

use crate::{error::Error, forces::Forces, leaders::Division, system::System};

impl Forces {
    /// Pairs and films.
    fn interactions(&mut self) -> impl Iterator<Item = &mut dyn Interactions> {
        let contacts = self.contacts.iter_mut().map(|contacts| contacts as &mut dyn Interactions);
        contacts.chain(self.films.iter_mut().map(|films| films as &mut dyn Interactions))
    }
}

impl System {
    /// Divides the system among ranks from now on, all of which hold the same: each moves its own tiles and
    /// computes the contacts and films at them. Every rank has to call the same methods in the same order,
    /// and gets the same from them wherever no other place is named. Loads and the user's laws are computed
    /// by all, and may read the nodes that they announce.
    ///
    /// Places, velocities and snapshots are those of the whole system after [`System::step_with_ledger`] and
    /// [`System::gather`], resultants after every step.
    pub fn divide(&mut self, ranks: Arc<dyn Ranks>) {
        self.dynamics.divide(ranks);
        let loads = self.forces.loads.iter().flat_map(|load| load.slots());
        let everywhere = loads.chain(self.of_laws.iter().copied()).collect();
        let gathered = Some(self.steps());
        self.division = Some(Division { everywhere, gathered, ..Division::default() });
        self.assign();
    }

    /// The ranks that the system is divided among.
    pub fn ranks(&self) -> Option<&Arc<dyn Ranks>> {
        self.dynamics.ranks()
    }

    /// Gathers the whole state on every rank.
    ///
    /// # Errors
    /// When ranks do not run the same system.
    pub fn gather(&mut self) -> Result<(), Error> {
        let step = self.steps();
        let Some(division) = self.division.as_mut().filter(|d| d.gathered != Some(step)) else {
            return Ok(());
        };
        division.gathered = Some(step);
        self.dynamics.gather();
        self.gather_memories()?;
        let moment = self.dynamics.moment();
        let mut burdens = Vec::new();
        for kind in self.forces.interactions() {
            for which in 0..kind.count() {
                let mut slots = Vec::new();
                kind.reach(which, moment, &mut slots);
                if !slots.is_empty() {
                    burdens.push((slots, kind.work(which)));
                }
            }
        }
        self.dynamics.balance(burdens.iter().map(|(slots, work)| (&slots[..], *work)));
        self.assign();
        Ok(())
    }

    /// One step, over ranks if there are several.
    pub(crate) fn advance(&mut self) -> Result<(), Error> {
        self.look_over_ranks()?;
        self.dynamics.step(&mut [&mut self.forces]);
        let Some(Division { leaders, shared, .. }) = &mut self.division else { return Ok(()) };
        let Some(ranks) = self.dynamics.ranks() else { return Ok(()) };
        for (kind, leaders) in self.forces.interactions().zip(&*leaders) {
            let led = leaders.iter().enumerate().filter(|(_, leader)| **leader == ranks.rank());
            led.for_each(|(which, _)| kind.report(which, shared));
        }
        let lengths: [usize; 2] = {
            let mut kinds = self.forces.interactions().map(|kind| kind.report_length());
            std::array::from_fn(|_| kinds.next().unwrap_or(0))
        };
        let items = leaders.iter().zip(lengths);
        shared
            .gather(&**ranks, items.flat_map(|(of, length)| of.iter().map(move |&leader| (leader, length))));
        for (kind, leaders) in self.forces.interactions().zip(&*leaders) {
            let length = kind.report_length();
            for (which, &leader) in leaders.iter().enumerate() {
                kind.hear(which, shared.hear(leader, length));
            }
            kind.add_up();
        }
        Ok(())
    }

    /// Where interactions are due for a search in the next step, searches with all nodes of surfaces, and
    /// reassigns them.
    fn look_over_ranks(&mut self) -> Result<(), Error> {
        let step = self.steps();
        let Some(division) = &self.division else { return Ok(()) };
        if !self.forces.interactions().any(|kind| kind.is_due(step)) {
            return Ok(());
        }
        if division.gathered != Some(step) {
            let nodes: Vec<u32> = self.forces.interactions().flat_map(|kind| kind.nodes()).collect();
            self.dynamics.gather_nodes(&nodes);
            self.gather_memories()?;
        }
        let moment = self.dynamics.moment();
        self.forces.interactions().for_each(|kind| kind.look(moment));
        self.assign();
        Ok(())
    }

    /// Gathers the states of interactions on every rank.
    fn gather_memories(&mut self) -> Result<(), Error> {
        let (Some(division), Some(ranks)) = (&self.division, self.dynamics.ranks()) else { return Ok(()) };
        for (kind, leaders) in self.forces.interactions().zip(&division.leaders) {
            let led_by = |rank: usize| (0..leaders.len()).filter(|&i| leaders[i] == rank).collect::<Vec<_>>();
            let own = kind.memories(&led_by(ranks.rank()));
            for (rank, memories) in ranks.all_gather_bytes(&own).iter().enumerate() {
                if rank != ranks.rank() && !kind.remember(&led_by(rank), memories) {
                    return Err(Error::OtherSystem { what: "contacts" });
                }
            }
        }
        Ok(())
    }

    /// Assigns interactions: each to the ranks that move nodes within its reach, the first of which reports
    /// its numbers.
    fn assign(&mut self) {
        let (Some(division), Some(ranks)) = (&mut self.division, self.dynamics.ranks()) else { return };
        let (rank, count, moment) = (ranks.rank(), ranks.count(), self.dynamics.moment());
        let mut wanted = vec![division.everywhere.clone(); count];
        division.leaders.clear();
        for kind in self.forces.interactions() {
            let (mut leaders, mut here) = (Vec::new(), Vec::new());
            for which in 0..kind.count() {
                let mut slots = Vec::new();
                kind.reach(which, moment, &mut slots);
                let mut owners = vec![false; count];
                slots.iter().for_each(|&slot| owners[self.dynamics.rank_of(slot)] = true);
                for (_, wanted) in owners.iter().zip(&mut wanted).filter(|(owns, _)| **owns) {
                    wanted.extend_from_slice(&slots);
                }
                leaders.push(owners.iter().position(|&owns| owns).unwrap_or(0));
                here.push(owners[rank]);
            }
            kind.compute(here);
            division.leaders.push(leaders);
        }
        self.dynamics.read_elsewhere(wanted);
    }
}
