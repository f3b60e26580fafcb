//! A run as a report reads it.

use std::path::Path;

use super::{ENERGY, RunDir, TRACE};
use crate::error::Error;
use crate::run_info::RunInfo;
use crate::trace::TraceFile;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::Scene;

/// A run as a report reads it.
#[derive(Debug)]
pub struct Run {
    /// The complete scene, in SI.
    pub scene: ResolvedScene,
    /// Provenance, sizes and cost.
    pub info: RunInfo,
    /// Sampled channels, on disk.
    pub trace: TraceFile,
    /// Sampled energy ledger, on disk.
    pub energy: TraceFile,
}

impl Run {
    /// Samples that `run.json` counts and the files do not hold, in words.
    pub fn damage(&self) -> Vec<String> {
        let wanted = self.info.samples;
        let short = |(name, found): (&str, usize)| {
            (found < wanted).then(|| {
                format!(
                    "`{name}` holds {found} of the {wanted} samples that the run wrote: it was cut off. \
                    Restore it, or repeat the run"
                )
            })
        };
        [(TRACE, self.trace.len()), (ENERGY, self.energy.len())].into_iter().filter_map(short).collect()
    }

    /// Refuses a run whose `scene.ron` differs from the simulated scene.
    pub fn check_scene(&self, path: &Path) -> Result<(), Error> {
        let (found, expected) = (self.scene.written.hash(), &self.info.scene_hash);
        if found == *expected {
            return Ok(());
        }
        Err(Error::OtherScene { path: path.to_owned(), found, expected: expected.clone() })
    }

    /// Reads the run in the folder `path`, also one that was interrupted, killed or is still going. Its
    /// samples stay on disk until they are read.
    ///
    /// # Errors
    ///
    /// [`Error::NotARun`], or the error of the first file that cannot be read.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let dir = RunDir::open(path)?;
        Ok(Self {
            scene: Scene::read(dir.scene())?.resolve(),
            info: dir.read_info()?,
            trace: TraceFile::open(dir.trace())?,
            energy: TraceFile::open(dir.energy())?,
        })
    }
}
