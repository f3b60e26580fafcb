//! The library of an FMU: `crates/apps/fmu`, compiled for this machine.

use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::workspace;

/// Its manifest, outside the workspace.
pub(crate) const MANIFEST: &str = "crates/apps/fmu/Cargo.toml";

/// The command of the program, with a library that is built before it where it makes an FMU.
pub(crate) fn with_library(command: stribeck::Command) -> Result<stribeck::Command> {
    Ok(match command {
        stribeck::Command::Fmu(options) => stribeck::Command::Fmu(options.with_library(library()?)),
        other => other,
    })
}

/// The shared library, built beside the program.
fn library() -> Result<PathBuf> {
    let root = workspace::root();
    let folder = workspace::target();
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(&root).args(["build", "--quiet", "--release", "--lib", "--manifest-path", MANIFEST]);
    let done = cargo.arg("--target-dir").arg(&folder).status().context("cannot start cargo")?;
    ensure!(
        done.success(),
        "the library of the FMU cannot be built. Its bindings to FMI are made with libclang: `apt-get \
         install libclang-dev` on Debian"
    );
    let name = format!("{}stribeck_fmu{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    Ok(folder.join("release").join(name))
}
