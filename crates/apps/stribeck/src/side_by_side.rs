//! Runs side by side, each in a folder of its own: several jobs take outstanding runs from one queue. Campaigns,
//! ensembles, validations and detections are run by this alone.

use std::path::PathBuf;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use anyhow::{Result, bail};
use stribeck_scene::scene::Scene;
use stribeck_simulation::run::host::Progress;
use stribeck_simulation::{self as simulation, Error};
use stribeck_store::Error as StoreError;
use stribeck_store::run_dir::{RunDir, State};
use stribeck_store::run_info::{RunInfo, Status, clock};

use crate::board::Board;
use crate::host::{self, SharedClock};
use crate::interrupt::Interrupt;
use crate::out::alert;
use crate::place::shown;
use crate::progress::energy_error;

pub(crate) struct Due {
    pub(crate) number: usize,
    pub(crate) scene: Scene,
    pub(crate) folder: PathBuf,
    /// What lies in the folder is damaged and is made again.
    pub(crate) anew: bool,
}

impl Due {
    pub(crate) fn new(number: usize, scene: Scene, folder: PathBuf) -> Self {
        Self { number, scene, folder, anew: false }
    }
}

/// Those of the planned runs that are not at their end; with each the flag that gives another folder.
pub(crate) fn outstanding(planned: impl Iterator<Item = (Due, &'static str)>) -> Result<Vec<Due>> {
    let mut due = Vec::new();
    for (run, flag) in planned {
        match State::of(&run.folder, &run.scene) {
            State::Done => {}
            State::New | State::Begun => due.push(run),
            State::Other => bail!(
                "`{}` holds a run of another scene, seed or duration: give another folder with `{flag}`, or move \
                 it away",
                shown(&run.folder)
            ),
        }
    }
    Ok(due)
}

/// Why runs may be left when all jobs have ended.
#[derive(Debug, Default)]
pub(crate) struct Left {
    /// How many another program is running.
    pub(crate) elsewhere: usize,
    /// What the disk has refused.
    pub(crate) refused: Option<String>,
}

impl Left {
    /// Says that `count` of `all` runs, each a `noun`, are left, and why; also with `--quiet`, because the command
    /// fails.
    pub(crate) fn say(&self, (count, all): (usize, usize), noun: &str, next: &str) {
        let refused = self.refused.as_ref().map_or_else(String::new, |why| format!(": {why}"));
        alert!("{count} of {all} {noun}s are not at their end{refused}");
        // Others may have come to their end meanwhile.
        match self.elsewhere.min(count) {
            0 => {}
            1 => alert!("1 of {all} {noun}s is being run by another program"),
            several => alert!("{several} of {all} {noun}s are being run by another program"),
        }
        alert!("{next}");
    }
}

/// How many jobs there are, and how many threads each has.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Jobs {
    pub(crate) count: usize,
    pub(crate) threads: usize,
}

impl Jobs {
    /// With at most this number of runs at a time: as requested, or the number of threads.
    pub(crate) fn of(jobs: Option<usize>, threads: Option<usize>, runs: usize) -> Self {
        let threads = threads.unwrap_or_else(host::cores);
        let count = jobs.unwrap_or(threads).clamp(1, runs.max(1));
        Self { count, threads: (threads / count).max(1) }
    }

    /// In words.
    pub(crate) fn shown(self) -> String {
        let Self { count, threads } = self;
        format!("{count} at a time with {threads} thread{} each", if threads == 1 { "" } else { "s" })
    }
}

/// State shared by the jobs.
pub(crate) struct Shop<'a> {
    due: &'a [Due],
    next: AtomicUsize,
    /// The disk refused a write: later ones would be refused as well.
    disk_refuses: AtomicBool,
    /// Why it did, or why a folder could not be used: the first reason.
    refused: OnceLock<String>,
    elsewhere: AtomicUsize,
    jobs: Jobs,
    clock: SharedClock,
    board: Board,
    interrupt: &'a Interrupt,
}

