//! `stribeck simulate`: scene file → run folder → report. Or the rest of a run that ended early.

mod ensemble;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};
use stribeck_report as report;
use stribeck_scene::scene::Scene;
use stribeck_simulation as simulation;
use stribeck_simulation::run::host::Progress;
use stribeck_store::Error;
use stribeck_store::run_dir::{RunDir, Stage};
use stribeck_store::run_info::{RunInfo, Status, clock};

use crate::disk;
use crate::host;
use crate::interrupt::{self, Interrupt};
use crate::out::{alert, caution, say, tell};
use crate::place::{Place, shown};
use crate::progress::{Meter, energy_error};

/// Flags of `simulate`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file [default: the run of the paper, fixtures/scenes/singh2014.ron]
    scene: Option<PathBuf>,
    /// Folder of the run [default: runs/NAME, the name of the scene; runs/NAME-2 … when there is a run
    /// already]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Name of the run, and of its folder below runs/ [default: that of the scene]
    #[arg(long, conflicts_with_all = ["out", "resume"])]
    name: Option<String>,
    /// Replaces the run in the folder, once the new one is complete; until then that lies in DIR.new
    #[arg(long)]
    overwrite: bool,
    /// Worker threads [default: all cores]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    threads: Option<usize>,
    /// Overrides a field of the scene, for example --set mesh.size_mm=1.0; may be repeated
    #[arg(long, value_name = "FIELD=VALUE")]
    set: Vec<String>,
    /// Continues the run in this folder, or in the one of this name below runs/, from its checkpoint; with
    /// --set solver.duration_ms=60 also a complete one, to that duration
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "out", "overwrite"])]
    resume: Option<PathBuf>,
    /// Writes no report at the end
    #[arg(long)]
    no_report: bool,
    /// Runs the scene from N starts, in one folder with one report: start angle, phase of the rollers' facets
    /// and places in the cage's pockets are drawn; with --resume more starts for an ensemble
    #[arg(long, value_name = "N", value_parser = starts)]
    starts: Option<usize>,
    /// Starts that run side by side, each with its share of the threads [default: as many as threads]
    #[arg(long, value_name = "M", value_parser = jobs)]
    jobs: Option<usize>,
    /// Seed of the starts: equal seeds draw the same [default: 1]
    #[arg(long, value_name = "S")]
    seed: Option<u64>,
}

impl Options {
    /// The scene of a new run.
    fn scene(&self, place: &Place) -> Result<Scene> {
        let name = self.name.iter().map(|name| format!("name={name:?}"));
        let set: Vec<String> = self.set.iter().cloned().chain(name).collect();
        place.scene(self.scene.as_deref(), &set)
    }
}

pub(crate) fn threads(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|n| (1..=1024).contains(n));
    number.ok_or_else(|| {
        "the number of worker threads is a whole number from 1 to 1024; leave it out for all cores".to_owned()
    })
}

/// A number of starts side by side.
pub(crate) fn jobs(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|n| (1..=1024).contains(n));
    number.ok_or_else(|| {
        "the number of starts side by side is a whole number from 1 to 1024; leave it out for as many as \
         there are threads"
            .to_owned()
    })
}

