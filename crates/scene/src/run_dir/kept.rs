//! What stays of a run whose samples take more room than its owner has.

use std::path::PathBuf;

use serde::Deserialize;

use super::{CHECKPOINT, ENERGY, FRAMES, MESH, PARTIAL, RunDir, SIGNALS, TRACE, files};
use crate::error::Error;
use crate::trace::TraceFile;

/// Names of the channels of sensors begin with it.
pub const SENSOR: &str = "sensor.";

/// What stays of a run when its numbers are made. Scene, provenance and numbers always do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename = "keep", rename_all = "snake_case")]
pub enum Keep {
    /// Everything.
    #[default]
    All,
    /// Of its samples the channels of sensors.
    Signals,
    /// No sample.
    Numbers,
}

impl RunDir {
    /// Channels of sensors, where the trace was not kept.
    pub fn signals(&self) -> PathBuf {
        self.path.join(SIGNALS)
    }

    /// Whether the trace is gone, which goes last, and what `keep` names of its samples is there.
    pub fn keeps_only(&self, keep: Keep) -> bool {
        match keep {
            Keep::All => true,
            Keep::Signals => !self.trace().exists() && self.signals().exists(),
            Keep::Numbers => !self.trace().exists(),
        }
    }

    /// Removes what `keep` does not name of a run that has come to its end: samples, energy ledger, mesh,
    /// frames and checkpoint. Nothing is removed before the channels of sensors lie in a file of their own,
    /// where they are kept; and the trace goes last, so that after a kill it can be done once more.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] or [`Error::Trace`] when the trace cannot be read, the disk refuses or a file cannot be
    /// removed.
    pub fn keep_only(&self, keep: Keep) -> Result<(), Error> {
        if self.keeps_only(keep) {
            return Ok(());
        }
        if keep == Keep::Signals {
            let beside = self.path.join(format!("{SIGNALS}{PARTIAL}"));
            TraceFile::open(self.trace())?
                .copy(&beside, |name| name == "time_s" || name.starts_with(SENSOR))?;
            files::rename(&beside, &self.signals())?;
        }
        files::remove_folder(&self.path, FRAMES)?;
        [CHECKPOINT, MESH, ENERGY, TRACE].iter().try_for_each(|name| files::remove(&self.path.join(name)))
    }
}
