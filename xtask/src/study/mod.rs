//! `cargo xtask study`: one question, many runs, one table.
//!
//! A study is a list of variants: a scene and what is changed in it. Runs are kept in `runs/study/STUDY/VARIANT`; those
//! that are finished are not repeated, and one that was interrupted is continued. The answer goes to
//! `docs/results/STUDY.md` with a `.csv` and pictures beside it.

mod impulse;
mod kills;
mod long;
mod noise;
mod paper;
mod rig;
mod runner;
mod stability;
mod table;
mod work_precision;

use std::process::ExitCode;

use anyhow::Result;

pub(crate) use runner::{Finished, Flags, Runner, Variant};
pub(crate) use table::{Column, Sheet};

/// Flags of `study`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    #[command(subcommand)]
    study: Study,
}

/// What is asked.
#[derive(Debug, clap::Subcommand)]
enum Study {
    /// Which reading of the paper agrees with it best, and whether its hypothesis holds
    Paper(paper::Options),
    /// The bearing for 0.35 s: lines resolved to 3 Hz, the defect in the envelope
    Long(long::Options),
    /// Runs killed at random moments and continued: the same bytes
    Kills(kills::Options),
    /// Stiff and extreme cases: what the energy did, and whether the code stopped honestly
    Stability(stability::Options),
    /// Error against work: elements, integrators, contacts, meshes
    #[command(name = "work_precision")]
    WorkPrecision(work_precision::Options),
    /// Where contact noise comes from and what each cure takes away
    Noise(noise::Options),
    /// Whether the impulse at the exit is that of a finer mesh, over many starts
    Impulse(impulse::Options),
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    match &options.study {
        Study::Paper(options) => paper::run(options),
        Study::Long(options) => long::run(options),
        Study::Kills(options) => kills::run(options),
        Study::Stability(options) => stability::run(options),
        Study::WorkPrecision(options) => work_precision::run(options),
        Study::Noise(options) => noise::run(options),
        Study::Impulse(options) => impulse::run(options),
    }
}
