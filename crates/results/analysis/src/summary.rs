//! `summary.json`: every figure that the report states, under stable names. A number that a run cannot yield
//! is `null`, with the reason in `notes`.

use serde::{Deserialize, Serialize};
use serde_json::Value;
use stribeck_diagnosis::quantities;
use stribeck_diagnosis::quantity::{Entry, Kind};
use stribeck_dsp::{Resolution, statistics};
use stribeck_scene::scene::DefectRing;
use stribeck_store::run_info::{EnergyInfo, MeshInfo, RunInfo, Status};

use crate::artefacts::Artefact;
use crate::diagnosis::DiagnosisFinding;
use crate::duty::DutyFinding;
use crate::enveloping::EnvelopeFinding;
use crate::families::FamilyFinding;
use crate::film::FilmFinding;
use crate::filtering::NotchFinding;
use crate::floor::FloorContact;
use crate::kinematics::KinematicsFinding;
use crate::levels::SignalLevel;
use crate::load::LoadFinding;
use crate::quantity::{self, Quantity};
use crate::reading::CursorReading;
use crate::tones::Tone;

const WORDS: Kind = Kind::Text;

/// Content of [`MeshInfo`].
const COUNTS: Kind = Kind::Group(&[
    counted("nodes", "Nodes."),
    counted("quads", "Quadrilaterals."),
    counted("triangles", "Triangles."),
    counted("roller_facets", "Facets on one roller."),
    counted("outer_facets", "Facets on the outer raceway, defect included."),
    counted("inner_facets", "Facets on the inner raceway."),
]);

const fn counted(name: &'static str, about: &'static str) -> Entry {
    Entry { name, about, written: "", kind: Kind::Whole, words: None, place: None }
}

quantities! {
    /// All numbers of a run.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Summary {
        /// Name of the scene.
        pub scene: String,
        /// How the run ended.
        pub status: Status as WORDS,
        /// Sizes of the mesh.
        pub mesh: MeshInfo as COUNTS,
        /// Cost.
        pub run: RunCost,
        /// Energy balance.
        pub energy: EnergyFinding,
        /// Measured motion.
        pub kinematics: KinematicsFinding,
        /// Speed and load where they change, with the families in orders of the shaft; `None` where neither
        /// does. Frequencies of [`kinematics`](Self::kinematics) are then those at the mean speed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub duty: Option<DutyFinding>,
        /// Passages over the defect.
        pub events: Vec<Event>,
        /// Forces on the rollers.
        pub load: LoadFinding,
        /// Combs of lines that the recorded motion predicts, and whether the record holds them.
        pub families: Vec<FamilyFinding>,
        /// Oil between rollers and raceways; `None` for a dry bearing.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub film: Option<FilmFinding>,
        /// Facet lines at every sensor: the leading sensor first, fundamentals first.
        pub tones: Vec<Tone>,
        /// Levels of the impulses and of the gaps between them, at the leading sensor.
        pub levels: LevelsFinding,
        /// The notch at the facet tone.
        pub notch: Option<NotchFinding>,
        /// Resolution of the spectra.
        pub spectrum: Option<SpectrumFinding>,
        /// Every line of the leading sensor's spectrum: mesh, beats, defect, ring.
        pub artefacts: Vec<Artefact>,
        /// The defect's family in the envelope; `None` when the record is too short.
        pub envelope: Option<EnvelopeFinding>,
        /// Blind diagnosis from the leading sensor; `None` when the record is too short.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub diagnosis: Option<DiagnosisFinding>,
        /// Possible readings behind the paper's 4545 Hz at this sample rate.
        pub cursor: Option<CursorReading>,
        /// Every number of the paper beside ours.
        pub paper: Vec<PaperRow>,
        /// Reasons for missing numbers, and cautions.
        pub notes: Vec<String>,
    }
}

quantities! {
    /// One number of the paper beside ours.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct PaperRow {
        /// Part of the paper.
        pub part: String,
        /// The quantity.
        pub quantity: String,
        /// As the paper prints it.
        pub paper: String,
        /// Of this run; words when there is no number.
        pub ours: String,
        /// The paper's as a number, where it is one.
        pub paper_value: Option<f64>,
        /// Ours as a number, where there is one.
        pub ours_value: Option<f64>,
        /// Unit of both.
        pub unit: String,
        /// Ours against the paper's.
        pub difference: String,
        /// Reason or comment.
        pub why: String,
    }
}

