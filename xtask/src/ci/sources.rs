//! Where the code lies.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// All Rust files below `folder`, sorted.
pub(crate) fn rust_files(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries =
            std::fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Names of the folders in `crates/`, sorted.
pub(crate) fn crates(root: &Path) -> Result<Vec<String>> {
    let folder = root.join("crates");
    let entries = std::fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut names: Vec<String> = entries
        .flatten()
        .filter(|entry| entry.path().join("Cargo.toml").is_file())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    Ok(names)
}

/// Folders of all packages, from the root: those in `crates/`, and what only the development uses.
pub(crate) fn folders(root: &Path) -> Result<Vec<String>> {
    let development = ["studies", "xtask"].map(str::to_owned);
    Ok(crates(root)?.iter().map(|name| format!("crates/{name}")).chain(development).collect())
}
