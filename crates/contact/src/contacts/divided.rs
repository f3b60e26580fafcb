//! Pairs of surfaces, shared out over ranks.

use stribeck_solver::{ranks::Shared, state::Moment};

use super::Contacts;
use crate::{interactions::Interactions, kernel::evaluate::Sum, memory::Memory, pass::Pass};

/// Numbers of a report: whether anything was done, and the sums of two passes.
const REPORT: usize = 1 + 2 * Sum::NUMBERS;

/// Nanoseconds of a unit of work.
const UNIT_NS: f64 = 10.0;

impl Interactions for Contacts {
    fn count(&self) -> usize {
        self.pairs.len()
    }

    fn is_due(&self, step: u64) -> bool {
        step >= self.search.next
    }

    fn look(&mut self, at: Moment<'_>) {
        if self.is_due(at.step) {
            self.search(&at);
        }
    }

    fn reach(&self, which: usize, _at: Moment<'_>, slots: &mut Vec<u32>) {
        self.pairs[which].passes.iter().for_each(|pass| pass.reach(&self.surfaces, slots));
    }

    fn work(&self, which: usize) -> f64 {
        UNIT_NS * self.pairs[which].result.work as f64
    }

    fn compute(&mut self, here: Vec<bool>) {
        for (pair, here) in self.pairs.iter_mut().zip(here) {
            pair.here = here;
            pair.result.idle_until = 0;
        }
        self.divided = true;
    }

    fn report_length(&self) -> usize {
        REPORT
    }

    fn report(&self, which: usize, to: &mut Shared) {
        let result = &self.pairs[which].result;
        to.tell([result.work as f64]);
        result.sum.iter().for_each(|sum| to.tell(sum.numbers()));
    }

    fn hear(&mut self, which: usize, report: &[f64]) {
        let result = &mut self.pairs[which].result;
        let [work, sums @ ..] = report else { return };
        result.work = *work as usize;
        for (sum, numbers) in result.sum.iter_mut().zip(sums.chunks_exact(Sum::NUMBERS)) {
            *sum = Sum::of_numbers(numbers);
        }
    }

    fn add_up(&mut self) {
        self.count_energies();
    }

    fn memories(&self, which: &[usize]) -> Vec<u8> {
        let passes = which.iter().flat_map(|&pair| &self.pairs[pair].passes);
        let memories: Vec<&Memory> = passes.map(|pass| &pass.memory).collect();
        postcard::to_allocvec(&memories).unwrap_or_default()
    }

    fn remember(&mut self, which: &[usize], memories: &[u8]) -> bool {
        let Ok(memories) = postcard::from_bytes::<Vec<Memory>>(memories) else { return false };
        let mut memories = memories.into_iter();
        for &pair in which {
            for pass in &mut self.pairs[pair].passes {
                let Some(memory) = memories.next().filter(|memory| pass.can_remember(memory, &self.surfaces))
                else {
                    return false;
                };
                Pass::remember(pass, memory);
            }
        }
        memories.next().is_none()
    }

    fn nodes(&self) -> Vec<u32> {
        self.slots().collect()
    }
}
