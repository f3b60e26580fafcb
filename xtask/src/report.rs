//! `cargo xtask report`: the report of a run, written again.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use stribeck_scene::run_dir::RunDir;

use crate::{engine, workspace};

/// Flags of `report`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Folder of the run, or its name below runs/ [default: the newest run]
    run: Option<PathBuf>,
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let folder = match &options.run {
        Some(run) => workspace::locate_run(run),
        None => workspace::newest_run(&workspace::runs())?,
    };
    let dir = RunDir::open(&folder)?;
    engine::write_report(dir.path())?;
    println!("report: {}", workspace::shown(&dir.report()));
    Ok(ExitCode::SUCCESS)
}
