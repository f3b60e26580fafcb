//! One model over ranks: the tiles of each, their messages in a step, and gathering the whole state.
//!
//! A rank sweeps its own tiles as threads do theirs. Their ghosts and whatever nodes its forces read come
//! from the ranks that own them, once a step, while the tiles that nobody waits for are swept. Every rank
//! receives the sums of a step and the places of rigid bodies after every step; fields of other ranks' tiles
//! are right only after [`Dynamics::gather`]. Sums are taken tile by tile in one order, as ever, so that
//! ranks change no bit.

use std::sync::Arc;

use crate::{
    dynamics::Dynamics,
    kernel::{
        advance::StepParameters,
        mass_sums::{LaneSums, MassSums, NUMBERS},
        structural_damping::{Evaluation, HeldWork},
        sweep::StepEnergies,
        tile::{Tile, Turn},
    },
    ranks::{Ranks, Shared, cut_in_place},
    rigid::RigidState,
    route::{Division, Route, pack, tile_at, unpack},
    state::State,
};

/// Length of a tile's counters of a step.
const ENERGIES: usize = 4;

/// Length of a rigid body's state and drive.
const RIGID: usize = 7;

/// A new division is taken where the busiest rank of the old one has this many times the work of the busiest
/// of the new one.
const WORTH_A_CUT: f64 = 1.03;

/// Slots from one that counts for the place of its tile to the next.
const PLACE_EVERY: usize = 61;

impl Dynamics {
    /// Divides the model among ranks from now on, all of which hold the same state: each moves its own tiles
    /// alone. Every rank has to call the same methods in the same order then, and [`Dynamics::gather`]
    /// must precede every reading of the whole state.
    pub fn divide(&mut self, ranks: Arc<dyn Ranks>) {
        let count = ranks.count();
        self.division = Some(Division {
            rank_of: Vec::new(),
            rank_of_rigid: Vec::new(),
            ghosts: Vec::new(),
            seams: Route::default(),
            read: Route::default(),
            outgoing: vec![Vec::new(); count],
            incoming: vec![Vec::new(); count],
            shared: Shared::default(),
            ranks,
        });
        self.balance(std::iter::empty());
        self.read_elsewhere(vec![Vec::new(); count]);
    }

    /// The ranks that the model is divided among.
    pub fn ranks(&self) -> Option<&Arc<dyn Ranks>> {
        self.division.as_ref().map(|division| &division.ranks)
    }

    /// The rank that moves the node in a slot.
    pub fn rank_of(&self, slot: u32) -> usize {
        let tile = tile_at(&self.tiles, slot as usize);
        self.division.as_ref().map_or(0, |division| division.rank_of[tile])
    }

