//! The program `stribeck`.

use std::process::ExitCode;

use clap::Parser;
use stribeck::{Cli, Place, conclude};

fn main() -> ExitCode {
    conclude(Cli::parse().run(&Place::here()))
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
