//! Samples that are alike: those of every n-th place, stretches and values that recur, peaks of one height.

use std::collections::HashMap;

/// Longest pattern of places.
const PLACES: usize = 8;
/// Ratio of the spreads of two places that no signal has, beside its scatter.
const UNLIKE: f64 = 1.25;
const SCATTER: f64 = 6.0;

/// What a pattern of places is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Pattern {
    /// Samples stand as many times.
    Held,
    /// One value stands between samples.
    Stuffed,
    /// Places differ in level.
    Unlike,
}

/// The shortest pattern of places that repeats through the samples, with its length.
pub(super) fn pattern(samples: &[f64]) -> Option<(usize, Pattern)> {
    let steps: Vec<f64> = samples.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let found = (2..=PLACES).find_map(|places| {
        let (values, steps) = (spreads(samples, places), spreads(&steps, places));
        let limit = UNLIKE + SCATTER * places as f64 / (samples.len() as f64).sqrt();
        let is_unlike = |all: &[f64]| extremes(all).is_some_and(|(least, most)| most > limit * least);
        let stands = |all: &[f64]| all.contains(&0.0) && all.iter().any(|spread| *spread > 0.0);
        match () {
            () if stands(&values) => Some((places, Pattern::Stuffed)),
            () if stands(&steps) => Some((places, Pattern::Held)),
            () if is_unlike(&values) || is_unlike(&steps) => Some((places, Pattern::Unlike)),
            () => None,
        }
    });
    let (places, kind) = found?;
    // Of samples that stand n times, n is the usual length of a run.
    let runs = steps.iter().filter(|step| **step != 0.0).count() + 1;
    let each = (samples.len() as f64 / runs as f64).round() as usize;
    Some((if kind == Pattern::Held { each.max(2) } else { places }, kind))
}

/// Mean distance from the mean of the samples at each of `places` places, which a line of the sample rate leaves as
/// they are.
fn spreads(samples: &[f64], places: usize) -> Vec<f64> {
    let of = |place: usize| samples.iter().skip(place).step_by(places).copied().filter(|x| x.is_finite());
    let spread = |place: usize| {
        let count = of(place).count().max(1) as f64;
        let first = of(place).next().unwrap_or(0.0);
        let mean = first + of(place).map(|x| x - first).sum::<f64>() / count;
        of(place).map(|x| (x - mean).abs()).sum::<f64>() / count
    };
    (0..places).map(spread).collect()
}

fn extremes(all: &[f64]) -> Option<(f64, f64)> {
    let least = all.iter().copied().reduce(f64::min)?;
    Some((least, all.iter().copied().reduce(f64::max)?))
}

/// Samples of a window by which stretches are found, one window in so many, and the shortest stretch.
const WINDOW: usize = 16;
const ONE_IN: u64 = 16;
const STRETCH: usize = 64;
/// Longest period of a waveform that was made, and fills most of the record.
const WAVEFORM: usize = 256;

/// Stretches that stand a second time, to the last bit.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Repeats {
    /// Samples in them.
    pub(super) samples: usize,
    /// Where the first begins, and how far before it stood.
    pub(super) first: usize,
    pub(super) lag: usize,
    /// Whether they are a short waveform that fills most of the record, as signals are that were made.
    pub(super) is_waveform: bool,
}

