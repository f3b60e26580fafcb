//! The error type of this crate.

/// Everything that can go wrong between a scene and a bearing under its preload.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene cannot be read, or is impossible.
    #[error(transparent)]
    Scene(#[from] stribeck_scene::scene_file::SceneError),

    /// The scene has no static load distribution.
    #[error(transparent)]
    Theory(#[from] stribeck_theory::Error),

    /// The bodies cannot be meshed.
    #[error("mesh: {0}")]
    Mesh(#[from] stribeck_mesh::Error),

    /// The file of a housing or a ring is not one that the bearing fits.
    #[error("`{field}` `{file}`: {what}")]
    MeshFile {
        /// The field that names it.
        field: String,
        /// Its name in the scene.
        file: String,
        /// Problem, and the names that exist.
        what: String,
    },

    /// The model cannot be solved.
    #[error("solver: {0}")]
    Solver(#[from] stribeck_solver::Error),

    /// Contact cannot be set up.
    #[error("contact: {0}")]
    Contact(#[from] stribeck_contact::Error),

    /// The bodies cannot be set in motion.
    #[error("system: {0}")]
    System(stribeck_system::Error),

    /// The operating system provides no threads.
    #[error("cannot start {threads} worker threads: {source}. Try fewer with --threads")]
    Threads {
        /// Number of threads requested.
        threads: usize,
        /// The system's answer.
        source: std::io::Error,
    },
}

impl From<stribeck_system::Error> for Error {
    fn from(error: stribeck_system::Error) -> Self {
        match error {
            stribeck_system::Error::Solver(error) => Self::Solver(error),
            stribeck_system::Error::Contact(error) => Self::Contact(error),
            stribeck_system::Error::Threads { threads, source } => Self::Threads { threads, source },
            other => Self::System(other),
        }
    }
}
