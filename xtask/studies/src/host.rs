//! The program around a study: it runs scenes on the cores of this machine, has a clock, listens for Ctrl-C
//! and says on standard error how far it is.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use stribeck::host;
use stribeck::interrupt::Interrupt;
use stribeck::progress::Meter;
use stribeck_scene::scene::Scene;
use stribeck_simulation as simulation;
use stribeck_simulation::run::host::Progress;
use stribeck_store::run_dir::RunDir;
use stribeck_store::run_info::RunInfo;

/// Folder of this package, which holds the plans and the pages of the studies.
pub fn package() -> PathBuf {
    // Cargo sets this variable for a program that it runs; the compiled-in path is for a binary started by
    // hand.
    std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into()).into()
}

/// Root of the repository: scenes are read below it, runs and pages are written below it.
pub fn root() -> PathBuf {
    let package = package();
    let root = package.ancestors().find(|folder| folder.join("fixtures/scenes").is_dir());
    root.unwrap_or(&package).to_owned()
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Job<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) folder: &'a Path,
    /// The folder holds the beginning of this run: it is continued.
    pub(crate) begun: bool,
    /// Worker threads; `None` for all cores.
    pub(crate) threads: Option<usize>,
    /// No other run is going: its progress may be shown.
    pub(crate) alone: bool,
}

/// The program around a study.
pub struct Host {
    root: PathBuf,
    began: Instant,
    interrupt: Interrupt,
}

impl Host {
    /// Listens for Ctrl-C from now on; once a process.
    pub fn new() -> Result<Self> {
        Ok(Self { root: root(), began: Instant::now(), interrupt: Interrupt::listen()? })
    }

    pub(crate) fn root(&self) -> &Path {
        &self.root
    }

    /// Runs a scene to its end, or until the user interrupts.
    ///
    /// # Errors
    /// When it cannot be run; one that diverges is no error.
    pub(crate) fn run(&self, job: &Job<'_>) -> Result<RunInfo> {
        let mut meter = Meter::new(job.scene.solver.duration_ms);
        let mut watch = |progress: &Progress| {
            if job.alone {
                meter.show(progress);
            }
            self.interrupt.flow()
        };
        let info = host::with(job.threads.unwrap_or_else(host::cores), |host| {
            if job.begun {
                simulation::resume(&RunDir::reopen(job.folder)?, host, &mut watch)
            } else {
                simulation::simulate(job.scene, &RunDir::create(job.folder)?, host, &mut watch)
            }
        });
        meter.finish();
        Ok(info?)
    }

    /// Applies `work` to every item, `jobs` of them at a time; results in the order of the items.
    pub(crate) fn each<T: Sync, R: Send + Sync>(
        &self,
        items: &[T],
        jobs: usize,
        work: impl Fn(&T) -> R + Sync,
    ) -> Result<Vec<R>> {
        let next = AtomicUsize::new(0);
        let done: Vec<OnceLock<R>> = items.iter().map(|_| OnceLock::new()).collect();
        let worker = || {
            let places = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
            for at in places.take_while(|at| *at < items.len() && !self.is_interrupted()) {
                let _ = done[at].set(work(&items[at]));
            }
        };
        std::thread::scope(|scope| {
            (1..jobs).for_each(|_| drop(scope.spawn(worker)));
            worker();
        });
        ensure!(!self.is_interrupted(), "interrupted; the same command goes on from here");
        Ok(done.into_iter().filter_map(OnceLock::into_inner).collect())
    }

    /// The program `stribeck`, for studies of whole processes: this one has its commands below one of its
    /// own.
    pub(crate) fn stribeck(&self) -> Result<Command> {
        let mut command = Command::new(std::env::current_exe().context("where is this program?")?);
        command.arg("stribeck");
        Ok(command)
    }

    /// Seconds since the start.
    pub(crate) fn seconds(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupt.is_pressed()
    }

    pub(crate) fn say(&self, line: &str) {
        eprintln!("{line}");
    }
}
