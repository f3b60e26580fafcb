//! The table of many runs: a row a run. Its columns are the entries declared here, the fields that vary, and the
//! numbers of [`Summary`](crate::summary::Summary); data sets, data sheets and pages follow from them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use stribeck_diagnosis::{Defect, quantities};
use stribeck_scene::deviation::{DeviationScene, FormScene};
use stribeck_scene::fields::value::Value as _;
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_store::run_info::{RunInfo, Status, Topic};
use stribeck_theory::kinematics::Kinematics;

use crate::Error;
use crate::diagnosis::DiagnosedFamily;
use crate::quantity::Quantity;
use crate::summary::Event;

quantities! {
    /// A row of the table.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct RunRow {
        /// Number of the run in the campaign.
        pub run: usize,
        /// Number of its scene.
        pub variant: usize,
        /// Number of its random start.
        pub start: usize,
        /// Part of the data: `train`, `validation` or `test`.
        pub split: String,
        /// How the run ended: `complete`, `diverged`, `failed`, `refused` or `not run`.
        pub status: String,
        /// Why it did not complete.
        pub reason: Option<String>,
        /// What its guards have warned of, a line each.
        pub warnings: Option<String>,
        /// Families that the verdict claims on the record, joined by `+`; `none`, or `undecided`.
        pub claimed: Option<String>,
        /// Samples of the record.
        pub n_samples: Option<usize>,
        /// What its scene says.
        #[serde(flatten)]
        pub truth: Option<Truth>,
    }
}

quantities! {
    /// What a scene says of its run, and what a model is to learn. A fault strikes once a passage: a spall, a dent,
    /// a profile, a rolling element that is missing. Waves, roughness and other diameters are deviations.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct Truth = of(scene: &Scene, fault: String, kinematics: Kinematics) {
        /// Name of its folder below `runs/`.
        pub scene_hash: String = scene.hash(),
        /// Designation.
        pub bearing: String = scene.bearing.designation.clone(),
        /// `full` or `reduced`.
        pub model: String = if scene.model == ModelScene::Full { "full" } else { "reduced" }.to_owned(),
        /// Damaged part, `healthy` without one.
        pub fault_location: String = fault,
        /// Form of the damage.
        pub fault_type: Option<String> = joined(&faults(scene)),
        /// Faults of the scene.
        pub fault_count: usize = faults(scene).len(),
        /// Length along the raceway of the first fault that has one.
        pub fault_size_mm: Option<f64> = extent(scene).map(|[length_mm, ..]| length_mm),
        /// Its depth.
        pub fault_depth_mm: Option<f64> = extent(scene).map(|[_, depth_mm, _]| depth_mm),
        /// Its place at the start.
        pub fault_angle_deg: Option<f64> = extent(scene).map(|[.., angle_deg]| angle_deg),
        /// Waves, roughness and other diameters.
        pub deviation_type: Option<String> = joined(&deviations(scene)),
        /// Speed of the shaft at the start.
        pub shaft_speed_rpm: f64 = scene.operation.speed_rpm,
        /// Load at the start.
        pub load_n: f64 = scene.operation.load_n,
        /// Samples of its signals a second.
        pub sampling_rate_hz: f64 = sampling_rate_hz(scene),
        /// Frequency of the outer raceway without slip.
        pub bpfo_hz: f64 = kinematics.bpfo_hz,
        /// Frequency of the inner raceway without slip.
        pub bpfi_hz: f64 = kinematics.bpfi_hz,
        /// Spin of an element without slip; a spot strikes twice as often.
        pub bsf_hz: f64 = kinematics.bsf_hz,
        /// Turns of the cage without slip.
        pub ftf_hz: f64 = kinematics.cage_hz,
    }
}

quantities! {
    /// A row of the events.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct EventRow {
        /// Number of the run in the campaign.
        pub run: usize,
        /// Part of the data: `train`, `validation` or `test`.
        pub split: String,
        /// The event.
        #[serde(flatten)]
        pub event: Event,
    }
}

