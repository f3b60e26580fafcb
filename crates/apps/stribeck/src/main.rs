//! The program `stribeck`.

use std::process::ExitCode;

use stribeck::{Cli, command_line, conclude};

fn main() -> ExitCode {
    conclude(command_line::parse::<Cli>().run())
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
