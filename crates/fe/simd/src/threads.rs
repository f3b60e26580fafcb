//! Work shared out over the threads of the `micropool` that the caller runs in.

use std::{
    ops::Range,
    sync::{Mutex, MutexGuard, PoisonError},
};

/// Items on either side of where two threads met that they share the next time.
const MARGIN: usize = 2;

/// Calls `each` for every item, on up to `threads` threads. Results do not depend on how many there are.
///
/// Two threads begin at either end and meet where they may, so an item mostly stays with the core that has it
/// in its cache, and neither waits for longer than one item takes. More than two threads are
/// split into halves, which get runs of about equal `work`. A fork takes some microseconds, so that items of
/// less than `least` work for each of two threads stay on the caller's.
pub fn share_out<T: Send>(
    items: &mut [T],
    threads: usize,
    least: usize,
    work: &(impl Fn(&T) -> usize + Sync),
    each: &(impl Fn(&mut T) + Sync),
) {
    share_out_beside(items, threads, least, work, &mut Met::default(), || {}, &mut |item| each(item), each);
}

/// The same, but one thread calls `first` for the first items, in order, and all others call `other` for the
/// rest. How many items either gets may differ from call to call; `met` remembers it for the next one. Of two
/// threads the other one calls `beside` before it takes items; else the first one does.
#[allow(clippy::too_many_arguments)] // items, and three things to do
pub fn share_out_beside<T: Send>(
    items: &mut [T],
    threads: usize,
    least: usize,
    work: &(impl Fn(&T) -> usize + Sync),
    met: &mut Met,
    beside: impl FnOnce() + Send,
    first: &mut (impl FnMut(&mut T) + Send),
    other: &(impl Fn(&mut T) + Sync),
) {
    let all: usize = items.iter().map(work).sum();
    if threads < 2 || items.len() < 2 || all < 2 * least {
        beside();
        items.iter_mut().for_each(first);
    } else if threads == 2 {
        let open = met.open(MARGIN, items.len());
        let (left, right) = items.split_at_mut(open.end);
        let (left, between) = left.split_at_mut(open.start);
        let parts = [left, between, right].map(|part| part.iter_mut());
        *met = from_both_ends(parts, beside, first, other);
    } else {
        let half = threads / 2;
        let cut = cut(items.iter().map(work), all, half, threads);
        let (here, there) = items.split_at_mut(cut);
        micropool::join(
            || share_out_beside(here, half, least, work, met, beside, first, other),
            || share_out(there, threads - half, least, work, other),
        );
    }
}

/// How many of the first items hold about `part` of `whole` equal parts of all work; `items` are the work of
/// each.
pub fn cut(items: impl ExactSizeIterator<Item = usize>, all: usize, part: usize, whole: usize) -> usize {
    let last = items.len().saturating_sub(1);
    let mut before = 0;
    let first = items.take_while(|work| {
        before += work;
        // An item goes to the side where more than half of it belongs.
        (2 * before - work) * whole <= 2 * all * part
    });
    first.count().clamp(1.min(last), last)
}

/// Where two threads met when they last shared items out between them.
#[derive(Debug, Clone, Copy, Default)]
pub struct Met(usize);

impl Met {
    /// The items that either thread may get this time: `margin` of them on either side of where the threads
    /// last met.
    pub fn open(self, margin: usize, items: usize) -> Range<usize> {
        let to = (self.0 + margin).min(items);
        self.0.saturating_sub(margin).min(to)..to
    }
}

/// An iterator that two threads take items from. It has a line of cache to itself, because a line that
/// another thread has just written is slow to load.
#[repr(align(128))]
struct Shared<I>(Mutex<I>);

impl<I: DoubleEndedIterator> Shared<I> {
    fn lock(&self) -> MutexGuard<'_, I> {
        // Nobody can leave an iterator half advanced: taking an item cannot fail.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Two threads take items until none is left. One calls `here`, for those of the `left` part from its first
/// one on; the other calls `beside`, and then `there`, for those of the `right` part from its last one on.
/// Both then go on with the part `between`, and a thread that finds it empty with the part of the other.
pub fn from_both_ends<I: Send>(
    [left, between, right]: [impl DoubleEndedIterator<Item = I> + Send; 3],
    beside: impl FnOnce() + Send,
    mut here: impl FnMut(I) + Send,
    mut there: impl FnMut(I) + Send,
) -> Met {
    let parts = [left, between, right].map(|part| Shared(Mutex::new(part)));
    let mut taken = 0;
    micropool::join(
        || {
            while let Some(item) = parts.iter().find_map(|part| part.lock().next()) {
                taken += 1;
                here(item);
            }
        },
        || {
            beside();
            while let Some(item) = parts.iter().rev().find_map(|part| part.lock().next_back()) {
                there(item);
            }
        },
    );
    Met(taken)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_first_takes_items_from_the_first_one_on_in_order() {
        for threads in 1..=5 {
            let pool = micropool::ThreadPoolBuilder::default().num_threads(threads.max(2) - 1).build();
            let mut met = Met::default();
            for count in [0, 1, 2, 7, 40, 40, 3] {
                // Who did it, and how often.
                let mut items: Vec<(usize, [u32; 2])> = (0..count).map(|i| (i, [0, 0])).collect();
                let mut taken = Vec::new();
                let mut beside = 0;
                let mut first = |item: &mut (usize, [u32; 2])| {
                    taken.push(item.0);
                    item.1[0] += 1;
                };
                let other = |item: &mut (usize, [u32; 2])| item.1[1] += 1;
                pool.install(|| {
                    share_out_beside(
                        &mut items,
                        threads,
                        2,
                        &|item| 1 + item.0 % 3,
                        &mut met,
                        || beside += 1,
                        &mut first,
                        &other,
                    );
                });
                assert_eq!(beside, 1, "{threads} threads");
                assert!(taken.iter().copied().eq(0..taken.len()), "{threads} threads: {taken:?}");
                let done =
                    |(i, done): &(usize, [u32; 2])| *done == if *i < taken.len() { [1, 0] } else { [0, 1] };
                assert!(items.iter().all(done), "{threads} threads: {items:?}");
            }
        }
    }
}
