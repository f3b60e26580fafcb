//! The ledger of lines: which of them are the bearing, which are its mesh, and what the spectrum shows of each.

use serde::{Deserialize, Serialize};
use stribeck_dsp::{PeriodCount, Spectrum};
use stribeck_scene::scene::Scene;

use crate::Error;
use crate::kinematics::KinematicsFinding;
use crate::prediction::Prediction;
use crate::ring;
use crate::tones::{self, PredictedLine, Tone};

/// Where a line comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// Facets that pass a contact: an artefact of the mesh.
    Mesh,
    /// Difference of two facet lines: how often they come in and out of step.
    Beat,
    /// Rollers that pass the defect: physics.
    Defect,
    /// A natural frequency of the outer ring: physics.
    Ring,
}

/// One line of the ledger.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Artefact {
    /// Where it comes from.
    pub family: Family,
    /// What it is, in words.
    pub name: String,
    /// Multiple of the fundamental, from 1.
    pub harmonic: usize,
    /// Predicted frequency without slip [Hz].
    pub predicted_hz: f64,
    /// The same from the recorded motion [Hz].
    pub from_motion_hz: Option<f64>,
    /// Measured frequency [Hz].
    pub measured_hz: Option<f64>,
    /// Peak amplitude [g].
    pub level_g: Option<f64>,
    /// What to make of it, in words.
    pub verdict: String,
}

/// Harmonics of the defect line that are looked for.
const DEFECT_HARMONICS: usize = 6;
/// Last bending mode of the ring that is looked for.
pub const LAST_MODE: u32 = 6;
/// A mounted ring's frequency may differ from the free thin ring's by this much.
const MODE_REACH: f64 = 0.12;

/// All lines at the leading sensor, `density` being its spectrum [g²/Hz] and `tones` the measured facet lines.
///
/// # Errors
/// [`Error::Signal`] when the spectrum cannot be searched.
pub fn ledger(
    scene: &Scene,
    prediction: &Prediction,
    motion: &KinematicsFinding,
    tones: &[Tone],
    sensor: &str,
    density: &Spectrum,
) -> Result<Vec<Artefact>, Error> {
    let comb = Comb::of(prediction, motion, density);
    let of_mesh = |tone: &Tone| Artefact::of_mesh(tone, comb.as_ref());
    let mut all: Vec<Artefact> = tones.iter().filter(|t| t.sensor == sensor).map(of_mesh).collect();
    all.extend(beats(prediction, motion, density));
    all.extend(defect(prediction, motion, sensor, density)?);
    for (n, hz) in ring::outer_ring_modes(scene, LAST_MODE) {
        all.push(mode(n, hz, density, comb.as_ref(), &all)?);
    }
    Ok(all)
}

/// Predicted lines of the defect: BPFO and its multiples.
pub fn defect_lines(prediction: &Prediction, motion: &KinematicsFinding) -> Vec<PredictedLine> {
    if prediction.defect.is_none() {
        return Vec::new();
    }
    let bpfo = prediction.kinematics.bpfo_hz;
    let mut lines = tones::harmonics(&[("BPFO".to_owned(), bpfo)], DEFECT_HARMONICS, f64::INFINITY);
    for line in &mut lines {
        line.from_motion_hz = motion.bpfo_hz.map(|hz| hz * line.harmonic as f64);
    }
    lines
}

/// Whether a segment of the record holds ten periods of `fundamental_hz`: below that, its multiples are not told from
/// whatever else is there.
pub fn shows_family(density: &Spectrum, fundamental_hz: f64) -> bool {
    density.resolution().segment_s * fundamental_hz >= PeriodCount::ENOUGH
}

fn beats(prediction: &Prediction, motion: &KinematicsFinding, density: &Spectrum) -> Vec<Artefact> {
    let lines = &prediction.facet_lines;
    let resolution = density.resolution();
    let mut all = Vec::new();
    for (at, (first, first_hz)) in lines.iter().enumerate() {
        for (second, second_hz) in &lines[at + 1..] {
            let predicted_hz = (first_hz - second_hz).abs();
            let moved = |name: &str, hz: f64| motion.ratio(name).map(|ratio| ratio * hz);
            let from_motion_hz =
                moved(first, *first_hz).zip(moved(second, *second_hz)).map(|(a, b)| (a - b).abs());
            let apart = from_motion_hz.unwrap_or(predicted_hz);
            let verdict = if predicted_hz == 0.0 {
                "no motion, no beat".to_owned()
            } else if apart < resolution.width_6db_hz {
                format!(
                    "slower than this record can show: the lines lie {apart:.0} Hz apart, it splits {:.0} Hz; one beat lasts {:.0} ms",
                    resolution.width_6db_hz,
                    1e3 / apart.max(1e-3)
                )
            } else {
                "the two lines are split, so the beat is not a line of its own".to_owned()
            };
            all.push(Artefact {
                family: Family::Beat,
                name: format!("{first} with {second}"),
                harmonic: 1,
                predicted_hz,
                from_motion_hz,
                measured_hz: None,
                level_g: None,
                verdict,
            });
        }
    }
    all
}

