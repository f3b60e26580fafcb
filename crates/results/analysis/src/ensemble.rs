//! Many starts of one scene together: every number of their summaries with its mean, interval and quantiles.

mod merge;

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use stribeck_scene::ensemble::{folder_name, is_start_of};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Ensemble;
use stribeck_store::run_dir::{Run, RunDir};
use stribeck_store::run_info::Status;

use crate::Error;
use crate::findings::Findings;
use crate::record::Record;
use crate::statistic::Statistic;
use crate::summary::Event;
pub use merge::Merged;

/// An ensemble: the scene, the starts and their results.
#[derive(Debug)]
pub struct EnsembleFindings {
    /// The scene of all starts.
    pub scene: ResolvedScene,
    /// The ensemble as it was requested.
    pub ensemble: Ensemble,
    /// The numbers.
    pub summary: EnsembleSummary,
    /// Findings of complete starts, by number.
    pub complete: Vec<(usize, Findings)>,
}

/// `summary.json` of an ensemble.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EnsembleSummary {
    /// Name of the scene.
    pub scene: String,
    /// Seed of the draws.
    pub seed: u64,
    /// Every requested start.
    pub starts: Vec<StartSummary>,
    /// The summaries of all complete starts as one: in place of each number its statistic over the starts, in
    /// place of yes and no the share of yes. Items of lists are matched by name; a text is kept where all
    /// starts have the same.
    pub ensemble: Merged,
    /// Cautions.
    pub notes: Vec<String>,
}

/// One start.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StartSummary {
    /// Number, from 1.
    pub number: usize,
    /// Its folder, below that of the ensemble.
    pub folder: String,
    /// How it ended.
    pub ended: Ended,
    /// Why it did not complete.
    pub why: Option<String>,
    /// Angle of roller 1 at its start [°]; `None` before it has begun.
    pub first_roller_deg: Option<f64>,
    /// Phase of its rollers' meshes [°].
    pub roller_phase_deg: Option<f64>,
    /// Simulated time on record [ms].
    pub simulated_ms: Option<f64>,
    /// Wall-clock time, set-up included [s].
    pub wall_s: Option<f64>,
    /// Largest |a_y| at exits at the leading sensor [g].
    pub exit_g: Option<f64>,
    /// Largest |a_y| in the gaps [g].
    pub gap_g: Option<f64>,
    /// Largest imbalance of energy over what contacts dissipate.
    pub energy_error: Option<f64>,
    /// Warnings of its run.
    pub warnings: Vec<String>,
}

/// How a start ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ended {
    /// At its end: it counts in the statistics.
    Complete,
    /// Stopped by a guard.
    Diverged,
    /// Before its end; it can be continued.
    Early,
    /// It could not be run or read.
    Failed,
    /// It has not begun.
    Missing,
}

impl EnsembleFindings {
    /// Reads the ensemble in `folder` and analyses its complete starts.
    ///
    /// # Errors
    /// [`Error::Run`] when the folder holds no ensemble or its scene was changed.
    pub fn of(folder: &Path) -> Result<Self, Error> {
        let dir = RunDir::open_ensemble(folder)?;
        let (scene, ensemble) = dir.read_ensemble()?;
        let (mut starts, mut complete) = (Vec::new(), Vec::new());
        for number in 1..=ensemble.starts {
            let (start, findings) = look(&dir, &scene, &ensemble, number);
            starts.push(start);
            complete.extend(findings.map(|findings| (number, findings)));
        }
        let notes = notes(&starts);
        let merged = Merged::of(complete.iter().map(|(_, findings)| &findings.summary))?;
        let summary = EnsembleSummary {
            scene: scene.name.clone(),
            seed: ensemble.seed,
            starts,
            ensemble: merged,
            notes,
        };
        Ok(Self { scene: scene.resolve(), ensemble, summary, complete })
    }
}

impl EnsembleFindings {
    /// Statistic of `of` over the first passages of a roller over the first spall, given by its number.
    pub fn over_events(&self, roller: &str, of: fn(&Event) -> Option<f64>) -> Option<Statistic> {
        let first = |f: &Findings| {
            f.summary.first_passages().into_iter().find(|e| e.roller.to_string() == roller).and_then(of)
        };
        let values: Vec<f64> = self.complete.iter().filter_map(|(_, findings)| first(findings)).collect();
        Statistic::of(&values, self.complete.len())
    }
}

impl EnsembleSummary {
    /// Starts that ended so.
    pub fn count(&self, ended: Ended) -> usize {
        self.starts.iter().filter(|start| start.ended == ended).count()
    }

    /// Statistic of the number at `path`, as in `levels.exit_g` or `events[0].floor_n`; `None` where no start
    /// has one.
    pub fn number(&self, path: &str) -> Option<&Statistic> {
        self.ensemble.number(path)
    }
}

/// Passages whose forces are kept for pictures.
const CROSSINGS: usize = 12;

