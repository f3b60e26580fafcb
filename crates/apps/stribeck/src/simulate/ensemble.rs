//! `stribeck simulate --starts`: one scene from many starts, side by side, in one folder with one report.

use std::path::Path;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

use anyhow::{Result, ensure};
use stribeck_report as report;
use stribeck_scene::ensemble::{is_start_of, start};
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Ensemble;
use stribeck_store::run_dir::RunDir;

use super::{Options, check_overrides, reserve, take_place};
use crate::host;
use crate::interrupt::{self, Interrupt};
use crate::out::{caution, say, tell};
use crate::place::{Place, shown};
use crate::side_by_side::{Due, Jobs, Shop, outstanding};

/// Default seed: the same command draws the same starts.
const SEED: u64 = 1;

pub(super) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    let (dir, scene, ensemble) = match &options.resume {
        Some(run) => reopen(&place.locate_run(run), options)?,
        None => {
            let scene = options.scene(place)?;
            let dir = reserve(options, place, &scene)?;
            let (seed, starts) = (options.seed.unwrap_or(SEED), options.starts.unwrap_or(1));
            let ensemble = Ensemble {
                version: env!("CARGO_PKG_VERSION").to_owned(),
                commit: host::COMMIT.to_owned(),
                scene_hash: scene.hash(),
                seed,
                starts,
                failed: Default::default(),
            };
            (dir, scene, ensemble)
        }
    };
    let due = outstanding(plan(&dir, &scene, &ensemble))?;
    let jobs = Jobs::of(options.jobs, options.threads, due.len());
    let wanted = ensemble.starts;
    tell!(
        "{}: {wanted} starts of {} ms, {} to run, {} → {}",
        scene.name,
        scene.solver.duration_ms,
        due.len(),
        jobs.shown(),
        shown(dir.path())
    );
    match options.resume {
        None => dir.start_ensemble(&scene, &ensemble)?,
        Some(_) if due.is_empty() => dir.write_ensemble(&scene, &ensemble)?,
        Some(_) => dir.go_on_ensemble(&scene, &ensemble)?,
    }
    let ensemble = Mutex::new(ensemble);
    let why = Shop::new("start", &due, jobs, &interrupt).run(&|shop, due, error| {
        let mut ensemble = ensemble.lock().unwrap_or_else(PoisonError::into_inner);
        let before = ensemble.failed.remove(&due.number);
        ensemble.failed.extend(error.map(|error| (due.number, error.to_string())));
        if ensemble.failed.get(&due.number) != before.as_ref()
            && let Err(error) = dir.write_ensemble(&scene, &ensemble)
        {
            shop.warn(&error.to_string());
        }
    });
    let ensemble = ensemble.into_inner().unwrap_or_else(PoisonError::into_inner);
    let left = outstanding(plan(&dir, &scene, &ensemble))?;
    let ended = wanted - left.iter().filter(|due| !ensemble.failed.contains_key(&due.number)).count();
    let dir = if ended == wanted { take_place(dir)? } else { dir };
    let path = shown(dir.path());
    if ended < wanted {
        if let Some(old) = dir.replaces() {
            tell!("`{}` still holds the earlier run; the new one lies in `{path}`", shown(old));
        }
        let next = format!("continue them: {} simulate --resume {path}", place.program);
        why.say((wanted - ended, wanted), "start", &next);
    }
    let mut complete = 0;
    if options.no_report {
        complete = ended;
    } else {
        let summary = report::write_ensemble(dir.path())?;
        complete += summary.count(stribeck_analysis::ensemble::Ended::Complete);
        for note in &summary.notes {
            caution!("{note}");
        }
        say!("report: {}", shown(&dir.report()));
    }
    Ok(if interrupt.is_pressed() && ended < wanted {
        ExitCode::from(interrupt::EXIT_CODE)
    } else if ended < wanted || complete == 0 {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

/// An ensemble to go on with: more starts, or longer ones.
fn reopen(folder: &Path, options: &Options) -> Result<(RunDir, Scene, Ensemble)> {
    check_overrides(&options.set)?;
    let dir = RunDir::reopen_ensemble(folder)?;
    let (scene, mut ensemble) = dir.read_ensemble()?;
    if let Some(seed) = options.seed {
        ensure!(
            seed == ensemble.seed,
            "`{}` was drawn from the seed {}: another one makes another ensemble, in a folder of its own",
            shown(folder),
            ensemble.seed
        );
    }
    if let Some(starts) = options.starts {
        ensure!(
            starts >= ensemble.starts,
            "`{}` has {} starts: an ensemble can be made larger, not smaller",
            shown(folder),
            ensemble.starts
        );
        ensemble.starts = starts;
    }
    let longer = scene.with_overrides(&options.set)?;
    ensure!(
        longer.solver.duration_ms >= scene.solver.duration_ms,
        "`{}` has starts of {} ms: they can be made longer, not shorter",
        shown(folder),
        scene.solver.duration_ms
    );
    ensemble.scene_hash = longer.hash();
    Ok((dir, longer, ensemble))
}

/// The scene of a start: the one that lies in its folder, or one that is drawn.
fn scene_of(dir: &RunDir, scene: &Scene, ensemble: &Ensemble, number: usize) -> Scene {
    let there = RunDir::open(dir.start_folder(number)).and_then(|dir| Ok(Scene::read(dir.scene())?));
    match there {
        Ok(mut there) => {
            there.solver.duration_ms = scene.solver.duration_ms;
            if is_start_of(&there, scene) { there } else { start(scene, ensemble.seed, number) }
        }
        Err(_) => start(scene, ensemble.seed, number),
    }
}

/// All starts, each with the flag that gives another folder.
fn plan<'a>(
    dir: &'a RunDir,
    scene: &'a Scene,
    ensemble: &'a Ensemble,
) -> impl Iterator<Item = (Due, &'static str)> + 'a {
    let start = |number| {
        (Due::new(number, scene_of(dir, scene, ensemble, number), dir.start_folder(number)), "--out")
    };
    (1..=ensemble.starts).map(start)
}
