//! Errors of this crate.

/// Errors of a system of bodies.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error("solver: {0}")]
    Solver(#[from] stribeck_solver::Error),

    #[error("contact: {0}")]
    Contact(#[from] stribeck_contact::Error),

    #[error("there is no {kind} `{name}`; there are: {known}")]
    UnknownName { kind: &'static str, name: String, known: String },

    #[error("the name `{name}` is given twice: give bodies, surfaces and loads names of their own")]
    TwiceNamed { name: String },

    #[error("{what} names node {node}, and the mesh has {nodes} nodes")]
    UnknownNode { what: String, node: u32, nodes: usize },

    #[error(
        "no time step is set: call `set_time_step_factor` (0.9 of the critical step is usual) or \
         `set_time_step` first"
    )]
    NoTimeStep,

    #[error(
        "a force acts on a node of `{body}` at x = {x_mm:.3} mm, y = {y_mm:.3} mm that no force announced: \
         name it in the nodes of `Plan::force`"
    )]
    UnannouncedForce {
        body: String,
        /// Where [mm].
        x_mm: f64,
        /// Where [mm].
        y_mm: f64,
    },

    #[error("the snapshot belongs to another system: {what} differ")]
    OtherSystem { what: &'static str },

    #[error("cannot start {threads} worker threads: {source}. Try fewer")]
    Threads { threads: usize, source: std::io::Error },
}
