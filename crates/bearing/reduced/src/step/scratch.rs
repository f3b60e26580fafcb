//! Scratch of a step.

use stribeck_simd::lanes::LANES;

use crate::{
    bearing::Bearing,
    contact::penetration::Penetration,
    frame::Frame,
    modes::Modes,
    roller_force::RollerForce,
    rollers::block::Block,
    row::Row,
    sensors::SensorMotion,
    state::{State, Stored},
};

/// Scratch of a step, and sums over the steps of a sample.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    /// The rollers during some steps.
    pub(crate) blocks: Vec<Block>,
    /// Overlaps of eight contacts, each by parts.
    pub(crate) parts: [Penetration<Row>; LANES],
    pub(crate) modes: Modes,
    /// Steps in the sums of the blocks.
    pub(crate) summed: usize,
    /// Normal forces on the outer raceway [N], and where they are.
    pub(crate) roller_forces: Vec<RollerForce>,
    /// Motion of the sensors before and after the last step of a sample.
    pub(crate) before: SensorMotion,
    pub(crate) now: SensorMotion,
    /// Energies at the positions of the last step, when they were computed.
    pub(crate) energy: Stored,
    /// Deepest penetration since the start of the sample [m].
    pub(crate) deepest: f64,
    pub(crate) frame: Option<Frame>,
}

impl Scratch {
    pub(crate) fn new(bearing: &Bearing) -> Self {
        let n = bearing.rollers.count;
        Self {
            blocks: (0..n)
                .step_by(LANES)
                .map(|first| Block::new(&bearing.rollers, &bearing.raceways, first))
                .collect(),
            modes: Modes::new(&bearing.structure, bearing.seat.as_ref()),
            roller_forces: vec![RollerForce::default(); n],
            ..Self::default()
        }
    }

    /// Takes the rollers from a state, before the first step here.
    pub(crate) fn load(&mut self, bearing: &Bearing, state: &State) {
        let Bearing { rollers, oil, .. } = bearing;
        self.blocks.iter_mut().for_each(|block| block.load(rollers, oil.as_ref(), state));
        if let Some(hold) = &state.seat {
            self.roller_forces.clone_from(&hold.pressed);
        }
    }

    /// Begins a sample, the number of which is known.
    pub(crate) fn begin(&mut self, bearing: &Bearing, sample: u64) {
        let anew = (sample % bearing.rollers.count as u64) as usize;
        self.blocks.iter_mut().for_each(|block| block.begin(&bearing.rollers, anew));
        (self.summed, self.deepest) = (0, 0.0);
    }

    /// Writes the sampled quantities to the state.
    pub(crate) fn show(&self, state: &mut State) {
        self.blocks.iter().for_each(|block| block.show(state));
    }

    /// Leaves the rollers to a state.
    pub(crate) fn store(&self, state: &mut State) {
        self.blocks.iter().for_each(|block| block.store(state));
        if let Some(hold) = &mut state.seat {
            hold.pressed.clone_from(&self.roller_forces);
        }
    }
}
