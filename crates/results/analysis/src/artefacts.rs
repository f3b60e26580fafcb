//! The ledger of lines: which belong to the bearing, which to its mesh, and the level of each in the
//! spectrum.

use serde::{Deserialize, Serialize};
use stribeck_dsp::{Peak, PeriodCount, Spectrum};
use stribeck_scene::resolved::ResolvedScene;

use crate::Error;
use crate::families::FamilyFinding;
use crate::kinematics::KinematicsFinding;
use crate::prediction::Prediction;
use crate::ring;
use crate::tones::{self, PredictedLine, Tone};
use stribeck_diagnosis::quantities;
use stribeck_diagnosis::quantity::Part;

/// Origin of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// Facets that pass a contact: an artefact of the mesh.
    Mesh,
    /// Difference of two facet lines: how often they come in and out of step.
    Beat,
    /// Rollers that pass the defect: physics.
    Defect,
    /// A natural frequency of the outer ring: physics.
    Ring,
}

impl Part for Origin {}

quantities! {
    /// One line of the ledger.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Artefact {
        /// Its origin.
        pub family: Origin,
        /// Name in words.
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
        /// Interpretation in words.
        pub verdict: String,
    }
}

/// Harmonics of the defect line that are looked for.
const DEFECT_HARMONICS: usize = 6;
/// Last bending mode of the ring that is looked for.
pub const LAST_MODE: u32 = 6;
/// A mounted ring's frequency may differ from the free thin ring's by this much.
const MODE_REACH: f64 = 0.12;

/// Measured lines and spectra of a run.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// Facet lines measured one by one.
    pub tones: &'a [Tone],
    /// Verdicts on the families.
    pub families: &'a [FamilyFinding],
    /// Leading sensor.
    pub sensor: &'a str,
    /// Its spectrum [g²/Hz].
    pub density: &'a Spectrum,
    /// That of the whole record, where only this shows the defect's family.
    pub fine: Option<&'a Spectrum>,
}

/// All lines at the leading sensor.
pub fn ledger(
    scene: &ResolvedScene,
    prediction: &Prediction,
    motion: &KinematicsFinding,
    seen: &Seen<'_>,
) -> Result<Vec<Artefact>, Error> {
    let comb = ShockComb::of(prediction, motion, seen.density);
    let here = seen.tones.iter().filter(|t| t.sensor == seen.sensor);
    let mut all: Vec<Artefact> = here.map(|tone| Artefact::of_mesh(tone, comb.as_ref(), seen)).collect();
    all.extend(beats(prediction, motion, seen.density));
    all.extend(defect(prediction, motion, seen.sensor, seen.fine.unwrap_or(seen.density))?);
    let modes = ring::outer_ring_modes(scene, LAST_MODE).into_iter();
    all.extend(modes.map(|(n, hz)| mode(n, hz, motion, seen, comb.as_ref())));
    Ok(all)
}

/// Predicted lines of the defect: BPFO or BPFI and its multiples.
pub fn defect_lines(prediction: &Prediction, motion: &KinematicsFinding) -> Vec<PredictedLine> {
    let Some(shocks) = prediction.shocks else { return Vec::new() };
    let mut lines =
        tones::harmonics(&[(shocks.name().to_owned(), shocks.hz)], DEFECT_HARMONICS, f64::INFINITY);
    for line in &mut lines {
        line.from_motion_hz = prediction.moved(motion.bpfo_hz).map(|hz| hz * line.harmonic as f64);
    }
    lines
}

