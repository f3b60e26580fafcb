//! `stribeck completions`: completions of shells.

use std::process::ExitCode;

use anyhow::Result;
use clap::CommandFactory;
use clap_complete::Shell;

use crate::Cli;
use crate::out::say;

/// Flags of `completions`.
#[derive(Debug, clap::Args)]
pub struct Completions {
    /// Shell
    #[arg(ignore_case = true)]
    shell: Shell,
}

/// Writes the completions of a shell to standard output.
pub(crate) fn completions(options: &Completions) -> Result<ExitCode> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut Cli::command(), "stribeck", &mut text);
    say!("{}", String::from_utf8_lossy(&text).trim_end());
    Ok(ExitCode::SUCCESS)
}
