//! A bearing between two communication points: what an importer sets and reads.

use std::path::Path;

use stribeck_reduced::{
    dense,
    shaft::{
        BearingOnShaft, LEAST_STEPS, OnShaft, ShaftPoint,
        variables::{OUTPUTS, RESOURCE, SENSORS},
    },
};

use crate::error::Error;

/// What an importer reads, at the end of a communication step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Outputs {
    /// Force of the bearing on the shaft [N], x and y.
    pub force: [f64; 2],
    /// Its mean over the communication step [N].
    pub mean_force: [f64; 2],
    /// Largest normal force of the outer raceway on a roller [N].
    pub largest_roller: f64,
    /// Angle by which the cage has turned [rad]; zero without a cage.
    pub cage_angle: f64,
    /// Angle of the inner ring [rad].
    pub shaft_angle: f64,
    /// Mean acceleration of each sensor over the communication step [m/s²].
    pub acceleration: [[f64; 2]; SENSORS],
}

impl Outputs {
    /// In the order of [`OUTPUTS`].
    pub fn values(&self) -> [f64; OUTPUTS.len()] {
        let Self {
            force: [fx, fy],
            mean_force: [mx, my],
            largest_roller,
            cage_angle,
            shaft_angle,
            acceleration,
        } = *self;
        let [[ax, ay], [bx, by], [cx, cy], [dx, dy]] = acceleration;
        [fx, fy, mx, my, largest_roller, cage_angle, shaft_angle, ax, ay, bx, by, cx, cy, dx, dy]
    }
}

/// A bearing that an importer drives.
#[derive(Debug)]
pub struct Session {
    from: OnShaft,
    bearing: Option<BearingOnShaft>,
    outputs: Outputs,
}

impl Session {
    /// The bearing in the resources of an FMU.
    ///
    /// # Errors
    /// When the file is not there, or is not that of a bearing.
    pub fn open(resources: &Path) -> Result<Self, Error> {
        let path = resources.join(RESOURCE);
        let bytes = std::fs::read(&path).map_err(|error| Error::Resource { path, error })?;
        Self::from_bytes(&bytes)
    }

    /// The bearing of these bytes.
    ///
    /// # Errors
    /// When they are not those of a bearing.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let from = postcard::from_bytes(bytes).map_err(Error::Content)?;
        Ok(Self { from, bearing: None, outputs: Outputs::default() })
    }

    /// Starts with the shaft at a place: rollers stand in balance between the raceways.
    ///
    /// # Errors
    /// When the shaft is too far away, or there is no equilibrium.
    pub fn start(&mut self, shaft: ShaftPoint) -> Result<(), Error> {
        let bearing = || BearingOnShaft::start(self.from.clone(), shaft, &dense::solve);
        // Forces are those of steps: two of them, by another bearing, show those of the start.
        let mut ahead = bearing()?;
        let length = LEAST_STEPS * self.from.time_step;
        let moved = [0, 1].map(|c: usize| shaft.displacement[c] + length * shaft.velocity[c]);
        ahead.advance(length, ShaftPoint { displacement: moved, ..shaft })?;
        let outputs = Outputs { cage_angle: 0.0, shaft_angle: 0.0, ..read(&ahead) };
        (self.bearing, self.outputs) = (Some(bearing()?), outputs);
        Ok(())
    }

    /// Moves through a communication step of `length` [s], at the end of which the shaft is at a place.
    ///
    /// # Errors
    /// When it has not been started, the step is too short, the shaft too far away, or the bearing diverges.
    pub fn advance(&mut self, length: f64, shaft: ShaftPoint) -> Result<(), Error> {
        let bearing = self.bearing.as_mut().ok_or(Error::NotStarted)?;
        bearing.advance(length, shaft)?;
        self.outputs = read(bearing);
        Ok(())
    }

    /// What an importer reads.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }
}

fn read(bearing: &BearingOnShaft) -> Outputs {
    let (force, motion) = (bearing.force(), bearing.motion());
    let mut acceleration = [[0.0; 2]; SENSORS];
    for (sensor, of) in acceleration.iter_mut().enumerate() {
        *of = bearing.acceleration(sensor).unwrap_or_default();
    }
    Outputs {
        force: force.last,
        mean_force: force.mean,
        largest_roller: motion.largest_outer_force(),
        cage_angle: motion.cage().map_or(0.0, |(_, angle)| angle),
        shaft_angle: motion.shaft(),
        acceleration,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_resources_without_a_bearing() {
        let nowhere = std::env::temp_dir().join("stribeck-no-such-fmu");
        let told = Session::open(&nowhere).expect_err("nothing is there").to_string();
        assert!(told.contains("bearing.postcard") && told.contains("no bearing"), "{told}");
        let told = Session::from_bytes(&[1, 2, 3]).expect_err("no bearing").to_string();
        assert!(told.contains("not a bearing"), "{told}");
    }
}
