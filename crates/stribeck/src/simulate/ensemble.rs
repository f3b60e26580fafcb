//! `stribeck simulate --starts`: one scene from many starts, side by side, in one folder with one report.

use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use anyhow::{Result, bail, ensure};
use stribeck_analysis::report;
use stribeck_bearing::simulation::Progress;
use stribeck_reduced::error::Error;
use stribeck_reduced::simulation;
use stribeck_scene::ensemble::{Ensemble, is_start_of, start};
use stribeck_scene::run_dir::{RunDir, State};
use stribeck_scene::run_info::{RunInfo, Status, clock};
use stribeck_scene::scene::Scene;

use super::{Options, check_overrides, reserve, take_place};
use crate::board::Board;
use crate::host::{self, SharedClock};
use crate::interrupt::{self, Interrupt};
use crate::place::{Place, shown};

/// Seed of those who give none: the same command draws the same starts.
const SEED: u64 = 1;

/// A start that is to be run or continued.
struct Due {
    number: usize,
    scene: Scene,
    state: State,
}

/// What the jobs share.
struct Shop<'a> {
    dir: &'a RunDir,
    scene: &'a Scene,
    ensemble: Mutex<Ensemble>,
    due: &'a [Due],
    next: AtomicUsize,
    /// The disk refused something: what comes next would be refused as well.
    disk_refuses: AtomicBool,
    threads: usize,
    clock: SharedClock,
    board: Board,
    interrupt: &'a Interrupt,
}

pub(super) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let interrupt = Interrupt::listen()?;
    let (dir, scene, ensemble) = match &options.resume {
        Some(run) => reopen(&place.locate_run(run), options)?,
        None => {
            let scene = place.scene(options.scene.as_deref(), &options.set)?;
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
    let due = due_starts(&dir, &scene, &ensemble)?;
    let threads = options.threads.unwrap_or_else(host::cores);
    let jobs = options.jobs.unwrap_or(threads).clamp(1, due.len().max(1));
    let (wanted, each) = (ensemble.starts, (threads / jobs).max(1));
    eprintln!(
        "{}: {wanted} starts of {} ms, {} to run, {jobs} at a time with {each} thread{} each → {}",
        scene.name,
        scene.solver.duration_ms,
        due.len(),
        if each == 1 { "" } else { "s" },
        shown(dir.path())
    );
    match options.resume {
        None => dir.start_ensemble(&scene, &ensemble)?,
        Some(_) => dir.write_ensemble(&scene, &ensemble)?,
    }
    let shop = Shop {
        dir: &dir,
        scene: &scene,
        ensemble: Mutex::new(ensemble),
        due: &due,
        next: AtomicUsize::new(0),
        disk_refuses: AtomicBool::new(false),
        threads: each,
        clock: SharedClock::default(),
        board: Board::new("start", due.len()),
        interrupt: &interrupt,
    };
    std::thread::scope(|scope| {
        (1..jobs).for_each(|_| drop(scope.spawn(|| shop.work())));
        shop.work();
    });
    shop.board.finish();

    let ensemble = shop.ensemble.into_inner().unwrap_or_else(PoisonError::into_inner);
    let left = due_starts(&dir, &scene, &ensemble)?;
    let ended = wanted - left.iter().filter(|due| !ensemble.failed.contains_key(&due.number)).count();
    let dir = if ended == wanted { take_place(dir)? } else { dir };
    let path = shown(dir.path());
    if ended < wanted {
        if let Some(old) = dir.replaces() {
            eprintln!("`{}` still holds the earlier run; the new one lies in `{path}`", shown(old));
        }
        eprintln!(
            "{} of {wanted} starts are not at their end; continue them: {} simulate --resume {path}",
            wanted - ended,
            place.program
        );
    }
    let mut complete = 0;
    if options.no_report {
        complete = ended;
    } else {
        let summary = report::write_ensemble(dir.path())?;
        complete += summary.count(stribeck_analysis::ensemble::Ended::Complete);
        for note in &summary.notes {
            eprintln!("warning: {note}");
        }
        println!("report: {}", shown(&dir.report()));
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

/// Starts that are not at their end.
fn due_starts(dir: &RunDir, scene: &Scene, ensemble: &Ensemble) -> Result<Vec<Due>> {
    let mut due = Vec::new();
    for number in 1..=ensemble.starts {
        let scene = scene_of(dir, scene, ensemble, number);
        let folder = dir.start_folder(number);
        match State::of(&folder, &scene) {
            State::Done => {}
            State::Other => bail!(
                "`{}` holds a run of another scene: move it away, and its start can be run anew",
                shown(&folder)
            ),
            state => due.push(Due { number, scene, state }),
        }
    }
    Ok(due)
}

impl Shop<'_> {
    /// Runs starts until none is left.
    fn work(&self) {
        while let Some(due) = self.due.get(self.next.fetch_add(1, Ordering::Relaxed)) {
            if self.interrupt.is_pressed() || self.disk_refuses.load(Ordering::Relaxed) {
                return;
            }
            let mut watch = |progress: &Progress| {
                self.board.show(due.number, progress);
                self.interrupt.flow()
            };
            let done = self.clock.with(self.threads, due.number, |host| match due.state {
                State::Begun => {
                    let dir = RunDir::reopen(self.dir.start_folder(due.number))?;
                    simulation::extend(&dir, due.scene.solver.duration_ms, host, &mut watch)
                }
                _ => {
                    let dir = RunDir::create_over(self.dir.start_folder(due.number))?;
                    simulation::simulate(&due.scene, &dir, host, &mut watch)
                }
            });
            self.note(due.number, done);
        }
    }

    /// Says how a start ended, and writes down why one could not be run.
    fn note(&self, number: usize, done: Result<RunInfo, Error>) {
        let mut ensemble = self.ensemble.lock().unwrap_or_else(PoisonError::into_inner);
        let before = ensemble.failed.remove(&number);
        match &done {
            Ok(info) => self.board.done(number, &words(info)),
            Err(error) => self.board.done(number, &format!("failed: {error}")),
        }
        match done {
            // What was written is there; the rest can follow when there is space again.
            Err(Error::Bearing(stribeck_bearing::error::Error::Scene(_))) => {
                self.disk_refuses.store(true, Ordering::Relaxed)
            }
            Err(error) => drop(ensemble.failed.insert(number, error.to_string())),
            Ok(_) => {}
        }
        if ensemble.failed.get(&number) != before.as_ref()
            && let Err(error) = self.dir.write_ensemble(self.scene, &ensemble)
        {
            self.board.say(&format!("warning: {error}"));
        }
    }
}

/// How a run ended, in a line.
pub(crate) fn words(info: &RunInfo) -> String {
    let (time, error) = (clock(info.setup_s + info.wall_s), 100.0 * info.energy.max_relative_error);
    match (info.status, &info.stop_reason) {
        (Status::Complete, _) => format!("complete after {time}, energy error {error:.3} %"),
        (Status::Diverged, Some(why)) => format!("diverged: {why}"),
        (_, Some(why)) => why.clone(),
        (_, None) => "ended early".to_owned(),
    }
}
