//! `stribeck report`: the report of a run, written again.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use stribeck_scene::run_dir::{Run, RunDir};

use crate::place::{Place, shown};

/// Flags of `report`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Folder of the run, or its name below runs/ [default: the newest run]
    run: Option<PathBuf>,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let folder = match &options.run {
        Some(run) => place.locate_run(run),
        None => place.newest_run()?,
    };
    if RunDir::is_ensemble(&folder) {
        for note in stribeck_analysis::report::write_ensemble(&folder)?.notes {
            eprintln!("warning: {note}");
        }
        println!("report: {}", shown(&RunDir::open_ensemble(&folder)?.report()));
        return Ok(ExitCode::SUCCESS);
    }
    let dir = RunDir::open(&folder)?;
    for missing in Run::read(dir.path())?.damage() {
        eprintln!("warning: {missing}");
    }
    stribeck_analysis::report::write(dir.path())?;
    println!("report: {}", shown(&dir.report()));
    Ok(ExitCode::SUCCESS)
}
