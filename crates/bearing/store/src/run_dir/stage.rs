//! Named states of a run or an ensemble, and what makes the next.

use std::path::Path;

use super::{CHECKPOINT, ENSEMBLE, Ensemble, INFO, REPORT, SUMMARY, TRACE, files, replacement};
use crate::run_info::Status;
use stribeck_scene::ensemble::folder_name;

/// How far a run has come on its way from a scene to a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// There is a scene, and nothing to continue from.
    Planned,
    /// Begun, and not at its end: going on, interrupted or killed.
    Running,
    /// Stopped by a guard, without its report.
    Diverged,
    /// At its end, without its report, or not yet in the place of the run that it replaces.
    Complete,
    /// At its end, with its report: `summary.json`, which is written last, and the page.
    Reported,
}

impl Stage {
    /// Of the run or the ensemble in `folder`.
    pub fn of(folder: &Path) -> Self {
        let there = |name: &str| folder.join(name).exists();
        let reported = there(SUMMARY) && (there(REPORT) || !there(TRACE) && !there(ENSEMBLE));
        match Self::of_steps(folder) {
            Self::Complete if replacement::marked(folder).is_none() && reported => Self::Reported,
            Self::Diverged if reported => Self::Reported,
            so_far => so_far,
        }
    }

    /// The same, whatever is there of a report.
    fn of_steps(folder: &Path) -> Self {
        if folder.join(ENSEMBLE).exists() {
            let ensemble: Option<Ensemble> = files::read_json(&folder.join(ENSEMBLE)).ok();
            let at_end = |number: usize| {
                matches!(Self::of_steps(&folder.join(folder_name(number))), Self::Complete | Self::Diverged)
            };
            let all =
                ensemble.is_some_and(|e| (1..=e.starts).all(|n| e.failed.contains_key(&n) || at_end(n)));
            return if all { Self::Complete } else { Self::Running };
        }
        match files::read_info(&folder.join(INFO)).map(|info| info.status) {
            Ok(Status::Complete) => Self::Complete,
            Ok(Status::Diverged) => Self::Diverged,
            _ if folder.join(CHECKPOINT).exists() => Self::Running,
            _ => Self::Planned,
        }
    }

    /// In a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Planned => "planned",
            Self::Running => "running",
            Self::Diverged => "diverged",
            Self::Complete => "complete",
            Self::Reported => "reported",
        }
    }

    /// Arguments of the program that make the next state of the run in `folder`; none for the last one.
    pub fn next(self, folder: &Path) -> Option<String> {
        let shown = folder.display();
        match self {
            Self::Planned => Some(format!("simulate {} --out {shown}", folder.join(super::SCENE).display())),
            Self::Complete if replacement::marked(folder).is_none() => Some(format!("report {shown}")),
            Self::Running | Self::Complete => Some(format!("simulate --resume {shown}")),
            Self::Diverged => Some(format!("report {shown}")),
            Self::Reported => None,
        }
    }
}
