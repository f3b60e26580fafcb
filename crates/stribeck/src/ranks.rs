//! Processes that run one scene together, where the program was built with the feature `mpi` and started by
//! `mpirun`.

use std::sync::Arc;

use stribeck_simulation::run::ranks::Ranks;

/// This process among those that were started with it.
#[derive(Debug)]
pub(crate) struct Processes {
    #[cfg(feature = "mpi")]
    mpi: Option<stribeck_mpi::Mpi>,
}

#[cfg(feature = "mpi")]
impl Processes {
    /// Meets the others; once a process.
    pub(crate) fn meet() -> Self {
        Self { mpi: stribeck_mpi::Mpi::begin() }
    }

    /// All of them, if there are several.
    pub(crate) fn ranks(&self) -> Option<Arc<dyn Ranks>> {
        self.mpi.as_ref().and_then(stribeck_mpi::Mpi::ranks)
    }

    /// Ends all other processes, too, with an exit code.
    pub(crate) fn abort(&self, code: u8) {
        if let Some(mpi) = &self.mpi {
            mpi.abort(code);
        }
    }
}

#[cfg(not(feature = "mpi"))]
impl Processes {
    /// Meets the others; once a process.
    pub(crate) fn meet() -> Self {
        Self {}
    }

    /// None: the program was built without MPI.
    pub(crate) fn ranks(&self) -> Option<Arc<dyn Ranks>> {
        None
    }

    /// There are no others.
    pub(crate) fn abort(&self, _code: u8) {}
}
