//! Sums of a step: energies at its positions, work, and sums over all rollers.

use pulp::Simd;
use stribeck_simd::lanes::Vector;

use crate::{
    drive::Drive,
    state::{Spent, State, Stored, count},
};

/// Energies and work of one step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Tally {
    /// Whether energies are computed, as in the last step before a sample.
    pub(crate) last: bool,
    pub(crate) stored: Stored,
    pub(crate) spent: Spent,
}

impl Tally {
    /// Adds the sums over all rollers of a step of `dt` [s].
    #[inline(always)]
    pub(crate) fn add<S: Simd>(&mut self, sums: &Sums<S>, drive: &Drive, dt: f64) {
        let spent = &mut self.spent;
        spent.heat = [spent.heat[0] + sums.heat[0].sum(), spent.heat[1] + sums.heat[1].sum()];
        let [by_outer, by_inner] = sums.drive;
        spent.drive += dt * drive.inner.rate * by_inner.sum();
        if let Some(outer) = drive.outer {
            spent.drive += dt * outer.rate * by_outer.sum();
        }
        spent.external += sums.external.sum();
        spent.damped += sums.damped.sum();
        self.stored.kinetic += 0.5 * sums.kinetic.sum();
        self.stored.contact += sums.shadow.sum();
    }

    /// Enters the work of the step into the state.
    #[inline(always)]
    pub(crate) fn enter(&self, state: &mut State, dt: f64) {
        let (work, spent) = (&mut state.work, &self.spent);
        work.friction += 0.5 * dt * spent.heat[0];
        work.contact_damping += 0.5 * dt * spent.heat[1];
        count(&mut work.external, spent.external);
        count(&mut work.drive, spent.drive);
        count(&mut work.damping, spent.damped);
    }
}

/// Sums over all rollers in one step, as of [`Spent`] and [`Stored`].
pub(crate) struct Sums<S: Simd> {
    pub(crate) heat: [Vector<S>; 2],
    /// Moments on the drives of outer and inner ring [N m].
    pub(crate) drive: [Vector<S>; 2],
    pub(crate) external: Vector<S>,
    pub(crate) damped: Vector<S>,
    /// Twice the energy.
    pub(crate) kinetic: Vector<S>,
    /// What the Hamiltonian that the steps conserve has more than the energy, of contacts (THEORY §9.4).
    pub(crate) shadow: Vector<S>,
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S) -> Self {
        let zero = Vector::all(simd, 0.0);
        Self { heat: [zero; 2], drive: [zero; 2], external: zero, damped: zero, kinetic: zero, shadow: zero }
    }
}
