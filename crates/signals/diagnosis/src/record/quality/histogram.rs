//! How values are distributed: one that is too frequent, both ends and nothing between, one side alone.

use super::similarity;

/// Values of a stretch of the record, sorted.
#[derive(Debug)]
pub(super) struct Histogram {
    sorted: Vec<f64>,
    /// Values with the number of runs of equal samples, ascending.
    values: Vec<(f64, usize)>,
    /// Places there of the most frequent ones.
    frequent: Vec<usize>,
    /// Samples in each of [`BINS`] parts of the range.
    bins: Vec<f64>,
}

/// Parts of the range.
const BINS: usize = 64;
/// How many values may be too frequent, and how many times as often as the next one each is.
const MARKS: usize = 4;
const OFTEN: usize = 8;
/// Share of the samples from which on they matter.
const SHARE: f64 = 0.002;
/// How many times as far from all others as these from each other a mark of missing samples lies, of which two
/// suffice.
const FAR: f64 = 10.0;
/// Fewest values of a signal.
const FEW: usize = 16;

impl Histogram {
    /// `None` for samples that are all equal.
    pub(super) fn of(samples: &[f64]) -> Option<Self> {
        let mut sorted: Vec<f64> = samples.iter().copied().filter(|x| x.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let (low, high) = (*sorted.first()?, *sorted.last()?);
        let width = (high - low) / BINS as f64;
        if !(width > 0.0 && width.is_finite()) {
            return None;
        }
        let mut bins = vec![0.0; BINS];
        sorted.iter().for_each(|x| bins[(((x - low) / width) as usize).min(BINS - 1)] += 1.0);
        // Of a run of equal samples the first counts.
        let again = samples.windows(2).filter(|pair| pair[0] == pair[1] && pair[1].is_finite());
        let mut again: Vec<f64> = again.map(|pair| pair[1]).collect();
        again.sort_unstable_by(f64::total_cmp);
        let mut at = 0;
        let runs = |all: &[f64]| {
            let from = at;
            while again.get(at).is_some_and(|x| *x == all[0]) {
                at += 1;
            }
            (all[0] + 0.0, all.len() + from - at)
        };
        let values: Vec<(f64, usize)> = sorted.chunk_by(|a, b| a == b).map(runs).collect();
        let mut frequent: Vec<usize> = (0..values.len()).collect();
        let rank = |at: &usize| std::cmp::Reverse(values[*at].1);
        if frequent.len() > FEW {
            frequent.select_nth_unstable_by_key(FEW, rank);
        }
        frequent.truncate(FEW);
        frequent.sort_by_key(rank);
        Some(Self { sorted, values, frequent, bins })
    }

    pub(super) fn range(&self) -> f64 {
        self.sorted[self.sorted.len() - 1] - self.sorted[0]
    }

    pub(super) fn quantile(&self, part: f64) -> f64 {
        self.sorted[(part * (self.sorted.len() - 1) as f64).round() as usize]
    }

    /// Whether the values span more decades than a sensor has, as numbers of another format do.
    pub(super) fn is_of_another_format(&self) -> bool {
        const DECADES: f64 = 1e-12;
        let most = self.sorted[0].abs().max(self.sorted[self.sorted.len() - 1].abs());
        let spread = (self.quantile(0.75) - self.quantile(0.25)).abs();
        self.values.len() > FEW && spread < DECADES * most && spread > 0.0
    }

    /// Values that stand more often than all others, but for those at the rails of a limiter, or at even distances where
    /// few do, with their samples.
    pub(super) fn marks(&self, samples: &[f64], rails: &[f64]) -> Vec<(f64, usize)> {
        if self.values.len() <= FEW {
            return Vec::new();
        }
        let some = self.values.iter().filter(|(_, runs)| 2000 * runs > self.sorted.len());
        // Many are those of a waveform.
        let spread = 0.5 * (self.quantile(0.75) - self.quantile(0.25));
        let even = similarity::at_even_distances(samples, some.map(|(value, _)| *value), spread);
        let even = if even.len() > MARKS { Vec::new() } else { even };
        let usual = self.values[self.frequent[MARKS]].1;
        let (first, last) = (self.sorted[0], self.sorted[self.sorted.len() - 1]);
        let count =
            |of: f64| self.sorted.partition_point(|x| *x <= of) - self.sorted.partition_point(|x| *x < of);
        // How far a value lies from all others, over how far these lie from each other.
        let apart = |value: f64| {
            let others = self.sorted.len() - count(value);
            let (lowest, highest) = match value {
                _ if value == first => (self.sorted[self.sorted.len() - others], last),
                _ if value == last => (first, self.sorted[others - 1]),
                _ => (first, last),
            };
            (lowest - value).max(value - highest) / (highest - lowest)
        };
        let at_rail = |value: f64| {
            let at_end = value == first || value == last;
            at_end || rails.iter().any(|rail| (value - rail).abs() < self.range() / 256.0)
        };
        let is_mark = |at: &usize| {
            let (value, runs) = self.values[*at];
            let (apart, at_rail) = (apart(value), at_rail(value));
            let beside = self.values[at.saturating_sub(2)..(at + 3).min(self.values.len())].iter();
            // The density of a signal is smooth.
            let peaks = beside.filter(|of| of.0 != value).all(|of| runs > 4 * of.1 || of.1 > runs);
            let is_often =
                peaks && runs >= OFTEN * usual.max(2) && runs as f64 > SHARE * self.sorted.len() as f64;
            // What fills gaps stands in a few long runs.
            let is_scattered = runs > 1 && 2 * runs > count(value);
            // A few impacts reach the end of the converter.
            let counts = self.frequent[..MARKS].contains(at) || 2000 * runs > self.sorted.len();
            counts && (is_scattered && apart > FAR || runs >= OFTEN && apart > 1.0)
                || is_often && (apart > 0.1 || !at_rail)
        };
        // Marks that lie apart are the first or the last value, however seldom.
        let ends = [0, self.values.len() - 1];
        let frequent = self.frequent.iter().take(MARKS).filter(|at| !ends.contains(at));
        let often = frequent.chain(&ends).filter(|at| is_mark(at)).map(|at| self.values[*at].0);
        let even = even.into_iter().filter(|value| apart(*value) > 0.1 || !at_rail(*value));
        let mut marks: Vec<f64> = often.chain(even).collect();
        marks.sort_by(f64::total_cmp);
        marks.dedup();
        marks.into_iter().map(|value| (value, count(value))).collect()
    }

    /// Samples a bin in the outermost two bins of either end, and in the middle half.
    fn ends_and_middle(&self) -> ([f64; 2], f64) {
        let of = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
        ([of(&self.bins[..2]), of(&self.bins[BINS - 2..])], of(&self.bins[BINS / 4..BINS * 3 / 4]))
    }

    /// Whether values stand at both ends of the range and none in its middle.
    pub(super) fn is_hollow(&self) -> bool {
        let (ends, middle) = self.ends_and_middle();
        let mean = self.sorted.len() as f64 / BINS as f64;
        self.values.len() > FEW && middle < 0.05 * mean && ends.iter().all(|end| *end > mean)
    }

    /// Whether the density breaks off at both ends, where that of a signal falls off and that of a limiter piles up.
    pub(super) fn breaks_off(&self) -> bool {
        const LEAST: f64 = 8.0;
        let sharp = |outer: f64, next: f64| outer >= LEAST && outer > 0.4 * next && outer < 4.0 * next;
        let end = self.bins.len() - 1;
        self.values.len() > FEW
            && sharp(self.bins[0], self.bins[1])
            && sharp(self.bins[end], self.bins[end - 1])
    }

    /// Whether the middle of the range is denser than its ends, as that of a uniform density is not.
    pub(super) fn is_domed(&self) -> bool {
        let (ends, middle) = self.ends_and_middle();
        middle > 1.2 * ends[0].max(ends[1])
    }

    /// Whether all values lie on one side of zero, and most of them near it.
    pub(super) fn is_one_sided(&self) -> bool {
        let [least, low, middle, high, most] = [0.001, 0.1, 0.5, 0.9, 0.999].map(|part| self.quantile(part));
        let (below, above) = ((low - least) / (middle - low), (most - high) / (high - middle));
        let near_zero = |edge: f64, other: f64| edge.abs() < 0.02 * (other - edge).abs();
        self.values.len() > FEW
            && (below < 0.5 && above > 0.9 && near_zero(least, most)
                || above < 0.5 && below > 0.9 && near_zero(most, least))
    }

    /// The range of nearly all values of noise as wide as the middle half is, about this.
    pub(super) fn usual(&self) -> (f64, f64) {
        let [low, high] = [self.quantile(0.25), self.quantile(0.75)];
        let reach = if high > low { 4.0 * (high - low) } else { self.range() };
        (low - reach, high + reach)
    }

    /// The step of the converter, where all values are whole numbers of it.
    pub(super) fn quantum(&self) -> Option<f64> {
        let steps =
            self.sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 1e-10 * self.range());
        let mut step = steps.fold(f64::INFINITY, f64::min);
        let (first, last) = (self.sorted[0], self.sorted.len() - 1);
        // Longer spans say it to more digits than one step of rounded numbers does.
        for at in (0..).map(|n| 1 << n).take_while(|at| *at < 2 * last) {
            let span = self.sorted[last.min(at)] - first;
            step = if span > 0.5 * step { span / (span / step).round() } else { step };
        }
        let is_whole = |x: &f64| (x / step - (x / step).round()).abs() < 0.05;
        let in_steps = step.is_finite() && self.range() / step < 4.4e9 && self.sorted.iter().all(is_whole);
        // Whole numbers of which few are there have larger steps than one.
        in_steps.then_some(step).or_else(|| self.sorted.iter().all(|x| x.fract() == 0.0).then_some(1.0))
    }
}
