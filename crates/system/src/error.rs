//! Errors of this crate.

/// Errors of a system of bodies.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The model cannot be solved.
    #[error("solver: {0}")]
    Solver(#[from] stribeck_solver::Error),

    /// Contact cannot be set up.
    #[error("contact: {0}")]
    Contact(#[from] stribeck_contact::Error),

    /// A name that nothing carries.
    #[error("there is no {kind} `{name}`; there are: {known}")]
    UnknownName {
        /// Kind of thing: a body, a surface, a load …
        kind: &'static str,
        /// The name given.
        name: String,
        /// The names that there are.
        known: String,
    },

    /// A name that is taken.
    #[error("the name `{name}` is given twice: give bodies, surfaces and loads names of their own")]
    TwiceNamed {
        /// The name given.
        name: String,
    },

    /// A node number beyond the mesh.
    #[error("{what} names node {node}, and the mesh has {nodes} nodes")]
    UnknownNode {
        /// The thing that refers to it.
        what: String,
        /// The number given.
        node: u32,
        /// Nodes of the mesh.
        nodes: usize,
    },

    /// A step without a time step.
    #[error(
        "no time step is set: call `set_time_step_factor` (0.9 of the critical step is usual) or \
         `set_time_step` first"
    )]
    NoTimeStep,

    /// A force was laid on a node that its law had not announced; the solver has not read it.
    #[error(
        "a force acts on a node of `{body}` at x = {x_mm:.3} mm, y = {y_mm:.3} mm that no force announced: \
         name it in the nodes of `Plan::force`"
    )]
    UnannouncedForce {
        /// Body of the node.
        body: String,
        /// Where [mm].
        x_mm: f64,
        /// Where [mm].
        y_mm: f64,
    },

    /// A snapshot of other bodies, contacts or loads.
    #[error("the snapshot belongs to another system: {what} differ")]
    OtherSystem {
        /// The difference.
        what: &'static str,
    },

    /// The operating system provides no threads.
    #[error("cannot start {threads} worker threads: {source}. Try fewer")]
    Threads {
        /// Number of threads requested.
        threads: usize,
        /// The operating system's answer.
        source: std::io::Error,
    },
}
