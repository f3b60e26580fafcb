//! Command line of Stribeck: `cargo xtask simulate`, `report`, `study`, `compare` and `ci`.
//!
//! Glue only: paths, flags, progress and exit codes. What is computed lives in the crates.

mod ci;
mod compare;
mod engine;
mod fuzz;
mod host;
mod plan;
mod progress;
mod report;
mod simulate;
mod study;
mod workspace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Explicit dynamics of rolling element bearings.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version, about, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs a scene and writes its report.
    Simulate(simulate::Options),
    /// Writes the report of a run again.
    Report(report::Options),
    /// Says what to expect of a scene before it is run: lines, levels, steps, cost, advice
    Plan(plan::Options),
    /// Answers a question by many runs: tables and pictures in docs/results
    Study(study::Options),
    /// Solves the same problems with other programs, checks that they agree, and times them
    Compare(compare::Options),
    /// Feeds the program generated bad input: scenes, overrides, traces, checkpoints, meshes
    Fuzz(fuzz::Options),
    /// Checks format, lints, tests and documents.
    Ci(ci::Options),
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match cli.command {
        Command::Simulate(options) => simulate::run(&options),
        Command::Report(options) => report::run(&options),
        Command::Plan(options) => plan::run(&options),
        Command::Study(options) => study::run(&options),
        Command::Compare(options) => compare::run(&options),
        Command::Fuzz(options) => fuzz::run(&options),
        Command::Ci(options) => ci::run(&options),
    };
    match done {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            // Many messages of the crates already contain their cause.
            let told = error.to_string();
            for cause in error.chain().skip(1).map(ToString::to_string).filter(|cause| !told.contains(cause))
            {
                eprintln!("  because: {cause}");
            }
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::Cli;

    #[test]
    fn example_the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
