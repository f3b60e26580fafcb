//! Mass-proportional damping relative to a motion that it does not affect (THEORY §2.6).

use serde::{Deserialize, Serialize};

use crate::{
    error::{Error, check},
    rigid::RigidMotion,
};

/// The motion that damping leaves alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Frame {
    /// Rest: damping brakes everything.
    Rest,
    /// The rigid part of the body's own motion: only its vibration is damped, its momentum stays.
    OwnMotion,
    /// The body's own motion without what carries its centre of mass towards or away from a point [m]: motion
    /// on a circle about that point and rotation stay, radial vibration is damped.
    Tangential {
        /// Centre of the circle [m].
        centre: [f64; 2],
    },
}

impl Frame {
    /// The frame where a body moves as `own` says.
    pub(crate) fn placed(self, own: RigidMotion) -> PlacedFrame {
        match self {
            Self::Rest => PlacedFrame::default(),
            Self::OwnMotion => PlacedFrame { centre: own.centre, velocity: own.velocity, spin: own.spin },
            Self::Tangential { centre } => {
                let (x, y) = (own.centre[0] - centre[0], own.centre[1] - centre[1]);
                let square = (x * x + y * y).max(f64::MIN_POSITIVE);
                let outwards = (own.velocity[0] * x + own.velocity[1] * y) / square;
                let velocity = [own.velocity[0] - outwards * x, own.velocity[1] - outwards * y];
                PlacedFrame { centre: own.centre, velocity, spin: own.spin }
            }
        }
    }
}

/// Mass-proportional damping of some bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct MassDamping {
    /// Rate α [1/s]; 2·ζ·ω gives the damping ratio ζ at the angular frequency ω.
    rate: f64,
    /// Frame of each damped body, by its number in the mesh.
    frames: Vec<(usize, Frame)>,
}

/// Where a frame was last placed. It belongs to what changes in time, because frames are not placed in every
/// step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PlacedFrame {
    /// A point of the frame [m].
    pub centre: [f64; 2],
    /// Its velocity [m/s].
    pub velocity: [f64; 2],
    /// Angular velocity of the frame [rad/s], counter-clockwise positive.
    pub spin: f64,
}

/// Steps from one placing of the frames to the next; in between their centres move on a straight line.
pub(crate) const PLACE_EVERY: u64 = 64;

impl MassDamping {
    /// Damping at `rate` [1/s] of the bodies named by their numbers in the mesh, each relative to its frame.
    ///
    /// # Errors
    /// When the rate is negative or not finite.
    pub fn new(rate: f64, frames: Vec<(usize, Frame)>) -> Result<Self, Error> {
        check("mass damping rate [1/s]", rate, rate >= 0.0, "zero or positive")?;
        Ok(Self { rate, frames })
    }

    /// Frame of a body; `None` leaves it undamped.
    pub(crate) fn frame(&self, body: usize) -> Option<Frame> {
        self.frames.iter().find(|(b, _)| *b == body).map(|(_, frame)| *frame)
    }

    /// Rate α [1/s].
    pub(crate) fn rate(&self) -> f64 {
        self.rate
    }
}
