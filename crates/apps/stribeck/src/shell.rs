//! `stribeck completions` and `stribeck man`: completions of shells, and manual pages.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::CommandFactory;
use clap_complete::Shell;

use crate::Cli;
use crate::out::say;
use crate::place::shown;

/// Flags of `completions`.
#[derive(Debug, clap::Args)]
pub struct Completions {
    /// Shell
    #[arg(ignore_case = true)]
    shell: Shell,
}

/// Flags of `man`.
#[derive(Debug, clap::Args)]
pub struct Man {
    /// Folder for the pages, such as ~/.local/share/man/man1; it is made
    folder: PathBuf,
}

/// Writes the completions of a shell to standard output.
pub(crate) fn completions(options: &Completions) -> Result<ExitCode> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut Cli::command(), "stribeck", &mut text);
    say!("{}", String::from_utf8_lossy(&text).trim_end());
    Ok(ExitCode::SUCCESS)
}

/// Writes a page of the manual for the program and one for each command.
pub(crate) fn man(options: &Man) -> Result<ExitCode> {
    let folder = &options.folder;
    let written =
        std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(Cli::command(), folder));
    written.with_context(|| {
        format!(
            "cannot write pages to `{}`: name a folder that may be made and written, such as `man`",
            folder.display()
        )
    })?;
    say!("{}", shown(&folder.join("stribeck.1")));
    Ok(ExitCode::SUCCESS)
}
