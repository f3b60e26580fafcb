//! Samples that are alike: those of every n-th place, stretches that recur, peaks of one height.

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

/// Samples over which a slow rail, and a faster one, hardly drifts, and bands below the highest of them, of these parts
/// of the range.
const NEAR: [usize; 2] = [512, 128];
const WIDTHS: [f64; 2] = [1.0 / 256.0, 1.0 / 128.0];
const BANDS: usize = 17;
/// How many samples a stretch the outermost band holds, and how many times as many as any other.
/// A sine's holds 2.4 times as many; of 17 bands with a dozen samples each one has twice its share by chance.
const PILED: f64 = 4.0;
const OVER: f64 = 5.0;

/// Share of the samples that pile up at the highest or the lowest of their neighbourhood.
pub(super) fn piled(samples: &[f64], range: f64) -> Option<f64> {
    let finite = || samples.iter().copied().filter(|x| x.is_finite());
    let all = finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min);
    let share = |sign: f64, near: usize, width: f64| {
        let mut bands = [0.0; BANDS];
        let mut stretches = 0.0;
        for near in samples.chunks_exact(near) {
            let most = near.iter().map(|x| sign * x).fold(f64::NEG_INFINITY, f64::max);
            let least = near.iter().map(|x| sign * x).fold(f64::INFINITY, f64::min);
            // A silent stretch lies near its highest sample.
            if most - least < 0.25 * range.min(all) {
                continue;
            }
            stretches += 1.0;
            // What stands still is a gap, or a rail that does not drift.
            let moves = |pair: &&[f64]| pair[0] != pair[1] && pair[1].is_finite();
            let moving = near.windows(2).filter(moves).map(|pair| pair[1]);
            moving.map(|x| ((most - sign * x) / (width * range)) as usize).for_each(|band| {
                if let Some(count) = bands.get_mut(band) {
                    *count += 1.0;
                }
            });
            bands[0] -= 1.0;
        }
        let next = bands[1..].iter().copied().fold(1.0, f64::max);
        (bands[0] > PILED * stretches && bands[0] > OVER * next).then_some(bands[0] / samples.len() as f64)
    };
    let any = |sign: f64| {
        NEAR.into_iter().find_map(|near| WIDTHS.into_iter().find_map(|width| share(sign, near, width)))
    };
    let [above, below] = [1.0, -1.0].map(any);
    (above.is_some() || below.is_some()).then(|| above.unwrap_or(0.0) + below.unwrap_or(0.0))
}
