//! The program of `cargo xtask study`: one question, many runs, one table.
//!
//! A program of its own, so that simulating and reporting from a fresh clone need not wait until all studies
//! are compiled.

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};
use stribeck::Place;
use stribeck::place::shown;
use stribeck_studies::{Host, Study};

/// Answers a question by many runs: tables and pictures in docs/results
#[derive(Debug, Parser)]
#[command(name = "cargo xtask study", bin_name = "cargo xtask study", max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Measures nothing: writes the page of the study anew from its template and the kept table
    #[arg(long, global = true)]
    page_only: bool,
    #[command(flatten)]
    loudness: stribeck::Loudness,
}

#[derive(Debug, Subcommand)]
#[expect(clippy::large_enum_variant, reason = "one command is parsed a run")]
enum Command {
    #[command(flatten)]
    Study(Study),
    /// A command of `stribeck`, for studies of whole processes
    #[command(subcommand, hide = true)]
    Stribeck(stribeck::Command),
}

fn main() -> ExitCode {
    let cli = stribeck::command_line::parse::<Cli>();
    cli.loudness.apply();
    stribeck::conclude(match cli.command {
        Command::Study(study) => answer(&study, cli.page_only),
        Command::Stribeck(command) => {
            command.run(&Place::repository("cargo xtask", stribeck_studies::root()))
        }
    })
}

/// Runs a study and says what it found.
fn answer(study: &Study, page_only: bool) -> Result<ExitCode> {
    let answer = study.run(&Host::new()?, page_only)?;
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

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::Cli;

    #[test]
    fn behaves_the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