fn starts(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|n| (1..=10_000).contains(n));
    number.ok_or_else(|| {
        "the number of starts is a whole number from 1 to 10000; ten tell a mean from its scatter, leave it \
         out for a single run"
            .to_owned()
    })
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let continued = options.resume.as_deref().map(|run| place.locate_run(run));
    match &continued {
        Some(folder) if RunDir::is_ensemble(folder) => return ensemble::run(options, place),
        Some(folder) if options.starts.is_some() => bail!(
            "`{0}` is a single run, and --starts adds to an ensemble. An ensemble of its scene: {1} simulate \
             {0}/scene.ron --starts {2}",
            shown(folder),
            place.program,
            options.starts.unwrap_or(1)
        ),
        None if options.starts.is_some() => return ensemble::run(options, place),
        _ => {}
    }
    for (flag, given) in [("--jobs", options.jobs.is_some()), ("--seed", options.seed.is_some())] {
        ensure!(
            !given,
            "`{flag}` belongs to an ensemble: say how many starts with `--starts N`. A single run has \
             `--threads` and no seed"
        );
    }
    let threads = options.threads.unwrap_or_else(host::cores);
    let interrupt = Interrupt::listen()?;
    let (scene, dir) = match &options.resume {
        Some(run) => reopen(&place.locate_run(run), &options.set)?,
        None => {
            let scene = options.scene(place)?;
            let dir = reserve(options, place, &scene)?;
            (scene, dir)
        }
    };
    if scene.solver.time_step_factor > 1.0 {
        caution!(
            "`solver.time_step_factor` is {}: steps longer than the critical one diverge",
            scene.solver.time_step_factor
        );
    }
    if let Some(warning) = disk::too_small(&scene.resolve(), dir.path()) {
        caution!("{warning}");
    }
    interrupt.need_not_wait_for(dir.reservation());
    let path = shown(dir.path());
    tell!("{}: {} ms, {threads} threads → {path}", scene.name, scene.solver.duration_ms);

    let mut meter = Meter::new(scene.solver.duration_ms);
    let mut watch = |progress: &Progress| {
        meter.show(progress);
        interrupt.flow()
    };
    let left = options.resume.as_ref().and_then(|_| at_its_end(&dir, &scene, options.no_report));
    let only_reported = left.is_some();
    let finished = left.map_or_else(
        || {
            host::with(threads, |host| match options.resume {
                Some(_) if options.set.is_empty() => simulation::resume(&dir, host, &mut watch),
                Some(_) => simulation::extend(&dir, scene.solver.duration_ms, host, &mut watch),
                None => simulation::simulate(&scene, &dir, host, &mut watch),
            })
        },
        Ok,
    );
    meter.finish();
    if finished.is_err() {
        // The interrupt has its copy of the place, too, so that nothing made for a run that never began goes
        // with `dir` alone.
        dir.reservation().unless_started(|| {});
    }

    if let Ok(info) = &finished {
        announce(info);
    }
    let complete = finished.as_ref().is_ok_and(|info| info.status == Status::Complete);
    let dir = if complete { take_place(dir)? } else { dir };
    if dir.has_started() && !complete {
        let path = shown(dir.path());
        if let Some(old) = dir.replaces() {
            tell!("`{}` still holds the earlier run; the new one lies in `{path}`", shown(old));
        }
        if finished.as_ref().is_ok_and(|info| info.status == Status::Interrupted) {
            tell!("continue it: {} simulate --resume {path}", place.program);
        }
    }
    if complete {
        crate::machine::keep(&dir)?;
        if let Some(assumed) = stribeck_analysis::machine::assumed(&scene) {
            tell!("note: {assumed}");
        }
    }
    // A run that broke off has a report too: the samples until then show the cause.
    if (dir.has_started() || only_reported) && !options.no_report {
        match report::write(dir.path()) {
            Ok(summary) => {
                if let Some(diagnosis) = summary.diagnosis {
                    say!("{}", diagnosis.verdict);
                }
                say!("report: {}", shown(&dir.report()));
            }
            // The run's own error matters more than that of its report.
            Err(error) if finished.is_err() => caution!("no report: {error}"),
            Err(error) => {
                let again = format!(
                    "the run is complete, its report is not: `{} report {}` writes it",
                    place.program,
                    shown(dir.path())
                );
                return Err(anyhow::Error::from(error).context(again));
            }
        }
    }
    Ok(match finished?.status {
        Status::Complete => ExitCode::SUCCESS,
        Status::Interrupted => ExitCode::from(interrupt::EXIT_CODE),
        Status::Diverged | Status::Running => ExitCode::FAILURE,
    })
}

