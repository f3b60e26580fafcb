//! A system in motion: its step, its time step, its energies.

use stribeck_contact::{Contacts, FilmResultant, Resultant};
use stribeck_solver::{
    Behaviour, Dynamics, Force, Velocities, critical::damped_time_step, damping::MassDamping,
    state::NodeForces,
};

use crate::{
    error::Error,
    forces::Forces,
    guards::{Finding, Limits, Seen, Words},
    ledger::{Balance, Ledger},
    names::{Names, unknown},
};

/// Bodies in motion, with contact, loads and the ledger of their energy. Everything is asked for in node
/// numbers of the mesh and in names.
///
/// Time is leapfrog: positions at [`System::time`], velocities half a step earlier.
#[derive(Debug)]
pub struct System {
    /// When to warn and when to stop.
    pub limits: Limits,
    /// The user's names for the fields in messages.
    pub words: Words,
    pub(crate) dynamics: Dynamics,
    pub(crate) forces: Forces,
    pub(crate) names: Names,
    pub(crate) behaviour: Vec<Behaviour>,
    pub(crate) pairs: Vec<String>,
    /// Of all contact surfaces [m].
    pub(crate) shortest_facet: f64,
    /// The critical time step that a factor counts from [s].
    pub(crate) reference_time_step: Option<f64>,
    pub(crate) balance: Balance,
    pub(crate) seen: Seen,
    ledger: Ledger,
    /// Velocities before a step, for the kinetic energy at its start.
    before: Velocities,
}

/// Parts of a system.
#[non_exhaustive]
pub struct Parts {
    /// Elements and their motion.
    pub dynamics: Dynamics,
    /// Contact, if there are pairs.
    pub contacts: Option<Contacts>,
    /// Loads, films and the laws of the user, as one force.
    pub others: Box<dyn Force + Send>,
}

impl System {
    pub(crate) fn new(
        dynamics: Dynamics,
        forces: Forces,
        names: Names,
        behaviour: Vec<Behaviour>,
        pairs: Vec<String>,
        shortest_facet: f64,
    ) -> Self {
        Self {
            limits: Limits::default(),
            words: Words::default(),
            dynamics,
            forces,
            names,
            behaviour,
            pairs,
            shortest_facet,
            reference_time_step: None,
            balance: Balance::default(),
            seen: Seen::default(),
            ledger: Ledger::default(),
            before: Velocities::default(),
        }
    }

    /// Critical time step [s] of elements, contact and the user's laws at the present positions; damping of
    /// contact and of stiffness acts half a step late and counts with the step that it is used at. Infinite
    /// when nothing is stiff.
    pub fn critical_time_step(&self) -> f64 {
        let first = self.dynamics.critical_time_step(&[&self.forces], 0.0).time_step;
        let damped = damped_time_step(first, self.dynamics.stiffness_damping());
        self.dynamics.critical_time_step(&[&self.forces], 0.9 * damped).time_step
    }

    /// Critical time step [s] of elements and of the present stiffness of contact and the user's laws: sharp,
    /// but good for these positions alone. Damping and rigid bodies are left out; infinite when nothing is
    /// stiff.
    pub fn present_critical_time_step(&self) -> f64 {
        self.dynamics.present_critical_time_step(&[&self.forces]).time_step
    }

    /// Sets the time step to `factor` of the critical one; returns it [s].
    ///
    /// # Errors
    /// When the factor is not positive, or nothing is stiff.
    pub fn set_time_step_factor(&mut self, factor: f64) -> Result<f64, Error> {
        let critical = self.critical_time_step();
        self.set_time_step(factor * critical, Some(critical))?;
        Ok(factor * critical)
    }

    /// Sets the time step [s], and the critical one that it was chosen by, if there was one, for messages.
    pub fn set_time_step(&mut self, time_step: f64, critical: Option<f64>) -> Result<(), Error> {
        self.dynamics.set_time_step(time_step)?;
        self.reference_time_step = critical;
        Ok(())
    }

