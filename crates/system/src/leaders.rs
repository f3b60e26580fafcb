//! The leader of each interaction: the rank that reports it.

use stribeck_solver::ranks::Shared;

/// The shares of all ranks, as each rank has them.
#[derive(Debug, Default)]
pub(crate) struct Division {
    /// The leader of each interaction, kind by kind.
    pub(crate) leaders: Vec<Vec<usize>>,
    /// Slots that the forces of every rank read: of loads and of the user's laws.
    pub(crate) everywhere: Vec<u32>,
    pub(crate) shared: Shared,
    /// Step before which the whole state was last gathered.
    pub(crate) gathered: Option<u64>,
}