quantities! {
    /// A row of the signals, before those of the sensors.
    #[derive(Debug, Clone, PartialEq, Serialize)]
    pub struct SignalRow {
        /// Number of the run in the campaign.
        pub run: usize,
        /// Part of the data: `train`, `validation` or `test`.
        pub split: String,
        /// Time since the start of the run.
        pub time_s: f64,
    }
}

/// One of many runs.
#[derive(Debug, Clone)]
pub struct OneOfMany {
    /// Its row.
    pub row: RunRow,
    /// Values of the fields that vary, as they were written.
    pub values: Vec<String>,
    /// Numbers of its summary by their path.
    pub numbers: BTreeMap<String, f64>,
    /// Its scene; `None` where it was refused.
    pub scene: Option<Scene>,
    /// Version and commit of the program that ran it.
    pub program: Option<String>,
    /// Its folder from that of all runs; `None` where it has none.
    pub folder: Option<String>,
}

impl OneOfMany {
    /// Takes over how the run ended and the `quantities` of its summary. What depends on the computer or on
    /// interruptions, such as seconds, stays in its folder.
    ///
    /// # Errors
    /// [`Error::Summary`] where another version has written the summary.
    pub fn take(&mut self, info: &RunInfo, summary: &Value, quantities: &[Quantity]) -> Result<(), Error> {
        if info.status == Status::Diverged {
            "diverged".clone_into(&mut self.row.status);
            self.row.reason.clone_from(&info.stop_reason);
        }
        // What a disk refused is no property of the run.
        let of_run = info.warned().filter(|(topic, _)| *topic != Some(Topic::Checkpoint));
        let warnings: Vec<&str> = of_run.map(|(_, words)| words.as_str()).collect();
        self.row.warnings = (!warnings.is_empty()).then(|| warnings.join("\n"));
        self.program = Some(format!("{} ({})", info.version, info.commit));
        let of_table = quantities.iter().filter(|quantity| quantity.is_of_table());
        self.numbers.extend(of_table.filter_map(|q| Some((q.path.clone(), q.number(summary)?))));
        if let Some(families) = summary.pointer("/diagnosis/families") {
            let families = Vec::<DiagnosedFamily>::deserialize(families).map_err(Error::Summary)?;
            self.numbers.extend(families.iter().filter_map(|of| Some((level_column(of.name), of.level_db?))));
            self.row.claimed = Some(claimed(&families));
        }
        // An overflow is no number, and a column without numbers is none.
        self.numbers.retain(|_, number| number.is_finite());
        Ok(())
    }

    /// Whether it came to its end.
    pub fn is_complete(&self) -> bool {
        self.row.status == "complete"
    }

    /// Its value of the field in this place as a number; names of bearings are none, whatever their digits.
    pub fn value(&self, fields: &[String], at: usize) -> Option<f64> {
        const NAMES: [&str; 3] = ["bearing", "name", "designation"];
        let field = fields.get(at)?;
        let is_name = NAMES.contains(&field.rsplit('.').next().unwrap_or(field));
        self.values.get(at).filter(|_| !is_name)?.parse().ok()
    }
}

/// Name of the number of a summary that is the level of a family.
pub fn level_column(family: Defect) -> String {
    format!("diagnosis.{}_level_db", family.name().to_lowercase())
}

/// Families that are claimed, joined by `+`; `undecided` where the machine's own lines hide a raceway's.
fn claimed(families: &[DiagnosedFamily]) -> String {
    let names: Vec<&str> = families.iter().filter(|f| f.claimed).map(|f| f.name.name()).collect();
    let is_open = families.iter().any(|f| f.undecided && matches!(f.name, Defect::Bpfo | Defect::Bpfi));
    match (names.as_slice(), is_open) {
        ([], true) => "undecided".to_owned(),
        ([], false) => "none".to_owned(),
        (names, _) => names.join("+"),
    }
}

/// Samples of a scene's signals a second, to a thousandth.
pub fn sampling_rate_hz(scene: &Scene) -> f64 {
    let of_run = 1e6 / scene.output.interval_us;
    let rate_hz = scene.housing.machine().map_or(of_run, |machine| machine.sensor.rate_hz);
    (rate_hz * 1e3).round() / 1e3
}

