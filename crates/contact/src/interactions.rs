//! Interactions of surfaces, shared out over ranks that run one model together.
//!
//! Each is computed by every rank that moves a node which it may push, as elements on a seam are: forces need
//! not be sent. One of these ranks, its *leader*, sends all others its results.

use stribeck_solver::{ranks::Shared, state::Moment};

/// Facets by which a foot may move along a surface between two searches, however fast it slides: it would
/// have to do so at a tenth of the speed of sound.
pub(crate) const REACH: usize = 16;

/// Pairs of surfaces, or films of oil.
pub trait Interactions {
    /// How many there are.
    fn count(&self) -> usize;

    /// Whether [`Interactions::look`] has to see all nodes of surfaces before this step.
    fn is_due(&self, step: u64) -> bool;

    /// Searches for interactions, as the next step would.
    fn look(&mut self, at: Moment<'_>);

    /// Adds the slots of all nodes that one may read or push until the next look; none where it does nothing.
    fn reach(&self, which: usize, at: Moment<'_>, slots: &mut Vec<u32>);

    /// About how long one took in the last step [ns].
    fn work(&self, which: usize) -> f64;

    /// Selects those that are computed here; [`Interactions::add_up`] is then called after every step.
    fn compute(&mut self, here: Vec<bool>);

    /// Length of the report of one after a step.
    fn report_length(&self) -> usize;

    /// Writes the report of one on the last step.
    fn report(&self, which: usize, to: &mut Shared);

    /// Takes a report over.
    fn hear(&mut self, which: usize, report: &[f64]);

    /// Counts the energies of the last step, once all is known.
    fn add_up(&mut self);

    /// States of the chosen ones.
    fn memories(&self, which: &[usize]) -> Vec<u8>;

    /// Restores their states from the rank that has computed them; false when they do not fit.
    fn remember(&mut self, which: &[usize], memories: &[u8]) -> bool;

    /// Slots of all nodes that [`Interactions::look`] reads.
    fn nodes(&self) -> Vec<u32>;
}

/// Vertices of the facets within [`REACH`] of those that are marked, on a surface with this number of facets.
pub(crate) fn within_reach(marked: &[bool], closed: bool, vertices: usize) -> impl Iterator<Item = usize> {
    let mut near = vec![false; vertices];
    for facet in (0..marked.len()).filter(|&facet| marked[facet]) {
        // On a closed surface a walk back by the reach is one forwards by the rest.
        let back = if closed { vertices.saturating_sub(REACH % vertices) } else { 0 };
        let first = if closed { facet + back } else { facet.saturating_sub(REACH) };
        let last = if closed { first + 2 * REACH + 1 } else { facet + REACH + 1 };
        (first..=last).filter(|&v| closed || v < vertices).for_each(|v| near[v % vertices] = true);
    }
    (0..vertices).filter(move |&vertex| near[vertex])
}

#[cfg(test)]
mod tests {
    use super::{REACH, within_reach};

    #[test]
    fn by_hand_facets_within_reach_go_round_a_closed_surface() {
        let mut marked = vec![false; 100];
        marked[3] = true;
        let near: Vec<usize> = within_reach(&marked, true, 100).collect();
        // Both ends of the facet, and as many further ones on either side.
        assert_eq!(near.len(), 2 * REACH + 2);
        assert!(
            near.contains(&(3 + REACH + 1))
                && near.contains(&(103 - REACH))
                && !near.contains(&(102 - REACH))
        );
        let near: Vec<usize> = within_reach(&marked[..99], false, 100).collect();
        assert_eq!(near, (0..=3 + REACH + 1).collect::<Vec<_>>());
        // All of a small one.
        assert_eq!(within_reach(&[false, true, false], true, 3).count(), 3);
    }
}
