//! Which rank speaks for what.

use stribeck_solver::ranks::Shared;

/// What one rank knows of the shares of all.
#[derive(Debug, Default)]
pub(crate) struct Division {
    /// The rank that speaks for each interaction, kind by kind.
    pub(crate) leaders: Vec<Vec<usize>>,
    /// Slots that the forces of every rank read: of loads and of the user's laws.
    pub(crate) everywhere: Vec<u32>,
    pub(crate) shared: Shared,
    /// Step before which the whole state was last gathered.
    pub(crate) gathered: Option<u64>,
}
