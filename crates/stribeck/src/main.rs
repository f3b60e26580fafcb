//! The program `stribeck`.

use std::process::ExitCode;

use clap::Parser;
use stribeck::{Command, Place, conclude};

/// Stribeck: explicit dynamics of rolling element bearings.
///
/// Reads a scene (a short text), simulates the bearing, and leaves a folder with traces, energies and a
/// report.
#[derive(Debug, Parser)]
#[command(name = "stribeck", version = stribeck::host::VERSION, max_term_width = 100, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

fn main() -> ExitCode {
    conclude(Cli::parse().command.run(&Place::here()))
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
