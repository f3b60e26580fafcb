//! Runs side by side, each in a folder of its own: several jobs take outstanding runs from one queue.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use stribeck_scene::scene::Scene;
use stribeck_simulation::run::host::Progress;
use stribeck_simulation::{self as simulation, Error};
use stribeck_store::Error as StoreError;
use stribeck_store::run_dir::{RunDir, State};
use stribeck_store::run_info::{RunInfo, Status, clock};

use crate::board::Board;
use crate::host::{self, SharedClock};
use crate::interrupt::Interrupt;
use crate::progress::energy_error;

pub(crate) struct Due {
    pub(crate) number: usize,
    pub(crate) scene: Scene,
    pub(crate) folder: PathBuf,
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
            jobs,
            clock: SharedClock::default(),
            board: Board::new(noun, due.len()),
            interrupt,
        }
    }

    /// Runs the outstanding runs until none remains, Ctrl-C is pressed or the disk refuses. `ended` is called
    /// for each run, with the reason where it could not be made; runs that disk or folder refused can follow
    /// later, and are not reported.
    pub(crate) fn run(&self, ended: &(dyn Fn(&Due, Option<&Error>) + Sync)) {
        std::thread::scope(|scope| {
            (1..self.jobs.count).for_each(|_| drop(scope.spawn(|| self.work(ended))));
            self.work(ended);
        });
        self.board.finish();
    }

    /// Warns above the bar.
    pub(crate) fn warn(&self, line: &str) {
        self.board.warn(line);
    }

    fn work(&self, ended: &(dyn Fn(&Due, Option<&Error>) + Sync)) {
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
                    State::New => simulation::simulate(&due.scene, &dir, host, &mut watch),
                    State::Begun => simulation::extend(&dir, due.scene.solver.duration_ms, host, &mut watch),
                    State::Done | State::Other => Ok(dir.read_info()?),
                }
            });
            match &done {
                Ok(info) => {
                    self.board.done(due.number, &words(info));
                    ended(due, None);
                }
                Err(Error::Store(StoreError::FolderInUse { .. })) => {
                    self.board.done(due.number, "is being run by another program");
                }
                Err(error) => {
                    self.board.done(due.number, &format!("failed: {error}"));
                    match error {
                        Error::Store(StoreError::Io { .. }) => {
                            self.disk_refuses.store(true, Ordering::Relaxed);
                        }
                        // An error of its folder; one of the scene occurs again on any computer.
                        Error::Store(_) => {}
                        _ => ended(due, Some(error)),
                    }
                }
            }
        }
    }
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
