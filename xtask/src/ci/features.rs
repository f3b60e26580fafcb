//! The program and `xtask` are made of the same libraries: what one has compiled the other need not compile
//! again.

use std::{collections::BTreeSet, path::Path, process::Command};

use anyhow::{Context, Result, ensure};

/// Packages that the program asks for with other features than `xtask` does: each is compiled twice, and so
/// is all that depends on it.
pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let [program, tasks] = [libraries(root, "stribeck")?, libraries(root, "xtask")?];
    let twice = program.difference(&tasks);
    let complaint = |library: &String| {
        format!(
            "`{library}` is asked for by `stribeck`, and by `xtask` with other features or not at all: name \
             them in both `Cargo.toml`"
        )
    };
    Ok(twice.map(complaint).collect())
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
