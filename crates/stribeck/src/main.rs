//! The program `stribeck`.

use std::process::ExitCode;

use stribeck::{Cli, Place, command_line, conclude};

fn main() -> ExitCode {
    conclude(command_line::parse::<Cli>().run(&Place::here()))
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