quantities! {
    /// Cost of the run.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct RunCost = of(info: &RunInfo, samples: usize, simulated_s: f64) {
        /// Steps taken.
        pub steps: u64 = info.steps,
        /// Steps planned.
        pub steps_planned: u64 = info.steps_planned,
        /// Time step [ns].
        pub time_step_ns: f64 = 1e9 * info.time_step_s,
        /// What has set the length of the steps of a reduced model.
        #[serde(default)]
        pub time_step_of: Option<String> = info.reduced.as_ref().map(|reduced| reduced.step_of.clone()),
        /// Simulated time on record [ms].
        pub simulated_ms: f64 = 1e3 * simulated_s,
        /// Samples that can be used.
        pub samples: usize = samples,
        /// Wall-clock time of the time loop [s].
        pub wall_s: f64 = info.wall_s => "wall-clock time, set-up left out",
        /// Processor time of the whole run [s].
        pub cpu_s: f64 = info.cpu_s,
        /// Wall-clock time before the first step [s].
        pub setup_s: f64 = info.setup_s => "set-up: mesh and preload",
        /// Worker threads.
        pub threads: usize = info.threads,
        /// Wall-clock time of the time loop for one element and one step [ns].
        pub ns_per_element_step: Option<f64> = ns_per_element_step(info),
    }
}

quantities! {
    /// Energy balance.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct EnergyFinding = of(energy: &EnergyInfo) {
        /// Largest |imbalance| divided by the peak strain energy.
        pub max_relative_error: f64 = energy.max_relative_error,
        /// Peak strain energy [J].
        pub peak_strain_j: f64 = energy.peak_strain_j,
        /// Energy dissipated by friction, films and damping [J].
        #[serde(default)]
        pub heat_j: f64 = energy.heat_j => "heat of friction and damping" at 11,
        /// Largest |imbalance| over the heat [-], where that is more than the peak strain energy.
        #[serde(default)]
        pub share_of_heat: Option<f64> = energy.share_of_heat(),
        /// Largest |imbalance| over what contacts and films dissipate [-]; absent where they dissipate nothing.
        #[serde(default)]
        pub share_of_contacts: Option<f64> = energy.share_of_contacts() => "imbalance of energy, of what contacts dissipate",
        /// Largest |imbalance| for each passage of an element [J]; absent before the first.
        #[serde(default)]
        pub missing_a_passage_j: Option<f64> = energy.missing_a_passage_j(),
    }
}

impl Summary {
    /// Every number that a summary may have.
    pub fn quantities() -> Vec<Quantity> {
        quantity::of::<Self>()
    }

    /// The schema of a `summary.json` that this version writes (JSON Schema, 2020-12).
    pub fn json_schema() -> Value {
        quantity::schema::titled("Summary of a run", quantity::schema::of::<Self>())
    }

    /// The main ones, in the order in which they are compared.
    pub fn main_quantities() -> Vec<Quantity> {
        let mut main = Self::quantities();
        main.retain(|quantity| quantity.place.is_some());
        main.sort_by_key(|quantity| quantity.place);
        // Levels of the leading sensor come before those of each sensor.
        main.dedup_by_key(|quantity| quantity.place);
        main
    }

    /// The duty of a run whose speed changes, so that no line has a frequency.
    pub fn unsteady(&self) -> Option<&DutyFinding> {
        self.duty.as_ref().filter(|duty| duty.is_unsteady())
    }

    /// The first passage of each roller over the first spall.
    pub fn first_passages(&self) -> Vec<&Event> {
        let mut first: Vec<&Event> = Vec::new();
        for event in self.events.iter().filter(|event| event.spall == 1) {
            if first.iter().all(|known| known.roller != event.roller) {
                first.push(event);
            }
        }
        first
    }
}

