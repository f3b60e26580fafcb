//! `docs/guide/src/quantities.md`: every number of a run, as the summary declares it.

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use stribeck_analysis::summary::Summary;

use crate::workspace;

/// The page.
const PAGE: &str = "docs/guide/src/quantities.md";

/// Flags of `quantities`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Prints the schema of summary.json instead
    #[arg(long)]
    schema: bool,
}

/// Writes the page.
pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    if options.schema {
        println!("{:#}", Summary::json_schema());
        return Ok(ExitCode::SUCCESS);
    }
    let path = workspace::root().join(PAGE);
    std::fs::write(path, page()?).with_context(|| format!("cannot write {PAGE}"))?;
    println!("{PAGE} says what the summary declares");
    Ok(ExitCode::SUCCESS)
}

/// Whether the page agrees with the summary.
pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let text = std::fs::read_to_string(root.join(PAGE)).unwrap_or_default();
    let complaint = || format!("{PAGE} is not what the summary declares; `cargo xtask quantities` writes it");
    Ok((text != page()?).then(complaint).into_iter().collect())
}

fn page() -> Result<String> {
    let mut text = String::from(
        "# Every number of a run\n\nWritten by `cargo xtask quantities` from the summary's own declarations. \
         A path leads to a number in `summary.json`, to its statistic in that of an ensemble, to the column \
         `summary.PATH` of a campaign, and to a target of an inference. Numbers with an … are in a list, of \
         which an inference takes one item or combines all, as in `median(events.floor_n)`, and campaigns \
         have no column. \
         `compare` sets the bold ones side by side, and the page of a campaign draws them over its fields. \
         `cargo xtask quantities --schema` prints the JSON schema of `summary.json`.\n",
    );
    let mut section = String::new();
    for quantity in Summary::quantities() {
        let (first, _) = quantity.path.split_once('.').unwrap_or_default();
        if section != first {
            first.clone_into(&mut section);
            write!(text, "\n## `{section}`\n\n| path | unit | |\n|---|---|---|\n")?;
        }
        let mark = if quantity.place.is_some() { "**" } else { "" };
        let list = if quantity.is_listed { " …" } else { "" };
        let unit = quantity.unit();
        // The sentence has its unit in brackets, which the column beside it says.
        let about = quantity.about_in_markdown().replace(&format!(" [{unit}]"), "");
        writeln!(text, "| {mark}`{}`{mark}{list} | {unit} | {about} |", quantity.path)?;
    }
    Ok(text)
}