impl<'a> Shop<'a> {
    /// For outstanding runs, each called a `noun`.
    pub(crate) fn new(noun: &'static str, due: &'a [Due], jobs: Jobs, interrupt: &'a Interrupt) -> Self {
        Self {
            due,
            next: AtomicUsize::new(0),
            disk_refuses: AtomicBool::new(false),
            refused: OnceLock::new(),
            elsewhere: AtomicUsize::new(0),
            jobs,
            clock: SharedClock::default(),
            board: Board::new(noun, due.len()),
            interrupt,
        }
    }

    /// Runs the outstanding runs until none remains, Ctrl-C is pressed or the disk refuses. `ended` is called
    /// for each run, with the reason where it could not be made; runs that disk or folder refused can follow
    /// later, and are counted in what is returned.
    pub(crate) fn run(self, ended: &(dyn Fn(&Self, &Due, Option<&Error>) + Sync)) -> Left {
        std::thread::scope(|scope| {
            (1..self.jobs.count).for_each(|_| drop(scope.spawn(|| self.work(ended))));
            self.work(ended);
        });
        self.board.finish();
        Left { elsewhere: self.elsewhere.into_inner(), refused: self.refused.into_inner() }
    }

    /// Warns above the bar.
    pub(crate) fn warn(&self, line: &str) {
        self.board.warn(line);
    }

    fn work(&self, ended: &(dyn Fn(&Self, &Due, Option<&Error>) + Sync)) {
        while let Some(due) = self.due.get(self.next.fetch_add(1, Ordering::Relaxed)) {
            if self.interrupt.is_pressed() || self.disk_refuses.load(Ordering::Relaxed) {
                return;
            }
            let mut watch = |progress: &Progress| {
                self.board.show(due.number, progress);
                self.interrupt.flow()
            };
            let done = self.clock.with(self.jobs.threads, due.number, |host| {
                let dir = RunDir::create_over(&due.folder)?;
                // Only while the folder is held: another program may have run it since it was found to be
                // due.
                match State::of(&due.folder, &due.scene) {
                    state if due.anew || state == State::New => {
                        simulation::simulate(&due.scene, &dir, host, &mut watch)
                    }
                    State::Begun => {
                        match simulation::extend(&dir, due.scene.solver.duration_ms, host, &mut watch) {
                            // Half written when its program was ended: there is nothing to go on from.
                            Err(error) if is_damage(&error) => {
                                simulation::simulate(&due.scene, &dir, host, &mut watch)
                            }
                            done => done,
                        }
                    }
                    _ => Ok(dir.read_info()?),
                }
            });
            match &done {
                Ok(info) => {
                    self.board.done(due.number, &words(info));
                    ended(self, due, None);
                }
                Err(Error::Store(StoreError::FolderInUse { .. })) => {
                    self.elsewhere.fetch_add(1, Ordering::Relaxed);
                    self.board.done(due.number, "is being run by another program");
                }
                Err(error) => {
                    self.board.done(due.number, &format!("failed: {error}"));
                    match error {
                        Error::Store(error) => {
                            let is_disk = matches!(error, StoreError::Io { .. });
                            self.disk_refuses.fetch_or(is_disk, Ordering::Relaxed);
                            // Other jobs may have met the same.
                            self.refused.set(error.to_string()).ok();
                        }
                        // An error of the scene occurs again on any computer.
                        _ => ended(self, due, Some(error)),
                    }
                }
            }
        }
    }
}

/// Whether the files of a run are not what a run leaves, so that it cannot be continued.
pub(crate) fn is_damage(error: &Error) -> bool {
    use StoreError::{Mesh, NotARun, OtherScene, RunInfo, Trace, Unfinished};
    matches!(
        error,
        Error::Resume { .. }
            | Error::Store(
                Trace { .. }
                    | Mesh { .. }
                    | NotARun { .. }
                    | Unfinished { .. }
                    | OtherScene { .. }
                    | RunInfo { .. }
            )
    )
}

fn words(info: &RunInfo) -> String {
    match (info.status, &info.stop_reason) {
        (Status::Complete, _) => {
            format!("complete after {}, {}", clock(info.setup_s + info.wall_s), energy_error(info))
        }
        (Status::Diverged, Some(why)) => format!("diverged: {why}"),
        (_, Some(why)) => why.clone(),
        (_, None) => "ended early".to_owned(),
    }
}
