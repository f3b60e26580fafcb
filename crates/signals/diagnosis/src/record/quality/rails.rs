//! Values that pile up at the ends of their range.
//!
//! The density of a signal falls towards its extremes, or rises as that of a sine does, whose outermost band
//! holds `1/(√2 − 1)` = 2.4 times the next one, whatever the width of the bands. A limiter puts all that lies
//! beyond it into one band, which then holds many times its neighbours.

use std::collections::HashMap;

/// Bands of the histogram.
const BANDS: usize = 1 << 13;
/// Levels that are counted one by one.
const LEVELS: usize = 1 << 12;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rail {
    pub(super) value: f64,
    pub(super) samples: u64,
    pub(super) first: u64,
}

/// Samples in a band, runs of equal ones, and the first of them.
#[derive(Debug, Clone, Copy, Default)]
struct Count {
    samples: u64,
    runs: u64,
    first: u64,
}

impl Count {
    fn join(&mut self, other: Self) {
        self.first = match (self.samples, other.samples) {
            (0, _) => other.first,
            (_, 0) => self.first,
            _ => self.first.min(other.first),
        };
        self.samples += other.samples;
        self.runs += other.runs;
    }
}

/// The density of values, in bands whose width doubles where the range grows.
#[derive(Debug, Default)]
pub(super) struct Rails {
    /// Values until the first two that differ.
    low: f64,
    width: f64,
    bands: Vec<Count>,
    /// Before there is a width.
    only: Option<(f64, Count)>,
    levels: Option<HashMap<u64, u64>>,
    extremes: Option<(f64, f64)>,
    longest: [(u64, u64); 2],
    count: u64,
    runs: u64,
}

impl Rails {
    /// Of values whose levels are counted, too.
    pub(super) fn with_levels() -> Self {
        Self { levels: Some(HashMap::new()), ..Self::default() }
    }

    pub(super) fn add(&mut self, value: f64, is_new: bool) {
        let at = self.count;
        self.count += 1;
        self.runs += u64::from(is_new);
        if let (Some(levels), true) = (&mut self.levels, is_new) {
            *levels.entry((value + 0.0).to_bits()).or_default() += 1;
            if levels.len() > LEVELS {
                self.levels = None;
            }
        }
        let (low, high) = self.extremes.get_or_insert((value, value));
        if value > *high {
            *high = value;
            self.longest[1] = (0, 0);
        }
        if value < *low {
            *low = value;
            self.longest[0] = (0, 0);
        }
        for (side, extreme) in [*low, *high].into_iter().enumerate() {
            let (now, most) = &mut self.longest[side];
            *now = if value == extreme { *now + 1 } else { 0 };
            *most = (*most).max(*now);
        }
        let one = Count { samples: 1, runs: u64::from(is_new), first: at };
        self.place(value, one);
    }

    fn place(&mut self, value: f64, one: Count) {
        if self.bands.is_empty() {
            let Some((only, count)) = &mut self.only else {
                self.only = Some((value, one));
                return;
            };
            if *only == value {
                count.join(one);
                return;
            }
            let (only, count) = (*only, *count);
            // The first step takes a quarter of the bands, in the middle of them all.
            self.width = (4.0 * (value - only).abs() / BANDS as f64).max(f64::MIN_POSITIVE);
            self.low = 0.5 * (value + only) - 0.5 * BANDS as f64 * self.width;
            self.bands = vec![Count::default(); BANDS];
            self.place(only, count);
        }
        while !(self.low..self.low + BANDS as f64 * self.width).contains(&value) {
            if !(self.width * 2.0 * BANDS as f64).is_finite() {
                return;
            }
            self.widen(value < self.low);
        }
        let band = ((value - self.low) / self.width) as usize;
        self.bands[band.min(BANDS - 1)].join(one);
    }

    /// Twice the width, and as much room again below or above.
    fn widen(&mut self, below: bool) {
        let mut half = vec![Count::default(); BANDS / 2];
        for (n, count) in self.bands.iter().enumerate() {
            half[n / 2].join(*count);
        }
        let empty = vec![Count::default(); BANDS / 2];
        if below {
            self.low -= BANDS as f64 * self.width;
            self.bands = [empty, half].concat();
        } else {
            self.bands = [half, empty].concat();
        }
        self.width *= 2.0;
    }

    /// Whether a value is the least or the largest so far.
    pub(super) fn is_extreme(&self, value: f64) -> bool {
        self.extremes.is_some_and(|(low, high)| value == low || value == high)
    }

    /// Whether an extreme lies farther from all other values than these from each other, as marks of missing
    /// samples do.
    pub(super) fn is_far(&self, value: f64) -> bool {
        self.distance(value).is_some_and(|over_range| over_range > 2.0)
    }

    /// Whether no values lie near an extreme: a limiter's rail has its neighbours.
    pub(super) fn is_apart(&self, value: f64) -> bool {
        self.distance(value).is_some_and(|over_range| over_range > 0.1)
    }

    /// How far an extreme lies from all other values, over the range of these.
    fn distance(&self, value: f64) -> Option<f64> {
        let (low, high) = self.extremes.filter(|_| !self.bands.is_empty())?;
        let own = (((value - self.low) / self.width) as usize).min(BANDS - 1);
        let others = || (0..BANDS).filter(|n| self.bands[*n].samples > 0 && n.abs_diff(own) > 1);
        let (least, most) = (others().next()?, others().next_back()?);
        let gap = if value == high { own.saturating_sub(most) } else { least.saturating_sub(own) };
        (value == high || value == low).then(|| gap as f64 / (most - least + 1) as f64)
    }

