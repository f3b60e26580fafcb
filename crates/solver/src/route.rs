//! The part of one rank in a model, and the values that it sends to others.

use std::{ops::Range, sync::Arc};

use crate::{
    kernel::tile::Tile,
    ranks::{Ranks, Shared},
};

/// The part of one rank in a model, and the values that it sends to others.
#[derive(Debug)]
pub(crate) struct Division {
    pub(crate) ranks: Arc<dyn Ranks>,
    /// Rank of each tile.
    pub(crate) rank_of: Vec<usize>,
    /// Rank of each rigid body.
    pub(crate) rank_of_rigid: Vec<usize>,
    /// Ghosts of own tiles, as in the layout.
    pub(crate) ghosts: Vec<(Range<usize>, usize)>,
    /// Nodes at seams, which ghosts copy, and nodes that forces read.
    pub(crate) seams: Route,
    pub(crate) read: Route,
    pub(crate) outgoing: Vec<Vec<f64>>,
    pub(crate) incoming: Vec<Vec<f64>>,
    pub(crate) shared: Shared,
}

/// Slots whose values go to each rank, and come from it.
#[derive(Debug, Default)]
pub(crate) struct Route {
    pub(crate) to: Vec<Vec<u32>>,
    pub(crate) from: Vec<Vec<u32>>,
}

impl Route {
    /// From the slots of others that each rank reads; `owner` is the rank of a slot, `None` for one that
    /// every rank has.
    pub(crate) fn new(
        mut wanted: Vec<Vec<u32>>,
        rank: usize,
        owner: impl Fn(usize) -> Option<usize>,
    ) -> Self {
        let ranks = wanted.len();
        let mut route = Self { to: vec![Vec::new(); ranks], from: vec![Vec::new(); ranks] };
        for (reader, slots) in wanted.iter_mut().enumerate() {
            slots.sort_unstable();
            slots.dedup();
            for &slot in slots.iter() {
                match owner(slot as usize) {
                    Some(owner) if owner == rank && reader != rank => route.to[reader].push(slot),
                    Some(owner) if owner != rank && reader == rank => route.from[owner].push(slot),
                    _ => {}
                }
            }
        }
        route
    }
}

/// Packs values of slots.
pub(crate) fn pack(slots: &[u32], fields: &[&[f64]], to: &mut Vec<f64>) {
    for field in fields {
        to.extend(slots.iter().map(|&n| field[n as usize]));
    }
}

/// Unpacks the values of [`pack`]; returns the rest of the message.
pub(crate) fn unpack<'a>(slots: &[u32], fields: &mut [&mut [f64]], mut from: &'a [f64]) -> &'a [f64] {
    for field in fields {
        let (values, rest) = from.split_at(slots.len());
        slots.iter().zip(values).for_each(|(&n, &value)| field[n as usize] = value);
        from = rest;
    }
    from
}

/// Number of the tile that a slot lies in.
pub(crate) fn tile_at(tiles: &[Tile], slot: usize) -> usize {
    tiles.partition_point(|tile| tile.slots.end <= slot)
}
