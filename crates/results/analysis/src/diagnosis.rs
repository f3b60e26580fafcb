//! Blind diagnosis from the leading sensor, without the scene: the verdict of [`stribeck_diagnosis`]
//! on the record, beside the defects that the scene has.

use serde::{Deserialize, Serialize};
use stribeck_diagnosis::{
    AccelerationUnit, Analysis, Conclusion, Defect, Family, Machine, STANDARD_GRAVITY, sidebands_seen,
};
use stribeck_dsp::channel::Channel;
use stribeck_dsp::{BandEnvelope, Whitened};
use stribeck_scene::catalogue;
use stribeck_scene::deviation::RollingSurface;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Run;
use stribeck_theory::kinematics::Kinematics;

use crate::Error;
use crate::defect;
use crate::kinematics::{KinematicsFinding, RollerMotion, mean, relative_hz};
use crate::record::Record;
use stribeck_diagnosis::quantities;

/// Speed of the outer ring of a scene, positive where it turns as the shaft does against it [1/min]; none where
/// speeds change, and nothing has one frequency.
pub fn outer_speed_rpm(scene: &Scene) -> f64 {
    let operation = &scene.operation;
    if operation.speed_varies() {
        return 0.0;
    }
    operation.outer_speed_rpm * (operation.speed_rpm - operation.outer_speed_rpm).signum()
}

quantities! {
    /// Verdict on a record, beside the truth.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct DiagnosisFinding {
        /// The sensor and component, as the trace names it.
        pub channel: String,
        /// The conclusion on each part of the bearing.
        #[serde(default)]
        pub conclusion: Conclusion,
        /// The conclusion in one sentence.
        pub verdict: String,
        /// Root mean square of the record that is judged [g].
        #[serde(default)]
        pub level_g: f64,
        /// One over the length of the segments behind the envelope spectra [Hz].
        pub resolution_hz: f64,
        /// Every family.
        pub families: Vec<DiagnosedFamily>,
    }
}

quantities! {
    /// One family of lines in the envelope spectra.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct DiagnosedFamily {
        /// Whose family it is.
        pub name: Defect,
        /// Frequency of rolling without slip [Hz].
        pub expected_hz: f64,
        /// Frequency of the recorded motion [Hz].
        pub from_motion_hz: Option<f64>,
        /// Frequency at which the family stands [Hz]; `None` when it is not there.
        pub measured_hz: Option<f64>,
        /// Height of its first harmonic above the background [dB].
        pub level_db: Option<f64>,
        /// Whether its impacts keep their phase while an element passes under the load only, so that it has no
        /// lines.
        #[serde(default)]
        pub in_passages: bool,
        /// Whether the record leaves it open: the machine's own lines stand where the family's would.
        #[serde(default)]
        pub undecided: bool,
        /// Whether the verdict claims such a defect.
        pub claimed: bool,
        /// Whether the scene has such a defect.
        pub present: bool,
        /// Why it is claimed, or not.
        pub reason: String,
        /// The sidebands that the load zone and the rotation of the defect make.
        pub sidebands: Option<Sidebands>,
    }
}

quantities! {
    /// Sidebands of the first three harmonics of a family.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Sidebands {
        /// Distance from the harmonic: `shaft` or `cage`.
        pub of: String,
        /// The same [Hz].
        pub spacing_hz: f64,
        /// Number of them above the noise, of six.
        pub seen: usize,
    }
}

/// Diagnosis of channel `name` without the scene; `None` where it is too short or not recorded. The longest
/// transforms of a run: nothing else need be in memory.
///
/// # Errors
/// [`Error::Run`] when the trace cannot be read, [`Error::Signal`] when a finite signal is refused.
pub fn analysis(
    scene: &ResolvedScene,
    record: &Record<'_>,
    expected: &Kinematics,
    name: &str,
) -> Result<Option<Analysis>, Error> {
    let Some(samples) = record.part(0..record.len(), |n| n == name)?.take(name) else { return Ok(None) };
    judged(scene, expected, name, (samples, record.sample_rate_hz()))
}

