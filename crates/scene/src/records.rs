//! Synthetic records of a machine's sensor: the force of a run behind an unknown path, in noise.

use serde::{Deserialize, Serialize};

/// Records of the force of all rolling elements on the outer ring, behind a path of resonances that the
/// scene's hash draws, in white noise: one for each level of the noise. `summary.json` has their signatures.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RecordsScene {
    /// Samples a second of the record [Hz]; at most those of the run.
    pub rate_hz: f64,
    /// Power of the noise over that of the rest [dB], a record each.
    pub noise_db: Vec<f64>,
}

impl Default for RecordsScene {
    fn default() -> Self {
        Self { rate_hz: 25_600.0, noise_db: vec![-20.0, -10.0, 0.0] }
    }
}
