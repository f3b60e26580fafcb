//! `run.json`: provenance, sizes, cost and the energy ledger's verdict of one run.

use serde::{Deserialize, Serialize};

/// Contents of `run.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunInfo {
    /// Version of the program.
    pub version: String,
    /// Commit it was built from, `unknown` outside a checkout.
    pub commit: String,
    /// Hash of the scene's values, as of `Scene::hash`, hexadecimal.
    pub scene_hash: String,
    /// Processor and operating system, in words.
    pub machine: String,
    /// Worker threads.
    pub threads: usize,
    /// How the run ended.
    pub status: Status,
    /// Why it ended before its time, when it did.
    pub stop_reason: Option<String>,
    /// Time step [s].
    pub time_step_s: f64,
    /// Critical time step [s].
    pub critical_time_step_s: f64,
    /// Steps taken.
    pub steps: u64,
    /// Steps planned.
    pub steps_planned: u64,
    /// Sampling interval [s].
    pub interval_s: f64,
    /// Samples written.
    pub samples: usize,
    /// Simulated time [s].
    #[serde(default)]
    pub simulated_s: f64,
    /// Mesh counts.
    pub mesh: MeshInfo,
    /// Wall-clock time of the time loop [s].
    pub wall_s: f64,
    /// Processor time of the whole run, all threads [s].
    pub cpu_s: f64,
    /// Processor time of the time loop, all threads [s].
    #[serde(default)]
    pub loop_cpu_s: f64,
    /// Wall-clock time from start to the first step (mesh, preload) [s].
    pub setup_s: f64,
    /// Simulated times from which the run was continued [s]; none for a run in one piece. Clocks count all
    /// pieces; version, machine and threads are those of the last one.
    #[serde(default)]
    pub resumed_at_s: Vec<f64>,
    /// Modes that the reduced model kept; none in the full one.
    #[serde(default)]
    pub reduced: Option<ReducedInfo>,
    /// Energy verdict.
    pub energy: EnergyInfo,
    /// Extremes of the other guards.
    #[serde(default)]
    pub guards: GuardInfo,
    /// Vertical force that the rollers must carry: load plus the weight of adapter and outer ring [N].
    pub expected_support_n: f64,
    /// Parts of the scene that the run ignores: of the mesh files of housing and rings.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Warnings, in the order in which they arose.
    pub warnings: Vec<String>,
    /// What each of them is about.
    #[serde(default)]
    pub warned_of: Vec<Topic>,
}

/// A warning of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// What it is about.
    pub topic: Topic,
    /// Its words: what was seen and what to change.
    pub words: String,
}

/// What a warning is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Topic {
    /// Contact that sinks in: the first thing to know of a run.
    Contact,
    /// The balance of energy.
    Energy,
    /// The time step.
    TimeStep,
    /// Elements that bend too much or turn inside out.
    Elements,
    /// The modes of a reduced model.
    Modes,
    /// Where rollers and cage are, and what carries the load.
    Motion,
    /// The state from which the run starts.
    Start,
    /// Pictures that the page lacks.
    Pictures,
    /// The files of the run.
    Files,
    /// A checkpoint that the disk refused: nothing in the results depends on it.
    Checkpoint,
}

impl Topic {
    /// A warning about it.
    pub fn warning(self, words: impl Into<String>) -> Warning {
        Warning { topic: self, words: words.into() }
    }
}

impl RunInfo {
    /// Takes back what was warned of, before it is judged anew.
    pub fn take_back(&mut self, topic: Topic) {
        let kept = self.warned_of.iter().map(|of| *of != topic).chain(std::iter::repeat(true));
        let kept: Vec<bool> = kept.take(self.warnings.len()).collect();
        let mut each = kept.iter();
        self.warnings.retain(|_| *each.next().unwrap_or(&true));
        self.warned_of.retain(|of| *of != topic);
    }

    /// Adds a warning.
    pub fn warn(&mut self, Warning { topic, words }: Warning) {
        self.warnings.push(words);
        self.warned_of.push(topic);
    }