/// The same of what the sensor of the scene's machine records; `None` where the scene has none.
pub fn analysis_at_the_machine(run: &Run, expected: &Kinematics) -> Result<Option<Analysis>, Error> {
    match crate::machine::of_run(run)? {
        Some(record) => {
            judged(&run.scene, expected, crate::machine::CHANNEL, (record.samples, record.rate_hz))
        }
        None => Ok(None),
    }
}

fn judged(
    scene: &ResolvedScene,
    expected: &Kinematics,
    name: &str,
    (samples, rate_hz): (Vec<f64>, f64),
) -> Result<Option<Analysis>, Error> {
    let machine = machine(scene, expected);
    let channel = Channel::held(name.to_owned(), samples)
        .in_unit(Some(AccelerationUnit::MetrePerSecondSquared.symbol().to_owned()));
    // No sensor has spoilt what is simulated: a housing in free flight has one value for long.
    match Analysis::of_inspected(&channel, rate_hz, &machine, Some(Vec::new())) {
        // A record that is too short, or a sensor that stands still.
        Err(stribeck_diagnosis::Error::NoSignal(_)) => Ok(None),
        analysis => Ok(Some(analysis?)),
    }
}

/// Speed and bearing of a scene.
pub(crate) fn machine(scene: &ResolvedScene, expected: &Kinematics) -> Machine {
    Machine {
        speed_rpm: Some(60.0 * relative_hz(expected)),
        outer_speed_rpm: outer_speed_rpm(&scene.written),
        bearing: Some(catalogue::of_scene(&scene.written)),
        speed_is_exact: true,
        ..Machine::default()
    }
}

/// The verdict of an `analysis` beside the recorded `motion` and the defects of the scene.
pub fn of(scene: &ResolvedScene, motion: &KinematicsFinding, analysis: &Analysis) -> DiagnosisFinding {
    let (present, steady) = (scene.written.faults(), !scene.written.operation.speed_varies());
    let families = analysis.findings.families.iter().map(|family| {
        let sides = match family.name {
            Defect::Bpfo if motion.outer_ring_hz > 0.0 => Some(("outer ring", motion.outer_ring_hz)),
            Defect::Bpfi if motion.shaft_hz > 0.0 => Some(("shaft", motion.shaft_hz)),
            Defect::Bsf if !family.in_passages => {
                Some(("cage", motion.cage_hz.unwrap_or(motion.expected_cage_hz)))
            }
            _ => None,
        };
        let sidebands = sides.and_then(|(of, hz)| sidebands(family, analysis.band_of(family)?, of, hz));
        DiagnosedFamily {
            name: family.name,
            expected_hz: family.expected_hz,
            from_motion_hz: from_motion(family.name, family.in_passages, motion, &present, steady),
            measured_hz: family.measured_hz,
            level_db: family.level_db.filter(|level| level.is_finite()),
            in_passages: family.in_passages,
            undecided: family.undecided,
            claimed: family.claimed,
            present: present.iter().any(|on| defect::on(*on) == family.name),
            reason: family.reason.to_string(),
            sidebands,
        }
    });
    DiagnosisFinding {
        channel: analysis.findings.channel.clone(),
        conclusion: analysis.findings.conclusion,
        verdict: analysis.findings.verdict.clone(),
        level_g: analysis.findings.health.rms / STANDARD_GRAVITY,
        resolution_hz: analysis.findings.resolution_hz,
        families: families.collect(),
    }
}

