//! A shaft that moves in a housing that stands still, seen from the shaft (THEORY §9.7).
//!
//! The bearing holds the centre of its inner ring. In the frame that moves along with the shaft, without
//! turning, the housing moves the other way: its two translations are prescribed, and rollers and cage have a
//! force of inertia. A program hands over where the shaft is at the end of each communication step, and reads
//! the force of the bearing on it.

pub mod variables;

use crate::modal::ModalBearing;
use serde::{Deserialize, Serialize};

pub use crate::frame::ShaftPoint;
use crate::{
    bearing::Bearing,
    error::Error,
    frame::Frame,
    housing::Housing,
    motion::{BearingInMotion, Energies, Saved},
    start::Solve,
    state::State,
};

/// Fewest steps of the bearing in a communication step: what sensors measure beyond the modes is a difference
/// between two of them.
pub const LEAST_STEPS: f64 = 2.0;

/// Farthest place of the shaft, over the radius of a roller: a bearing is broken long before.
const FARTHEST: f64 = 0.5;

/// All that a bearing on a moving shaft is made of: plain data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OnShaft {
    /// Its numbers.
    pub modal: ModalBearing,
    /// Time step [s].
    pub time_step: f64,
    /// Centre of the outer raceway where the coordinates of all modes are zero [m].
    pub centre: [f64; 2],
}

/// A bearing whose shaft is moved, from one communication step to the next.
#[derive(Debug)]
pub struct BearingOnShaft {
    motion: BearingInMotion,
}

/// Its state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedOnShaft {
    bearing: Saved,
    frame: Frame,
}

/// Force of the bearing on its shaft [N], x and y: of the inner raceway, by contact and oil.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ShaftForce {
    /// At the end of the communication step, extrapolated from the last two steps.
    pub last: [f64; 2],
    /// Mean over the communication step.
    pub mean: [f64; 2],
}

impl BearingOnShaft {
    /// At rest on a shaft that is there, with rollers in balance between the raceways; `solve` as for
    /// [`Bearing::at_start`].
    ///
    /// # Errors
    /// When the housing cannot stand still, the shaft is too far away, or there is no equilibrium.
    pub fn start(from: OnShaft, shaft: ShaftPoint, solve: Solve<'_>) -> Result<Self, Error> {
        let bearing = Bearing::on_shaft(from)?;
        let state = bearing.start_on_shaft(shaft, solve)?;
        let saved = Saved::first(&bearing, state);
        Ok(Self::of(bearing, SavedOnShaft { bearing: saved, frame: Frame::at(shaft) }))
    }

    /// Goes on from `saved`.
    ///
    /// # Errors
    /// When it belongs to another bearing.
    pub fn go_on(&mut self, saved: SavedOnShaft) -> Result<(), Error> {
        if !saved.bearing.fits(&self.motion.bearing) {
            return Err(Error::OtherBearing);
        }
        *self = Self::of(self.motion.bearing.clone(), saved);
        Ok(())
    }

    fn of(bearing: Bearing, saved: SavedOnShaft) -> Self {
        let mut motion = BearingInMotion::new(bearing, saved.bearing);
        motion.scratch.frame = Some(saved.frame);
        Self { motion }
    }

    /// Moves through a communication step of `length` [s], in which the shaft goes from its last place to
    /// `shaft`, on the cubic with both velocities. The bearing takes its own steps; what is left of the last
    /// one is taken in the next communication step. Energies are those of the moving frame.
    ///
    /// # Errors
    /// When the communication step is too short, the shaft too far away, or forces are no numbers any more.
    pub fn advance(&mut self, length: f64, shaft: ShaftPoint) -> Result<Energies, Error> {
        let Self { motion } = self;
        let dt = motion.bearing.time_step;
        motion.bearing.check(shaft)?;
        if length.is_nan() || length < LEAST_STEPS * dt * (1.0 - 1e-6) {
            return Err(Error::ShortStep { us: 1e6 * length, least_us: 1e6 * LEAST_STEPS * dt });
        }
        let Some(frame) = &mut motion.scratch.frame else { return Err(Error::OtherBearing) };
        let steps = frame.begin(length, shaft, dt);
        let energies = motion.interval(steps);
        let force = self.force();
        if !(force.last.iter().chain(&force.mean).all(|force| force.is_finite())) {
            return Err(Error::Diverged { time: self.motion.time() });
        }
        Ok(energies)
    }

    /// Force of the bearing on the shaft.
    pub fn force(&self) -> ShaftForce {
        let (scratch, dt) = (&self.motion.scratch, self.motion.bearing.time_step);
        let steps = scratch.summed.max(1) as f64;
        let sum = |c: usize| -> f64 {
            scratch.blocks.iter().map(|block| block.sums[1][c][..block.count].iter().sum::<f64>()).sum()
        };
        ShaftForce {
            last: scratch.frame.as_ref().map_or([0.0; 2], |frame| frame.force(dt)),
            mean: [0, 1].map(|c: usize| -sum(c) / steps),
        }
    }

    /// Mean acceleration of a sensor over the last communication step, relative to the ground [m/s²].
    pub fn acceleration(&self, sensor: usize) -> Option<[f64; 2]> {
        let relative = self.motion.sensors().get(sensor)?.mean;
        let gained = self.motion.scratch.frame.as_ref()?.gained();
        let interval = self.motion.bearing.time_step * self.motion.scratch.summed.max(1) as f64;
        Some([relative[0] + gained[0] / interval, relative[1] + gained[1] / interval])
    }

    /// Its readings in the frame of the shaft.
    pub fn motion(&self) -> &BearingInMotion {
        &self.motion
    }

    /// State to continue from.
    pub fn saved(&self) -> SavedOnShaft {
        let frame = self.motion.scratch.frame.clone().unwrap_or_default();
        SavedOnShaft { bearing: self.motion.saved(), frame }
    }
}

impl Bearing {
    /// The bearing whose housing stands still and whose shaft is moved: no load acts, because the shaft
    /// brings it.
    fn on_shaft(from: OnShaft) -> Result<Self, Error> {
        let OnShaft { mut modal, time_step, centre } = from;
        if modal.parameters.outer_turns {
            return Err(Error::OuterRingTurns);
        }
        let housing = Housing::of(&modal.reduction, centre)?;
        housing.let_go(&mut modal.reduction);
        let mut bearing = Self::new(modal, time_step)?;
        bearing.operation.released = true;
        bearing.housing = Some(housing);
        Ok(bearing)
    }

    /// Equilibrium of rollers and modes while shaft and housing are where they are.
    fn start_on_shaft(&self, shaft: ShaftPoint, solve: Solve<'_>) -> Result<State, Error> {
        self.check(shaft)?;
        let mut state = self.rest();
        if let Some(housing) = &self.housing {
            housing.place(&mut state.q, shaft.displacement);
        }
        let mut state = self.in_equilibrium(state, solve)?;
        if let Some(housing) = &self.housing {
            housing.drive(&mut state.v, shaft.velocity);
        }
        Ok(state)
    }

    fn check(&self, shaft: ShaftPoint) -> Result<(), Error> {
        let away = libm::hypot(shaft.displacement[0], shaft.displacement[1]);
        let most = FARTHEST * self.rollers.rims[0].top;
        if away <= most && shaft.velocity.iter().all(|v| v.is_finite()) {
            return Ok(());
        }
        Err(Error::ShaftTooFar { um: 1e6 * away, most_um: 1e6 * most })
    }
}