pub(super) fn repeats(samples: &[f64]) -> Option<Repeats> {
    let mut seen = HashMap::<u64, usize>::new();
    let (mut found, mut past) = (Repeats::default(), 0);
    for (at, window) in samples.windows(WINDOW).enumerate() {
        if at < past {
            continue;
        }
        let hash = window
            .iter()
            .fold(0_u64, |hash, x| (hash ^ x.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(23));
        if hash % ONE_IN != 0 || window.windows(2).filter(|pair| pair[0] == pair[1]).count() > WINDOW / 4 {
            continue;
        }
        let Some(before) = seen.insert(hash, at) else { continue };
        let equal = |(a, b): &(&f64, &f64)| a == b;
        let behind = samples[at..].iter().zip(&samples[before..]).take_while(equal).count();
        let ahead =
            samples[past..at].iter().rev().zip(samples[..before].iter().rev()).take_while(equal).count();
        if ahead + behind >= STRETCH {
            if found.samples == 0 {
                (found.first, found.lag) = (at - ahead, at - before);
            }
            found.samples += ahead + behind;
            past = at + behind;
        }
    }
    found.is_waveform = found.lag < WAVEFORM && 2 * found.samples > samples.len();
    (found.samples > 0).then_some(found)
}

/// Periods of counters [samples], beside the distance of the largest steps, and the shortest.
const COUNTS: [usize; 4] = [256, 1024, 4096, 65_536];
const SHORTEST: usize = 64;
/// Share of the power of the mean period that lies in its rise; that of a sine has 6/π² at most.
const RISE: f64 = 0.9;

/// The period of a counter in the samples, alone or below a signal, and by how much it rises.
pub(super) fn counter(samples: &[f64]) -> Option<(usize, f64)> {
    let steps = || samples.windows(2).map(|pair| pair[1] - pair[0]);
    let largest = steps().fold(0.0, |most: f64, step| if step.abs() > most.abs() { step } else { most });
    let falls: Vec<usize> = steps().enumerate().filter(|(_, s)| s / largest > 0.5).map(|(n, _)| n).collect();
    let apart: Vec<f64> = falls.windows(2).map(|pair| (pair[1] - pair[0]) as f64).collect();
    let own = super::median(&apart).map(|apart| apart as usize);
    COUNTS.into_iter().chain(own).find_map(|period| Some((period, rise(samples, period)?)))
}

/// By how much the mean of all periods rises, where it does so evenly and falls back at once.
fn rise(samples: &[f64], period: usize) -> Option<f64> {
    if period < SHORTEST {
        return None;
    }
    let level = |of: &[f64]| of.iter().sum::<f64>() / period as f64;
    let all: Vec<&[f64]> = samples.chunks_exact(period).filter(|of| level(of).is_finite()).collect();
    let [first, .., last] = &all[..] else { return None };
    let count = all.len() as f64;
    let mut mean = vec![0.0; period];
    all.iter().for_each(|of| mean.iter_mut().zip(*of).for_each(|(sum, x)| *sum += x / count));
    let step = |at: usize| (mean[at] - mean[(at + period - 1) % period]).abs();
    let falls = (0..period).max_by(|a, b| step(*a).total_cmp(&step(*b)))?;
    mean.rotate_left(falls);
    let (about, middle) = (level(&mean), 0.5 * (period as f64 - 1.0));
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        mean.iter().enumerate().map(|(n, y)| of(n as f64 - middle, y - about)).sum()
    };
    let (xx, xy, yy) = (sum(&|x, _| x * x), sum(&|x, y| x * y), sum(&|_, y| y * y));
    let rise = xy / xx * period as f64;
    // What drifts does not fall back.
    let drift = (level(last) - level(first)) / (count - 1.0);
    (xy * xy > RISE * xx * yy && drift.abs() < 0.25 * rise.abs()).then_some(rise)
}

/// Fewest runs of a value that show that it stands at even distances.
const EVEN: usize = 16;

/// Those of the values that stand at even distances, as marks do that are written in turn: the samples before them
/// differ by `spread` and more, where those of a waveform are equal, too.
pub(super) fn at_even_distances(samples: &[f64], values: impl Iterator<Item = f64>, spread: f64) -> Vec<f64> {
    // The last place of each, its distance from the one before, runs, and those at the same distance as before; the
    // range of the samples before.
    let none = ([0_usize; 4], (f64::INFINITY, f64::NEG_INFINITY));
    let mut seen: HashMap<u64, _> = values.map(|value| (value.to_bits(), none)).collect();
    for (at, pair) in samples.windows(2).enumerate().filter(|(_, pair)| pair[0] != pair[1]) {
        if let Some(([last, apart, runs, same], (low, high))) = seen.get_mut(&(pair[1] + 0.0).to_bits()) {
            *same += usize::from(at - *last == *apart);
            (*last, *apart, *runs) = (at, at - *last, *runs + 1);
            (*low, *high) = (low.min(pair[0]), high.max(pair[0]));
        }
    }
    seen.retain(|_, ([.., runs, same], (low, high))| {
        *runs >= EVEN && 2 * *same > *runs && *high - *low > spread
    });
    let mut even: Vec<f64> = seen.into_keys().map(f64::from_bits).collect();
    even.sort_by(f64::total_cmp);
    even
}

