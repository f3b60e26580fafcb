//! The unknowns, and the order in which they are eliminated.

use std::ops::Range;

use super::graph::Graph;
use crate::dynamics::Dynamics;

/// Stands for a slot that does not move.
const FIXED: u32 = u32::MAX;

/// Nodes that may move, two equations each; a held component has one of its own that says nothing. Nodes of a
/// body that moves as one piece without turning share the equations of its first one.
pub(super) struct Unknowns {
    /// Their slots, in the order of elimination.
    pub(super) slots: Vec<u32>,
    /// Which of (x, y) may move.
    pub(super) free: Vec<[bool; 2]>,
    /// Slots of each body that moves as one piece, the first of which is among `slots`.
    pub(super) pieces: Vec<Range<u32>>,
    /// Position in `slots` of each slot.
    index: Vec<u32>,
}

/// Slots of each body that moves as one piece and whose turn is prescribed.
fn turning(d: &Dynamics) -> impl Iterator<Item = Range<u32>> {
    let bodies = d.rigid_bodies().iter().filter(|body| body.turns());
    bodies.map(|body| body.slots.start as u32..body.slots.end as u32)
}

impl Unknowns {
    pub(super) fn new(d: &Dynamics) -> Self {
        let mut slots: Vec<u32> = d.elastic_slots().into_iter().map(|slot| slot as u32).collect();
        slots.extend(turning(d).map(|piece| piece.start));
        Self::of_slots(d, &slots)
    }

    /// Those of these slots that may move.
    pub(super) fn of_slots(d: &Dynamics, slots: &[u32]) -> Self {
        let pieces: Vec<Range<u32>> = turning(d).filter(|piece| slots.contains(&piece.start)).collect();
        let by_itself = |slot: &u32| {
            d.free_components(*slot as usize) != [false; 2]
                && pieces.iter().all(|piece| !piece.contains(slot))
        };
        let mut slots: Vec<u32> = slots.iter().copied().filter(by_itself).collect();
        let mut free: Vec<[bool; 2]> = slots.iter().map(|&slot| d.free_components(slot as usize)).collect();
        slots.extend(pieces.iter().map(|piece| piece.start));
        free.resize(slots.len(), [true; 2]);
        let mut unknowns = Self { slots, free, pieces, index: vec![FIXED; d.state.x.len()] };
        unknowns.number();
        unknowns
    }

    fn number(&mut self) {
        for (i, &slot) in self.slots.iter().enumerate() {
            self.index[slot as usize] = i as u32;
        }
        for piece in &self.pieces {
            let first = self.index[piece.start as usize];
            self.index[piece.start as usize..piece.end as usize].fill(first);
        }
    }

    /// Every slot that moves with an unknown, and the position of that among `slots`.
    pub(super) fn moving(&self) -> impl Iterator<Item = (usize, usize)> {
        let own = self.slots.iter().enumerate().map(|(i, &slot)| (slot as usize, i));
        let of_piece = |piece: &Range<u32>| piece.start as usize + 1..piece.end as usize;
        own.chain(self.pieces.iter().flat_map(of_piece).map(|slot| (slot, self.index[slot] as usize)))
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