    /// Sets the mass-proportional damping of elastic bodies; replaces an earlier one.
    pub fn set_mass_damping(&mut self, damping: &MassDamping) {
        self.dynamics.set_mass_damping(damping);
    }

    /// Multiplies a load, as it was given, by `factor` from now on: 0 removes it, −1 reverses it.
    ///
    /// # Errors
    /// When there is no load of that name.
    pub fn scale_load(&mut self, name: &str, factor: f64) -> Result<(), Error> {
        let known = self.forces.loads.iter().position(|load| load.name == name);
        let at =
            known.ok_or_else(|| unknown("load", name, self.forces.loads.iter().map(|load| &*load.name)))?;
        self.forces.loads[at].memory.factor = factor;
        Ok(())
    }

    /// Lets all nodes that were constrained to rotate turn at `rate` [rad/s], counter-clockwise positive,
    /// from the next step on. No part of a [`Snapshot`](crate::Snapshot): it is a function of time, which
    /// the caller has.
    ///
    /// # Errors
    /// When the rate is not finite or beyond π·10⁶.
    pub fn set_rotation_rate(&mut self, rate: f64) -> Result<(), Error> {
        Ok(self.dynamics.set_rotation_rate(rate)?)
    }

    /// Lets all rigid bodies that turn at a prescribed rate turn at this one [rad/s], as
    /// [`System::set_rotation_rate`] does nodes.
    pub fn set_turning_rate(&mut self, rate: f64) -> Result<(), Error> {
        Ok(self.dynamics.set_turning_rate(rate)?)
    }

    /// One step: everything pushes, everything moves (THEORY §2.3).
    ///
    /// # Errors
    /// When no time step is set, or, at the first step and those of [`System::step_with_ledger`], when a law
    /// of the user has pushed on a node that it did not announce.
    pub fn step(&mut self) -> Result<(), Error> {
        if self.balance.reference.is_some() && self.dynamics.time_step() > 0.0 {
            self.dynamics.step(&mut [&mut self.forces]);
            return Ok(());
        }
        self.first_step().map(|_| ())
    }

    /// One step, and the energies at the positions before it.
    pub fn step_with_ledger(&mut self) -> Result<Ledger, Error> {
        let mut ledger =
            if self.balance.reference.is_some() { self.counted_step()? } else { self.first_step()? };
        self.balance.enter(&mut ledger, self.limits.energy_scale);
        self.ledger = ledger;
        Ok(ledger)
    }

    /// Takes `steps` steps and looks after the first and after every `every`-th that follows; `see` is shown
    /// each ledger. The first finding that stops ends it.
    pub fn run(
        &mut self,
        steps: u64,
        every: u64,
        mut see: impl FnMut(&Self, &Ledger),
    ) -> Result<Vec<Finding>, Error> {
        let mut findings = Vec::new();
        for n in 0..steps {
            if !n.is_multiple_of(every.max(1)) {
                self.step()?;
                continue;
            }
            let ledger = self.step_with_ledger()?;
            findings.extend(self.look());
            if findings.iter().any(|finding| finding.stops) {
                break;
            }
            see(self, &ledger);
        }
        Ok(findings)
    }

    /// Takes steps until `time` [s].
    pub fn run_until(&mut self, time: f64) -> Result<(), Error> {
        while self.time() < time {
            self.step()?;
        }
        Ok(())
    }

    /// The step that the ledger counts from.
    fn first_step(&mut self) -> Result<Ledger, Error> {
        let ledger = self.counted_step()?;
        self.balance.reference = Some(ledger.balance());
        Ok(ledger)
    }

