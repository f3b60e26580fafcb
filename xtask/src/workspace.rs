//! Where things are, from whatever folder the command was given.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result, bail};

/// The root of the repository.
pub(crate) fn root() -> PathBuf {
    // Cargo tells a running program where its package lies now; the compiled-in path is for a binary started by hand.
    let package = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    let package = PathBuf::from(package);
    package.parent().map_or_else(|| package.clone(), Path::to_owned)
}

/// The scene that is run when none is named.
pub(crate) fn default_scene() -> PathBuf {
    root().join("fixtures/scenes/singh2014.ron")
}

/// The folder of all runs.
pub(crate) fn runs() -> PathBuf {
    root().join("runs")
}

/// `path` as the user wrote it when that exists, else the same path below the repository's root.
pub(crate) fn locate(path: &Path) -> PathBuf {
    let below_root = root().join(path);
    if !path.exists() && below_root.exists() { below_root } else { path.to_owned() }
}

/// The folder of a run, given as a path or by its name below `runs/`.
pub(crate) fn locate_run(run: &Path) -> PathBuf {
    let by_name = runs().join(run);
    if !run.exists() && by_name.exists() { by_name } else { locate(run) }
}

/// The run in `folder` whose `run.json` was written last.
pub(crate) fn newest_run(folder: &Path) -> Result<PathBuf> {
    let advice = "start one with `cargo xtask simulate`, or name a run's folder";
    let entries =
        std::fs::read_dir(folder).with_context(|| format!("no runs in `{}`: {advice}", folder.display()))?;
    let written =
        |path: &Path| -> Option<SystemTime> { path.join("run.json").metadata().ok()?.modified().ok() };
    let runs = entries.flatten().filter_map(|entry| Some((written(&entry.path())?, entry.path())));
    match runs.max() {
        Some((_, path)) => Ok(path),
        None => bail!("no runs in `{}`: {advice}", folder.display()),
    }
}

/// `path` relative to the current folder when it lies below it: shorter to read and to copy.
pub(crate) fn shown(path: &Path) -> String {
    let below =
        std::env::current_dir().ok().and_then(|here| path.strip_prefix(here).ok().map(Path::to_owned));
    below.unwrap_or_else(|| path.to_owned()).display().to_string()
}
