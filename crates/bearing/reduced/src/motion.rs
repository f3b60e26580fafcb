//! A reduced bearing in motion, as a time loop drives it from one sampling interval to the next.

pub mod readings;

use serde::{Deserialize, Serialize};

use crate::{
    bearing::Bearing,
    state::{State, at_positions},
    step::Scratch,
};

use readings::{Memory, SensorReading};

/// A reduced bearing in motion.
#[derive(Debug)]
pub struct BearingInMotion {
    pub(crate) bearing: Bearing,
    pub(crate) saved: Saved,
    pub(crate) scratch: Scratch,
    pub(crate) sensors: Vec<SensorReading>,
}

/// Its state in a checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// Positions and velocities.
    pub state: State,
    pub(crate) memory: Memory,
}

/// Energies at the positions before the last step of an interval [J]: stored, and work and heat since the
/// start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// Time of these positions [s].
    pub time: f64,
    /// Kinetic energy.
    pub kinetic: f64,
    /// Strain energy of the modes.
    pub strain: f64,
    /// Stored in contacts.
    pub contact: f64,
    /// Heat of friction.
    pub friction: f64,
    /// Heat of mass, stiffness and structural damping.
    pub damping: f64,
    /// Heat of damping in contacts.
    pub contact_damping: f64,
    /// Heat of oil films.
    pub film: f64,
    /// Work of load and gravity.
    pub external: f64,
    /// Work of the drive.
    pub drive: f64,
}

impl Saved {
    /// Before the first step.
    pub fn first(bearing: &Bearing, state: State) -> Self {
        Self { memory: bearing.first_memory(&state), state }
    }

    /// Whether it may belong to this bearing: all arrays have its lengths.
    pub fn fits(&self, bearing: &Bearing) -> bool {
        let (n, r, s) = (bearing.rollers.count, bearing.reduction.padded, &self.state);
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
            && s.branches.len() == bearing.structure.branches.len()
            && s.branches.iter().all(|v| v.len() == r)
            && match (&bearing.seat, &s.seat) {
                (Some(seat), Some(panels)) => seat.fits(panels, r, n),
                (seat, panels) => seat.is_none() && panels.is_none(),
            }
            && match (&bearing.oil, &s.films) {
                (Some(oil), Some(films)) => oil.fits(films, &bearing.rollers.rim_of),
                (oil, films) => oil.is_none() && films.is_none(),
            }
            && self.memory.fits(bearing)
    }
}

impl BearingInMotion {
    /// A bearing that continues from `saved`.
    pub fn new(bearing: Bearing, saved: Saved) -> Self {
        let mut scratch = Scratch::new(&bearing);
        scratch.load(&bearing, &saved.state);
        let sensors = vec![SensorReading::default(); bearing.reduction.sensors.len()];
        Self { bearing, saved, scratch, sensors }
    }

    /// Takes the steps of one sampling interval; the energies are those before the last one.
    pub fn interval(&mut self, steps: usize) -> Energies {
        let Self { bearing, saved: Saved { state, memory }, scratch, sensors } = self;
        scratch.begin(bearing, state.steps / steps as u64);
        bearing.draw_edges(state.shaft, &mut scratch.blocks);
        bearing.advance(state, scratch, steps - 1, false);
        bearing.advance(state, scratch, 1, true);
        scratch.show(state);
        bearing.read_sensors(scratch, memory, sensors);
        self.energies()
    }

    fn energies(&self) -> Energies {
        let (state, stored) = (&self.saved.state, &self.scratch.energy);
        let work = &state.work;
        Energies {
            time: (state.steps - 1) as f64 * self.bearing.time_step,
            kinetic: stored.kinetic,
            strain: stored.strain,
            contact: stored.contact,
            friction: work.friction - stored.sticking,
            damping: at_positions(work.damping),
            contact_damping: work.contact_damping,
            film: state.films.as_ref().map_or(0.0, |films| films.heat),
            external: at_positions(work.external),
            drive: at_positions(work.drive),
        }
    }

    /// The bearing.
    pub fn bearing(&self) -> &Bearing {
        &self.bearing
    }

    /// Coordinates of the modes [√kg m] from the preload.
    pub fn modes(&self) -> &[f64] {
        &self.saved.state.q
    }

    /// Angle of the inner ring [rad].
    pub fn shaft(&self) -> f64 {
        self.saved.state.shaft
    }

    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.saved.state.steps
    }

    /// Time of the positions [s].
    pub fn time(&self) -> f64 {
        self.saved.state.steps as f64 * self.bearing.time_step
    }

    /// State to continue from.
    pub fn saved(&self) -> Saved {
        let mut saved = self.saved.clone();
        self.scratch.store(&mut saved.state);
        saved
    }
}