    fn counted_step(&mut self) -> Result<Ledger, Error> {
        if self.time_step() <= 0.0 {
            return Err(Error::NoTimeStep);
        }
        let d = &mut self.dynamics;
        d.velocities_into(&mut self.before);
        let (elastic, gravity) = (d.measure_elastic_energy(), d.gravity_work());
        self.dynamics.step(&mut [&mut self.forces]);
        self.check_announced()?;
        let d = &self.dynamics;
        let (contact, film, others) =
            (self.forces.of_contact(), self.forces.of_films(), self.forces.of_others());
        let gravity_work = gravity - *self.balance.gravity_work.get_or_insert(gravity);
        Ok(Ledger {
            time: d.state.time - d.time_step(),
            kinetic: d.kinetic_energy(&self.before),
            strain: elastic.strain,
            hourglass: elastic.hourglass,
            contact: contact.stored + film.stored,
            further: others.stored,
            friction: contact.friction + others.friction,
            damping: d.heat.at_last_positions() + d.structural_loss(),
            contact_damping: contact.damping + others.damping,
            film: film.damping,
            external: others.supplied + gravity_work,
            drive: d.drive.at_last_positions(),
            ..Ledger::default()
        })
    }

    /// Contact and loads announce their nodes by construction; a law of the user may be wrong about its own.
    fn check_announced(&self) -> Result<(), Error> {
        if self.forces.further.is_empty() {
            return Ok(());
        }
        let Some(slot) = self.dynamics.unread_force() else { return Ok(()) };
        let node = self.dynamics.layout().node_of_slot[slot].unwrap_or(0);
        let [x, y] = self.position(node);
        Err(Error::UnannouncedForce { body: self.body_of(node).to_owned(), x_mm: 1e3 * x, y_mm: 1e3 * y })
    }

    /// Takes a system apart, to measure one part of a step alone. The parts use the node numbers of the
    /// solver.
    pub fn into_parts(self) -> Parts {
        let Forces { contacts, films, loads, further } = self.forces;
        let others = Box::new(Forces { contacts: None, films, loads, further });
        Parts { dynamics: self.dynamics, contacts, others }
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.dynamics.state.step
    }

    /// Time of the positions [s].
    pub fn time(&self) -> f64 {
        self.dynamics.state.time
    }

    /// The time step [s]; zero before one is set.
    pub fn time_step(&self) -> f64 {
        self.dynamics.time_step()
    }

    /// The last ledger that was taken.
    pub fn last_ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Peaks of the ledgers so far.
    pub fn balance(&self) -> &Balance {
        &self.balance
    }

    /// Extremes of all looks.
    pub fn seen(&self) -> &Seen {
        &self.seen
    }

    /// Results of each contact pair in the last step, in the order of the plan.
    pub fn resultants(&self) -> impl Iterator<Item = Resultant> {
        self.forces.contacts.iter().flat_map(|contacts| contacts.resultants())
    }

    /// Results of each oil film in the last step, in the order of the plan.
    pub fn films(&self) -> impl Iterator<Item = FilmResultant> {
        self.forces.films.iter().flat_map(|films| films.resultants())
    }

    /// Force of all contact pairs on each node of the mesh at the present positions [N], in and out of
    /// equilibrium. Nothing moves and the state of contact stays as it is, but resultants are those of the
    /// present positions from here on.
    pub fn contact_forces(&mut self) -> Vec<[f64; 2]> {
        let mut force = NodeForces::zeros(self.dynamics.state.x.len());
        if let Some(contacts) = &mut self.forces.contacts {
            let memory = contacts.state();
            contacts.accumulate(self.dynamics.moment(), &mut force);
            contacts.restore(memory);
        }
        let nodes = 0..self.node_count() as u32;
        nodes.map(|node| self.slot(node)).map(|n| [force.fx[n], force.fy[n]]).collect()
    }

    /// Results of the contact pairs of that name in the last step, added up: the force on their first
    /// surfaces' bodies, and the deepest penetration.
    ///
    /// # Errors
    /// When there is no pair of that name.
    pub fn resultant(&self, pair: &str) -> Result<Resultant, Error> {
        let of_that_name = self.pairs.iter().zip(self.resultants()).filter(|(name, _)| *name == pair);
        let sum = of_that_name.map(|(_, resultant)| resultant).reduce(|a, b| Resultant {
            force: [a.force[0] + b.force[0], a.force[1] + b.force[1]],
            penetration: a.penetration.max(b.penetration),
        });
        sum.ok_or_else(|| unknown("contact pair", pair, self.pairs.iter().map(String::as_str)))
    }
}