    /// The warnings with what they are about; `None` in runs of earlier versions.
    pub fn warned(&self) -> impl Iterator<Item = (Option<Topic>, &String)> {
        let topics = self.warned_of.iter().copied().map(Some).chain(std::iter::repeat(None));
        topics.zip(&self.warnings)
    }
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// Still going, or killed.
    Running,
    /// All steps taken.
    Complete,
    /// Interrupted by the user.
    Interrupted,
    /// Stopped by a guard: energy, NaN, penetration, distortion, a body out of its place.
    Diverged,
}

/// Mesh counts.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MeshInfo {
    /// Nodes.
    pub nodes: usize,
    /// Quadrilaterals.
    pub quads: usize,
    /// Triangles.
    pub triangles: usize,
    /// Facets on one roller.
    pub roller_facets: usize,
    /// Facets on the outer raceway, defect included.
    pub outer_facets: usize,
    /// Facets on the inner raceway.
    pub inner_facets: usize,
}

/// Modes that the reduced model kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReducedInfo {
    /// Modes of outer ring and adapter, the two that nothing resists among them.
    pub modes: usize,
    /// Highest natural frequency that was kept [Hz].
    pub highest_hz: f64,
    /// Whether the modes were read from an earlier run's.
    pub from_cache: bool,
    /// What has set the length of the steps, in words; empty in runs of programs that did not record it.
    #[serde(default)]
    pub step_of: String,
}

/// Energy verdict.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyInfo {
    /// Largest |imbalance| divided by the peak strain energy [-]; infinite (`null` in the file) after an
    /// overflow.
    #[serde(deserialize_with = "null_is_infinite")]
    pub max_relative_error: f64,
    /// Peak strain energy [J]; infinite likewise.
    #[serde(deserialize_with = "null_is_infinite")]
    pub peak_strain_j: f64,
    /// Heat of friction, films and damping [J]; absent in runs of programs that did not record it.
    #[serde(default, deserialize_with = "null_is_infinite")]
    pub heat_j: f64,
    /// The part of it that contacts and films dissipate [J]; 0 in runs of programs that did not record it.
    #[serde(default, deserialize_with = "null_is_infinite")]
    pub contact_heat_j: f64,
    /// Elements that have passed a place of the outer ring, without slip.
    #[serde(default)]
    pub passages: f64,
}

impl EnergyInfo {
    /// Largest |imbalance| [J].
    fn missing_j(&self) -> f64 {
        self.max_relative_error * self.peak_strain_j
    }

    /// Largest |imbalance| over the heat [-], where the heat exceeds the peak strain energy.
    pub fn share_of_heat(&self) -> Option<f64> {
        let share = self.missing_j() / self.heat_j;
        (self.heat_j > self.peak_strain_j && share.is_finite()).then_some(share)
    }

    /// Largest |imbalance| over what contacts have dissipated [-]: the measure of a run, whatever its length, its housing
    /// and its damping. `None` where they dissipate nothing.
    pub fn share_of_contacts(&self) -> Option<f64> {
        (self.contact_heat_j > 0.0).then(|| self.missing_j() / self.contact_heat_j)
    }

    /// The same; over the peak strain energy where contacts dissipate nothing [-].
    pub fn share(&self) -> f64 {
        self.share_of_contacts().unwrap_or(self.max_relative_error)
    }

    /// Largest |imbalance| for each passage of an element [J]; `None` before the first.
    pub fn missing_a_passage_j(&self) -> Option<f64> {
        (self.passages >= 1.0).then(|| self.missing_j() / self.passages)
    }

    /// Largest energy imbalance in words, as of [`imbalance`].
    pub fn in_words(&self) -> String {
        imbalance(self.missing_a_passage_j(), self.share_of_contacts(), self.max_relative_error)
    }
}

