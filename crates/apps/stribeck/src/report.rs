//! `stribeck report`: writes the report of a run that exists already.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use stribeck_store::run_dir::{Run, RunDir};

use crate::lab;
use crate::out::{caution, detail, say};
use crate::place::{Place, shown};
use crate::shelf::existing;

/// Flags of `report`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Folder of the run, or its name below runs/ [default: the newest run]
    run: Option<PathBuf>,
    /// Look at the record from this time on [s] [default: the last two million samples]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    from_s: Option<f64>,
    /// Look at the record up to this time [s] [default: its end]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    to_s: Option<f64>,
    /// Make the page in which the bearing of the run runs, too, as lab.html beside the report, which leads to
    /// it (`stribeck lab`)
    #[arg(long)]
    lab: bool,
    /// The module of that page, where it was just built.
    #[arg(skip)]
    module: Option<PathBuf>,
}

impl Options {
    /// Whether the page in which the bearing runs is wanted.
    pub fn makes_lab(&self) -> bool {
        self.lab
    }

    /// With the module of that page.
    pub fn with_module(mut self, module: PathBuf) -> Self {
        self.module = Some(module);
        self
    }
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let folder = match &options.run {
        Some(run) => existing(run, place)?,
        None => place.newest_run()?,
    };
    let time_s = options.from_s.unwrap_or(f64::NEG_INFINITY)..options.to_s.unwrap_or(f64::INFINITY);
    // Not a number is refused, too.
    anyhow::ensure!(
        time_s.start < time_s.end,
        "--from-s {} and --to-s {} leave nothing of the record; the first must be the smaller one",
        time_s.start,
        time_s.end
    );
    if RunDir::is_ensemble(&folder) {
        anyhow::ensure!(
            !options.lab,
            "`{}` is an ensemble: a lab is made of one run; name one of its starts",
            shown(&folder)
        );
        anyhow::ensure!(
            time_s == (f64::NEG_INFINITY..f64::INFINITY),
            "`{}` is an ensemble: --from-s and --to-s choose from the record of one run; name one of its \
             starts",
            shown(&folder)
        );
        for note in stribeck_report::write_ensemble(&folder)?.notes {
            caution!("{note}");
        }
        say!("report: {}", shown(&RunDir::open_ensemble(&folder)?.report()));
        return Ok(ExitCode::SUCCESS);
    }
    let dir = RunDir::open(&folder)?;
    for missing in Run::read(dir.path())?.damage() {
        caution!("{missing}");
    }
    if options.lab {
        lab::beside_report(&dir, options.module.as_deref(), place)?;
    }
    detail!("report of `{}`", shown(dir.path()));
    stribeck_report::write_between(dir.path(), time_s)?;
    say!("report: {}", shown(&dir.report()));
    Ok(ExitCode::SUCCESS)
}
