//! What an earlier run has left in a folder. Samples are worth keeping, however the run ended.

use std::path::Path;

use super::{CHECKPOINT, INFO, TRACE, files};
use crate::run_info::{RunInfo, Status};
use crate::trace::Trace;

/// A run that holds samples.
#[derive(Debug)]
pub(super) struct Earlier {
    /// What `run.json` says; `None` when it cannot be read.
    info: Option<RunInfo>,
    /// It has a checkpoint to go on from.
    can_go_on: bool,
}

impl Earlier {
    /// The run in `folder`, if there is one with samples.
    pub(super) fn of(folder: &Path) -> Option<Self> {
        // A trace that cannot be read may be worth a lot to its owner; one that is not there is not.
        let samples = Trace::count(folder.join(TRACE)).unwrap_or(1);
        (folder.join(TRACE).exists() && samples > 0).then(|| Self {
            info: files::read_info(&folder.join(INFO)).ok(),
            can_go_on: folder.join(CHECKPOINT).exists(),
        })
    }

    /// What it is.
    pub(super) fn name(&self) -> String {
        let Some(info) = &self.info else { return "a run whose `run.json` cannot be read".to_owned() };
        // To the nanosecond, so that it reads as it was written.
        let ms = |samples: f64| (1e9 * info.interval_s * samples).round() / 1e6;
        let per_sample = (info.interval_s / info.time_step_s).round();
        let (done, planned) = (ms(info.samples as f64), ms(info.steps_planned as f64 / per_sample));
        match info.status {
            Status::Complete => format!("a complete run of {done} ms"),
            Status::Diverged => format!("a run that diverged after {done} ms"),
            Status::Running | Status::Interrupted => {
                format!("a run that ended early, after {done} of {planned} ms")
            }
        }
    }

    /// How to go on with it, if that is possible.
    pub(super) fn way_on(&self, folder: &Path) -> Option<String> {
        let folder = folder.display();
        let status = self.info.as_ref().map(|info| info.status);
        self.can_go_on.then_some(())?;
        match status {
            Some(Status::Complete) => {
                Some(format!("make it longer with `--resume {folder} --set solver.duration_ms=…`"))
            }
            Some(Status::Diverged) => None,
            _ => Some(format!("continue it with `--resume {folder}`")),
        }
    }
}
