//! What a run takes, by its beginning: a constant of another machine, or of one that is busy, would be wrong.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Result;
use stribeck_analysis::plan::Plan;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::run_dir::RunDir;
use stribeck_scene::run_info::RunInfo;
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_simulation as simulation;

use crate::host;
use crate::place::Place;

/// The loop is tried for about so long [s].
const LOOP_S: f64 = 0.5;
/// Elements and steps of the full model in a second, and rollers and steps of the reduced one, to guess how
/// many samples that is.
const ELEMENT_STEPS: f64 = 3e8;
const ROLLER_STEPS: f64 = 2e6;
/// Samples at least.
const SAMPLES: f64 = 3.0;

/// A tried beginning.
pub(super) struct Trial {
    /// Making the modes [s]; `None` in the full model, and where an earlier run has kept them.
    pub(super) modes_s: Option<f64>,
    /// Whether runs find these modes.
    pub(super) kept: bool,
    /// From there to the first step [s].
    pub(super) setup_s: f64,
    /// All steps, from those that were tried [s].
    pub(super) loop_s: f64,
    /// The account of the beginning.
    pub(super) info: RunInfo,
    /// Threads.
    pub(super) threads: usize,
}

impl Trial {
    /// What a run will take [s], its report left out.
    pub(super) fn run_s(&self) -> f64 {
        let modes = self.modes_s.filter(|_| !self.kept).unwrap_or(0.0);
        modes + self.setup_s + self.loop_s
    }
}

/// A folder that goes with its owner.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Begins a run of the scene in a folder of its own, which is gone afterwards. Modes that it makes are kept
/// for the run where there are runs.
pub(super) fn begin(scene: &ResolvedScene, plan: &Plan, place: &Place) -> Result<Trial> {
    let written = &scene.written;
    let threads = host::cores();
    let runs = Some(place.runs()).filter(|runs| runs.is_dir());
    let own = Folder(std::env::temp_dir().join(format!("stribeck-plan-{}", std::process::id())));
    fs::create_dir_all(&own.0)?;
    let parent = runs.clone().unwrap_or_else(|| own.0.clone());
    let mut modes_s = None;
    if let ModelScene::Reduced(_) = &written.model {
        eprintln!("modes …");
        let began = Instant::now();
        let made = simulation::make_modes(scene, Some(&parent))?;
        modes_s = made.then(|| began.elapsed().as_secs_f64());
    }
    let run = Folder(parent.join(format!(".plan-{}", std::process::id())));
    let interval_ms = 1e-3 * written.output.interval_us;
    let samples = samples(scene, plan);
    let mut beginning = written.clone();
    beginning.output.frames = None;
    beginning.solver.duration_ms = (samples * interval_ms).min(written.solver.duration_ms);
    let info = run_in(&beginning, &run.0, threads)?;
    let share = written.solver.duration_ms / beginning.solver.duration_ms;
    Ok(Trial {
        modes_s,
        kept: runs.is_some(),
        setup_s: info.setup_s,
        loop_s: info.wall_s * share,
        info,
        threads,
    })
}

/// Samples that take about [`LOOP_S`].
fn samples(scene: &ResolvedScene, plan: &Plan) -> f64 {
    let all = (scene.duration / scene.interval).round();
    let of_one = match &scene.written.model {
        ModelScene::Full => plan.steps / all * plan.elements as f64 / ELEMENT_STEPS,
        ModelScene::Reduced(reduced) => {
            let steps = scene.written.output.interval_us / reduced.step_us;
            steps * scene.rollers as f64 / ROLLER_STEPS
        }
    };
    (LOOP_S / of_one).round().max(SAMPLES).min(all.max(SAMPLES))
}

fn run_in(scene: &Scene, folder: &Path, threads: usize) -> Result<RunInfo> {
    let dir = RunDir::create(folder)?;
    Ok(host::with(threads, |host| {
        simulation::simulate(scene, &dir, host, &mut |_| ControlFlow::Continue(()))
    })?)
}