    /// How many values make up 99 of 100 runs, where they are [`FEW`] at most.
    pub(super) fn few_levels(&self) -> Option<usize> {
        let levels = self.levels.as_ref()?;
        let mut counts: Vec<u64> = levels.values().copied().collect();
        counts.sort_unstable_by(|a, b| b.cmp(a));
        let mut seen = 0;
        let few = counts.iter().take(FEW).position(|count| {
            seen += count;
            100 * seen >= 99 * self.runs
        })?;
        Some(few + 1)
    }

    /// Rails at the lower and the upper end. `natural` is the usual length of runs of equal samples; samples of
    /// few levels have no density.
    pub(super) fn clipped(&self, natural: u64, few: bool) -> (Option<Rail>, Option<Rail>) {
        if self.bands.is_empty() || few {
            return (None, None);
        }
        let of = |upper: bool| {
            let row = self.longest[usize::from(upper)].1;
            let extreme = self.extremes.map_or(0.0, |(low, high)| if upper { high } else { low });
            let outermost = || {
                let band = (((extreme - self.low) / self.width) as usize).min(BANDS - 1);
                let count = self.bands[band];
                Rail { value: extreme, samples: count.samples, first: count.first }
            };
            self.rail(upper, natural, 0)
                .or_else(|| self.rail(upper, natural, (self.count / 10_000).max(3)))
                .or_else(|| (row >= ROW * natural && !self.is_far(extreme)).then(outermost))
        };
        (of(false), of(true))
    }

    /// The rail at one end, where up to `beyond` samples lie beyond it.
    fn rail(&self, upper: bool, natural: u64, beyond: u64) -> Option<Rail> {
        let mut occupied: Vec<usize> = (0..BANDS).filter(|n| self.bands[*n].samples > 0).collect();
        // A mark of missing samples is no rail, and stretches the range of the others.
        let (low, high) = self.extremes?;
        if self.is_far(high) {
            occupied.pop();
        }
        if self.is_far(low) {
            occupied.remove(0);
        }
        if occupied.len() <= FEW {
            return None;
        }
        let (mut least, mut most) = (*occupied.first()?, *occupied.last()?);
        let mut skipped = 0;
        let inward: Vec<usize> =
            if upper { occupied.iter().rev().copied().collect() } else { occupied.clone() };
        let outer = inward.into_iter().find(|n| {
            skipped += self.bands[*n].samples;
            skipped > beyond
        })?;
        if upper {
            most = outer
        } else {
            least = outer
        }
        let range = most.checked_sub(least)? as f64;
        // Where a converter has fewer levels than there are bands, one of these holds one level.
        let spacing = range / (occupied.len() as f64 - 1.0);
        let level = if self.levels.is_some() && spacing > 1.5 { spacing } else { 1.0 };
        // What repeats itself exactly has its other values as often as its largest.
        let mut held: Vec<u64> = occupied.iter().map(|n| self.bands[*n].samples).collect();
        let middle = held.len() / 2;
        let usual_band = *held.select_nth_unstable(middle).1;
        WIDTHS.iter().find_map(|part| {
            let width = (part * range).max(level);
            let others = ((OUTER * range / width).ceil() as usize).max(4);
            let mut bands = vec![Count::default(); others + 1];
            for (n, count) in self.bands.iter().enumerate().take(most + 1).skip(least) {
                let distance = if upper { most - n } else { n - least };
                if let Some(band) = bands.get_mut(((distance as f64 + 0.25 * width) / width) as usize) {
                    band.join(*count);
                }
            }
            let (top, others) = bands.split_first()?;
            let next = others.iter().map(|band| band.samples).max().unwrap_or(0);
            let share = top.samples as f64 / self.count as f64;
            let ratio = top.samples as f64 / next.max(1) as f64;
            let usual = self.count as f64 / self.runs.max(1) as f64;
            let stays = top.samples as f64 >= 1.1 * usual * top.runs as f64;
            let piles = top.samples as f64 >= OVER * usual_band as f64;
            let much = share >= MUCH && ratio >= OVER / 2.0;
            let is_rail = top.runs >= RUNS && natural > 0 && (much || (stays || piles) && ratio >= OVER);
            let extreme = if upper { high } else { low };
            let is_outermost = beyond == 0 && !self.is_far(extreme);
            let value = if is_outermost { extreme } else { self.low + (outer as f64 + 0.5) * self.width };
            is_rail.then_some(Rail { value, samples: top.samples, first: top.first })
        })
    }
}

/// Most levels of a converter that hardly resolves a signal.
const FEW: usize = 16;
/// Widths of the outermost band, as parts of the range: a hard limiter fills the first, a soft one the last.
const WIDTHS: [f64; 3] = [1.0 / 1024.0, 1.0 / 256.0, 1.0 / 64.0];
/// Part of the range beside it with which it is compared.
const OUTER: f64 = 1.0 / 16.0;
/// How many times as many samples as any of its neighbours it holds: a sine's holds 2.4 times as many.
const OVER: f64 = 10.0;
/// Share of all samples from which on half of that suffices.
const MUCH: f64 = 0.01;
/// Fewest runs at a rail.
const RUNS: u64 = 12;
/// Equal samples in a row at an extreme, over the usual number, that only a limiter makes.
const ROW: u64 = 4;
