//! Stretches that stand still at one value.

/// Samples that stand still at one value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Run {
    pub(super) value: f64,
    pub(super) from: u64,
    pub(super) count: u64,
    /// Whether it begins with the record, or ends with it.
    pub(super) from_start: bool,
    pub(super) to_end: bool,
}

/// Shortest stretch that is kept [samples]: a converter that resolves the signal makes none as long.
const SHORTEST: u64 = 16;
/// Shortest one of those of which there are many, where samples all differ, and how many.
const SHORT: u64 = 6;
const MANY: usize = 8;
const MOST_SHORT: usize = 4096;
/// How many times as long as nearly all runs of equal samples a stretch is in which there is no signal.
const UNUSUAL: u64 = 16;
/// Stretches kept; further ones are as these.
const KEPT: usize = 1 << 16;
/// Lengths that are counted.
const LENGTHS: usize = 1 << 12;

/// Runs of equal samples.
#[derive(Debug, Default)]
pub(super) struct Flat {
    run: Option<(Run, bool)>,
    kept: Vec<Run>,
    /// Those that are too short to mean anything alone.
    short: Vec<Run>,
    /// Runs by their length, those at an extreme apart: what a limiter makes says nothing about the converter.
    lengths: Vec<u64>,
    all: u64,
}

impl Flat {
    pub(super) fn add(&mut self, value: f64, at: u64, is_new: bool, is_extreme: bool) {
        match &mut self.run {
            Some((run, _)) if !is_new => run.count += 1,
            _ => {
                self.interrupt();
                self.run =
                    Some((Run { value, from: at, count: 1, from_start: at == 0, to_end: false }, is_extreme));
            }
        }
    }

    /// Whether a value is that of the run, or as near to it.
    pub(super) fn goes_on(&self, value: f64, reach: f64) -> bool {
        self.run.is_some_and(|(run, _)| (run.value - value).abs() <= reach)
    }

    /// Runs of so many samples and more of a value other than zero.
    pub(super) fn of_at_least(&self, count: u64) -> Vec<Run> {
        self.kept.iter().filter(|run| run.count >= count && run.value != 0.0).copied().collect()
    }

    /// Ends the run, as a sample that is no number does, and the end of the record.
    pub(super) fn interrupt(&mut self) {
        let Some((run, is_extreme)) = self.run.take() else { return };
        if !is_extreme {
            let place = (run.count as usize).min(LENGTHS - 1);
            if self.lengths.len() <= place {
                self.lengths.resize(place + 1, 0);
            }
            self.lengths[place] += 1;
            self.all += 1;
        }
        if run.count >= SHORTEST && self.kept.len() < KEPT {
            self.kept.push(run);
        } else if (SHORT..SHORTEST).contains(&run.count) && self.short.len() < MOST_SHORT {
            self.short.push(run);
        }
    }

    /// Length that 99 of 100 runs do not exceed; 1 for samples that all differ, more for a sensor that is read
    /// more often than it measures.
    pub(super) fn natural(&self) -> u64 {
        let mut seen = 0;
        let place = self.lengths.iter().position(|count| {
            seen += count;
            100 * seen >= 99 * self.all
        });
        place.unwrap_or(1).max(1) as u64
    }

    /// The stretches without a signal in a record of `count` samples.
    pub(super) fn stretches(&self, count: u64) -> Vec<Run> {
        let least = SHORTEST.max(UNUSUAL * self.natural());
        let are_many = self.natural() == 1 && (MANY..MOST_SHORT).contains(&self.short.len());
        let short = self.short.iter().filter(|_| are_many);
        let long = self.kept.iter().filter(|run| run.count >= least).chain(short);
        long.map(|run| Run { to_end: run.from + run.count == count, ..*run }).collect()
    }
}

/// Shortest straight line that is kept [samples], and how much its steps may differ, over the values.
pub(super) const STRAIGHT: u64 = 64;
pub(super) const ROUNDING: f64 = 1e-12;
