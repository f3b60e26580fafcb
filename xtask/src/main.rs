//! What develops Stribeck: `cargo xtask ci` and `study`, and the program's own `simulate`,
//! `report` and `plan`.
//!
//! Glue only: paths, flags, progress and exit codes. All computation is in the crates.

mod book;
mod ci;
mod fields;
mod fmu;
mod handed_on;
mod lab;
mod quantities;
mod release;
mod wheel;
mod workspace;

use std::ffi::{OsStr, OsString};
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use stribeck::{Loudness, Place};

/// Stribeck: explicit dynamics of rolling element bearings. The commands of `stribeck`, and those that
/// develop it.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version, about, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    loudness: Loudness,
}

#[derive(Debug, Subcommand)]
#[allow(clippy::large_enum_variant, reason = "one command is parsed a run")]
enum Command {
    #[command(flatten)]
    Program(stribeck::Command),
    /// Answers a question by many runs: tables and pictures in docs/results
    Study(handed_on::Words),
    /// Builds the module of `cargo xtask lab`, which steps a bearing in a page, and says where it is
    LabModule(lab::Options),
    /// Builds the documents as a book with mdBook, with a lab in its guide
    WriteBook,
    /// Builds the wheel of the Python module, which needs no Rust where it is installed
    Wheel(wheel::Options),
    /// Makes the files of a release: programs, wheels, installers, checksums, licences
    Release(release::Options),
    /// Writes the guide's page of all fields of a scene from their types
    WriteFields,
    /// Writes the guide's page of all numbers of a run from the summary's declarations
    Quantities(quantities::Options),
    /// Checks format, lints, tests and documents
    Ci(ci::Options),
}

fn main() -> ExitCode {
    let words: Vec<OsString> = std::env::args_os().skip(1).collect();
    if let [help, command] = &words[..]
        && help == "help"
        && is_handed_on(command)
    {
        return stribeck::conclude(handed_on::program(
            &[command.clone(), "--help".into()],
            Loudness::default(),
        ));
    }
    let cli = stribeck::command_line::parse::<Cli>();
    cli.loudness.apply();
    stribeck::conclude(match cli.command {
        Command::Program(command) if command.needs_full() => handed_on::program(&words, cli.loudness),
        Command::Program(command) => lab::with_module(command)
            .map(lab::opened)
            .and_then(fmu::with_library)
            .and_then(|command| command.run(&Place::repository("cargo xtask", workspace::root()))),
        Command::Study(words) => handed_on::study(&words, cli.loudness),
        Command::LabModule(options) => lab::build_module(&options),
        Command::Wheel(options) => wheel::build(&options),
        Command::WriteBook => book::run(),
        Command::Release(options) => release::run(&options),
        Command::WriteFields => fields::run(),
        Command::Quantities(options) => quantities::run(&options),
        Command::Ci(options) => ci::run(&options),
    })
}

/// Whether a command is one that this program knows by its name alone.
fn is_handed_on(name: &OsStr) -> bool {
    let parsed = Cli::try_parse_from([OsStr::new("cargo xtask"), name]);
    matches!(parsed, Ok(Cli { command: Command::Program(command), .. }) if command.needs_full())
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    use super::{Cli, Command};

    #[test]
    fn behaves_the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn behaves_what_follows_study_is_left_to_its_program() {
        for line in ["--help", "-h", "kills --help", "kills --kills 5", "help kills", ""] {
            let words = line.split_whitespace();
            let cli = Cli::try_parse_from(["xtask", "-q", "study"].into_iter().chain(words)).expect(line);
            let Command::Study(study) = cli.command else { panic!("{line}") };
            assert_eq!(
                format!("{:?}", study.words),
                format!("{:?}", line.split_whitespace().collect::<Vec<_>>())
            );
            assert_eq!(cli.loudness.flag(), Some("--quiet"));
        }
    }
}
