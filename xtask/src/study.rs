//! `cargo xtask study`: one question, many runs, one table.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use anyhow::{Context, Result};
use stribeck::host;
use stribeck::interrupt::Interrupt;
use stribeck::place::shown;
use stribeck::progress::Meter;
use stribeck_run::host::Progress;
use stribeck_scene::run_dir::RunDir;
use stribeck_scene::run_info::RunInfo;
use stribeck_simulation as simulation;
use stribeck_studies::{Host, Job, Study};

use crate::workspace;

/// Flags of `study`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(subcommand)]
    study: Study,
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let terminal =
        Terminal { root: workspace::root(), began: Instant::now(), interrupt: Interrupt::listen()? };
    let answer = options.study.run(&terminal)?;
    if let Some(said) = answer.said {
        println!("{said}");
    }
    if let Some(page) = answer.page {
        println!("{}", shown(&page));
    }
    Ok(match answer.failure {
        Some(failure) => {
            eprintln!("{failure}");
            ExitCode::FAILURE
        }
        None => ExitCode::SUCCESS,
    })
}

/// A study started by hand.
struct Terminal {
    root: PathBuf,
    began: Instant,
    interrupt: Interrupt,
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
        // This program has the commands of `stribeck`.
        Ok(Command::new(std::env::current_exe().context("where is this program?")?))
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
