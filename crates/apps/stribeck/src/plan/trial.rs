//! Cost of a run, from its first steps: a constant of another computer would be wrong.
//!
//! A busy computer takes longer by the clock, and its load during the run is unknown. So each part has two
//! times: by the clock, under the present load, and by the processor time of its threads, as on an idle
//! computer.

use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use anyhow::Result;
use stribeck_analysis::plan::Plan;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::{ModelScene, Scene};
use stribeck_simulation as simulation;
use stribeck_simulation::run::host::{Host, Progress};
use stribeck_store::run_dir::RunDir;
use stribeck_store::run_info::{RunInfo, Status};

use crate::host;
use crate::place::Place;

/// The loop is tried for about so long [s].
const LOOP_S: f64 = 1.0;
/// Elements and steps of the full model in a second, and rollers and steps of the reduced one, to guess how
/// many samples that is.
const ELEMENT_STEPS: f64 = 3e8;
const ROLLER_STEPS: f64 = 2e6;
/// Where a scene is slower than guessed, it is tried for so long at most [s of processor time of a thread].
const MOST_S: f64 = 2.0 * LOOP_S;
/// The processor's clock is read as often at most [s]: it takes as long as a sample of a reduced bearing.
const LOOK_S: f64 = 0.02;
/// Samples at least.
const SAMPLES: f64 = 5.0;
/// This part of the tried steps is left out: they include the first checkpoint, the first contact search, and
/// the start of threads.
const FIRST: f64 = 0.2;

/// A duration [s], by the clock and by processor time.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cost {
    /// By the clock, as busy as the machine is now.
    pub(super) busy_s: f64,
    /// Where nothing else runs.
    pub(super) quiet_s: f64,
}

impl Cost {
    /// Of a clock and processor time, shared by some threads; a system that does not count the latter has the
    /// clock alone.
    fn of(wall_s: f64, cpu_s: f64, threads: usize) -> Self {
        let own = cpu_s / threads.max(1) as f64;
        // Processor time is counted in hundredths.
        Self { busy_s: wall_s, quiet_s: if own > 0.0 { own.min(wall_s) } else { wall_s } }
    }

    fn plus(self, other: Self) -> Self {
        Self { busy_s: self.busy_s + other.busy_s, quiet_s: self.quiet_s + other.quiet_s }
    }

    fn times(self, share: f64) -> Self {
        Self { busy_s: self.busy_s * share, quiet_s: self.quiet_s * share }
    }
}

/// A tried beginning.
pub(super) struct Trial {
    /// Making the modes; `None` in the full model, and where an earlier run has kept them.
    pub(super) modes: Option<Cost>,
    /// Whether runs find these modes.
    pub(super) kept: bool,
    /// From there to the first step.
    pub(super) setup: Cost,
    /// All steps, from those that were tried.
    pub(super) steps: Cost,
    /// Their number.
    pub(super) steps_planned: f64,
    pub(super) info: RunInfo,
    pub(super) threads: usize,
}

impl Trial {
    /// Time of a run before its first step.
    pub(super) fn before(&self) -> Cost {
        self.setup.plus(self.modes.filter(|_| !self.kept).unwrap_or_default())
    }

    /// Time of a run without its report.
    pub(super) fn run(&self) -> Cost {
        self.before().plus(self.steps)
    }
}

