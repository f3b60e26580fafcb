//! The program around a study that was started by hand.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context, Result};
use stribeck::host;
use stribeck::interrupt::Interrupt;
use stribeck::progress::Meter;
use stribeck_simulation as simulation;
use stribeck_simulation::run::host::Progress;
use stribeck_store::run_dir::RunDir;
use stribeck_store::run_info::RunInfo;
use stribeck_studies::{Host, Job};

/// The root of the repository.
pub(crate) fn root() -> PathBuf {
    // Cargo sets this variable for a program that it runs; the compiled-in path is for a binary started by
    // hand.
    let package = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    let package = PathBuf::from(package);
    package.parent().map_or_else(|| package.clone(), Path::to_owned)
}

/// Runs on the cores of this machine, Ctrl-C, and lines on standard error.
pub(crate) struct Terminal {
    root: PathBuf,
    began: Instant,
    interrupt: Interrupt,
}

impl Terminal {
    /// Listens for Ctrl-C from now on; once a process.
    pub(crate) fn new() -> Result<Self> {
        Ok(Self { root: root(), began: Instant::now(), interrupt: Interrupt::listen()? })
    }
}

impl Host for Terminal {
    fn root(&self) -> &Path {
        &self.root
    }

    fn run(&self, job: &Job<'_>) -> Result<RunInfo> {
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

    fn stribeck(&self) -> Result<Command> {
        // This program has the commands of `stribeck` below one of its own.
        let mut command = Command::new(std::env::current_exe().context("where is this program?")?);
        command.arg("stribeck");
        Ok(command)
    }

    fn seconds(&self) -> f64 {
        self.began.elapsed().as_secs_f64()
    }

    fn is_interrupted(&self) -> bool {
        self.interrupt.is_pressed()
    }

    fn say(&self, line: &str) {
        eprintln!("{line}");
    }
}