/// What is known of a run that has taken all of its steps and was killed between them and its report, or its
/// move to the place of an earlier run.
fn at_its_end(dir: &RunDir, scene: &Scene, no_report: bool) -> Option<RunInfo> {
    let unfinished = match Stage::of(dir.path()) {
        Stage::Complete => !no_report || dir.replaces().is_some(),
        Stage::Diverged => !no_report,
        Stage::Planned | Stage::Running | Stage::Reported => false,
    };
    dir.read_info().ok().filter(|info| unfinished && info.scene_hash == scene.hash())
}

/// The folder of a new run. The user's own choice is used or refused; the default avoids existing runs.
fn reserve(options: &Options, place: &Place, scene: &Scene) -> Result<RunDir> {
    let by_name = place.runs().join(&scene.name);
    let folder = options.out.as_deref().unwrap_or(&by_name);
    if options.overwrite {
        return Ok(RunDir::replace(folder)?);
    }
    match RunDir::create(folder) {
        Err(Error::FolderHoldsRun { found, ways, .. }) if options.out.is_none() => {
            tell!("`{}` holds {found}, which is kept. You can {}", shown(folder), ways.join(", or "));
            Ok(RunDir::create_numbered(folder)?)
        }
        Err(Error::FolderInUse { .. }) if options.out.is_none() => Ok(RunDir::create_numbered(folder)?),
        done => Ok(done?),
    }
}

/// Moves a complete run to its final folder.
fn take_place(dir: RunDir) -> Result<RunDir> {
    let path = shown(dir.path());
    dir.take_place().with_context(|| {
        format!(
            "the new run is complete, but lies in `{path}` and not yet in the place of the earlier one: \
            move it there"
        )
    })
}

/// A run to go on with, and its scene under `overrides`, which may change the duration and nothing else.
fn reopen(run: &Path, overrides: &[String]) -> Result<(Scene, RunDir)> {
    check_overrides(overrides)?;
    let dir = RunDir::reopen(run)?;
    let scene = Scene::read(dir.scene())?.with_overrides(overrides)?;
    Ok((scene, dir))
}

/// Refuses to change anything but the duration of a run that has begun.
fn check_overrides(overrides: &[String]) -> Result<()> {
    const MAY_CHANGE: &str = "solver.duration_ms";
    let other = overrides.iter().find(|text| text.split('=').next().unwrap_or_default().trim() != MAY_CHANGE);
    if let Some(other) = other {
        bail!(
            "`--set {other}` cannot be used with --resume: the samples so far belong to the scene as it was. \
             Only `{MAY_CHANGE}` may change; for anything else start a new run"
        );
    }
    Ok(())
}

/// Prints how the run ended, and its cost.
fn announce(info: &RunInfo) {
    for note in &info.notes {
        tell!("note: {note}");
    }
    for warning in &info.warnings {
        caution!("{warning}");
    }
    let how = match info.status {
        Status::Complete => "complete",
        Status::Interrupted => "interrupted",
        Status::Diverged => "diverged",
        Status::Running => "still running",
    };
    let step = info.time_step_s;
    // The reduced model's elements do not take part in its steps.
    let (step, size, pace) = match &info.reduced {
        Some(reduced) => {
            let pace = if info.simulated_s > 0.0 { info.wall_s / info.simulated_s } else { 0.0 };
            (
                format!("{:.2} µs ({})", 1e6 * step, reduced.step_of),
                format!("{} modes", reduced.modes),
                format!("{pace:.2} s a simulated second"),
            )
        }
        None => {
            let elements = info.mesh.quads + info.mesh.triangles;
            let element_steps = info.steps as f64 * elements as f64;
            let pace = if element_steps > 0.0 { 1e9 * info.wall_s / element_steps } else { 0.0 };
            (
                format!("{:.2} ns", 1e9 * step),
                format!("{elements} elements"),
                format!("{pace:.2} ns per element-step"),
            )
        }
    };
    say!(
        "{how}: {} steps of {step}, {size}, {} (set-up {}), {pace}, {}",
        info.steps,
        clock(info.wall_s),
        clock(info.setup_s),
        energy_error(info)
    );
    if let Some(reason) = &info.stop_reason {
        alert!("stopped: {reason}");
    }
}
