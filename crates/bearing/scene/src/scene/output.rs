//! Sampling, sensors and frames of a run, and the limits of its guards.

use super::solver::LONGEST_MS;
use crate::group;

/// At places around the ring of the paper's bearing.
fn default_sensors() -> Vec<SensorScene> {
    let places = [("side", 0.0), ("shoulder", 22.0), ("seat", 90.0), ("bottom", 270.0)];
    places.map(|(name, angle_deg)| SensorScene { name: name.into(), angle_deg }).into()
}

group! {
    /// Sampling, sensors and frames.
    pub struct OutputScene {
        /// Sampling interval [µs]; 10 µs is 100 kHz.
        pub interval_us: f64 = 10.0, within(0.01, 1e6);
        /// Sensors on the outer surface of the outer ring; the report leads with the first.
        pub sensors: Vec<SensorScene> = default_sensors();
        /// Pictures of the stress about the defect; `None` writes none.
        pub frames: Option<FramesScene> = Some(FramesScene::default());
    }
}

group! {
    /// Displacements of all nodes near the middle of the defect (the top of a healthy bearing) at several
    /// times.
    pub struct FramesScene {
        /// Time of the first frame [ms].
        pub from_ms: f64 = 0.2, within(0.0, LONGEST_MS);
        /// Latest time of a frame [ms].
        pub to_ms: f64 = 5.6, within(0.0, LONGEST_MS);
        /// Time between two frames [µs], rounded to whole samples.
        pub every_us: f64 = 100.0, positive(1e6);
        /// Half the side of the recorded square, about the path of the rollers' centres [mm].
        pub half_width_mm: f64 = 14.0, positive(20_000.0);
    }
}

group! {
    /// One sensor: a node on the outer surface of the outer ring.
    pub struct SensorScene {
        /// Name in the trace, letters, digits and `_`.
        pub name: String = String::new(), required();
        /// Angle [°], counter-clockwise from the x axis.
        pub angle_deg: f64 = 0.0, within(-360.0, 360.0), required();
    }
}

group! {
    /// Limits of the guards, which are checked at every sample (`guards.rs`).
    pub struct GuardsScene {
        /// Imbalance of energy above which the run carries a warning when it ends [%], over what contacts dissipate
        /// (where they dissipate nothing, over the peak strain energy).
        pub energy_warning_percent: f64 = 10.0, positive(1e6);
        /// Imbalance over the peak strain energy (of a reduced run, the most that rings and contacts have stored)
        /// above which it stops [%]; a reduced run does so only when it is off by a hundredth of its heat, too.
        pub energy_stop_percent: f64 = 25.0, positive(1e6);
        /// Hourglass energy over strain energy above which the run carries a warning [%].
        pub hourglass_warning_percent: f64 = 10.0, positive(1e6);
        /// Penetration over the element size above which the run carries a warning [%], unless it is that of balls.
        pub penetration_warning_percent: f64 = 10.0, positive(200.0);
        /// … and above which it stops [%]; at 200 % its force vanishes.
        pub penetration_stop_percent: f64 = 100.0, positive(200.0);
        /// Area of an element over its area at rest below which the run stops [%].
        pub area_stop_percent: f64 = 20.0, within(0.0, 99.0);
        /// Time for which no roller may carry anything before the run carries a warning [ms].
        pub unsupported_warning_ms: f64 = 0.5, positive(LONGEST_MS);
    }
}

group! {
    /// Records of the force of all rolling elements on the outer ring, behind a path of resonances that the
    /// scene's hash draws, in white noise: one for each level of the noise. `summary.json` has their
    /// signatures.
    pub struct RecordsScene {
        /// Samples a second of the record [Hz]; at most those of the run.
        pub rate_hz: f64 = 25_600.0, up_to(100.0, "output.interval_us", |us| 1e6 / us);
        /// Power of the noise over that of the rest [dB], a record each.
        pub noise_db: Vec<f64> = vec![-20.0, -10.0, 0.0], within(-100.0, 60.0);
    }
}