quantities! {
    /// One passage of a roller over the defect.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct Event {
        /// Roller, from 1.
        pub roller: usize,
        /// Which spall of a raceway, from 1: `defect` of the scene first, then those of its `defects`.
        #[serde(default = "first")]
        pub spall: usize,
        /// Whose raceway the spall is on.
        #[serde(default)]
        pub ring: DefectRing as WORDS,
        /// Unloading read from the force [ms].
        pub entry_ms: Option<f64>,
        /// Re-stressing read from the force [ms].
        pub exit_ms: Option<f64>,
        /// Time between the two [ms].
        #[serde(default)]
        pub free_ms: Option<f64>,
        /// Centre over the leading edge without slip [ms].
        pub expected_entry_ms: f64,
        /// Centre over the trailing edge without slip [ms].
        pub expected_exit_ms: f64,
        /// Recorded centre over the leading edge [ms].
        pub path_entry_ms: Option<f64>,
        /// Recorded centre over the trailing edge [ms].
        pub path_exit_ms: Option<f64>,
        /// Force before the defect [N].
        pub level_n: Option<f64>,
        /// Largest |a_y| within 1 ms of the exit at the leading sensor [g]: of the re-stressing, or where the
        /// roller never unloaded, of its recorded centre over the trailing edge.
        pub impulse_g: Option<f64>,
        /// When the roller presses most on the floor of the defect [ms], through metal (event #2) or oil; `None`
        /// when neither carries it.
        pub floor_ms: Option<f64>,
        /// Its force then [N].
        pub floor_n: Option<f64>,
        /// Whether the surfaces touch or oil stops the roller before they do.
        #[serde(default)]
        pub floor_by: Option<FloorContact>,
        /// When the roller carries most for a neighbour in the defect [ms] (event #3).
        pub compensation_ms: Option<f64>,
        /// Its force then [N], a running median as wide as that of the events.
        pub compensation_n: Option<f64>,
        /// Its force then over its force before that neighbour entered.
        pub compensation_gain: Option<f64>,
        /// Length of the defect estimated from both times and the speed without slip [mm].
        pub spall_mm: Option<f64> => "length of the spall by its events" at 10,
        /// How far the length by a further passage over the same spall lies from their mean at most, at 95 %
        /// [mm]; `None` of a single passage.
        #[serde(default)]
        pub spall_scatter_mm: Option<f64>,
    }
}

/// Events that were written before there were several spalls are of the first.
fn first() -> usize {
    1
}

quantities! {
    /// Largest magnitude and root mean square [g] in each phase of a record ([`crate::levels::Phase`]);
    /// `None` where the record has no such phase.
    #[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
    pub struct PhaseLevels = of(
        start: Option<SignalLevel>,
        entry: Option<SignalLevel>,
        defect: Option<SignalLevel>,
        exit: Option<SignalLevel>,
        gap: Option<SignalLevel>
    ) {
        /// Largest magnitude in the start-up.
        pub start_g: Option<f64> = start.map(|l| l.peak) => "peak in the start-up",
        /// Root mean square in the start-up.
        pub start_rms_g: Option<f64> = start.map(|l| l.rms) => "root mean square in the start-up",
        /// Largest magnitude while rollers enter the defect.
        pub entry_g: Option<f64> = entry.map(|l| l.peak) => "peak at entries to the defect" at 2,
        /// Root mean square while rollers enter.
        pub entry_rms_g: Option<f64> = entry.map(|l| l.rms) => "root mean square at entries",
        /// Largest magnitude while a roller is in the defect.
        pub defect_g: Option<f64> = defect.map(|l| l.peak) => "peak in the defect",
        /// Root mean square while a roller is in the defect.
        pub defect_rms_g: Option<f64> = defect.map(|l| l.rms) => "root mean square in the defect",
        /// Largest magnitude while rollers leave the defect.
        pub exit_g: Option<f64> = exit.map(|l| l.peak) => "peak at exits from the defect" at 1,
        /// Root mean square while rollers leave.
        pub exit_rms_g: Option<f64> = exit.map(|l| l.rms) => "root mean square at exits",
        /// Largest magnitude in the gaps between the events.
        pub gap_g: Option<f64> = gap.map(|l| l.peak) => "peak between passages" at 3,
        /// Root mean square in the gaps.
        pub gap_rms_g: Option<f64> = gap.map(|l| l.rms) => "root mean square between passages" at 4,
    }
}

