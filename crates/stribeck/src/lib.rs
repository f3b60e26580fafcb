//! The program `stribeck`: its commands, for the binary and for `cargo xtask`, which has the same ones.
//!
//! Glue only: paths, flags, progress and exit codes. What is computed lives in the crates below.

pub mod host;
pub mod interrupt;
pub mod place;
pub mod progress;

mod analyse;
mod bearings;
mod board;
mod campaign;
mod emit;
mod export;
mod infer;
mod many_runs;
mod memory;
mod out;
mod pdf;
mod plan;
mod ranks;
mod report;
mod side_by_side;
mod simulate;
mod validate;

use std::process::ExitCode;

use anyhow::Result;
pub use place::Place;

/// What the program can do.
#[derive(Debug, clap::Subcommand)]
pub enum Command {
    /// Runs a scene and writes its report
    Simulate(simulate::Options),
    /// Writes the report of a run again
    Report(report::Options),
    /// Runs many scenes made from one, and makes a data set of them; the same command starts and goes on
    Campaign(campaign::Options),
    /// Infers unknown fields of a scene from numbers that were seen: what they can have been, what they
    /// cannot
    Infer(infer::Options),
    /// Runs a scene by the full and by the reduced model, and says how far apart they are
    Validate(validate::Options),
    /// Says what to expect of a scene before it is run: lines, levels, steps, cost, advice
    Plan(plan::Options),
    /// Lists the bearings that have a name, with dimensions, defect frequencies and where the numbers are
    /// from
    Bearings(bearings::Options),
    /// Says what a measured record shows: which defects, how sure, and what it cannot say
    Analyse(analyse::Options),
    /// Writes the signals or the stress frames of a run in a format of other programs
    Export(export::Options),
}

impl Command {
    /// Does it, with paths and words of `place`.
    ///
    /// # Errors
    /// With what to tell the user.
    pub fn run(&self, place: &Place) -> Result<ExitCode> {
        match self {
            Self::Simulate(options) => simulate::run(options, place),
            Self::Report(options) => report::run(options, place),
            Self::Campaign(options) => campaign::run(options, place),
            Self::Infer(options) => infer::run(options, place),
            Self::Validate(options) => validate::run(options, place),
            Self::Plan(options) => plan::run(options, place),
            Self::Bearings(options) => bearings::run(options),
            Self::Analyse(options) => analyse::run(options, place),
            Self::Export(options) => export::run(options, place),
        }
    }
}

/// The exit code of a command; says on stderr what went wrong.
pub fn conclude(done: Result<ExitCode>) -> ExitCode {
    let done = done.and_then(|code| match out::trouble() {
        Some(trouble) if code == ExitCode::SUCCESS => Err(anyhow::Error::msg(trouble)),
        _ => Ok(code),
    });
    done.unwrap_or_else(|error| {
        eprintln!("error: {error}");
        causes(&error).iter().for_each(|cause| eprintln!("  because: {cause}"));
        ExitCode::FAILURE
    })
}

/// The causes of an error that its message does not contain already, as many of those of the crates do.
fn causes(error: &anyhow::Error) -> Vec<String> {
    let told = error.to_string();
    error.chain().skip(1).map(ToString::to_string).filter(|cause| !told.contains(cause)).collect()
}
