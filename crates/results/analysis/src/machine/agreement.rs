//! A measured record beside the one that a machine about a simulated bearing makes: third octaves, level,
//! kurtosis, and the height of the defect's family.

use serde::{Deserialize, Serialize};
use stribeck_diagnosis::{Analysis, Defect, Machine};
use stribeck_dsp::channel::Channel;
use stribeck_dsp::statistics;
use stribeck_scene::machine::MachineScene;
use stribeck_scene::scene::BearingScene;

use super::octaves::{above_db, median_size, third_octaves};
use super::{Force, record};
use crate::Error;

/// Part of the sample rate up to which records are compared.
const COMPARED: f64 = 0.45;

/// A simulated record beside a measured one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MachineAgreement {
    /// Median size of the difference in a third octave [dB].
    pub octaves_db: f64,
    /// Root mean square of the simulated record and of the measured one, in the third octaves that are compared
    /// [m/s²].
    pub rms_m_s2: [f64; 2],
    /// Kurtosis of both; 3 is that of noise.
    pub kurtosis: [f64; 2],
    /// Height of the first line of the defect's family above its surroundings in the envelope spectrum, of both
    /// [dB]; `None` where a record has none.
    pub height_db: [Option<f64>; 2],
    /// Whether the verdict claims the defect in each.
    pub claimed: [bool; 2],
}

impl MachineAgreement {
    /// The simulated level over the measured one [dB].
    pub fn level_db(&self) -> f64 {
        20.0 * (self.rms_m_s2[0] / self.rms_m_s2[1]).log10()
    }
}

/// What is known of a measured record.
#[derive(Debug, Clone, Copy)]
pub struct Measured<'a> {
    /// Accelerations [m/s²].
    pub samples: &'a [f64],
    /// Their rate [Hz].
    pub rate_hz: f64,
    /// Speed and bearing.
    pub known: &'a Machine,
    /// The family of its defect; `None` for a healthy bearing.
    pub defect: Option<Defect>,
}

/// A measured record beside that of a machine under the force of a bearing in the same state.
///
/// # Errors
/// When one of them is too short.
pub fn beside(
    machine: &MachineScene,
    bearing: &BearingScene,
    force: &Force,
    measured: Measured<'_>,
) -> Result<MachineAgreement, Error> {
    let mut of = machine.clone();
    of.sensor.rate_hz = measured.rate_hz;
    // Not beyond the gains of the path.
    let known_hz = of.gains.last().map_or(f64::INFINITY, |gain| 1.15 * gain.hz);
    let highest_hz = known_hz.min(COMPARED * measured.rate_hz);
    let simulated = record(&of, bearing, force)?.samples;
    let both = [&simulated[..], measured.samples];
    let mut octaves = Vec::new();
    let mut agreement = MachineAgreement {
        octaves_db: 0.0,
        rms_m_s2: [0.0; 2],
        kurtosis: [0.0; 2],
        height_db: [None; 2],
        claimed: [false; 2],
    };
    for (at, samples) in both.into_iter().enumerate() {
        let bands = third_octaves(samples, measured.rate_hz, highest_hz)?;
        agreement.rms_m_s2[at] = bands.iter().map(|band| band.rms.powi(2)).sum::<f64>().sqrt();
        octaves.push(bands);
        let mean = statistics::mean(samples).map_err(Error::Signal)?;
        let swing: Vec<f64> = samples.iter().map(|x| x - mean).collect();
        agreement.kurtosis[at] = statistics::kurtosis(&swing).map_err(Error::Signal)?;
        let Some(defect) = measured.defect else { continue };
        let channel = Channel::held("record", swing);
        let findings = Analysis::of(&channel, measured.rate_hz, measured.known)?.findings;
        let family = findings.families.iter().find(|family| family.name == defect);
        agreement.height_db[at] = family.and_then(|family| family.level_db);
        agreement.claimed[at] = family.is_some_and(|family| family.claimed);
    }
    agreement.octaves_db = median_size(&above_db(&octaves[0], &octaves[1]));
    Ok(agreement)
}
