//! Remains of an earlier run in a folder. Samples are worth keeping, however the run ended.

use std::path::Path;

use super::ensemble::Ensemble;
use super::{CHECKPOINT, ENSEMBLE, INFO, SUMMARY, TRACE, files};
use crate::run_info::{RunInfo, Status};
use crate::trace::TraceFile;

/// A run that holds samples, or an ensemble of them.
#[derive(Debug)]
pub(super) enum Earlier {
    Run {
        /// Content of `run.json`; `None` when it cannot be read.
        info: Option<Box<RunInfo>>,
        /// It has a checkpoint to go on from.
        can_go_on: bool,
    },
    Ensemble {
        /// Number of starts requested; `None` when `ensemble.json` cannot be read.
        wanted: Option<usize>,
        /// Starts that have come to their end.
        ended: usize,
    },
}

impl Earlier {
    /// The run in `folder`, if there is one with samples.
    pub(super) fn of(folder: &Path) -> Option<Self> {
        if folder.join(ENSEMBLE).exists() {
            let starts: Vec<Self> = files::start_folders(folder).iter().filter_map(|f| Self::of(f)).collect();
            let read: Option<Ensemble> = files::read_json(&folder.join(ENSEMBLE)).ok();
            let ended = starts.iter().filter(|start| start.has_ended()).count();
            return (!starts.is_empty()).then(|| Self::Ensemble { wanted: read.map(|e| e.starts), ended });
        }
        // A trace that cannot be read may be worth a lot to its owner; one that is not there is not, unless
        // its numbers are.
        let there = |name: &str| folder.join(name).exists();
        let samples = TraceFile::open(folder.join(TRACE)).map_or(1, |trace| trace.len());
        let numbers = !there(TRACE) && there(SUMMARY) && there(INFO);
        (numbers || there(TRACE) && samples > 0).then(|| Self::Run {
            info: files::read_info(&folder.join(INFO)).ok().map(Box::new),
            can_go_on: folder.join(CHECKPOINT).exists(),
        })
    }

    fn has_ended(&self) -> bool {
        let Self::Run { info: Some(info), .. } = self else { return false };
        matches!(info.status, Status::Complete | Status::Diverged)
    }

    pub(super) fn name(&self) -> String {
        let info = match self {
            Self::Ensemble { wanted: Some(wanted), ended } => {
                return format!("an ensemble with {ended} of {wanted} starts at their end");
            }
            Self::Ensemble { wanted: None, .. } => {
                return "an ensemble whose `ensemble.json` cannot be read".to_owned();
            }
            Self::Run { info: None, .. } => return "a run whose `run.json` cannot be read".to_owned(),
            Self::Run { info: Some(info), .. } => info,
        };
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
        let status = match self {
            Self::Ensemble { wanted, ended } => {
                return wanted.map(|wanted| match *ended < wanted {
                    true => format!("continue it with `--resume {folder}`"),
                    false => format!("add starts with `--resume {folder} --starts …`"),
                });
            }
            Self::Run { can_go_on: false, .. } => return None,
            Self::Run { info, .. } => info.as_ref().map(|info| info.status),
        };
        match status {
            Some(Status::Complete) => {
                Some(format!("make it longer with `--resume {folder} --set solver.duration_ms=…`"))
            }
            Some(Status::Diverged) => None,
            _ => Some(format!("continue it with `--resume {folder}`")),
        }
    }
}
