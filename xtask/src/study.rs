//! `cargo xtask study`: the program of `crates/studies`, built when a study is asked for.

use std::ffi::OsString;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result};
use stribeck::Loudness;

use crate::workspace;

/// Words of `study`: its program parses them, `--help` among them.
#[derive(Debug, clap::Args)]
#[command(disable_help_flag = true)]
pub(crate) struct Options {
    /// Name of a study and its flags; `cargo xtask study --help` lists the studies
    #[arg(value_name = "NAME", trailing_var_arg = true, allow_hyphen_values = true)]
    pub(crate) words: Vec<OsString>,
}

pub(crate) fn run(options: &Options, loudness: Loudness) -> Result<ExitCode> {
    // From the working folder, which a relative CARGO_TARGET_DIR and files among the words are meant from.
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["run", "--quiet", "--release", "--package", "stribeck-studies", "--manifest-path"]);
    cargo.arg(workspace::root().join("Cargo.toml")).arg("--").args(loudness.flag()).args(&options.words);
    become_it(cargo).context(
        "cannot start cargo, which builds the studies: put it in PATH, or name it in the variable CARGO",
    )
}

/// Takes the place of this process, as that of cargo is taken by the program: Ctrl-C and other signals reach
/// it, and its exit code is the command's.
#[cfg(unix)]
fn become_it(mut command: Command) -> Result<ExitCode> {
    use std::os::unix::process::CommandExt;

    Err(command.exec().into())
}

/// Waits for it. The terminal sends Ctrl-C to both processes; it ends the other one, and so the wait.
#[cfg(not(unix))]
fn become_it(mut command: Command) -> Result<ExitCode> {
    ctrlc::set_handler(|| {}).context("cannot listen for Ctrl-C")?;
    let code = command.status()?.code();
    Ok(code.and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from))
}
