//! `docs/guide/src/quantities.md`: every number of a run, as the summary declares it.

use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use stribeck_analysis::quantity::Quantity;
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
         A path leads to a number in `summary.json`, to its statistic in that of an ensemble, and to the column \
         `summary.PATH` of a campaign. Numbers with an … are in a list, and campaigns have no column of them. `compare` and the page of a campaign show the bold ones. \
         `cargo xtask quantities --schema` prints the JSON schema of `summary.json`.\n",
    );
    let quantities = Summary::quantities();
    let said = |quantity: &Quantity| {
        let (section, _) = quantity.path.split_once('.').unwrap_or_default();
        let (_, leaf) = quantity.path.rsplit_once('.').unwrap_or_default();
        (section.to_owned(), leaf.to_owned(), quantity.about)
    };
    let mut section = String::new();
    for (n, quantity) in quantities.iter().enumerate() {
        let mine = said(quantity);
        // Paths with one name and one sentence share a line.
        if quantities[..n].iter().any(|before| said(before) == mine) {
            continue;
        }
        if section != mine.0 {
            mine.0.clone_into(&mut section);
            write!(text, "\n## `{section}`\n\n")?;
        }
        let alike = quantities[n..].iter().filter(|other| said(other) == mine);
        let paths: Vec<String> = alike.map(path).collect();
        let unit = quantity.unit();
        let bracket = if unit.is_empty() { String::new() } else { format!(" [{unit}]") };
        let about = quantity.about_in_markdown().replace(&format!(" [{unit}]"), "");
        writeln!(text, "- {}{bracket}: {about}", paths.join(", "))?;
    }
    Ok(text)
}

/// A path, bold where pages compare the number, with … in a list.
fn path(quantity: &Quantity) -> String {
    let mark = if quantity.place.is_some() { "**" } else { "" };
    let list = if quantity.is_listed { "…" } else { "" };
    format!("{mark}`{}`{mark}{list}", quantity.path)
}
