//! The second event of passages whose rhythm is known, from the mean power about the strongest event of each.
//!
//! A correlation of the power with itself needs two events of about equal energy: one that is weaker by a
//! factor `a` stands in it by `a/(1 + a²)`, beneath the ringing of the other. The mean over passages, each
//! counted from its own strongest event, shows a second one as soon as it stands above the level between
//! passages, however much weaker than the first it is. Source: own.

mod faint;

use std::ops::Range;

use super::{AGREED, smoothing};

/// Passages that share one phase: within them slip moves an event by less than the quarter of a period in
/// which it is looked for.
const SHARED: f64 = 40.0;
/// Steps of a period in which the place of the strongest event is looked for, and how many of them, on either
/// side, the power is summed over.
const STEPS: usize = 100;
const BESIDE: usize = 2;
/// Part of a period about that place in which an event belongs to a passage, on either side.
const OWN: f64 = 0.25;
/// Fewest passages of a mean.
const FEWEST: usize = 8;
/// Least power of a second event over the median between passages: in the mean of all of them, and in that of
/// either half, every other passage.
const ABOVE: f64 = 2.0;
const ABOVE_IN_HALF: f64 = 1.5;
/// Between the second and the strongest event the power falls to this part of the second's, or it is the
/// ringing of the strongest.
const VALLEY: f64 = 0.4;
/// A second event is the highest within this part of its distance, on either side.
const ALONE: f64 = 0.05;
/// The mean is looked at up to this many times the longest distance, so that an event there has both flanks.
const BEYOND: f64 = 1.1;
/// An event of several peaks begins with the first that has this part of the height of the one taken.
const BEGINS: f64 = 0.5;

pub(super) struct Search {
    /// Time between passages [samples].
    pub(super) period: f64,
    /// Distances of the second event [samples].
    pub(super) lags: Range<usize>,
    pub(super) sample_rate_hz: f64,
}

/// Mean power of one band about the strongest events, from before them to as long after, over its median
/// between passages.
struct Mean {
    all: Vec<f64>,
    /// Those of every other passage.
    halves: [Vec<f64>; 2],
    /// Place of the strongest event.
    reach: usize,
}

#[derive(Clone, Copy)]
struct Second {
    /// Its place in the mean.
    at: usize,
    /// Distance from the strongest event, before or after it [samples].
    lag: f64,
    /// How far the power falls between the two, over the power of the second.
    valley: f64,
}

impl Search {
    /// Distances in samples at which both of two bands have the second event; `None` where they have none, or
    /// do not agree. `bands` are smoothed powers over time.
    pub(super) fn second_events(&self, bands: &[Vec<f64>; 2]) -> Option<[f64; 2]> {
        let both: Vec<f64> = bands[0].iter().zip(&bands[1]).map(|(low, high)| low + high).collect();
        let strongest = self.strongest(&both);
        if strongest.len() < FEWEST {
            return None;
        }
        let means = bands.each_ref().map(|power| self.mean(power, &strongest));
        self.clear(&means).or_else(|| self.faint(&means).map(|lag| [lag; 2]))
    }

    /// Distances of an event that stands in either band by itself [samples].
    fn clear(&self, means: &[Mean; 2]) -> Option<[f64; 2]> {
        let [low, high] = means.each_ref().map(|mean| self.seconds(mean));
        // Events are no sharper than the filter that smoothed them.
        let sharp = smoothing(self.sample_rate_hz) as f64;
        let agree =
            |a: &Second, b: &Second| (a.lag - b.lag).abs() < (AGREED * a.lag.max(b.lag)).max(0.5 * sharp);
        let pairs: Vec<[Second; 2]> = low
            .iter()
            .flat_map(|a| high.iter().filter(move |b| agree(a, b)).map(move |b| [*a, *b]))
            .collect();
        // Of several, the one before which it is most silent: what bounces or rings right after an impact may
        // be louder than a second impact, and never stands as free of the first.
        let ringing = |[a, b]: &[Second; 2]| a.valley.max(b.valley);
        let best = pairs.iter().min_by(|one, other| ringing(one).total_cmp(&ringing(other)))?;
        let begins = pairs.iter().filter(|pair| begins(means, pair, best));
        let first = begins.min_by_key(|[a, b]| a.at + b.at).unwrap_or(best);
        Some(first.map(|second| second.lag))
    }

    /// Places of the strongest event of each passage, but of those too near to an end of the record.
    fn strongest(&self, power: &[f64]) -> Vec<usize> {
        let mut places = Vec::new();
        let shared = (SHARED * self.period) as usize;
        for (n, part) in power.chunks(shared).enumerate() {
            let centre = self.phase(part);
            let of = |passage: usize, off: f64| {
                (((passage as f64 + centre + off) * self.period).max(0.0)) as usize
            };
            let ends = (0..).map(|passage| of(passage, -OWN)..of(passage, OWN));
            for within in ends.take_while(|within| within.end <= part.len()) {
                let place = n * shared + highest(part, within);
                if place >= self.reach() && place + self.reach() < power.len() {
                    places.push(place);
                }
            }
        }
        places
    }

    /// Part of a period at which the power is highest, over all passages of a part of the record.
    fn phase(&self, power: &[f64]) -> f64 {
        let mut steps = [0.0; STEPS];
        for (n, power) in power.iter().enumerate() {
            steps[((n as f64 / self.period).fract() * STEPS as f64) as usize % STEPS] += power;
        }
        let about = |step: usize| {
            (step + STEPS - BESIDE..=step + STEPS + BESIDE).map(|near| steps[near % STEPS]).sum::<f64>()
        };
        let best = (0..STEPS).max_by(|a, b| about(*a).total_cmp(&about(*b))).unwrap_or(0);
        (best as f64 + 0.5) / STEPS as f64
    }