/// Samples over which a rail is straight, the slower it drifts the more, and the width of a band, over their usual span.
const NEAR: [usize; 3] = [2048, 512, 128];
const WIDTH: f64 = 1.0 / 256.0;
const BANDS: usize = 16;
/// How much of a stretch lies on the rail, and how many times as many samples as in any other band, beside those
/// through which it is drawn; a sine's outermost band holds 2.4 times as many. Of fewer samples some are as many by chance.
const PILED: f64 = 1.0 / 128.0;
const OVER: f64 = 4.0;
const SOME: f64 = 24.0;

/// Share of the samples that pile up at the highest or the lowest of their neighbourhood; those of a converter have steps
/// of `quantum`.
pub(super) fn piled(samples: &[f64], quantum: f64) -> Option<f64> {
    let rail = |sign: f64| NEAR.into_iter().find_map(|near| on_rail(samples, sign, near, quantum));
    let [above, below] = [1.0, -1.0].map(rail);
    (above.is_some() || below.is_some()).then(|| above.unwrap_or(0.0) + below.unwrap_or(0.0))
}

/// Share of the samples that lie on straight lines, each through the highest of either half of `near` samples.
fn on_rail(samples: &[f64], sign: f64, near: usize, quantum: f64) -> Option<f64> {
    let finite = samples.chunks_exact(near).filter(|of| of.iter().all(|x| x.is_finite()));
    let all: Vec<(&[f64], f64)> =
        finite.filter_map(|of| Some((of, extremes(of).map(|(low, high)| high - low)?))).collect();
    let usual = super::median(&all.iter().map(|(_, span)| *span).collect::<Vec<_>>())?;
    let width = (WIDTH * usual).max(quantum);
    // The bands above the line, at it, and below.
    let (mut bands, mut looked_at) = ([0.0_f64; BANDS + 2], 0.0);
    // A silent stretch lies near its highest sample.
    for (of, span) in all.into_iter().filter(|(_, span)| *span > 0.5 * usual) {
        let highest = |from: usize, to: usize| {
            (from..to).max_by(|a, b| f64::total_cmp(&(sign * of[*a]), &(sign * of[*b])))
        };
        let (first, last) = (highest(0, near / 2)?, highest(near / 2, near)?);
        let (from, to) = (sign * of[first], sign * of[last]);
        let dip = of[first..last].iter().map(|x| sign * x).fold(f64::INFINITY, f64::min);
        // One slow swing has no rail of its own.
        let is_line = from.min(to) - dip > 0.25 * span;
        let slope = if is_line { (to - from) / (last - first) as f64 } else { 0.0 };
        let height = if is_line { from } else { from.max(to) };
        for n in 1..near {
            let below = (height + slope * (n as f64 - first as f64) - sign * of[n]) / width + 1.5;
            // What stands still is a gap, or a rail that does not drift.
            if of[n] != of[n - 1] && below >= 0.0 && below < (BANDS + 2) as f64 {
                bands[below as usize] += 1.0;
            }
        }
        bands[1] -= if is_line { 2.0 } else { 1.0 };
        looked_at += near as f64;
    }
    let next = bands[2..].iter().copied().fold(bands[0].max(1.0), f64::max);
    let is_rail = bands[1] > SOME.max(PILED * looked_at).max(OVER * next);
    is_rail.then_some(bands[1] / samples.len() as f64)
}
