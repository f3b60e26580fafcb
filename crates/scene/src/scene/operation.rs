//! The operating point: load, speed, gravity, and the courses of load and speed over time.

use serde::{Deserialize, Serialize};

use crate::housing;

/// Operating point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OperationScene {
    /// Load on the top edge of the adapter, downwards, or on another housing [N].
    pub load_n: f64,
    /// Direction in which the load pushes the housing [°], counter-clockwise from the x axis; absent for 270,
    /// downwards, with the load zone at the top. A pedestal and a housing from a mesh take 90, too, a rigid
    /// one and springs any.
    #[serde(skip_serializing_if = "housing::is_down")]
    pub load_angle_deg: f64,
    /// Speed of the inner ring [rpm]; positive clockwise, negative counter-clockwise.
    pub speed_rpm: f64,
    /// Speed of the outer ring with its housing, which must be rigid then [rpm], counted likewise; absent for
    /// 0.
    #[serde(skip_serializing_if = "housing::is_zero")]
    pub outer_speed_rpm: f64,
    /// Gravity, downwards [m/s²].
    pub gravity_m_s2: f64,
    /// Course of the speed over time [rpm]; absent for a constant `speed_rpm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_profile: Option<ProfileScene>,
    /// Course of the outer ring's speed over time [rpm]; absent for a constant `outer_speed_rpm`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outer_speed_profile: Option<ProfileScene>,
    /// Course of the load over time [N]; absent for a constant `load_n`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_profile: Option<ProfileScene>,
    /// A force that turns with the inner ring, on top of the load; absent for none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rotating_load: Option<RotatingLoadScene>,
}

/// Course of a speed or load over time ([`duty`](crate::duty)). Values have the unit of the field that they
/// vary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ProfileScene {
    /// From the field's value along a straight line to another one, which stays.
    Ramp(RampScene),
    /// The field's value with a sine about it.
    Harmonic(HarmonicScene),
    /// Times [ms], ascending, and values: straight lines between them, the first and the last value before
    /// and behind them. The field itself has no part in it.
    Points(Vec<(f64, f64)>),
    /// The same from a CSV file, whose first line names its columns, `time_ms` and `value`. Its path counts
    /// from the folder of the scene. When a scene is read its points take the place of the file, so a run
    /// holds all of its scene.
    Table(String),
}

/// A change at a constant rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RampScene {
    /// When it begins [ms].
    pub from_ms: f64,
    /// When it is over [ms].
    pub to_ms: f64,
    /// Value at its end and from then on.
    pub to: f64,
}

/// A sine about a mean.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HarmonicScene {
    /// Amplitude.
    pub amplitude: f64,
    /// Frequency [Hz].
    pub hz: f64,
    /// Phase at the start [°]; 0 begins at the mean, upwards.
    pub phase_deg: f64,
}

/// A force on the housing that turns with the inner ring, as that of an unbalanced shaft. Where the housing
/// is guided up and down it takes the vertical part; the horizontal one goes into the guide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RotatingLoadScene {
    /// Its magnitude [N].
    pub force_n: f64,
    /// Its direction at the start [°], counter-clockwise from the x axis.
    pub angle_deg: f64,
}

impl Default for OperationScene {
    fn default() -> Self {
        Self {
            load_n: 50_000.0,
            load_angle_deg: housing::DOWN_DEG,
            speed_rpm: 500.0,
            outer_speed_rpm: 0.0,
            gravity_m_s2: 9.81,
            speed_profile: None,
            outer_speed_profile: None,
            load_profile: None,
            rotating_load: None,
        }
    }
}

impl Default for RampScene {
    fn default() -> Self {
        Self { from_ms: 0.0, to_ms: 100.0, to: 1000.0 }
    }
}

impl Default for HarmonicScene {
    fn default() -> Self {
        Self { amplitude: 50.0, hz: 10.0, phase_deg: 0.0 }
    }
}

impl Default for RotatingLoadScene {
    fn default() -> Self {
        Self { force_n: 1000.0, angle_deg: 0.0 }
    }
}
