//! The program, `xtask` and the studies are made of the same libraries: what one has compiled the others need
//! not compile again.

use std::{collections::BTreeSet, path::Path, process::Command};

use anyhow::{Context, Result, ensure};

/// Packages that one of the programs asks for with other features than `xtask` or the studies do, which are
/// built after it: each is compiled twice, and so is all that depends on it.
pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let program = libraries(root, "stribeck")?;
    let mut complaints = Vec::new();
    for other in ["xtask", "stribeck-studies"] {
        let theirs = libraries(root, other)?;
        complaints.extend(program.difference(&theirs).map(|library| {
            format!(
                "`{library}` is asked for by `stribeck`, and by `{other}` with other features or not at all: \
                 name them in both `Cargo.toml`"
            )
        }));
    }
    Ok(complaints)
}

/// All packages that one of the workspace is compiled with, by name, version and features.
fn libraries(root: &Path, package: &str) -> Result<BTreeSet<String>> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let arguments = ["tree", "--locked", "--package", package, "--edges", "normal,build", "--prefix", "none"];
    let output = Command::new(cargo)
        .args(arguments)
        .args(["--format", "{p} with {f}"])
        .current_dir(root)
        .output()
        .context("cargo tree does not start")?;
    ensure!(output.status.success(), "cargo tree: {}", String::from_utf8_lossy(&output.stderr).trim());
    let text = String::from_utf8(output.stdout).context("cargo tree writes no text")?;
    // Packages that were listed before end with a star.
    Ok(text.lines().map(|line| line.trim_end_matches(" (*)").trim_end().to_owned()).collect())
}
