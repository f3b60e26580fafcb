//! `stribeck list`: the runs that there are.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{SystemTime, UNIX_EPOCH};

use anyhow::{Result, ensure};
use serde_json::json;
use stribeck_store::run_dir::Stage;

use crate::out::say;
use crate::place::{Place, shown};
use crate::shelf::{Item, ago, all_items, in_words, items, size};

/// Flags of `list`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Folder of runs [default: runs, and what `--out` put beside it]
    folder: Option<PathBuf>,
    /// Writes the list as JSON
    #[arg(long)]
    json: bool,
}

/// Modes that later runs of the same mesh take.
const CACHE: &str = ".reduced";

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let folder = options.folder.clone().unwrap_or_else(|| place.runs());
    ensure!(
        folder.is_dir() || options.folder.is_none() || folder == place.runs(),
        "there is no folder `{}`: `{} list` without one lists `{}`",
        folder.display(),
        place.program,
        shown(&place.runs())
    );
    let all = if options.folder.is_some() { items(&folder) } else { all_items(place) };
    if options.json {
        let rows: Vec<_> = all.iter().map(as_json).collect();
        say!("{}", serde_json::to_string_pretty(&rows)?);
        return Ok(ExitCode::SUCCESS);
    }
    if all.is_empty() {
        say!("no runs in `{}`: start one with `{} simulate`", shown(&folder), place.program);
        return Ok(ExitCode::SUCCESS);
    }
    let width = all.iter().map(|item| item.name.chars().count()).max().unwrap_or(0).max(4);
    say!("{:<width$}  {:<10}  {:<28} {:>9}  {}", "name", "what", "state", "size", "written");
    let now = SystemTime::now();
    for item in &all {
        say!(
            "{:<width$}  {:<10}  {:<28} {:>9}  {}{}{}",
            item.name,
            item.kind.word(),
            item.state,
            in_words(item.bytes),
            item.written.map_or_else(String::new, |written| ago(written, now)),
            if item.page().is_some() { "" } else { ", no page" },
            item.next().map_or_else(String::new, |next| format!(", next: {} {next}", place.program))
        );
    }
    let cached = size(&folder.join(CACHE)).0;
    if cached > 0 {
        say!(
            "{} in `{}` are modes of reduced bearings, which later runs of the same mesh take; they may be \
             removed at any time",
            in_words(cached),
            shown(&folder.join(CACHE))
        );
    }
    Ok(ExitCode::SUCCESS)
}

fn as_json(item: &Item) -> serde_json::Value {
    let written = item.written.and_then(|written| written.duration_since(UNIX_EPOCH).ok());
    json!({
        "name": item.name,
        "path": item.path,
        "kind": item.kind.word(),
        "state": item.state,
        "stage": item.stage.map(Stage::word),
        "next": item.next(),
        "bytes": item.bytes,
        "written_unix_s": written.map(|since| since.as_secs()),
        "page": item.page(),
    })
}