/// Whether a segment of the record holds ten periods of `fundamental_hz`: below that, its multiples cannot be
/// distinguished from other lines.
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
                    "slower than this spectrum can show: the lines lie {apart:.0} Hz apart, it splits {:.0} \
                     Hz; one beat lasts {:.0} ms",
                    resolution.width_6db_hz,
                    1e3 / apart.max(1e-3)
                )
            } else {
                "the two lines are split, so the beat is not a line of its own".to_owned()
            };
            all.push(Artefact {
                family: Origin::Beat,
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
    let fundamental = prediction.shocks.map_or(0.0, |shocks| shocks.hz);
    let split = shows_family(density, fundamental);
    let tones = if split { tones::measure(sensor, &lines, density)? } else { Vec::new() };
    let entry = |line: &PredictedLine| {
        let tone = tones.iter().find(|t| t.harmonic == line.harmonic);
        let verdict = match tone {
            None => format!(
                "a record of {:.3} s holds {:.1} of its periods, ten are needed",
                resolution.record_s,
                resolution.record_s * fundamental
            ),
            Some(tone) if tone.measured_hz.is_some() => "physics: rollers pass the defect".to_owned(),
            Some(_) => {
                "does not stand 10 dB above its surroundings; look at the envelope spectrum".to_owned()
            }
        };
        Artefact {
            family: Origin::Defect,
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

/// All multiples of the defect's frequency, where a spectrum shows them: impacts make a comb over the whole
/// spectrum.
struct ShockComb {
    name: &'static str,
    spacing_hz: f64,
    /// A line closer to a multiple than this cannot be distinguished from it [Hz].
    reach_hz: f64,
}

impl ShockComb {
    fn of(prediction: &Prediction, motion: &KinematicsFinding, density: &Spectrum) -> Option<Self> {
        let shocks = prediction.shocks?;
        let spacing_hz = prediction.moved(motion.bpfo_hz).unwrap_or(shocks.hz);
        let reach_hz = 0.5 * density.resolution().width_6db_hz;
        shows_family(density, spacing_hz).then_some(Self { name: shocks.name(), spacing_hz, reach_hz })
    }

    /// The multiple that stands at `hz`, if any.
    fn tooth(&self, hz: f64) -> Option<u64> {
        let nearest = (hz / self.spacing_hz).round();
        (nearest >= 1.0 && (hz - nearest * self.spacing_hz).abs() < self.reach_hz).then_some(nearest as u64)
    }
}

/// A natural frequency with the highest peak near it. It is never booked as measured: a mounted ring's
/// frequencies differ from the free ring's by more than a peak nearby can prove, and most peaks have another
/// cause.
fn mode(n: u32, hz: f64, motion: &KinematicsFinding, seen: &Seen<'_>, comb: Option<&ShockComb>) -> Artefact {
    let density = seen.density;
    let width = density.resolution().width_6db_hz;
    let near =
        density.peak((1.0 - MODE_REACH) * hz, (1.0 + MODE_REACH) * hz).ok().filter(|peak| !peak.at_edge);
    let above = |peak: &Peak| density.stands_above_db(peak, 0.6 * hz, 1.4 * hz, 1.5 * width).unwrap_or(0.0);
    let verdict = match near.filter(|peak| above(peak) >= tones::LEAST_PROMINENCE_DB) {
        None => "no peak near it: the seat, the rollers and the damping keep it quiet".to_owned(),
        Some(peak) => {
            let at = peak.frequency_hz;
            let family = seen.families.iter().find(|f| f.claims(at, motion.bpfo_hz, 0.5 * width));
            match (comb.and_then(|c| Some((c.name, c.tooth(at)?))), family) {
                (_, Some(family)) => format!(
                    "the highest peak near it, {at:.0} Hz, belongs to the family of {}",
                    family.spoken()
                ),
                (Some((name, multiple)), None) => {
                    format!("the highest peak near it, {at:.0} Hz, is {name} ×{multiple}")
                }
                (None, None) => format!(
                    "a peak stands {:+.0} % from it, at {at:.0} Hz; its place alone does not make it this \
                     mode",
                    100.0 * (at / hz - 1.0)
                )
                .replace('-', "−"),
            }
        }
    };
    Artefact {
        family: Origin::Ring,
        name: format!("outer ring, n = {n}"),
        harmonic: 1,
        predicted_hz: hz,
        from_motion_hz: None,
        measured_hz: None,
        level_g: None,
        verdict,
    }
}

impl Artefact {
    /// A facet line. Only a family that was found by its whole comb claims a peak; one at the predicted place
    /// proves nothing.
    fn of_mesh(tone: &Tone, comb: Option<&ShockComb>, seen: &Seen<'_>) -> Self {
        let family = seen.families.iter().find(|f| f.name == tone.name);
        let found = family.is_some_and(|f| f.found);
        let carrier = family.filter(|_| tone.harmonic == 1);
        let tooth = tone.measured_hz.zip(comb).and_then(|(hz, comb)| Some((comb.name, comb.tooth(hz)?)));
        let verdict = match (carrier, tooth, tone.measured_hz) {
            (Some(family), _, _) => family.verdict.clone(),
            (None, Some((name, multiple)), _) => {
                format!("{name} ×{multiple} stands at the same place: not distinguishable")
            }
            (None, None, Some(_)) if found => "a line at the harmonic of a family that was found".to_owned(),
            (None, None, Some(hz)) => {
                format!("a peak stands at {hz:.1} Hz, but the record does not hold this family")
            }
            (None, None, None) => tone.prominence_db.map_or("no peak of its own".to_owned(), |db| {
                format!("not above the background: {db:.1} dB, {:.0} dB count", tones::LEAST_PROMINENCE_DB)
            }),
        };
        // The carrier of a family may be weaker than its sidebands: then it has no line of its own here.
        let own = carrier.and_then(|f| f.lines.iter().find(|l| l.sideband == 0 && l.sensor == seen.sensor));
        let (measured_hz, level_g) = match carrier {
            Some(_) => (own.and_then(|l| l.measured_hz), own.and_then(|l| l.level_g)),
            None if found => (tone.measured_hz, tone.level_g),
            None => (None, None),
        };
        Self {
            family: Origin::Mesh,
            name: tone.name.clone(),
            harmonic: tone.harmonic,
            predicted_hz: tone.predicted_hz,
            from_motion_hz: tone.from_motion_hz,
            measured_hz,
            level_g,
            verdict,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_multiples_of_bpfo_are_teeth_and_what_lies_between_is_not() {
        let comb = ShockComb { name: "BPFO", spacing_hz: 89.8, reach_hz: 3.0 };
        assert_eq!((comb.tooth(89.8), comb.tooth(628.7), comb.tooth(592.0)), (Some(1), Some(7), None));
        assert_eq!((comb.tooth(1.0), comb.tooth(45.0)), (None, None));
    }
}