/// Frequency of a family by the recorded motion [Hz], over the damaged parts that are `present`.
fn from_motion(
    defect: Defect,
    in_passages: bool,
    motion: &KinematicsFinding,
    present: &[RollingSurface],
    steady: bool,
) -> Option<f64> {
    match defect {
        Defect::Bpfo => motion.bpfo_hz,
        // The rates of passing both raceways add up to the shaft's rate times the number of rollers.
        Defect::Bpfi => motion.bpfo_hz.map(|bpfo| motion.pockets() * motion.relative_hz - bpfo),
        // A spot strikes in the load zone, at the spin rate under load. From one turn of the cage to the next
        // its phase advances by the whole rotation of its roller, outside the load zone as well: lines lie at
        // multiples of the mean spin rate.
        Defect::Bsf if in_passages => motion.roller_spin_hz,
        Defect::Bsf => {
            let damaged = |roller: &&RollerMotion| present.contains(&RollingSurface::Roller(roller.roller));
            let own = mean(motion.rollers.iter().filter(damaged).map(|roller| roller.spin_hz));
            own.or(motion.roller_spin_hz)
        }
        // Turns in space, but for speeds that change: orders are those beside an outer ring that stands
        // still.
        Defect::Ftf if steady => motion.cage_hz,
        Defect::Ftf => motion.cage_on_outer_hz[0].or(motion.cage_hz),
    }
}

/// Lines beside the harmonics of a family that is there.
fn sidebands(family: &Family, band: &BandEnvelope, of: &str, spacing_hz: f64) -> Option<Sidebands> {
    let fundamental_hz = family.name.shocks_per_period() * family.measured_hz?;
    let spectrum = Whitened::new(&band.values, band.grid_hz, band.segments).ok()?;
    Some(Sidebands {
        of: of.to_owned(),
        spacing_hz,
        seen: sidebands_seen(&spectrum, fundamental_hz, spacing_hz),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bare housing that bounces falls with one acceleration, sample by sample: that is no mark of missing samples, as
    /// which the verdict on a run was refused.
    #[test]
    fn issue_free_flight_in_a_run_is_no_mark() {
        let scene = Scene::parse("(bearing: \"6205\", model: reduced())", "here").expect("a scene").resolve();
        let expected = Kinematics::new(&scene.written.bearing, 1500.0);
        let mut noise = stribeck_testing::Noise::new(3);
        let value = |n: usize| if n % 50 < 20 { -49.571 } else { noise.uniform() };
        let samples: Vec<f64> = (0..60_000).map(value).collect();
        let analysis =
            judged(&scene, &expected, "side", (samples, 1e5)).expect("a signal").expect("a verdict");
        assert!(analysis.findings.quality.is_empty());
        assert!(!analysis.findings.verdict.starts_with("No verdict"), "{}", analysis.findings.verdict);
    }

    #[test]
    fn issue_motion_is_that_beside_the_outer_ring_and_of_rollers_under_load() {
        let spins =
            |roller: usize, spin_hz: f64| RollerMotion { roller, orbit_hz: 5.3, spin_hz, loaded: true };
        let motion = KinematicsFinding {
            cage_hz: Some(5.3),
            cage_on_outer_hz: [Some(15.3), Some(15.27)],
            roller_spin_hz: Some(79.7),
            roller_spin_all_hz: Some(58.2),
            rollers: vec![spins(1, 79.7), spins(2, 36.7)],
            ..KinematicsFinding::default()
        };
        let of =
            |defect: Defect, present: &[RollingSurface]| from_motion(defect, false, &motion, present, true);
        assert_eq!((of(Defect::Ftf, &[]), of(Defect::Bsf, &[])), (Some(5.3), Some(79.7)));
        assert_eq!(from_motion(Defect::Ftf, false, &motion, &[], false), Some(15.3));
        // Lines of a damaged roller stand at all that it turns.
        assert_eq!(of(Defect::Bsf, &[RollingSurface::Roller(2)]), Some(36.7));
    }

    #[test]
    fn by_hand_an_outer_ring_turns_with_or_against_the_shaft() {
        let scene = |speeds: &str| {
            Scene::parse(
                &format!("(housing: rigid(), film: None, defect: None, operation: ({speeds}))"),
                "here",
            )
            .expect("sound")
        };
        assert_eq!(outer_speed_rpm(&scene("speed_rpm: 0, outer_speed_rpm: 1500")), -1500.0);
        assert_eq!(outer_speed_rpm(&scene("speed_rpm: 1500, outer_speed_rpm: -900")), -900.0);
    }
}
