//! Mass-proportional damping relative to a motion that is not to be braked (THEORY §2.6).

use serde::{Deserialize, Serialize};

use crate::{error::Error, error::check, rigid::RigidMotion};
use stribeck_simd::lanes::LANES;

/// The motion that damping leaves alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Frame {
    /// Rest: damping brakes everything.
    Rest,
    /// The rigid part of the body's own motion: only its vibration is damped, its momentum stays.
    OwnMotion,
    /// The body's own motion without the part that carries its centre towards or away from the origin: running around
    /// the origin and turning stay, rattling across a track is damped.
    Track,
}

/// Mass-proportional damping of some bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct MassDamping {
    /// Rate α [1/s]; 2·ζ·ω gives the damping ratio ζ at the angular frequency ω.
    rate: f64,
    /// Frame of each damped body, by its number in the mesh.
    frames: Vec<(usize, Frame)>,
}

/// Where a frame was last placed. Part of what changes in time, because frames are placed now and then only.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct PlacedFrame {
    /// A point of the frame [m].
    pub centre: [f64; 2],
    /// Its velocity [m/s].
    pub velocity: [f64; 2],
    /// Angular velocity of the frame [rad/s], counter-clockwise positive.
    pub spin: f64,
}

/// Frames are placed anew every so many steps; in between their centres move on a straight line.
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

/// Where the frames of a tile's bodies are: one a lane, all alike in a tile of one body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LaneFrames {
    frames: [Frame; LANES],
    centre: [[f64; 2]; LANES],
    velocity: [[f64; 2]; LANES],
    spin: [f64; LANES],
}

/// How the frames of a tile's bodies move in one step: velocity at the origin [m/s] and angular velocity [rad/s].
#[derive(Debug, Clone)]
pub(crate) struct LaneMotion {
    pub(crate) origin_x: [f64; LANES],
    pub(crate) origin_y: [f64; LANES],
    pub(crate) spin: [f64; LANES],
}

impl LaneFrames {
    /// All at rest.
    pub(crate) const REST: Self = Self {
        frames: [Frame::Rest; LANES],
        centre: [[0.0; 2]; LANES],
        velocity: [[0.0; 2]; LANES],
        spin: [0.0; LANES],
    };

    pub(crate) fn new(frames: [Frame; LANES]) -> Self {
        Self { frames, ..Self::REST }
    }

    /// Whether one of them asks how its body moves.
    pub(crate) fn follow(&self) -> bool {
        self.frames.iter().any(|&frame| frame != Frame::Rest)
    }

    /// Places the frame of a lane by the present motion of its body.
    pub(crate) fn place(&mut self, lane: usize, own: RigidMotion) {
        let frame = match self.frames[lane] {
            Frame::Rest => PlacedFrame::default(),
            Frame::OwnMotion => PlacedFrame { centre: own.centre, velocity: own.velocity, spin: own.spin },
            Frame::Track => {
                let [x, y] = own.centre;
                let square = (x * x + y * y).max(f64::MIN_POSITIVE);
                let outwards = (own.velocity[0] * x + own.velocity[1] * y) / square;
                let velocity = [own.velocity[0] - outwards * x, own.velocity[1] - outwards * y];
                PlacedFrame { centre: own.centre, velocity, spin: own.spin }
            }
        };
        self.put(lane, frame);
    }

    /// Puts the frame of a lane where it was placed earlier.
    pub(crate) fn put(&mut self, lane: usize, frame: PlacedFrame) {
        self.centre[lane] = frame.centre;
        self.velocity[lane] = frame.velocity;
        self.spin[lane] = frame.spin;
    }

    /// Where the frame of a lane was last placed.
    pub(crate) fn placed(&self, lane: usize) -> PlacedFrame {
        PlacedFrame { centre: self.centre[lane], velocity: self.velocity[lane], spin: self.spin[lane] }
    }

    /// How the frames move `span` [s] after they were placed.
    pub(crate) fn after(&self, span: f64) -> LaneMotion {
        let mut motion = LaneMotion { origin_x: [0.0; LANES], origin_y: [0.0; LANES], spin: self.spin };
        for l in 0..LANES {
            let (v, w) = (self.velocity[l], self.spin[l]);
            let c = [self.centre[l][0] + span * v[0], self.centre[l][1] + span * v[1]];
            motion.origin_x[l] = v[0] + w * c[1];
            motion.origin_y[l] = v[1] - w * c[0];
        }
        motion
    }
}
