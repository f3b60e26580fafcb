//! `cargo xtask ci`: everything that must hold before a change is accepted.

mod documents;
mod features;
mod layers;
mod markdown;
mod pages;
mod sources;
mod test_names;
mod validation;

use std::path::Path;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, ensure};

use crate::workspace;

/// Flags of `ci`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Only the checks of text, which compile nothing
    #[arg(long)]
    quick: bool,
    /// Checks nothing: writes the first lines of pages of results that an older program made
    #[arg(long, conflicts_with = "quick")]
    mark: bool,
}

/// One check: its name, and the function that returns its complaints.
type Check = (&'static str, fn(&Path) -> Result<Vec<String>>);

const CHECKS: &[Check] = &[
    ("no arrow runs to a higher layer", layers::check),
    ("the program and xtask are made of the same libraries", features::check),
    ("THEORY has every section that code cites", documents::check_citations),
    ("links in the documents lead somewhere, within the book", documents::check_links),
    ("commands in the documents exist", documents::check_commands),
    ("scenes in the documents can be run", documents::check_scenes),
    ("the guide lists the fields that scenes have", crate::fields::check),
    ("the guide lists the numbers that summaries have", crate::quantities::check),
    ("tests have a prefix, and a source where they need one", test_names::check),
    ("VALIDATION says what the tests say", validation::check),
    ("pages of an older program say so", pages::check),
];

pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    let root = workspace::root();
    if options.mark {
        pages::mark(&root)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut failed = Vec::new();
    for (name, check) in CHECKS {
        // A document that is missing is one more complaint, not the end of the checks.
        let complaints = check(&root).unwrap_or_else(|error| vec![format!("{error:#}")]);
        println!("{} {name}", if complaints.is_empty() { "ok    " } else { "FAILED" });
        for complaint in &complaints {
            println!("         {complaint}");
        }
        if !complaints.is_empty() {
            failed.push((*name).to_owned());
        }
    }
    if !options.quick {
        let ledger = fresh_folder(&root.join("target/ledger"))?;
        for arguments in cargo_steps(&sources::crates(&root)?) {
            let name = format!("cargo {}", arguments.join(" "));
            println!("run    {name}");
            if !cargo(&root, &arguments, &ledger)? {
                failed.push(name);
            }
        }
        let complaints = validation::renew(&root, &ledger)?;
        complaints.iter().for_each(|complaint| println!("         {complaint}"));
        if !complaints.is_empty() {
            failed.push("VALIDATION was out of date".into());
        }
    }
    ensure!(failed.is_empty(), "{} of the checks failed: {}", failed.len(), failed.join("; "));
    println!("all checks passed");
    Ok(ExitCode::SUCCESS)
}

/// What cargo has to accept: format, lints, documentation, and the tests of each crate by itself.
fn cargo_steps(crates: &[String]) -> Vec<Vec<String>> {
    let words = |line: &str| line.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let mut steps = vec![
        words("fmt --all --check"),
        words("clippy --workspace --all-targets -- -D warnings"),
        // As a fresh clone has it: in a workspace all features are on.
        words("clippy -p xtask -- -D warnings"),
        words("doc --workspace --no-deps"),
    ];
    let package = |name: &str| if name == "stribeck" { name.to_owned() } else { format!("stribeck-{name}") };
    // The library for other programs is no member of the workspace: it needs libclang.
    let names = crates.iter().filter_map(|folder| folder.rsplit('/').next());
    let members = names.filter(|name| *name != "fmu");
    steps.extend(members.map(|name| words(&format!("test --release -p {}", package(name)))));
    steps.push(words("test --release -p stribeck-studies -p xtask"));
    steps
}

/// An empty folder at `path`.
fn fresh_folder(path: &Path) -> Result<std::path::PathBuf> {
    std::fs::remove_dir_all(path).ok();
    std::fs::create_dir_all(path).with_context(|| format!("cannot create {}", path.display()))?;
    Ok(path.to_owned())
}

/// Runs cargo in the workspace; true when it is content.
fn cargo(root: &Path, arguments: &[String], ledger: &Path) -> Result<bool> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(program)
        .args(arguments)
        .current_dir(root)
        .env("RUSTDOCFLAGS", "-D warnings")
        .env(validation::FOLDER, ledger)
        .status()
        .context("cannot start cargo")?;
    Ok(status.success())
}
