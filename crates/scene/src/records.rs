//! Synthetic records of a machine's sensor: the force of a run behind an unknown path, in noise.

use crate::fields::group;
use crate::scene::Scene;

/// As many samples a second as the run has [Hz].
fn most_rate_hz(scene: &Scene) -> f64 {
    1e6 / scene.output.interval_us
}

group! {
    /// Records of the force of all rolling elements on the outer ring, behind a path of resonances that the
    /// scene's hash draws, in white noise: one for each level of the noise. `summary.json` has their
    /// signatures.
    pub struct RecordsScene {
        /// Samples a second of the record [Hz]; at most those of the run.
        pub rate_hz: f64 = 25_600.0, up_to(100.0, most_rate_hz);
        /// Power of the noise over that of the rest [dB], a record each.
        pub noise_db: Vec<f64> = vec![-20.0, -10.0, 0.0], within(-100.0, 60.0);
    }
}
