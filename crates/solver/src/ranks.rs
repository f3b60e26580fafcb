//! Processes that run one model together, as a trait: ranks, in the words of MPI.
//!
//! Every rank makes the whole model and holds all of its arrays, but takes only its own tiles from step to
//! step ([`Dynamics::divide`](crate::Dynamics::divide)). All ranks call the same methods in the same order.

use std::fmt::Debug;

/// Ranks that run one model together.
pub trait Ranks: Debug + Send + Sync {
    /// Number of this one, from zero.
    fn rank(&self) -> usize;

    /// How many there are.
    fn count(&self) -> usize;

    /// Sends `outgoing[r]` to each rank r and receives `incoming[r]` from it, while `meanwhile` goes on.
    /// Both sides know the lengths beforehand; nothing is sent between two ranks without common data.
    fn exchange(&self, outgoing: &[Vec<f64>], incoming: &mut [Vec<f64>], meanwhile: &mut dyn FnMut());

    /// Gathers the parts of all ranks, one after the other, in `all`; `lengths` are those of the parts.
    fn all_gather(&self, own: &[f64], lengths: &[usize], all: &mut [f64]);

    /// Gathers bytes of any length from all ranks.
    fn all_gather_bytes(&self, own: &[u8]) -> Vec<Vec<u8>>;
}

/// Broadcasts the bytes of the first rank; those of others are ignored.
pub fn broadcast(ranks: &dyn Ranks, own: &[u8]) -> Vec<u8> {
    let own = if ranks.rank() == 0 { own } else { &[] };
    ranks.all_gather_bytes(own).into_iter().next().unwrap_or_default()
}

/// Numbers of items, each of which belongs to one rank: every rank adds those of its own items, all are
/// gathered, and every rank reads them in the same order.
#[derive(Debug, Default)]
pub struct Shared {
    own: Vec<f64>,
    all: Vec<f64>,
    lengths: Vec<usize>,
    /// Where the next item of each rank begins in `all`.
    next: Vec<usize>,
}

impl Shared {
    /// Adds numbers of an item of this rank.
    pub fn tell(&mut self, numbers: impl IntoIterator<Item = f64>) {
        self.own.extend(numbers);
    }

    /// Gathers the numbers of all ranks; `items` are the rank of each item and how many numbers it has.
    pub fn gather(&mut self, ranks: &dyn Ranks, items: impl Iterator<Item = (usize, usize)>) {
        let Self { own, all, lengths, next } = self;
        lengths.clear();
        lengths.resize(ranks.count(), 0);
        items.for_each(|(rank, length)| lengths[rank] += length);
        next.clear();
        let mut end = 0;
        for length in &*lengths {
            next.push(end);
            end += length;
        }
        all.resize(end, 0.0);
        if end > 0 {
            ranks.all_gather(own, lengths, all);
        }
        own.clear();
    }

    /// The numbers of the next item, which is of this rank and so long.
    pub fn hear(&mut self, rank: usize, length: usize) -> &[f64] {
        let first = self.next[rank];
        self.next[rank] += length;
        &self.all[first..first + length]
    }
}

/// Shares `items` with these works out over ranks: cut across the longer side of the box around their places
/// again and again, so that each rank has about equal work in one piece. The rank of each item.
pub(crate) fn cut_in_place(places: &[[f64; 2]], work: &[f64], ranks: usize) -> Vec<usize> {
    let mut rank_of = vec![0; places.len()];
    // Items, the first of the ranks that share them, and how many these are.
    let mut todo = vec![((0..places.len()).collect::<Vec<_>>(), 0, ranks)];
    while let Some((mut items, first, count)) = todo.pop() {
        if count < 2 {
            items.iter().for_each(|&i| rank_of[i] = first);
            continue;
        }
        let extent = |c: usize| {
            let of = items.iter().map(|&i| places[i][c]);
            let (low, high) = of.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            high - low
        };
        let c = usize::from(extent(1) > extent(0));
        items.sort_by(|&a, &b| places[a][c].total_cmp(&places[b][c]).then(a.cmp(&b)));
        let half = count / 2;
        let wanted = items.iter().map(|&i| work[i]).sum::<f64>() * half as f64 / count as f64;
        let mut before = 0.0;
        // An item goes to the side where more than half of it belongs.
        let at = items.iter().take_while(|&&i| {
            before += work[i];
            before - 0.5 * work[i] <= wanted
        });
        let right = items.split_off(at.count());
        todo.push((items, first, half));
        todo.push((right, first + half, count - half));
    }
    rank_of
}

#[cfg(test)]
mod tests {
    use super::cut_in_place;

    #[test]
    fn by_hand_work_is_cut_into_equal_pieces_across_the_longer_side() {
        let places: Vec<[f64; 2]> = (0..60).map(|i| [f64::from(i % 12), f64::from(i / 12)]).collect();
        for ranks in 1..=6 {
            let rank_of = cut_in_place(&places, &[1.0; 60], ranks);
            for rank in 0..ranks {
                let own = rank_of.iter().filter(|&&r| r == rank).count();
                assert_eq!(own, 60 / ranks, "{ranks} ranks");
            }
        }
        let halves = cut_in_place(&places, &[1.0; 60], 2);
        assert!((0..60).all(|i| halves[i] == usize::from(i % 12 >= 6)));
    }
}
