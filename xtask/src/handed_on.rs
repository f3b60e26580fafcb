//! Commands of other programs, which are built when they are asked for: what a fresh clone simulates and
//! reports with is compiled without them.

use std::ffi::OsString;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result};
use stribeck::Loudness;
use stribeck::place::REPOSITORY;

use crate::workspace;

/// Words of a command: its program parses them, `--help` among them.
#[derive(Debug, clap::Args)]
#[command(disable_help_flag = true)]
pub(crate) struct Words {
    /// Its own words and flags; `--help` lists them
    #[arg(value_name = "WORDS", trailing_var_arg = true, allow_hyphen_values = true)]
    pub(crate) words: Vec<OsString>,
}

/// A study.
pub(crate) fn study(words: &Words, loudness: Loudness) -> Result<ExitCode> {
    let mut cargo = cargo_run("stribeck-studies", loudness);
    cargo.args(loudness.flag()).args(&words.words);
    replace_process(cargo)
}

/// A command of `stribeck`, with all words that this process was called with.
pub(crate) fn program(words: &[OsString], loudness: Loudness) -> Result<ExitCode> {
    let mut cargo = cargo_run("stribeck", loudness);
    cargo.env(REPOSITORY, workspace::root()).args(words);
    replace_process(cargo)
}

/// Runs in the working folder, to which a relative `CARGO_TARGET_DIR` and files among the words refer.
fn cargo_run(package: &str, loudness: Loudness) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["run", "--release", "--package", package, "--manifest-path"]);
    cargo.arg(workspace::root().join("Cargo.toml"));
    // Whoever waits for the compiler sees it at work; later cargo has nothing to say.
    if is_built(package) || loudness.flag() == Some("--quiet") {
        cargo.arg("--quiet");
    } else {
        eprintln!("note: building `{package}`, which has this command, once");
    }
    cargo.arg("--");
    cargo
}

/// Whether a program lies beside this one, where cargo puts it.
fn is_built(package: &str) -> bool {
    let program = format!("{package}{}", std::env::consts::EXE_SUFFIX);
    std::env::current_exe().is_ok_and(|this| this.with_file_name(program).exists())
}

/// Takes the place of this process, as that of cargo is taken by the program: Ctrl-C and other signals reach
/// it, and its exit code is the command's.
#[cfg(unix)]
fn replace_process(mut command: Command) -> Result<ExitCode> {
    use std::os::unix::process::CommandExt;

    Err(command.exec()).context(NO_CARGO)
}

/// Waits for it. The terminal sends Ctrl-C to both processes; it ends the other one, and so the wait.
#[cfg(not(unix))]
fn replace_process(mut command: Command) -> Result<ExitCode> {
    ctrlc::set_handler(|| {}).context("cannot listen for Ctrl-C")?;
    let code = command.status().context(NO_CARGO)?.code();
    Ok(code.and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from))
}

const NO_CARGO: &str =
    "cannot start cargo, which builds this command: put it in PATH, or name it in the variable CARGO";
