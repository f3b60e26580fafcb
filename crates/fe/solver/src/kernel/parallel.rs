//! Tiles dealt out to threads: each gets its own parts of the fields, so nothing is shared.

use crate::kernel::{
    advance::StepParameters,
    fields::TileFields,
    structural_damping::Evaluation,
    sweep::{Scratch, StepEnergies, sweep},
    tile::Tile,
};
use stribeck_simd::threads::{cut, from_both_ends};

/// Tiles, their parts of the fields and where their energies go, from either end.
pub(crate) struct TileRuns<'a> {
    pub(crate) tiles: &'a [Tile],
    pub(crate) fields: TileFields<'a>,
    pub(crate) counted: &'a mut [StepEnergies],
    /// Action of the branches of structural damping, in a step that evaluates them.
    pub(crate) evaluation: Option<&'a Evaluation>,
}

impl<'a> TileRuns<'a> {
    fn split_at(self, tile: usize) -> (Self, Self) {
        let (left, right) = self.tiles.split_at(tile);
        let nodes = match (left.first(), right.first()) {
            (Some(first), Some(next)) => next.slots.start - first.slots.start,
            (None, _) => 0,
            (_, None) => self.fields.x.len(),
        };
        let (a, b) = self.fields.split_at(nodes);
        let ((p, q), evaluation) = (self.counted.split_at_mut(tile), self.evaluation);
        let left = Self { tiles: left, fields: a, counted: p, evaluation };
        (left, Self { tiles: right, fields: b, counted: q, evaluation })
    }

    fn take(&mut self) -> Self {
        let (tiles, fields, counted) = (&[][..], TileFields::default(), &mut [][..]);
        std::mem::replace(self, Self { tiles, fields, counted, evaluation: self.evaluation })
    }

    /// From the first one on, or backwards.
    fn turned(self, back: bool) -> Turned<'a> {
        Turned { runs: self, back }
    }

    fn sweep_one(self, scratch: &mut Scratch, parameters: StepParameters) {
        if let ([tile], [energies]) = (self.tiles, self.counted) {
            *energies = sweep(tile, self.fields, scratch, parameters, self.evaluation);
        }
    }
}

impl<'a> Iterator for TileRuns<'a> {
    type Item = Self;

    fn next(&mut self) -> Option<Self> {
        let (one, rest) = (!self.tiles.is_empty()).then(|| self.take().split_at(1))?;
        *self = rest;
        Some(one)
    }
}

impl DoubleEndedIterator for TileRuns<'_> {
    fn next_back(&mut self) -> Option<Self> {
        let last = self.tiles.len().checked_sub(1)?;
        let (rest, one) = self.take().split_at(last);
        *self = rest;
        Some(one)
    }
}

/// Tiles from the first one on, or backwards.
struct Turned<'a> {
    runs: TileRuns<'a>,
    back: bool,
}

impl<'a> Iterator for Turned<'a> {
    type Item = TileRuns<'a>;

    fn next(&mut self) -> Option<TileRuns<'a>> {
        if self.back { self.runs.next_back() } else { self.runs.next() }
    }
}

impl DoubleEndedIterator for Turned<'_> {
    fn next_back(&mut self) -> Option<Self::Item> {
        if self.back { self.runs.next() } else { self.runs.next_back() }
    }
}

/// Tiles on either side of where two threads met last that are swept last in every step, so that they may
/// meet elsewhere.
const UNDECIDED: usize = 1;

/// Sweeps tiles; two threads from either end to where they meet, in every second step from there outwards but
/// for the tiles about it, which come last. More threads share runs of about equal work.
pub(crate) fn sweep_all(runs: TileRuns<'_>, scratch: &mut [Scratch], parameters: StepParameters) {
    match scratch {
        [] => {}
        [one] => runs.turned(parameters.back).for_each(|run| run.sweep_one(one, parameters)),
        [one, other] => {
            let open = one.met.open(UNDECIDED, runs.tiles.len());
            let (runs, right) = runs.split_at(open.end);
            let (left, between) = runs.split_at(open.start);
            let parts = [left.turned(parameters.back), between.turned(false), right.turned(parameters.back)];
            one.met = from_both_ends(
                parts,
                || {},
                |run| run.sweep_one(one, parameters),
                |run| run.sweep_one(other, parameters),
            );
        }
        _ => {
            let (threads, half) = (scratch.len(), scratch.len() / 2);
            let work = runs.tiles.iter().map(|tile| tile.work);
            let (left, right) = runs.split_at(cut(work.clone(), work.sum(), half, threads));
            let (here, there) = scratch.split_at_mut(half);
            micropool::join(|| sweep_all(left, here, parameters), || sweep_all(right, there, parameters));
        }
    }
}