    /// Reassigns tiles by their work and by `burdens`: slots, and the work that is done for them, in units of
    /// about a nanosecond. The whole state must be gathered before. True where a tile has moved to another
    /// rank; the nodes that forces read must then be announced again.
    pub fn balance<'a>(&mut self, burdens: impl Iterator<Item = (&'a [u32], f64)>) -> bool {
        let Some(division) = &self.division else { return false };
        let (rank, count) = (division.ranks.rank(), division.ranks.count());
        let mut work: Vec<f64> = self.tiles.iter().map(|tile| tile.work as f64).collect();
        for (slots, burden) in burdens {
            let each = burden / slots.len() as f64;
            slots.iter().for_each(|&slot| work[tile_at(&self.tiles, slot as usize)] += each);
        }
        let place = |tile: &Tile| {
            let slots = (tile.slots.start..tile.slots.start + tile.own).step_by(PLACE_EVERY);
            let n = slots.len() as f64;
            let mean = |v: &[f64]| slots.clone().map(|slot| v[slot]).sum::<f64>() / n;
            [mean(&self.state.x), mean(&self.state.y)]
        };
        let places: Vec<[f64; 2]> = self.tiles.iter().map(place).collect();
        let new = cut_in_place(&places, &work, count);
        let most = |rank_of: &[usize]| {
            let mut of_rank = vec![0.0; count];
            rank_of.iter().zip(&work).for_each(|(&rank, work)| of_rank[rank] += work);
            of_rank.into_iter().fold(0.0, f64::max)
        };
        if !division.rank_of.is_empty() && most(&division.rank_of) <= WORTH_A_CUT * most(&new) {
            return false;
        }
        let of_slot = |slot: usize| new[tile_at(&self.tiles, slot)];
        let mut wanted = vec![Vec::new(); count];
        let mut own = Vec::new();
        for (ghosts, owner) in &self.layout().ghosts {
            let reader = of_slot(ghosts.start);
            wanted[reader].extend((*owner..owner + ghosts.len()).map(|slot| slot as u32));
            if reader == rank {
                own.push((ghosts.clone(), *owner));
            }
        }
        let seams = Route::new(wanted, rank, |slot| Some(of_slot(slot)));
        let rigid = self.rigid_bodies.iter().map(|body| of_slot(body.slots.start)).collect();
        if let Some(division) = &mut self.division {
            (division.seams, division.ghosts) = (seams, own);
            (division.rank_of, division.rank_of_rigid) = (new, rigid);
        }
        true
    }

    /// Says which nodes the forces of each rank read, by their slots: from the next step on they are known
    /// there, as they are now. Nodes of bodies that move as one piece are known everywhere.
    pub fn read_elsewhere(&mut self, wanted: Vec<Vec<u32>>) {
        let Some(division) = &mut self.division else { return };
        let (rank, tiles) = (division.ranks.rank(), &mut self.tiles);
        let owner = |slot: usize| {
            let tile = tile_at(tiles, slot);
            tiles[tile].elastic.then(|| division.rank_of[tile])
        };
        division.read = Route::new(wanted, rank, owner);
        for (tile, &of) in tiles.iter_mut().zip(&division.rank_of) {
            tile.turn = if of == rank { Turn::Late } else { Turn::Elsewhere };
        }
        for slots in division.seams.to.iter().chain(&division.read.to) {
            for &slot in slots {
                let tile = tile_at(tiles, slot as usize);
                tiles[tile].turn = Turn::Early;
            }
        }
    }

    /// Sends these nodes, by their slots, to every rank.
    pub fn gather_nodes(&mut self, slots: &[u32]) {
        let Some(mut division) = self.division.take() else { return };
        let rank = division.ranks.rank();
        let State { x, y, vx, vy, .. } = &mut self.state;
        let of = |slot: u32| division.rank_of[tile_at(&self.tiles, slot as usize)];
        let owners: Vec<usize> = slots.iter().map(|&slot| of(slot)).collect();
        for (&slot, _) in slots.iter().zip(&owners).filter(|(_, owner)| **owner == rank) {
            let n = slot as usize;
            division.shared.tell([x[n], y[n], vx[n], vy[n]]);
        }
        division.shared.gather(&*division.ranks, owners.iter().map(|&owner| (owner, 4)));
        for (&slot, &owner) in slots.iter().zip(&owners) {
            let (n, at) = (slot as usize, division.shared.hear(owner, 4));
            (x[n], y[n], vx[n], vy[n]) = (at[0], at[1], at[2], at[3]);
        }
        self.division = Some(division);
    }

    /// Gathers the whole state on every rank.
    pub fn gather(&mut self) {
        let Some(mut division) = self.division.take() else { return };
        let State { x, y, vx, vy, springs, .. } = &mut self.state;
        for field in [x, y, vx, vy].into_iter().chain(springs.paths.iter_mut().flatten()) {
            gather_field(&mut division, &self.tiles, field, |value| value);
        }
        if !springs.paths.is_empty() {
            for held in &mut springs.held {
                gather_field(&mut division, &self.tiles, held, |value| value as f32);
            }
        }
        self.division = Some(division);
    }

    /// Drops pushes on nodes that other ranks move: those ranks have them, too.
    pub(crate) fn drop_pushes_elsewhere(&mut self) {
        if self.division.is_none() {
            return;
        }
        for tile in self.tiles.iter().filter(|tile| tile.turn == Turn::Elsewhere) {
            let whole = 0..tile.slots.len();
            let pushed = if tile.elastic { &tile.loaded[..] } else { std::slice::from_ref(&whole) };
            for run in pushed {
                let slots = tile.slots.start + run.start..tile.slots.start + run.end;
                self.forces.fx[slots.clone()].fill(0.0);
                self.forces.fy[slots].fill(0.0);
            }
        }
    }

    /// Copies nodes to the ghosts of tiles that this rank sweeps.
    pub(crate) fn fill_ghosts(&mut self) {
        let ahead = self.sees_ahead();
        let (layout, division) = (&self.layout, &self.division);
        let State { x, y, vx, vy, .. } = &mut self.state;
        for field in [x, y].into_iter().chain(ahead.then_some([vx, vy]).into_iter().flatten()) {
            match division {
                None => layout.copy_to_ghosts(field),
                Some(division) => division.ghosts.iter().for_each(|(ghosts, owner)| {
                    field.copy_within(*owner..owner + ghosts.len(), ghosts.start);
                }),
            }
        }
    }

    /// Gathers the sums of all tiles that have them on every rank.
    pub(crate) fn share_sums(
        &mut self,
        tiles: &mut [Tile],
        sums: impl Fn(&mut Tile) -> Option<&mut LaneSums>,
    ) {
        let Some(Division { ranks, rank_of, shared, .. }) = &mut self.division else { return };
        let mut items = Vec::new();
        for (tile, &of) in tiles.iter_mut().zip(&*rank_of) {
            let Some(sums) = sums(tile) else { continue };
            if of == ranks.rank() {
                shared.tell(sums.iter().flat_map(|sums| sums.numbers()));
            }
            items.push((of, NUMBERS * sums.len()));
        }
        shared.gather(&**ranks, items.into_iter());
        for (tile, &of) in tiles.iter_mut().zip(&*rank_of) {
            let Some(sums) = sums(tile) else { continue };
            let all = shared.hear(of, NUMBERS * sums.len());
            for (sums, numbers) in sums.iter_mut().zip(all.chunks_exact(NUMBERS)) {
                *sums = MassSums::of_numbers(numbers);
            }
        }
    }

    /// Sweeps the tiles of this rank, those first that others wait for, and exchanges nodes meanwhile.
    pub(crate) fn sweep_and_exchange(&mut self, parameters: StepParameters, evaluation: Option<&Evaluation>) {
        let Some(mut division) = self.division.take() else {
            return self.sweep_turn(Turn::Late, parameters, evaluation);
        };
        self.sweep_turn(Turn::Early, parameters, evaluation);
        self.exchange(&mut division, |dynamics| dynamics.sweep_turn(Turn::Late, parameters, evaluation));
        self.division = Some(division);
    }

    /// Sends what others read of nodes that have moved, and receives what this rank reads, while `meanwhile`
    /// moves others.
    fn exchange(&mut self, division: &mut Division, meanwhile: impl Fn(&mut Self)) {
        let seams = if self.sees_ahead() { 4 } else { 2 };
        let State { x, y, vx, vy, .. } = &self.state;
        let fields: [&[f64]; 4] = [x, y, vx, vy];
        for (rank, to) in division.outgoing.iter_mut().enumerate() {
            to.clear();
            pack(&division.seams.to[rank], &fields[..seams], to);
            pack(&division.read.to[rank], &fields, to);
        }
        for (rank, from) in division.incoming.iter_mut().enumerate() {
            from.resize(seams * division.seams.from[rank].len() + 4 * division.read.from[rank].len(), 0.0);
        }
        division.ranks.exchange(&division.outgoing, &mut division.incoming, &mut || meanwhile(self));
        let State { x, y, vx, vy, .. } = &mut self.state;
        let mut fields: [&mut [f64]; 4] = [x, y, vx, vy];
        for (rank, from) in division.incoming.iter().enumerate() {
            let rest = unpack(&division.seams.from[rank], &mut fields[..seams], from);
            unpack(&division.read.from[rank], &mut fields, rest);
        }
    }

    /// Moves rigid bodies, each on one rank, and sends their positions and the counters of tiles to all
    /// ranks.
    pub(crate) fn move_rigid_and_share(&mut self, parameters: &StepParameters, evaluates: bool) {
        let (dt, gravity) = (self.time_step, self.gravity);
        let Some(Division { ranks, rank_of, rank_of_rigid, shared, .. }) = &mut self.division else {
            for ((body, at), driven) in self.rigid_bodies.iter().zip(&mut self.rigid).zip(&mut self.driven) {
                *driven = body.advance(at, &mut self.state, &mut self.forces, dt, gravity);
            }
            return;
        };
        let rank = ranks.rank();
        let counts = |tile: &Tile| {
            let heat = tile.damping.is_some() || tile.elastic && parameters.beta > 0.0;
            tile.turns || heat && parameters.count_heat || evaluates && tile.structural.is_some()
        };
        let tiles = self.tiles.iter().zip(&*rank_of).zip(&mut self.counted);
        for ((_, _), StepEnergies { work, heat, held }) in
            tiles.filter(|((tile, of), _)| **of == rank && counts(tile))
        {
            shared.tell([*work, *heat, held.released, held.taken_up]);
        }
        for (b, body) in self.rigid_bodies.iter().enumerate().filter(|(b, _)| rank_of_rigid[*b] == rank) {
            let at = &mut self.rigid[b];
            let driven = body.advance(at, &mut self.state, &mut self.forces, dt, gravity);
            let RigidState { centre: [x, y], angle, velocity: [u, v], spin } = *at;
            shared.tell([x, y, angle, u, v, spin, driven]);
        }
        let tiles = self.tiles.iter().zip(&*rank_of);
        let energies = tiles.filter(|(tile, _)| counts(tile)).map(|(_, &of)| (of, ENERGIES));
        shared.gather(&**ranks, energies.chain(rank_of_rigid.iter().map(|&of| (of, RIGID))));
        for ((tile, &of), counted) in self.tiles.iter().zip(&*rank_of).zip(&mut self.counted) {
            *counted = match counts(tile).then(|| shared.hear(of, ENERGIES)) {
                Some(&[work, heat, released, taken_up]) => {
                    StepEnergies { work, heat, held: HeldWork { released, taken_up } }
                }
                _ => StepEnergies::default(),
            };
        }
        for (b, body) in self.rigid_bodies.iter().enumerate() {
            let &[x, y, angle, u, v, spin, driven] = shared.hear(rank_of_rigid[b], RIGID) else { continue };
            self.driven[b] = driven;
            if rank_of_rigid[b] != rank {
                self.rigid[b] = RigidState { centre: [x, y], angle, velocity: [u, v], spin };
                body.place(&self.rigid[b], &mut self.state, dt);
            }
        }
    }
}

/// Gathers a field of nodes on every rank; `back` makes its numbers of those that are sent.
fn gather_field<T: Copy + Into<f64>>(
    division: &mut Division,
    tiles: &[Tile],
    field: &mut [T],
    back: impl Fn(f64) -> T,
) {
    let Division { ranks, rank_of, shared, .. } = division;
    let rank = ranks.rank();
    let tiles = || tiles.iter().zip(&*rank_of);
    for (tile, _) in tiles().filter(|(_, of)| **of == rank) {
        shared.tell(field[tile.slots.clone()].iter().map(|&value| value.into()));
    }
    shared.gather(&**ranks, tiles().map(|(tile, &of)| (of, tile.slots.len())));
    for (tile, &of) in tiles() {
        let values = shared.hear(of, tile.slots.len());
        if of != rank {
            field[tile.slots.clone()].iter_mut().zip(values).for_each(|(to, &value)| *to = back(value));
        }
    }
}