fn local(scene: &Scene) -> impl Iterator<Item = &DeviationScene> {
    scene.defects.iter().filter(|deviation| deviation.form.length_mm().is_some())
}

/// Forms of the faults, in the words of a scene.
fn faults(scene: &Scene) -> Vec<String> {
    let missing = scene.bearing.rollers - scene.rollers_in_place().count();
    let of_defect = scene.defect.iter().map(|_| "spall".to_owned());
    let forms = of_defect.chain(local(scene).map(|deviation| word(&deviation.form)));
    forms.chain(std::iter::repeat_n("missing".to_owned(), missing)).collect()
}

fn deviations(scene: &Scene) -> Vec<String> {
    let forms = scene.defects.iter().map(|deviation| &deviation.form);
    let others = forms.filter(|form| form.length_mm().is_none() && **form != FormScene::Missing);
    others.map(word).collect()
}

fn word(form: &FormScene) -> String {
    form.write().word().unwrap_or_default().to_owned()
}

/// Length [mm], depth [mm] and angle [°] of the first fault that has a length, in the order of the scene.
fn extent(scene: &Scene) -> Option<[f64; 3]> {
    let of_defect = scene.defect.as_ref().map(|d| [d.length_mm, d.depth_mm, d.angle_deg]);
    let of_form = |d: &DeviationScene| Some([d.form.length_mm()?, d.form.depth_mm(), d.angle_deg]);
    of_defect.or_else(|| local(scene).next().and_then(of_form))
}

/// Each name once, in the order in which they come; `None` without any.
fn joined(names: &[String]) -> Option<String> {
    let first = names.iter().enumerate().filter(|(at, name)| !names[..*at].contains(name));
    let once: Vec<&str> = first.map(|(_, name)| name.as_str()).collect();
    (!once.is_empty()).then(|| once.join("+"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(set: &[&str]) -> Truth {
        let scene = Scene::default().with_overrides(set).expect("a scene");
        Truth::of(&scene, String::new(), scene.kinematics())
    }

    #[test]
    fn behaves_several_defects_of_several_forms() {
        let found = truth(&[
            "film=None",
            "defect=None",
            "defects=[(on: roller(3), angle_deg: 20, form: dent(length_mm: 2.2, depth_mm: 0.04)), \
             (on: outer, form: waviness(order: 9)), (on: inner, form: spall(length_mm: 4.0)), (on: \
             roller(5), form: missing)]",
        ]);
        assert_eq!((found.fault_type.as_deref(), found.fault_count), (Some("dent+spall+missing"), 3));
        // The hollow and half as much of the rim on either side; the first one of the scene.
        let extent = (found.fault_size_mm, found.fault_depth_mm, found.fault_angle_deg);
        assert_eq!(extent, (Some(4.4), Some(0.04), Some(20.0)));
        assert_eq!(found.deviation_type.as_deref(), Some("waviness"));
    }

    #[test]
    fn behaves_a_healthy_bearing_and_the_papers() {
        let healthy = truth(&["defect=None"]);
        assert_eq!((healthy.fault_type, healthy.fault_count, healthy.fault_size_mm), (None, 0, None));
        let paper = truth(&["defect.length_mm=8", "defect.depth_mm=0.3", "defect.angle_deg=80"]);
        assert_eq!((paper.fault_type.as_deref(), paper.fault_count), (Some("spall"), 1));
        assert_eq!(
            (paper.fault_size_mm, paper.fault_depth_mm, paper.fault_angle_deg),
            (Some(8.0), Some(0.3), Some(80.0))
        );
    }

    #[test]
    fn behaves_columns_are_the_declared_entries() {
        let names: Vec<&str> = crate::quantity::columns::<RunRow>().iter().map(|entry| entry.name).collect();
        for name in ["run", "reason", "fault_size_mm", "ftf_hz"] {
            assert!(names.contains(&name), "{name} is not in {names:?}");
        }
        let events = crate::quantity::columns::<EventRow>();
        assert!(events.iter().any(|entry| entry.name == "floor_n" && entry.about.contains("force")));
    }
}
