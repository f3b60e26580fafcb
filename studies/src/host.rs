//! Interface of a study to the program that runs it.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Result;
use stribeck_scene::scene::Scene;
use stribeck_store::run_info::RunInfo;

/// One run of a study.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// Scene to run.
    pub scene: &'a Scene,
    /// Where its files go.
    pub folder: &'a Path,
    /// The folder holds the beginning of this run: it is continued.
    pub begun: bool,
    /// Worker threads; `None` for all cores.
    pub threads: Option<usize>,
    /// No other run is going: its progress may be shown.
    pub alone: bool,
}

/// The program around a study: it runs scenes, has a clock and prints.
pub trait Host: Sync {
    /// Root of the repository: scenes are read below it, runs and pages are written below it.
    fn root(&self) -> &Path;

    /// Runs a scene to its end, or until the user interrupts.
    ///
    /// # Errors
    /// When it cannot be run; one that diverges is no error.
    fn run(&self, job: &Job<'_>) -> Result<RunInfo>;

    /// The program `stribeck`, for studies of whole processes.
    ///
    /// # Errors
    /// When it cannot be found.
    fn stribeck(&self) -> Result<Command>;

    /// Seconds since some moment.
    fn seconds(&self) -> f64;

    /// Whether the user wants to stop.
    fn is_interrupted(&self) -> bool;

    /// Prints the progress of the study in one line.
    fn say(&self, line: &str);
}

/// Result of a study.
#[derive(Debug, Clone, Default)]
pub struct Answer {
    /// The answer in a sentence, for studies that have one.
    pub said: Option<String>,
    /// The page that was written.
    pub page: Option<PathBuf>,
    /// Errors in the studied cases that are failures of the program.
    pub failure: Option<String>,
}

impl Answer {
    /// An answer that is all on its page.
    pub(crate) fn on(page: PathBuf) -> Self {
        Self { page: Some(page), ..Self::default() }
    }
}
