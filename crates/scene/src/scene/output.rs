//! Sampling, sensors and frames of a run, and the limits of its guards.

use serde::{Deserialize, Serialize};

use crate::records::RecordsScene;

/// Sampling, sensors and frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OutputScene {
    /// Sampling interval [µs]; 10 µs is 100 kHz.
    pub interval_us: f64,
    /// Sensors on the outer surface of the outer ring; the report leads with the first.
    pub sensors: Vec<SensorScene>,
    /// Pictures of the stress about the defect; `None` writes none.
    pub frames: Option<FramesScene>,
    /// Synthetic records of a machine's sensor, whose signatures of the passages over the defect can be
    /// compared with a measured record's; `None` without.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub records: Option<RecordsScene>,
}

/// Displacements of all nodes near the middle of the defect (the top of a sound bearing) at several times.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FramesScene {
    /// Time of the first frame [ms].
    pub from_ms: f64,
    /// Latest time of a frame [ms].
    pub to_ms: f64,
    /// Time between two frames [µs], rounded to whole samples.
    pub every_us: f64,
    /// Half the side of the recorded square, about the path of the rollers' centres [mm].
    pub half_width_mm: f64,
}

/// One sensor: a node on the outer surface of the outer ring.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorScene {
    /// Name in the trace, letters, digits and `_`.
    pub name: String,
    /// Angle [°], counter-clockwise from the x axis.
    pub angle_deg: f64,
}

/// Limits of the guards, which are checked at every sample (`guards.rs`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GuardsScene {
    /// Imbalance of energy above which the run carries a warning [%], over the larger of the peak strain
    /// energy (of a reduced run, of the most that rings and contacts have stored) and of the heat.
    pub energy_warning_percent: f64,
    /// … and above which it stops [%]; a reduced run does so only when it is off by a hundredth of its heat,
    /// too.
    pub energy_stop_percent: f64,
    /// Hourglass energy over strain energy above which the run carries a warning [%].
    pub hourglass_warning_percent: f64,
    /// Penetration over the element size above which the run carries a warning [%].
    pub penetration_warning_percent: f64,
    /// … and above which it stops [%]; at 200 % contact takes a point as lying on the far side of the body,
    /// and its force vanishes.
    pub penetration_stop_percent: f64,
    /// Area of an element over its area at rest below which the run stops [%].
    pub area_stop_percent: f64,
    /// Time for which no roller may carry anything before the run carries a warning [ms].
    pub unsupported_warning_ms: f64,
}

impl Default for OutputScene {
    fn default() -> Self {
        let sensor = |name: &str, angle_deg| SensorScene { name: name.into(), angle_deg };
        Self {
            interval_us: 10.0,
            sensors: vec![
                sensor("side", 0.0),
                sensor("shoulder", 22.0),
                sensor("seat", 90.0),
                sensor("bottom", 270.0),
            ],
            frames: Some(FramesScene::default()),
            records: None,
        }
    }
}

impl Default for GuardsScene {
    fn default() -> Self {
        Self {
            energy_warning_percent: 0.5,
            energy_stop_percent: 25.0,
            hourglass_warning_percent: 10.0,
            penetration_warning_percent: 10.0,
            penetration_stop_percent: 100.0,
            area_stop_percent: 20.0,
            unsupported_warning_ms: 0.5,
        }
    }
}

impl Default for FramesScene {
    fn default() -> Self {
        Self { from_ms: 0.2, to_ms: 5.6, every_us: 100.0, half_width_mm: 14.0 }
    }
}
