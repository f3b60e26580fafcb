//! A second event that is faint: it stands out of the mean of both bands together.
//!
//! Under a heavy load an element is let go softly, and its entry is twice as strong as what lies between
//! passages in one band only. Such an event is told from chance by the scatter of the mean itself, and from
//! the ringing of the strongest event by silence between the two. Source: own.

use super::super::{RESOLVED, narrower_hz};
use super::{ABOVE, ABOVE_IN_HALF, Mean, Search, between, median, top};

/// Least height of both bands together above their median, over their scatter: a convention.
const SCATTERS: f64 = 4.0;
/// The scatter of normal numbers over the median of their distances from the median.
const OF_MEDIAN: f64 = 1.4826;

impl Search {
    /// Distance of a faint second event [samples]: the one before which it is most silent.
    pub(super) fn faint(&self, means: &[Mean; 2]) -> Option<f64> {
        let together = |low: &[f64], high: &[f64]| -> Vec<f64> {
            low.iter().zip(high).map(|(low, high)| (low * high).sqrt()).collect()
        };
        let [low, high] = means;
        let reach = low.reach;
        let both = together(&low.all, &high.all);
        let halves = [0, 1].map(|half| together(&low.halves[half], &high.halves[half]));
        let middle = median(self.among(&both, reach));
        let off = self.among(&both, reach).iter().map(|power| (power - middle).abs()).collect();
        let least = middle + SCATTERS * OF_MEDIAN * median(off);
        let shortest = RESOLVED / narrower_hz(self.sample_rate_hz) * self.sample_rate_hz;
        let silence = |n: usize| between(&low.all, n, reach).min(between(&high.all, n, reach));
        let stands = |n: usize| {
            n.abs_diff(reach) as f64 >= shortest
                && both[n] >= least
                && low.all[n].max(high.all[n]) >= ABOVE
                && low.all[n].min(high.all[n]) >= ABOVE_IN_HALF
                && halves.iter().all(|half| half[n] >= ABOVE_IN_HALF)
                && silence(n) <= 1.0
                && self.is_alone(&both, n, reach)
        };
        let ringing = |n: &usize| silence(*n) / both[*n];
        let found = (1..both.len() - 1).filter(|n| stands(*n));
        let best = found.min_by(|one, other| ringing(one).total_cmp(&ringing(other)))?;
        Some((top(&both, best) - reach as f64).abs())
    }
}
