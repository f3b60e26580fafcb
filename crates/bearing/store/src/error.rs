//! The error type of this crate.

use std::path::PathBuf;

use stribeck_scene::ensemble::folder_name;
use stribeck_scene::scene_file::SceneError;

/// Everything that can go wrong with the folder of a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error(transparent)]
    Scene(#[from] SceneError),

    #[error("cannot {action} `{}`: {source}. {kept}", path.display())]
    Io {
        /// Operation that failed: `create`, `write`, `read` …
        action: &'static str,
        path: PathBuf,
        kept: String,
        source: std::io::Error,
    },

    #[error("`{}` is not a readable trace: {message}", path.display())]
    Trace { path: PathBuf, message: String },

    #[error("`{}` is not a mesh that can be read again: {message}", path.display())]
    Mesh { path: PathBuf, message: String },

    #[error(
        "`{}` holds files of something else (for example `{found}`), and what is written there would mix \
         with them. Try another folder with --out, or empty this one",
        path.display()
    )]
    ForeignFolder { path: PathBuf, found: String },

    #[error(
        "`{}` holds {found}, which is kept. You can {}choose another folder with --out, such as `{}`",
        path.display(), or(ways), free.display()
    )]
    FolderHoldsRun { path: PathBuf, found: String, ways: Vec<String>, free: PathBuf },

    #[error("`{}` is being written by another run (process {owner}). Wait for it, or choose another folder \
        with --out", path.display())]
    FolderInUse { path: PathBuf, owner: String },

    #[error("`{}` is not a run of Stribeck: `{missing}` is missing. Name the folder of a run, such as those \
        below `runs/`", path.display())]
    NotARun { path: PathBuf, missing: &'static str },

    #[error("`{}` has a scene, and no `run.json`: its run ended before that was written. `stribeck {next}` \
        brings it on", path.display())]
    Unfinished { path: PathBuf, next: String },

    #[error(
        "`{}` is an ensemble, and each of its {starts} starts is a run: name one of them, such as `{}`",
        path.display(), path.join(folder_name(1)).display()
    )]
    Ensemble { path: PathBuf, starts: usize },

    #[error(
        "`scene.ron` in `{}` was changed after the run: it is the scene {found}, and `run.json` names \
         {expected}. Put the run's own `scene.ron` back, or simulate the changed one anew",
        path.display()
    )]
    OtherScene { path: PathBuf, found: String, expected: String },

    #[error("`{}` cannot be understood: {source}. Repeat the run, or restore the file", path.display())]
    RunInfo { path: PathBuf, source: serde_json::Error },
}

/// Ways to go before the last one.
fn or(ways: &[String]) -> String {
    if ways.is_empty() { String::new() } else { ways.join(", ") + ", or " }
}