quantities! {
    /// Levels of one component of a sensor.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct ComponentLevels {
        /// `radial`, outwards at the sensor's angle, or `tangential`, counter-clockwise.
        pub component: String,
        /// By phase.
        #[serde(flatten)]
        pub phases: PhaseLevels,
    }
}

quantities! {
    /// Levels of a_y [g], mean over each sampling interval.
    #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
    pub struct LevelsFinding {
        /// Sensor that the figures of this section belong to.
        pub sensor: Option<String>,
        /// By phase.
        #[serde(flatten)]
        pub phases: PhaseLevels,
        /// Largest magnitude within 1 ms of any exit.
        pub impulse_g: Option<f64>,
        /// Largest magnitude in the gaps, as `gap_g`.
        pub between_g: Option<f64>,
        /// The same behind the notch, its transient left out.
        pub between_filtered_g: Option<f64> => "peak between passages, behind the notch",
        /// Magnitude that 1 % of the samples in the gaps exceed.
        pub between_p99_g: Option<f64>,
        /// The same behind the notch.
        pub between_filtered_p99_g: Option<f64>,
        /// Root mean square in the gaps.
        pub between_rms_g: Option<f64>,
        /// The same behind the notch.
        pub between_filtered_rms_g: Option<f64>,
        /// Largest magnitude within 1 ms of any exit, behind the notch.
        pub impulse_filtered_g: Option<f64>,
        /// The whole record, start-up included; `None` where it is constant.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub record: Option<RecordLevels>,
        /// The strongest line of the mesh over all in the record that is no line of the mesh [dB]; `None` where no
        /// family of such lines was found.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub mesh_over_rest_db: Option<f64> => "strongest line of the mesh over the bearing's own level",
        /// Every sensor.
        pub sensors: Vec<SensorLevels>,
    }
}

quantities! {
    /// Numbers of a whole record of the leading sensor about its mean.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    pub struct RecordLevels = of(signal: &Shape) {
        /// Root mean square [g].
        pub rms_g: f64 = signal.rms,
        /// Largest distance from the mean [g].
        pub peak_g: f64 = signal.peak,
        /// Peak over root mean square.
        pub crest_factor: f64 = signal.peak / signal.rms,
        /// Fourth central moment over the square of the second; 3 for Gaussian noise.
        pub kurtosis: f64 = signal.kurtosis,
    }
}

/// Numbers of a signal about its mean, in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Root mean square.
    pub rms: f64,
    /// Largest distance from the mean.
    pub peak: f64,
    /// Fourth central moment over the square of the second.
    pub kurtosis: f64,
}

impl Shape {
    /// Of a signal; `None` where it is constant or not finite.
    pub fn of(signal: &[f64]) -> Option<Self> {
        let mean = statistics::mean(signal).ok()?;
        let values: Vec<f64> = signal.iter().map(|x| x - mean).collect();
        let kurtosis = statistics::kurtosis(&values).ok()?;
        let (rms, peak) = (statistics::rms(&values).ok()?, statistics::peak(&values).ok()?);
        Some(Self { rms, peak, kurtosis })
    }
}

