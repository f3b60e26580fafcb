//! Choice of the files that are kept of a run, to save disk space.

use std::path::PathBuf;

use stribeck_scene::fields::words;

use super::{CHECKPOINT, ENERGY, FRAMES, MACHINE, MESH, PARTIAL, RunDir, SIGNALS, TRACE, files};
use crate::error::Error;
use crate::trace::TraceFile;

/// Names of the channels of sensors begin with it.
pub const SENSOR: &str = "sensor.";

words! {
    /// Files that are kept of a run once its summary exists. Scene, provenance and summary always are.
    pub enum Keep: Copy, Eq, PartialOrd, Ord {
        /// Everything.
        All = "all",
        /// Of its samples the channels of sensors; of a run with a machine those of its sensor alone.
        Signals = "signals",
        /// No sample.
        Numbers = "numbers",
    }
}

impl Keep {
    /// All of them, what keeps more first.
    pub const ALL: [Self; 3] = [Self::All, Self::Signals, Self::Numbers];

    /// As files and flags have it.
    pub fn word(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Signals => "signals",
            Self::Numbers => "numbers",
        }
    }
}

impl RunDir {
    /// Channels of sensors, where the trace was not kept.
    pub fn signals(&self) -> PathBuf {
        self.path.join(SIGNALS)
    }

    /// The record of the machine's sensor, where the scene has a machine.
    pub fn machine(&self) -> PathBuf {
        self.path.join(MACHINE)
    }

    /// Whether the trace, which is removed last, is gone and the samples that `keep` names are there.
    pub fn keeps_only(&self, keep: Keep) -> bool {
        match keep {
            Keep::All => true,
            Keep::Signals => !self.trace().exists() && (self.machine().exists() || self.signals().exists()),
            Keep::Numbers => !self.trace().exists(),
        }
    }

    /// Removes the files of a finished run that `keep` does not name: samples, energy ledger, mesh, frames
    /// and checkpoint. Nothing is removed before the channels of sensors lie in a file of their own, where
    /// they are kept; and the trace goes last, so that a removal that was killed can be repeated.
    ///
    /// # Errors
    ///
    /// [`Error::Io`] or [`Error::Trace`] when the trace cannot be read, the disk refuses or a file cannot be
    /// removed.
    pub fn keep_only(&self, keep: Keep) -> Result<(), Error> {
        if self.keeps_only(keep) {
            return Ok(());
        }
        // The sensor of a machine is the one that there is.
        if keep == Keep::Signals && !self.machine().exists() {
            let beside = self.path.join(format!("{SIGNALS}{PARTIAL}"));
            TraceFile::open(self.trace())?
                .copy(&beside, |name| name == "time_s" || name.starts_with(SENSOR))?;
            files::rename(&beside, &self.signals())?;
        }
        if keep == Keep::Numbers {
            files::remove(&self.path.join(MACHINE))?;
        }
        files::remove_folder(&self.path, FRAMES)?;
        [CHECKPOINT, MESH, ENERGY, TRACE].iter().try_for_each(|name| files::remove(&self.path.join(name)))
    }
}