/// One start, and its findings when it is complete.
fn look(dir: &RunDir, scene: &Scene, ensemble: &Ensemble, number: usize) -> (StartSummary, Option<Findings>) {
    let mut start = StartSummary::before(number, ensemble.failed.get(&number).cloned());
    let folder = dir.start_folder(number);
    // Nothing but an empty folder, before the first step.
    let Ok(there) = RunDir::open(&folder) else { return (start, None) };
    let read = Run::read(there.path()).map_err(Error::from).and_then(|run| {
        run.check_scene(&folder)?;
        Ok(run)
    });
    let run = match read {
        Ok(run) => run,
        Err(why) => return (start.failed(why.to_string()), None),
    };
    let longer_ms = run.scene.written.solver.duration_ms - scene.solver.duration_ms;
    if let Some(differs) = another_scene(&run.scene.written, scene, longer_ms) {
        return (start.failed(format!("its scene {differs} that of the ensemble")), None);
    }
    start.take(&run, longer_ms < 0.0);
    if start.ended != Ended::Complete {
        start.why = run.info.stop_reason.clone().or(start.why);
        return (start, None);
    }
    let damage = run.damage();
    if !damage.is_empty() {
        return (start.failed(damage.join("; ")), None);
    }
    match findings_of(&run) {
        Ok(findings) => {
            let levels = &findings.summary.levels.phases;
            (start.exit_g, start.gap_g) = (levels.exit_g, levels.gap_g);
            (start, Some(findings))
        }
        Err(why) => (start.failed(why.to_string()), None),
    }
}

/// How the scene of a run differs from that of its ensemble in more than the draws and a shorter duration;
/// `None` where it does not.
fn another_scene(of_run: &Scene, scene: &Scene, longer_ms: f64) -> Option<&'static str> {
    if longer_ms > 0.0 {
        return Some("is longer than");
    }
    let mut as_long = of_run.clone();
    as_long.solver.duration_ms = scene.solver.duration_ms;
    (!is_start_of(&as_long, scene)).then_some("differs in more than what is drawn from")
}

impl StartSummary {
    /// A start whose folder has not been read; `why` it failed, where it did.
    fn before(number: usize, why: Option<String>) -> Self {
        Self {
            number,
            folder: folder_name(number),
            ended: if why.is_some() { Ended::Failed } else { Ended::Missing },
            why,
            first_roller_deg: None,
            roller_phase_deg: None,
            simulated_ms: None,
            wall_s: None,
            exit_g: None,
            gap_g: None,
            energy_error: None,
            warnings: Vec::new(),
        }
    }

    /// The same as failed.
    fn failed(mut self, why: String) -> Self {
        (self.ended, self.why) = (Ended::Failed, Some(why));
        self
    }

    /// Fills in the account of a run, which may be shorter than the ensemble asks for.
    fn take(&mut self, run: &Run, shorter: bool) {
        self.first_roller_deg = Some(run.scene.written.bearing.first_roller_deg);
        self.roller_phase_deg = Some(run.scene.written.mesh.roller_phase_deg);
        self.simulated_ms = Some(1e3 * run.info.interval_s * run.info.samples as f64);
        self.wall_s = Some(run.info.wall_s + run.info.setup_s);
        self.energy_error = Some(run.info.energy.share());
        self.warnings.clone_from(&run.info.warnings);
        self.ended = match run.info.status {
            Status::Complete if shorter => Ended::Early,
            Status::Complete => Ended::Complete,
            Status::Diverged => Ended::Diverged,
            Status::Interrupted | Status::Running if self.why.is_some() => Ended::Failed,
            Status::Interrupted | Status::Running => Ended::Early,
        };
    }
}

fn findings_of(run: &Run) -> Result<Findings, Error> {
    let record = Record::new(run)?;
    Findings::of(&record)?.with_crossings(&record, CROSSINGS)
}

/// Incomplete starts, and the warnings of the runs.
fn notes(starts: &[StartSummary]) -> Vec<String> {
    let mut notes = Vec::new();
    for start in starts {
        let word = match start.ended {
            Ended::Complete => continue,
            Ended::Diverged => "diverged",
            Ended::Failed => "failed",
            Ended::Early => "ended early",
            Ended::Missing => "has not begun",
        };
        let why = start.why.as_ref().map_or(String::new(), |why| format!(": {why}"));
        notes.push(format!("start {} {word} and does not count{why}", start.number));
    }
    match starts.iter().filter(|start| start.ended == Ended::Complete).count() {
        0 => notes.push("no start is complete: there are no numbers".into()),
        1 => notes.push("one start is complete: it has no scatter, and its means no interval".into()),
        _ => {}
    }
    // Warnings that differ in their numbers alone are one.
    let mut warnings: BTreeMap<String, (&StartSummary, &String, usize)> = BTreeMap::new();
    for (start, warning) in starts.iter().flat_map(|start| start.warnings.iter().map(move |w| (start, w))) {
        let words = warning.replace(|c: char| c.is_ascii_digit(), "");
        warnings.entry(words).and_modify(|w| w.2 += 1).or_insert((start, warning, 1));
    }
    for (start, warning, count) in warnings.into_values() {
        let others =
            if count > 1 { format!(" (and {} starts more, likewise)", count - 1) } else { String::new() };
        notes.push(format!("warning of start {}{others}: {warning}", start.number));
    }
    notes
}