/// An energy imbalance in words: what is missing for each passage [J], as a share of what contacts dissipate, or of the peak
/// strain energy where they dissipate nothing.
pub fn imbalance(a_passage_j: Option<f64>, of_contacts: Option<f64>, of_strain: f64) -> String {
    let share = of_contacts.unwrap_or(of_strain);
    let of = if of_contacts.is_some() { "what contacts dissipate" } else { "the peak strain energy" };
    let a_passage = a_passage_j.map_or(String::new(), |joules| format!("{:.2} µJ a passage, ", 1e6 * joules));
    format!("{a_passage}{:.3} % of {of}", 100.0 * share)
}

/// Extremes of the guards (`guards.rs`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GuardInfo {
    /// Largest energy that rings and contacts of a reduced bearing have stored [J].
    pub stored_j: f64,
    /// Largest hourglass energy over strain energy [-].
    pub hourglass_share: f64,
    /// Deepest penetration over the element size [-].
    pub penetration_share: f64,
    /// Least area of an element over its area at rest [-]; infinite (`null` in the file) before it was looked
    /// at.
    #[serde(deserialize_with = "null_is_infinite")]
    pub least_area: f64,
    /// Largest strain for which the critical time step has been computed again [-].
    pub strain_checked: f64,
    /// Samples in a row, up to the last one, at which no roller carried anything.
    pub unsupported_samples: usize,
    /// Longest such time [s].
    pub longest_unsupported_s: f64,
    /// Farthest that the cage's centre has been from that of the outer ring [m].
    #[serde(default)]
    pub cage_offset_m: f64,
    /// Largest force with which it has pushed a roller [N].
    pub cage_push_n: f64,
    /// Time, up to the last sample, in which it has turned at less than half its speed [s].
    pub cage_slow_s: f64,
    /// Longest such time [s].
    pub longest_cage_slow_s: f64,
}

impl Default for GuardInfo {
    fn default() -> Self {
        Self {
            stored_j: 0.0,
            hourglass_share: 0.0,
            penetration_share: 0.0,
            least_area: f64::INFINITY,
            strain_checked: 0.0,
            unsupported_samples: 0,
            longest_unsupported_s: 0.0,
            cage_offset_m: 0.0,
            cage_push_n: 0.0,
            cage_slow_s: 0.0,
            longest_cage_slow_s: 0.0,
        }
    }
}

/// JSON has no infinity: it is written as `null`. The binary checkpoint holds infinity itself.
fn null_is_infinite<'de, D: serde::Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    if !from.is_human_readable() {
        return f64::deserialize(from);
    }
    Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::INFINITY))
}

/// A time [s] as people write it: `7.3 s`, `3:05` or `2:03:05`.
pub fn clock(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "unknown".to_owned();
    }
    if seconds < 60.0 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds.round() as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 { format!("{hours}:{minutes:02}:{seconds:02}") } else { format!("{minutes}:{seconds:02}") }
}

#[cfg(test)]
mod tests {
    use super::{EnergyInfo, clock};

    /// A light bearing in a rigid housing stores millionths of what it dissipates, and damping of the rings that the scene
    /// chose can be most of the heat: neither says what the steps do to contacts.
    #[test]
    fn issue_an_imbalance_is_relative_to_what_contacts_dissipate() {
        let energy = EnergyInfo {
            max_relative_error: 0.2,
            peak_strain_j: 2e-3,
            heat_j: 0.5,
            contact_heat_j: 0.01,
            passages: 40.0,
        };
        assert_eq!(energy.in_words(), "10.00 µJ a passage, 4.000 % of what contacts dissipate");
        assert_eq!(energy.share_of_heat(), Some(8e-4));
        let frictionless = EnergyInfo { contact_heat_j: 0.0, passages: 0.5, ..energy };
        assert_eq!(frictionless.in_words(), "20.000 % of the peak strain energy");
        assert_eq!(frictionless.share(), 0.2);
    }

    #[test]
    fn behaves_times_are_written_for_people() {
        assert_eq!(clock(7.26), "7.3 s");
        assert_eq!(clock(185.4), "3:05");
        assert_eq!(clock(7385.0), "2:03:05");
        assert_eq!(clock(f64::NAN), "unknown");
    }
}
