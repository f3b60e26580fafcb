//! A reduced bearing in motion, sample by sample.

use crate::{
    bearing::Bearing,
    recorder::Memory,
    state::{State, at_positions},
    step::Scratch,
};

/// A bearing, its state and its recorder.
#[derive(Debug)]
pub struct Motion {
    /// What does not change.
    pub bearing: Bearing,
    /// What does.
    pub state: State,
    /// What the recorder remembers.
    pub memory: Memory,
    scratch: Scratch,
    row: Vec<f64>,
}

impl Motion {
    /// A bearing before its first step.
    pub fn new(bearing: Bearing, state: State) -> Self {
        let scratch = Scratch::new(&bearing, &state);
        let memory = bearing.first_memory(&state);
        Self { bearing, state, memory, scratch, row: Vec::new() }
    }

    /// Takes the steps of a sampling interval.
    pub fn interval(&mut self, steps: usize) -> &[f64] {
        self.scratch.refresh(&self.bearing, &self.state);
        self.bearing.advance(&mut self.state, &mut self.scratch, steps - 1, false);
        let before = self.bearing.before_last_step(&self.state);
        self.bearing.advance(&mut self.state, &mut self.scratch, 1, true);
        self.bearing.row(&self.state, &self.scratch, &before, &mut self.memory, &mut self.row);
        &self.row
    }

    /// kinetic, strain, contact, friction, damping, contact damping, external, drive [J].
    pub fn energies(&self) -> [f64; 8] {
        let (w, e) = (&self.state.work, &self.scratch.energy);
        [
            e.kinetic,
            e.strain,
            e.contact,
            at_positions(w.friction) - e.sticking,
            at_positions(w.damping),
            at_positions(w.contact_damping),
            at_positions(w.external),
            at_positions(w.drive),
        ]
    }
}
