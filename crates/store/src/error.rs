//! The error type of this crate.

use std::path::PathBuf;

use stribeck_scene::ensemble::folder_name;
use stribeck_scene::scene_file::SceneError;

/// Everything that can go wrong with the folder of a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene of the run cannot be read or describes something impossible.
    #[error(transparent)]
    Scene(#[from] SceneError),

    /// The system refused to read or write a file.
    #[error("cannot {action} `{}`: {source}. {kept}", path.display())]
    Io {
        /// Operation that failed: `create`, `write`, `read` …
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// Files that remain readable, and the remedy.
        kept: String,
        /// The system's answer.
        source: std::io::Error,
    },

    /// A file is not the trace it should be.
    #[error("`{}` is not a readable trace: {message}", path.display())]
    Trace {
        /// The file.
        path: PathBuf,
        /// Problem and remedy.
        message: String,
    },

    /// A file is not the mesh of a run, or not all of it.
    #[error("`{}` is not a mesh that can be read again: {message}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// Problem.
        message: String,
    },

    /// The folder for a run, or for a result made from runs, holds something else.
    #[error(
        "`{}` holds files of something else (for example `{found}`), and what is written there would mix \
         with them. Try another folder with --out, or empty this one",
        path.display()
    )]
    ForeignFolder {
        /// The folder.
        path: PathBuf,
        /// One of the foreign files.
        found: String,
    },

    /// An earlier run left samples in the folder for a run, or for a result made from runs.
    #[error(
        "`{}` holds {found}, which is kept. You can {}choose another folder with --out, such as `{}`",
        path.display(), or(ways), free.display()
    )]
    FolderHoldsRun {
        /// The folder.
        path: PathBuf,
        /// Description of that run.
        found: String,
        /// Ways to proceed, in words; none where the folder was not meant for a run.
        ways: Vec<String>,
        /// A folder of a similar name that is not there.
        free: PathBuf,
    },

    /// Another process is writing this run.
    #[error("`{}` is being written by another run (process {owner}). Wait for it, or choose another folder \
        with --out", path.display())]
    FolderInUse {
        /// The folder.
        path: PathBuf,
        /// Process number of the other run, as it wrote it down.
        owner: String,
    },

    /// A folder that should hold a run does not.
    #[error("`{}` is not a run of Stribeck: `{missing}` is missing. Name the folder of a run, such as those \
        below `runs/`", path.display())]
    NotARun {
        /// The folder.
        path: PathBuf,
        /// The first file that was looked for in vain.
        missing: &'static str,
    },

    /// The folder of an ensemble, where that of one run is wanted.
    #[error(
        "`{}` is an ensemble, and each of its {starts} starts is a run: name one of them, such as `{}`",
        path.display(), path.join(folder_name(1)).display()
    )]
    Ensemble {
        /// The folder.
        path: PathBuf,
        /// Starts that are there.
        starts: usize,
    },

    /// `scene.ron` is not the scene that was simulated.
    #[error(
        "`scene.ron` in `{}` was changed after the run: it is the scene {found}, and `run.json` names \
         {expected}. Put the run's own `scene.ron` back, or simulate the changed one anew",
        path.display()
    )]
    OtherScene {
        /// The folder of the run.
        path: PathBuf,
        /// Hash of the scene that lies there.
        found: String,
        /// Hash of the scene that was simulated.
        expected: String,
    },

    /// `run.json` cannot be understood.
    #[error("`{}` cannot be understood: {source}. Repeat the run, or restore the file", path.display())]
    RunInfo {
        /// The file.
        path: PathBuf,
        /// Problem, with line and column.
        source: serde_json::Error,
    },
}

/// Ways to go before the last one.
fn or(ways: &[String]) -> String {
    if ways.is_empty() { String::new() } else { ways.join(", ") + ", or " }
}