/// A folder that is removed when dropped.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Begins a run of the scene in a temporary folder, which is removed afterwards. Modes that it makes are kept
/// for the run where there are runs.
pub(super) fn begin(scene: &ResolvedScene, plan: &Plan, place: &Place) -> Result<Trial> {
    let written = &scene.written;
    let reduced = matches!(written.model, ModelScene::Reduced(_));
    let threads = if reduced { 1 } else { host::cores() };
    let runs = Some(place.runs()).filter(|runs| runs.is_dir());
    let own = Folder(std::env::temp_dir().join(format!("stribeck-plan-{}", std::process::id())));
    fs::create_dir_all(&own.0)?;
    let parent = runs.clone().unwrap_or_else(|| own.0.clone());
    let mut modes = None;
    if reduced {
        eprintln!("modes …");
        modes = host::with(1, |host| -> Result<Option<Cost>> {
            let made = simulation::make_modes(scene, Some(&parent))?;
            Ok(made.then(|| Cost::of((host.wall_s)(), (host.cpu_s)(), 1)))
        })?;
    }
    let run = Folder(parent.join(format!(".plan-{}", std::process::id())));
    let interval_ms = 1e-3 * written.output.interval_us;
    let samples = samples(scene, plan);
    let mut beginning = written.clone();
    beginning.output.frames = None;
    beginning.solver.duration_ms = (samples * interval_ms).min(written.solver.duration_ms);
    let (info, rate) = run_in(&beginning, &run.0, threads)?;
    let share = written.solver.duration_ms / beginning.solver.duration_ms;
    let steps_planned = info.steps_planned as f64 * share;
    Ok(Trial {
        modes,
        kept: runs.is_some(),
        setup: Cost::of(info.setup_s, info.cpu_s - info.loop_cpu_s, 1),
        steps: rate.times(steps_planned),
        steps_planned: steps_planned.round(),
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

/// A moment of the loop.
#[derive(Debug, Clone, Copy)]
struct Mark {
    step: u64,
    wall_s: f64,
    cpu_s: f64,
}

impl Mark {
    fn now(step: u64, host: &Host<'_>) -> Self {
        Self { step, wall_s: (host.wall_s)(), cpu_s: (host.cpu_s)() }
    }
}

/// Runs a scene to its end, or for [`MOST_S`]; returns its `run.json` and the time of a step.
fn run_in(scene: &Scene, folder: &Path, threads: usize) -> Result<(RunInfo, Cost)> {
    let dir = RunDir::create(folder)?;
    host::with(threads, |host| {
        let (mut first, mut last) = (None, None);
        let (mut samples, mut began_s, mut looked_s) = (0.0, None, f64::NEG_INFINITY);
        let mut watch = |at: &Progress| {
            if at.step == 0 {
                return ControlFlow::Continue(());
            }
            samples += 1.0;
            let tried = at.step as f64 / at.steps.max(1) as f64;
            let at_a_mark = at.step >= at.steps || (first.is_none() && tried >= FIRST);
            let wall_s = (host.wall_s)();
            if !at_a_mark && wall_s - looked_s < LOOK_S {
                return ControlFlow::Continue(());
            }
            looked_s = wall_s;
            let now = Mark::now(at.step, host);
            let spent = (now.cpu_s - *began_s.get_or_insert(now.cpu_s)) / threads as f64 / MOST_S;
            let long_enough = spent >= 1.0 && samples >= SAMPLES;
            if first.is_none() && tried.max(spent) >= FIRST {
                first = Some(now);
            } else if at.step >= at.steps || long_enough {
                last = Some(now);
            }
            if long_enough && last.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let mut info = simulation::simulate(scene, &dir, host, &mut watch)?;
        // It was ended here.
        info.stop_reason.take_if(|_| info.status == Status::Interrupted);
        let rate = match (first, last) {
            (Some(a), Some(b)) if b.step > a.step => {
                let steps = (b.step - a.step) as f64;
                Cost::of(b.wall_s - a.wall_s, b.cpu_s - a.cpu_s, threads).times(1.0 / steps)
            }
            // It stopped, or is over at once.
            _ => Cost::of(info.wall_s, info.loop_cpu_s, threads).times(1.0 / info.steps.max(1) as f64),
        };
        Ok((info, rate))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plan of a full model beside other work promised 8:45 for a run that took 3:17 on the machine alone.
    #[test]
    fn issue_a_busy_machine_is_distinguished_from_a_slow_run() {
        let cost = Cost::of(525.0, 394.0, 2);
        assert_eq!((cost.busy_s, cost.quiet_s), (525.0, 197.0));
        // Without a count of processor time there is the clock alone.
        assert_eq!(Cost::of(5.0, 0.0, 2).quiet_s, 5.0);
        // Nothing is faster than the clock.
        assert_eq!(Cost::of(5.0, 11.0, 2).quiet_s, 5.0);
        let all = cost.plus(Cost::of(1.0, 1.0, 1)).times(2.0);
        assert_eq!((all.busy_s, all.quiet_s), (1052.0, 396.0));
    }
}
