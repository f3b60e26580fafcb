//! What the page holds of a bearing: its numbers as a step needs them, where it starts, and what handles are
//! reckoned from.

use serde::{Deserialize, Serialize};
use stribeck_reduced::modal::{
    ModalBearing,
    parameters::{Oil, Speeds},
};
use stribeck_reduced::motion::Saved;

use crate::{error::Error, handles::Handles, limits::Limits, spall::Spall};

/// A bearing in the page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Content {
    /// The bearing of the scene. Its sensors are those of the scene, then others all around the ring.
    pub modal: ModalBearing,
    /// Length of a sampling interval [s].
    pub interval: f64,
    /// Steps of the scene in it.
    pub steps_per_sample: usize,
    /// Where a run of the scene starts.
    pub start: Saved,
    /// Initial positions of the controls, by the scene.
    pub handles: Handles,
    /// The spall that the raceways of `modal` were meshed with.
    pub spall: Option<Spall>,
    /// What follows from handles.
    pub rates: Rates,
    /// Where a run of the scene stops.
    pub limits: Limits,
}

/// By how much numbers of the bearing grow with a handle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// Speeds without slip at one revolution a minute of the inner ring [rad/s], and of the outer one.
    pub speeds: [Speeds; 2],
    /// Speed of the outer ring [rpm], clockwise positive.
    pub outer_rpm: f64,
    /// Contact damping of a damping ratio of one [N s/m³].
    pub contact_damping: f64,
    /// Unit vector of the load, and whether its housing moves along it alone.
    pub along: [f64; 2],
    /// See `along`.
    pub guided: bool,
    /// Whether mass damping acts on the modes.
    pub damps_modes: bool,
    /// The oil as it is for a viscosity [Pa s] and a speed [rpm] of reference, whatever the scene has.
    pub oil: Oil,
    /// Speed of reference [rpm].
    pub oil_rpm: f64,
    /// Thickness of the films there before roughness limits it, outer and inner [m].
    pub thickness: [f64; 2],
    /// Composite roughness, the least film [m].
    pub roughness: f64,
}

/// Tables that are rounded to single precision already, in half the bytes.
#[derive(Serialize, Deserialize)]
struct Singles {
    shapes: Vec<f32>,
    tension: Vec<f32>,
    by_rollers: Vec<f32>,
    stiffness: Vec<f32>,
    residuals: Vec<Vec<[f32; 2]>>,
    at_sensors: Vec<Vec<[f32; 2]>>,
}

fn narrow(table: &mut Vec<f64>) -> Vec<f32> {
    std::mem::take(table).into_iter().map(|number| number as f32).collect()
}

fn wide(table: Vec<f32>) -> Vec<f64> {
    table.into_iter().map(f64::from).collect()
}

fn narrow_pairs(table: &mut Vec<[f64; 2]>) -> Vec<[f32; 2]> {
    std::mem::take(table).into_iter().map(|pair| pair.map(|number| number as f32)).collect()
}

fn wide_pairs(table: Vec<[f32; 2]>) -> Vec<[f64; 2]> {
    table.into_iter().map(|pair| pair.map(f64::from)).collect()
}

impl Content {
    /// As bytes. What sensors measure beyond the modes is kept in single precision; all that the bearing's
    /// motion depends on is kept as it is.
    pub fn to_bytes(&self) -> Result<Vec<u8>, Error> {
        let mut content = self.clone();
        let reduction = &mut content.modal.reduction;
        let mut singles = Singles {
            shapes: narrow(&mut reduction.shapes),
            residuals: reduction.sensors.iter_mut().map(|s| narrow_pairs(&mut s.residual)).collect(),
            tension: Vec::new(),
            by_rollers: Vec::new(),
            stiffness: Vec::new(),
            at_sensors: Vec::new(),
        };
        if let Some(seat) = &mut reduction.springs {
            singles.tension = narrow(&mut seat.tension);
            singles.by_rollers = narrow(&mut seat.by_rollers);
            singles.stiffness = narrow(&mut seat.stiffness);
            singles.at_sensors = seat.at_sensors.iter_mut().map(narrow_pairs).collect();
        }
        Ok(postcard::to_stdvec(&(content, singles))?)
    }

    /// From bytes.
    ///
    /// # Errors
    /// [`Error::Content`] when they are not those of a bearing.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let (mut content, singles): (Self, Singles) = postcard::from_bytes(bytes)?;
        let reduction = &mut content.modal.reduction;
        reduction.shapes = wide(singles.shapes);
        for (sensor, residual) in reduction.sensors.iter_mut().zip(singles.residuals) {
            sensor.residual = wide_pairs(residual);
        }
        if let Some(seat) = &mut reduction.springs {
            seat.tension = wide(singles.tension);
            seat.by_rollers = wide(singles.by_rollers);
            seat.stiffness = wide(singles.stiffness);
            seat.at_sensors = singles.at_sensors.into_iter().map(wide_pairs).collect();
        }
        Ok(content)
    }
}
