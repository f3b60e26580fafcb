//! Commands that are not in this build of the program: `full` has them.

use std::ffi::OsString;
use std::process::ExitCode;

use anyhow::{Result, bail};

use crate::Place;

/// Words of such a command, `--help` among them: whoever has the command parses them.
#[derive(Debug, clap::Args)]
#[command(disable_help_flag = true)]
pub struct Options {
    /// Its own words and flags; `--help` lists them
    #[arg(value_name = "WORDS", trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<OsString>,
}

pub(crate) fn run(_: &Options, place: &Place) -> Result<ExitCode> {
    bail!(
        "this build of `{}` leaves the command out: build it with the feature `full`, which is on by default",
        place.program
    )
}
