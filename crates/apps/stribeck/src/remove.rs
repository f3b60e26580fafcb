//! `stribeck rm`: removes runs, after asking: the files that Stribeck wrote, one by one, and no others.

use std::io::{BufRead, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow, bail, ensure};

use crate::out::say;
use crate::own_files::Contents;
use crate::place::{Place, shown};
use crate::shelf::{Item, find, in_words, is_held};

/// Flags of `rm`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Runs, ensembles, campaigns or analyses: their folders, or their names below runs/
    #[arg(required = true, value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// Removes them without asking
    #[arg(long, short = 'y')]
    yes: bool,
}

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    // All are looked at before the first is removed.
    let mut items: Vec<Item> = Vec::new();
    for asked in &options.runs {
        let item = find(asked, place).map_err(|why| anyhow!("{why}. Nothing was removed"))?;
        removable(&item)?;
        if items.iter().all(|other| other.path != item.path) {
            items.push(item);
        }
    }
    let contents: Vec<Contents> = items.iter().map(|item| Contents::of(&item.path)).collect();
    for (item, contents) in items.iter().zip(&contents) {
        say!("{}  {}, {}, {}", shown(&item.path), item.kind.word(), item.state, in_words(item.bytes));
        say!("  {}", listed(&contents.own, &item.path));
        if !contents.others.is_empty() {
            say!("  stays, as it is not of Stribeck: {}", listed(&contents.others, &item.path));
        }
    }
    let bytes =
        contents.iter().flat_map(|c| &c.own).filter_map(|file| file.metadata().ok()).map(|of| of.len()).sum();
    if !options.yes && !agreed(&items, bytes, place)? {
        say!("nothing was removed");
        return Ok(ExitCode::FAILURE);
    }
    contents.iter().try_for_each(Contents::remove)?;
    let kept: Vec<String> = items
        .iter()
        .filter(|item| item.path.exists())
        .map(|item| format!("`{}`", shown(&item.path)))
        .collect();
    let files: usize = contents.iter().map(|contents| contents.own.len()).sum();
    match kept.len() {
        0 => say!("removed {}, {}", in_number(items.len()), in_words(bytes)),
        _ => say!(
            "removed {files} files, {}; with the files of others in them stay {}",
            in_words(bytes),
            kept.join(", ")
        ),
    }
    Ok(ExitCode::SUCCESS)
}

/// Most names of files that are printed.
const NAMED: usize = 12;

/// Names of files below a folder.
fn listed(files: &[PathBuf], folder: &Path) -> String {
    let name = |path: &PathBuf| path.strip_prefix(folder).unwrap_or(path).display().to_string();
    let mut names: Vec<String> = files.iter().take(NAMED).map(name).collect();
    if files.len() > NAMED {
        names.push(format!("{} more", files.len() - NAMED));
    }
    names.join(", ")
}

fn in_number(count: usize) -> String {
    if count == 1 { "1 folder".to_owned() } else { format!("{count} folders") }
}

fn removable(item: &Item) -> Result<()> {
    let path = &item.path;
    ensure!(
        !path.is_symlink(),
        "`{}` is a link to another place: remove the link, or name the folder itself",
        shown(path)
    );
    let (whole, here) = (canonical(path)?, canonical(Path::new("."))?);
    ensure!(
        !here.starts_with(&whole),
        "`{}` is the folder that you are in, or holds it: go to another one first",
        shown(path)
    );
    ensure!(!is_held(path), "`{}` is being written by a program: stop that with Ctrl-C first", shown(path));
    Ok(())
}

fn canonical(path: &Path) -> Result<PathBuf> {
    path.canonicalize().with_context(|| format!("`{}` cannot be found", path.display()))
}

/// Whether the user agrees; without a terminal the answer is no.
fn agreed(items: &[Item], bytes: u64, place: &Place) -> Result<bool> {
    let (mut stderr, stdin) = (std::io::stderr(), std::io::stdin());
    if !(stdin.is_terminal() && stderr.is_terminal()) {
        bail!(
            "nothing was removed: nobody can be asked here. `{} rm {} --yes` removes without asking",
            place.program,
            items.iter().map(|item| shown(&item.path)).collect::<Vec<_>>().join(" ")
        );
    }
    write!(stderr, "Remove {} for good, {}? [y/N] ", in_number(items.len()), in_words(bytes))?;
    stderr.flush()?;
    let mut answer = String::new();
    stdin.lock().read_line(&mut answer)?;
    Ok(matches!(answer.trim().to_lowercase().as_str(), "y" | "yes"))
}