quantities! {
    /// Levels at one sensor [g].
    #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
    pub struct SensorLevels {
        /// Sensor.
        pub sensor: String,
        /// Its angle, counter-clockwise from the x axis [°].
        pub angle_deg: f64,
        /// a_y by phase.
        #[serde(flatten)]
        pub phases: PhaseLevels,
        /// The radial and the tangential component by phase; empty when a_x was not recorded.
        pub components: Vec<ComponentLevels>,
        /// Largest |a_y| within 1 ms of any exit.
        pub impulse_g: Option<f64>,
        /// Largest |a_y| in the gaps, as `gap_g`.
        pub between_g: Option<f64>,
        /// Root mean square in the gaps.
        pub between_rms_g: Option<f64>,
        /// Largest |a_y| in the gaps behind the sensor's notch, its transient left out.
        pub between_filtered_g: Option<f64>,
        /// Root mean square in the gaps behind the notch.
        pub between_filtered_rms_g: Option<f64>,
        /// Line of a_y that is nearest to the rollers' vertices times their recorded spin [Hz]; `None` where
        /// none stands 10 dB above its surroundings within 0.5 % or the width of a line.
        #[serde(default)]
        pub tone_hz: Option<f64>,
        /// Its peak amplitude [g].
        #[serde(default)]
        pub tone_g: Option<f64>,
        /// How far it stands above the median of its surroundings [dB]; without a line, the
        /// highest peak there.
        #[serde(default)]
        pub tone_db: Option<f64>,
        /// The line nearest to its fifth harmonic [Hz], as `tone_hz`.
        #[serde(default)]
        pub fifth_hz: Option<f64>,
        /// Its peak amplitude [g].
        #[serde(default)]
        pub fifth_g: Option<f64>,
        /// As `tone_db`.
        #[serde(default)]
        pub fifth_db: Option<f64>,
        /// Centre of this sensor's notch [Hz]: its own dominant facet tone; without one, that of the record.
        #[serde(default)]
        pub notch_hz: Option<f64>,
        /// Drop of the density there [dB]: Hann window, whole record, transient included.
        #[serde(default)]
        pub notch_db: Option<f64>,
    }
}

quantities! {
    /// Resolution of the spectra.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    pub struct SpectrumFinding = of(resolution: &Resolution) {
        /// Length of the record [s].
        pub record_s: f64 = resolution.record_s,
        /// Length of a segment [s].
        pub segment_s: f64 = resolution.segment_s,
        /// Segments averaged.
        pub segments: usize = resolution.segments,
        /// Window.
        pub window: String = resolution.window.to_string(),
        /// One over the length of a segment [Hz].
        pub resolution_hz: f64 = resolution.resolution_hz,
        /// Width of a line at −3 dB [Hz].
        pub width_3db_hz: f64 = resolution.width_3db_hz,
        /// Width of a line at −6 dB [Hz]: closer lines merge.
        pub width_6db_hz: f64 = resolution.width_6db_hz,
        /// Equivalent noise bandwidth [Hz].
        pub noise_bandwidth_hz: f64 = resolution.noise_bandwidth_hz,
        /// Distance between points of the drawn curve [Hz].
        pub grid_hz: f64 = resolution.grid_hz,
        /// True when the grid is finer than the resolution.
        pub zero_padded: bool = resolution.zero_padded,
        /// Resolution of the spectrum of the whole record in which the defect's family is looked for [Hz],
        /// where that is another one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub fine_resolution_hz: Option<f64> = None,
    }
}

impl Event {
    /// Unloading after the centre would stand over the leading edge without slip [ms].
    pub fn entry_off_ms(&self) -> Option<f64> {
        Some(self.entry_ms? - self.expected_entry_ms)
    }

    /// When its roller strikes the floor [ms], as in the paper: a landing on oil is no such impact.
    pub fn impact_ms(&self) -> Option<f64> {
        self.floor_ms.filter(|_| self.floor_by != Some(FloorContact::Film))
    }

    /// When its roller lands on the oil above the floor [ms].
    pub fn landing_ms(&self) -> Option<f64> {
        self.floor_ms.filter(|_| self.floor_by == Some(FloorContact::Film))
    }

    /// When its roller left the spall [ms]: by its force, or else by its path.
    pub fn left_ms(&self) -> Option<f64> {
        self.exit_ms.or(self.path_exit_ms)
    }

    /// Re-stressing after the centre would stand over the trailing edge without slip [ms].
    pub fn exit_off_ms(&self) -> Option<f64> {
        Some(self.exit_ms? - self.expected_exit_ms)
    }
}

/// Wall-clock time of the time loop for one element and one step [ns].
fn ns_per_element_step(info: &RunInfo) -> Option<f64> {
    let elements = (info.mesh.quads + info.mesh.triangles) as f64;
    let work = info.steps as f64 * elements;
    (work > 0.0).then(|| 1e9 * info.wall_s / work)
}
