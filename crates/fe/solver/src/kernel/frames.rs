//! The frames of mass damping of a tile's bodies, one in each lane.

use stribeck_simd::lanes::LANES;

use crate::{
    damping::{Frame, PlacedFrame},
    rigid::RigidMotion,
};

/// Where the frames of a tile's bodies are: one a lane, all alike in a tile of one body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LaneFrames {
    frames: [Frame; LANES],
    centre: [[f64; 2]; LANES],
    velocity: [[f64; 2]; LANES],
    spin: [f64; LANES],
}

/// How the frames of a tile's bodies move in one step: velocity at the origin [m/s] and angular velocity
/// [rad/s].
#[derive(Debug, Clone, Default)]
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

    /// Whether a frame depends on the motion of its body.
    pub(crate) fn follow(&self) -> bool {
        self.frames.iter().any(|&frame| frame != Frame::Rest)
    }

    /// Places the frame of a lane by the present motion of its body.
    pub(crate) fn place(&mut self, lane: usize, own: RigidMotion) {
        self.put(lane, self.frames[lane].placed(own));
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