fn defect(
    prediction: &Prediction,
    motion: &KinematicsFinding,
    sensor: &str,
    density: &Spectrum,
) -> Result<Vec<Artefact>, Error> {
    let lines = defect_lines(prediction, motion);
    let resolution = density.resolution();
    let split = shows_family(density, prediction.kinematics.bpfo_hz);
    let tones = if split { tones::measure(sensor, &lines, density)? } else { Vec::new() };
    let entry = |line: &PredictedLine| {
        let tone = tones.iter().find(|t| t.harmonic == line.harmonic);
        let verdict = match tone {
            None => format!(
                "a record of {:.3} s holds {:.1} of its periods, ten are needed",
                resolution.record_s,
                resolution.record_s * prediction.kinematics.bpfo_hz
            ),
            Some(tone) if tone.measured_hz.is_some() => "physics: rollers pass the defect".to_owned(),
            Some(_) => {
                "does not stand 10 dB above its surroundings; look at the envelope spectrum".to_owned()
            }
        };
        Artefact {
            family: Family::Defect,
            name: line.name.clone(),
            harmonic: line.harmonic,
            predicted_hz: line.predicted_hz,
            from_motion_hz: line.from_motion_hz,
            measured_hz: tone.and_then(|t| t.measured_hz),
            level_g: tone.and_then(|t| t.level_g),
            verdict,
        }
    };
    Ok(lines.iter().map(entry).collect())
}

/// All multiples of BPFO, where a spectrum shows them: knocks make a comb over the whole spectrum.
struct Comb {
    spacing_hz: f64,
    /// A line closer to a tooth than this is not told from it [Hz].
    reach_hz: f64,
}

impl Comb {
    fn of(prediction: &Prediction, motion: &KinematicsFinding, density: &Spectrum) -> Option<Self> {
        prediction.defect?;
        let spacing_hz = motion.bpfo_hz.unwrap_or(prediction.kinematics.bpfo_hz);
        let reach_hz = 0.5 * density.resolution().width_6db_hz;
        shows_family(density, spacing_hz).then_some(Self { spacing_hz, reach_hz })
    }

    /// The multiple of BPFO that stands at `hz`, if any.
    fn tooth(&self, hz: f64) -> Option<u64> {
        let nearest = (hz / self.spacing_hz).round();
        (nearest >= 1.0 && (hz - nearest * self.spacing_hz).abs() < self.reach_hz).then_some(nearest as u64)
    }
}

fn mode(
    n: u32,
    hz: f64,
    density: &Spectrum,
    comb: Option<&Comb>,
    known: &[Artefact],
) -> Result<Artefact, Error> {
    let (from, to) = ((1.0 - MODE_REACH) * hz, (1.0 + MODE_REACH) * hz);
    let mut entry = Artefact {
        family: Family::Ring,
        name: format!("outer ring, n = {n}"),
        harmonic: 1,
        predicted_hz: hz,
        from_motion_hz: None,
        measured_hz: None,
        level_g: None,
        verdict: "no peak: the seat, the rollers and the damping keep it quiet".to_owned(),
    };
    let Ok(peak) = density.peak(from, to).map_err(Error::Signal) else { return Ok(entry) };
    let width = density.resolution().width_6db_hz;
    let above = density.stands_above_db(&peak, 0.6 * hz, 1.4 * hz, 1.5 * width).unwrap_or(0.0);
    if !peak.at_edge && above >= tones::LEAST_PROMINENCE_DB {
        let line = density.sinusoid(&peak).map_err(Error::Signal)?;
        if let Some(multiple) = comb.and_then(|c| c.tooth(line.frequency_hz)) {
            entry.verdict =
                format!("the highest peak near it, {:.1} Hz, is BPFO ×{multiple}", line.frequency_hz);
            return Ok(entry);
        }
        let same = |a: &&Artefact| {
            a.family == Family::Mesh
                && a.measured_hz.is_some_and(|hz| (hz - line.frequency_hz).abs() < 0.5 * width)
        };
        if let Some(mesh) = known.iter().find(same) {
            entry.verdict = format!(
                "the highest peak near it, {:.1} Hz, is that of {} ×{}",
                line.frequency_hz,
                mesh.name.replace('_', " "),
                mesh.harmonic
            );
            return Ok(entry);
        }
        entry.measured_hz = Some(line.frequency_hz);
        entry.level_g = Some(line.amplitude);
        entry.verdict = format!(
            "a peak {above:.0} dB above its surroundings stands near; a free thin ring has its mode here"
        );
    }
    Ok(entry)
}

impl Artefact {
    fn of_mesh(tone: &Tone, comb: Option<&Comb>) -> Self {
        let tooth = tone.measured_hz.and_then(|hz| comb?.tooth(hz));
        let verdict = match (tooth, tone.measured_hz, tone.prominence_db) {
            (Some(multiple), ..) => format!("BPFO ×{multiple} stands at the same place: not told apart"),
            (None, Some(_), _) if tone.unresolved_from.is_empty() => {
                "artefact of the mesh, on its own".to_owned()
            }
            (None, Some(_), _) => {
                "artefact of the mesh; this record cannot say of which of the merged lines".to_owned()
            }
            (None, None, Some(db)) => {
                format!("not above the background: {db:.1} dB, {:.0} dB count", tones::LEAST_PROMINENCE_DB)
            }
            (None, None, None) => "no peak of its own".to_owned(),
        };
        Self {
            family: Family::Mesh,
            name: tone.name.clone(),
            harmonic: tone.harmonic,
            predicted_hz: tone.predicted_hz,
            from_motion_hz: tone.from_motion_hz,
            measured_hz: tone.measured_hz,
            level_g: tone.level_g,
            verdict,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_multiples_of_bpfo_are_teeth_and_what_lies_between_is_not() {
        let comb = Comb { spacing_hz: 89.8, reach_hz: 3.0 };
        assert_eq!((comb.tooth(89.8), comb.tooth(628.7), comb.tooth(592.0)), (Some(1), Some(7), None));
        assert_eq!((comb.tooth(1.0), comb.tooth(45.0)), (None, None));
    }
}
