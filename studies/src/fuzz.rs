//! `cargo xtask fuzz`: generated bad input by the hundred thousand. Every one must get an answer: no panic,
//! no hang, no memory out of proportion.

mod damage;
mod inputs;
mod readers;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

use inputs::Inputs;
pub(crate) use stribeck_scene::dice::Dice;

use stribeck::{host, place::shown};

/// An input that takes longer than this hangs: the largest mesh that is tried takes a tenth of that on a busy
/// machine.
const PATIENCE: Duration = Duration::from_secs(20);

/// Memory that a small input may take beyond the program's own [MiB].
const MEMORY_MIB: f64 = 512.0;

/// Flags of `fuzz`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Inputs to try
    #[arg(long, default_value_t = 100_000)]
    cases: u64,
    /// Where the sequence of inputs begins; a failure names the seed of its input
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Only inputs of this kind: scene, override, table, campaign, trace, checkpoint, run-info, mesh, shape,
    /// reader
    #[arg(long)]
    kind: Option<String>,
    /// Compares our readings of files of signals and meshes, most of them damaged, with those of the programs
    /// that this Python has (numpy, scipy, h5py, npTDMS, asammdf, pandas, pyarrow, pyuff, soundfile, meshio),
    /// and writes docs/results/readers.csv and .md
    #[arg(long, value_name = "PYTHON", conflicts_with = "kind")]
    peers: Option<String>,
    /// With --peers: after this number of seconds the other programs are given no further files
    #[arg(long, value_name = "S", default_value_t = 600, requires = "peers")]
    seconds: u64,
    /// With --peers: keeps the files that are read differently, or by the other program alone
    #[arg(long, value_name = "FOLDER", requires = "peers")]
    keep: Option<std::path::PathBuf>,
}

/// How an input was answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Answer {
    /// It was good after all.
    Taken,
    /// It was refused with words.
    Refused,
}

/// What happened to the inputs of one kind.
#[derive(Debug, Default, Clone, Copy)]
struct Tally {
    cases: u64,
    taken: u64,
    refused: u64,
    slowest: Duration,
}

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let folder = std::env::temp_dir().join(format!("stribeck-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).context("cannot make a folder for the inputs")?;
    let done = match &options.peers {
        Some(python) => readers::against(
            &readers::Wanted {
                python,
                keep: options.keep.as_deref(),
                time: Duration::from_secs(options.seconds),
                first: options.seed,
                cases: options.cases,
            },
            &folder,
        ),
        None => all(options, &Inputs::new(&folder)?),
    };
    std::fs::remove_dir_all(&folder).ok();
    done
}

fn all(options: &Options, inputs: &Inputs) -> Result<ExitCode> {
    let kinds: Vec<_> = inputs::KINDS
        .iter()
        .filter(|kind| options.kind.as_ref().is_none_or(|only| only == kind.name))
        .collect();
    anyhow::ensure!(!kinds.is_empty(), "no such kind of input");
    let mut tallies = vec![Tally::default(); kinds.len()];
    let mut failures = Vec::new();
    let memory = host::peak_memory_mib();
    let words = listen_to_panics();
    let weight: u64 = kinds.iter().map(|kind| kind.weight).sum();
    for seed in options.seed..options.seed + options.cases {
        let mut dice = Dice::new(seed);
        let mut at = dice.below(weight as usize) as u64;
        let chosen = kinds.iter().position(|kind| {
            let here = at < kind.weight;
            at = at.saturating_sub(kind.weight);
            here
        });
        let k = chosen.unwrap_or(0);
        let began = Instant::now();
        let answer = catch_unwind(AssertUnwindSafe(|| (kinds[k].attempt)(inputs, &mut dice)));
        let took = began.elapsed();
        let tally = &mut tallies[k];
        tally.cases += 1;
        tally.slowest = tally.slowest.max(took);
        match answer {
            Ok(Ok(Answer::Taken)) => tally.taken += 1,
            Ok(Ok(Answer::Refused)) => tally.refused += 1,
            Ok(Err(error)) => failures.push(format!("{}, seed {seed}: {error:#}", kinds[k].name)),
            Err(_) => {
                let said = words.lock().unwrap_or_else(|e| e.into_inner()).clone();
                failures.push(format!("{}, seed {seed}: panic: {said}", kinds[k].name));
            }
        }
        if took > PATIENCE {
            failures.push(format!("{}, seed {seed}: took {:.1} s", kinds[k].name, took.as_secs_f64()));
        }
        if (seed + 1).is_multiple_of(10_000) {
            eprintln!("{} inputs, {} failures", seed + 1 - options.seed, failures.len());
        }
    }
    let _ = std::panic::take_hook();
    for (kind, t) in kinds.iter().zip(&tallies) {
        println!(
            "{:10} {:7} inputs: {:7} refused with words, {:6} good after all, slowest {:.3} s",
            kind.name,
            t.cases,
            t.refused,
            t.taken,
            t.slowest.as_secs_f64()
        );
    }
    if let (Some(before), Some(after)) = (memory, host::peak_memory_mib()) {
        println!("memory: {before:.0} MiB before, {after:.0} MiB at most");
        if after > before + MEMORY_MIB {
            failures.push(format!("memory grew to {after:.0} MiB"));
        }
    }
    for failure in failures.iter().take(20) {
        eprintln!("FAILED {failure}");
    }
    println!("{} inputs, {} unhandled (folder {})", options.cases, failures.len(), shown(&inputs.folder));
    Ok(if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Keeps the words of the last panic instead of printing them.
fn listen_to_panics() -> Arc<Mutex<String>> {
    let words = Arc::new(Mutex::new(String::new()));
    let heard = Arc::clone(&words);
    std::panic::set_hook(Box::new(move |info| {
        *heard.lock().unwrap_or_else(|e| e.into_inner()) = info.to_string();
    }));
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn survives_generated_bad_inputs_with_an_answer() {
        // As many as the test of the readers where it is told how many.
        let cases = std::env::var("STRIBECK_MUTATIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(800);
        let code = run(&Options { cases, seed: 7, kind: None, peers: None, seconds: 0, keep: None })
            .expect("a folder for temporary files");
        assert_eq!(code, ExitCode::SUCCESS);
    }
}
