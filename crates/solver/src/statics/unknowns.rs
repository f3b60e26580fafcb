//! What is solved for, and in which order it is eliminated.

use super::graph::Graph;
use crate::dynamics::Dynamics;

/// Stands for a slot that does not move.
const FIXED: u32 = u32::MAX;

/// Nodes that may move, two equations each; a held component has one of its own that says nothing.
pub(super) struct Unknowns {
    /// Their slots, in the order of elimination.
    pub(super) slots: Vec<u32>,
    /// Which of (x, y) may move.
    pub(super) free: Vec<[bool; 2]>,
    /// Position in `slots` of each slot.
    index: Vec<u32>,
}

impl Unknowns {
    pub(super) fn new(d: &Dynamics) -> Self {
        let slots: Vec<u32> = d.elastic_slots().into_iter().map(|slot| slot as u32).collect();
        Self::of_slots(d, &slots)
    }

    /// Those of these slots that may move.
    pub(super) fn of_slots(d: &Dynamics, slots: &[u32]) -> Self {
        let moves = |slot: &u32| d.free_components(*slot as usize) != [false; 2];
        let slots: Vec<u32> = slots.iter().copied().filter(moves).collect();
        let free = slots.iter().map(|&slot| d.free_components(slot as usize)).collect();
        let mut unknowns = Self { slots, free, index: vec![FIXED; d.state.x.len()] };
        unknowns.number();
        unknowns
    }

    fn number(&mut self) {
        for (i, &slot) in self.slots.iter().enumerate() {
            self.index[slot as usize] = i as u32;
        }
    }

    /// Position of a slot among the unknowns, if it may move.
    pub(super) fn of(&self, slot: u32) -> Option<usize> {
        Some(self.index[slot as usize]).filter(|&i| i != FIXED).map(|i| i as usize)
    }

    /// Nodes that share an element or appear in one of `couplings`, pairs of slots.
    pub(super) fn graph(&self, d: &Dynamics, couplings: &[[u32; 2]]) -> Graph {
        let elements = d.elements();
        let quads = elements
            .quads
            .iter()
            .flat_map(|([a, b, c, e], _)| [[*a, *b], [*a, *c], [*a, *e], [*b, *c], [*b, *e], [*c, *e]]);
        let triangles = elements.triangles.iter().flat_map(|([a, b, c], _)| [[*a, *b], [*a, *c], [*b, *c]]);
        let pairs = quads.chain(triangles).chain(couplings.iter().copied());
        Graph::new(
            self.slots.len(),
            pairs.filter_map(|[a, b]| Some([self.of(a)? as u32, self.of(b)? as u32])),
        )
    }

    /// Takes the order of elimination that gives little fill in a matrix of this graph.
    pub(super) fn reorder(&mut self, d: &Dynamics, graph: &Graph) {
        let place = |&slot: &u32| [d.state.x[slot as usize], d.state.y[slot as usize]];
        let places: Vec<[f64; 2]> = self.slots.iter().map(place).collect();
        let order = graph.dissect(&places);
        self.slots = order.iter().map(|&i| self.slots[i as usize]).collect();
        self.free = order.iter().map(|&i| self.free[i as usize]).collect();
        self.number();
    }
}
