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

/// Folders of the packages below `crates/`, one or two levels down, from the root, sorted.
pub(crate) fn crates(root: &Path) -> Result<Vec<String>> {
    let mut found = Vec::new();
    let mut folders = vec!["crates".to_owned()];
    while let Some(folder) = folders.pop() {
        let entries =
            std::fs::read_dir(root.join(&folder)).with_context(|| format!("cannot read {folder}"))?;
        for entry in entries.flatten().filter(|entry| entry.path().is_dir()) {
            let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
            let list = if entry.path().join("Cargo.toml").is_file() { &mut found } else { &mut folders };
            // Below `crates/` are layers, below those packages.
            if name.matches('/').count() <= 2 {
                list.push(name);
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Folders that hold all packages, from the root.
pub(crate) const FOLDERS: [&str; 2] = ["crates", "xtask"];