    fn seconds(&self, mean: &Mean) -> Vec<Second> {
        let Mean { all, halves, reach } = mean;
        let reach = *reach;
        let stands = |n: usize| {
            all[n] >= ABOVE
                && halves.iter().all(|half| half[n] >= ABOVE_IN_HALF)
                && self.is_alone(all, n, reach)
                && between(all, n, reach) <= VALLEY * all[n]
        };
        // A band may be later than both together.
        let sharp = smoothing(self.sample_rate_hz).min(reach - 1);
        let first = top(all, highest(all, reach - sharp..reach + sharp + 1));
        let second = |n: usize| Second {
            at: n,
            lag: (top(all, n) - first).abs(),
            valley: between(all, n, reach) / all[n],
        };
        // Such a band moves the distance, too, out of those that are looked at.
        let within = |second: &Second| self.lags.contains(&(second.lag.round() as usize));
        (1..all.len() - 1).filter(|n| stands(*n)).map(second).filter(within).collect()
    }

    /// Whether a place is among the distances that are looked at, and nothing near it is higher.
    fn is_alone(&self, values: &[f64], n: usize, reach: usize) -> bool {
        let apart = n.abs_diff(reach);
        let alone = ((ALONE * apart as f64) as usize).max(1);
        let near = &values[n.saturating_sub(alone)..(n + alone + 1).min(values.len())];
        self.lags.contains(&apart) && near.iter().all(|power| *power <= values[n])
    }

    /// Longest distance of a mean, on either side [samples].
    fn reach(&self) -> usize {
        (BEYOND * self.lags.end as f64) as usize
    }

    fn mean(&self, power: &[f64], strongest: &[usize]) -> Mean {
        let of = |from: usize, step: usize| self.mean_about(power, strongest.iter().skip(from).step_by(step));
        Mean { all: of(0, 1), halves: [of(0, 2), of(1, 2)], reach: self.reach() }
    }

    /// Mean power about the strongest events, over its median among the distances that are looked at.
    fn mean_about<'a>(&self, power: &[f64], strongest: impl Iterator<Item = &'a usize>) -> Vec<f64> {
        let reach = self.reach();
        let mut mean = vec![0.0; 2 * reach + 1];
        for place in strongest {
            mean.iter_mut().zip(&power[place - reach..]).for_each(|(sum, power)| *sum += power);
        }
        let median = median(self.among(&mean, reach)).max(f64::MIN_POSITIVE);
        mean.iter_mut().for_each(|power| *power /= median);
        mean
    }

    /// The values among the distances that are looked at, on either side.
    fn among(&self, values: &[f64], reach: usize) -> Vec<f64> {
        let within = |(n, _): &(usize, &f64)| self.lags.contains(&n.abs_diff(reach));
        values.iter().enumerate().filter(within).map(|x| *x.1).collect()
    }
}

/// Whether an event that one pair of peaks shows begins with another: earlier on the same side of the
/// strongest event, half as high, and without silence between.
fn begins(means: &[Mean; 2], earlier: &[Second; 2], taken: &[Second; 2]) -> bool {
    means.iter().zip(earlier).zip(taken).all(|((mean, a), b)| {
        let same_side = (a.at < mean.reach) == (b.at < mean.reach);
        let goes_on = || mean.all[a.at..b.at].iter().all(|power| *power > 1.0);
        same_side && a.at < b.at && mean.all[a.at] >= BEGINS * mean.all[b.at] && goes_on()
    })
}

/// The least value between a place and the strongest event.
fn between(values: &[f64], n: usize, reach: usize) -> f64 {
    let between = if n < reach { &values[n..reach] } else { &values[reach..n] };
    between.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The middle one of values, of which there is one.
fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The place of the highest value of a range that holds one.
fn highest(values: &[f64], within: Range<usize>) -> usize {
    let from = within.start;
    within.max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(from)
}

/// Where the parabola through a value and its neighbours has its top, if it has one near it [samples].
fn top(values: &[f64], n: usize) -> f64 {
    let (left, right) = (values[n - 1], values[n + 1]);
    let bend = left - 2.0 * values[n] + right;
    let offset = if bend < 0.0 { (0.5 * (left - right) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    n as f64 + offset
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In one band events may come later than in both together, from which passages are counted.
    #[test]
    fn invariant_a_distance_is_among_those_that_are_looked_at() {
        let search = Search { period: 1000.0, lags: 16..400, sample_rate_hz: 40_000.0 };
        let late = smoothing(search.sample_rate_hz) - 1;
        let found = |apart: usize| {
            let strongest: Vec<usize> = (1..20).map(|passage| 1000 * passage).collect();
            let mut power = vec![1.0; 21_000];
            for place in &strongest {
                for (at, height) in [(place + late, 50.0), (place + late - apart, 20.0)] {
                    power[at] = height;
                    power[at - 1] = 0.7 * height;
                    power[at + 1] = 0.7 * height;
                }
            }
            search.seconds(&search.mean(&power, &strongest)).len()
        };
        assert_eq!((found(380), found(398), found(402)), (1, 1, 0));
    }

    /// The parabola through 1, 4 and 3 has its top a quarter of a step behind the middle; a straight line has none.
    #[test]
    fn by_hand_the_top_of_a_parabola() {
        assert_eq!(top(&[0.0, 1.0, 4.0, 3.0], 2), 2.25);
        assert_eq!(top(&[1.0, 2.0, 3.0], 1), 1.0);
    }
}
