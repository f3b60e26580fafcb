//! `docs/guide/src/fields.md`: every field of a scene, from the table by which scenes are read.

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result};
use stribeck_scene::fields::page;

use crate::workspace;

/// The page.
const PAGE: &str = "docs/guide/src/fields.md";

pub(crate) fn run() -> Result<ExitCode> {
    std::fs::write(workspace::root().join(PAGE), page()).with_context(|| format!("cannot write {PAGE}"))?;
    println!("{PAGE} says what the table of fields says");
    Ok(ExitCode::SUCCESS)
}

/// Whether the page agrees with the table.
pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let text = std::fs::read_to_string(root.join(PAGE)).unwrap_or_default();
    let complaint =
        || format!("{PAGE} is not what the table says; `cargo xtask write-fields` writes it anew");
    Ok((text != page()).then(complaint).into_iter().collect())
}
