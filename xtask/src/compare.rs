//! `cargo xtask peers`: the same problems in our solver and in others, answers checked, times side by side.
//!
//! Other programs are installed from PyPI into `target/peers`. One that cannot be installed or run is
//! reported and left out. Ours is timed again before every run of another, so that both meet the same
//! machine.

mod bearing;
mod block;
mod environment;
mod measure;
mod peers;
mod program;
mod squeeze;
mod tables;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, bail, ensure};

use self::block::Block;
use self::environment::Environment;
use self::measure::{Absent, Measured, measure};
use self::peers::{ON_BLOCKS, ON_DISC, Peer};
use crate::workspace;
use stribeck::place::shown;

/// Flags of `compare`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Programs to compare with, for example numba,scipy [default: all]
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    peers: Vec<String>,
    /// Only the small problems, three rounds, and nothing written
    #[arg(long)]
    quick: bool,
    /// Times each program is measured
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u8).range(1..=99))]
    rounds: u8,
    /// Interpreter that makes the Python environment
    #[arg(long, default_value = "python3", value_name = "PROGRAM")]
    python: String,
}

const BLOCKS: [(usize, usize); 2] = [(210, 125), (420, 250)];

const QUICK_ROUNDS: usize = 3;

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    check_names(&options.peers)?;
    let root = workspace::root();
    let environment = Environment::prepare(&root, &options.python)?;
    let rounds = if options.quick { QUICK_ROUNDS } else { usize::from(options.rounds) };
    let chosen = |peers: &'static [Peer]| -> Vec<&'static Peer> {
        let all = options.peers.is_empty();
        peers.iter().filter(|p| all || options.peers.iter().any(|name| name == p.name)).collect()
    };
    let mut absent: Vec<Absent> = Vec::new();
    let mut measured: Vec<Measured> = Vec::new();
    for &(columns, rows) in if options.quick { &BLOCKS[..1] } else { &BLOCKS[..] } {
        let problem = block::problem(&Block::new(columns, rows), &environment.folder)?;
        measured.push(measure(problem, &chosen(&ON_BLOCKS), &environment, rounds, &mut absent)?);
    }
    let on_disc = chosen(&ON_DISC);
    if !on_disc.is_empty() {
        let problem = squeeze::problem(&environment.folder)?;
        measured.push(measure(problem, &on_disc, &environment, rounds, &mut absent)?);
    }

    measured.extend(bearing::measured(&root)?);

    let page = tables::page(rounds, &measured, &absent);
    println!("{page}");
    if !options.quick {
        write(&root, "compare.md", &page)?;
        write(&root, "compare.csv", &tables::csv(&measured))?;
    }
    let apart: Vec<&str> = measured.iter().flat_map(Measured::disagreeing).collect();
    ensure!(apart.is_empty(), "answers differ by more than their limits: {}", apart.join(", "));
    Ok(ExitCode::SUCCESS)
}

/// Refuses names that no program has.
fn check_names(names: &[String]) -> Result<()> {
    let mut known: Vec<&str> = ON_BLOCKS.iter().chain(&ON_DISC).map(|p| p.name).collect();
    known.sort_unstable();
    known.dedup();
    match names.iter().find(|name| !known.contains(&name.as_str())) {
        Some(unknown) => bail!("there is no peer `{unknown}`; known are {}", known.join(", ")),
        None => Ok(()),
    }
}

fn write(root: &Path, name: &str, text: &str) -> Result<()> {
    let folder = root.join("docs/results");
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot make `{}`", folder.display()))?;
    let file = folder.join(name);
    std::fs::write(&file, text).with_context(|| format!("cannot write `{}`", file.display()))?;
    println!("written: {}", shown(&file));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::check_names;

    #[test]
    fn refuses_unknown_peers_with_those_that_exist() {
        assert!(check_names(&[]).is_ok());
        assert!(check_names(&["numba".to_owned(), "scipy".to_owned()]).is_ok());
        assert!(check_names(&["nastran".to_owned()]).is_err_and(|e| e.to_string().contains("akantu")));
    }
}
