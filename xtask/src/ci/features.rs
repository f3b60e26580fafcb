//! The program, `xtask` and the studies are made of the same libraries, as far as they need them: what one
//! has compiled the others need not compile again.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};

/// The one package that `xtask` asks for with fewer features, because it hands on some commands.
const PROGRAM: &str = "stribeck v";

/// Features that a package is compiled with, once or several times.
type Builds = BTreeSet<String>;

/// Packages that one of the programs asks for with other features than `xtask` or the studies do, which are
/// built after it: each is compiled twice, and so is all that depends on it.
pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let program = libraries(root, "stribeck")?;
    let mut complaints = Vec::new();
    for other in ["xtask", "stribeck-studies"] {
        let theirs = libraries(root, other)?;
        let differs = |name: &str, builds: &Builds| {
            !name.starts_with(PROGRAM) && theirs.get(name).is_some_and(|theirs| theirs.is_disjoint(builds))
        };
        let differing = program.iter().filter(|(name, builds)| differs(name, builds));
        complaints.extend(differing.map(|(name, builds)| {
            format!(
                "`{name}` is asked for by `stribeck` with {builds:?}, and by `{other}` with {:?}: name all \
                 of them in both `Cargo.toml`",
                theirs[name]
            )
        }));
    }
    Ok(complaints)
}

/// All packages that one of the workspace is compiled with, by name and version, and their features.
fn libraries(root: &Path, package: &str) -> Result<BTreeMap<String, Builds>> {
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
    let mut libraries = BTreeMap::new();
    for line in text.lines() {
        // Packages that were listed before end with a star.
        let line = line.trim_end_matches(" (*)").trim_end();
        let (name, features) = line.split_once(" with").unwrap_or((line, ""));
        libraries.entry(name.to_owned()).or_insert_with(Builds::new).insert(features.trim_start().to_owned());
    }
    Ok(libraries)
}
