//! Rising edges of a tachometer, through levels that follow the record.

/// How the levels are taken between which a pulse must rise and fall to count.
#[derive(Debug, Clone, Copy)]
pub(super) struct Levels {
    /// Stretches of the record that have levels of their own.
    stretches: usize,
    /// Below the first a pulse has ended, above the second it has come: parts of the way from the low to the
    /// high level. Noise and glitches that stay between them are none.
    between: [f64; 2],
    /// The low and the high level are the lowest and the highest sample, not those that one sample in a
    /// thousand lies beyond.
    extreme: bool,
}

/// Those of most tachometers; pulses of differing height; pulses downwards of differing depth.
const BETWEEN: [[f64; 2]; 3] = [[0.3, 0.7], [0.1, 0.3], [0.7, 0.9]];
/// Stretches of the record, the whole first.
const STRETCHES: [usize; 4] = [1, 4, 16, 64];
/// Fewest samples of a stretch.
const LEAST: usize = 64;
/// A stretch whose levels lie nearer to each other than this part of the usual distance holds no pulse.
const FLAT: f64 = 0.25;
/// Fewest samples that make a level; fewer are a spark.
const SPARK: usize = 3;

impl Levels {
    /// All, in the order in which they are tried.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        STRETCHES.into_iter().flat_map(|stretches| {
            [false, true].into_iter().flat_map(move |extreme| {
                BETWEEN.into_iter().map(move |between| Self { stretches, between, extreme })
            })
        })
    }

    /// Low and high level of a stretch.
    fn of(self, samples: &[f64]) -> Option<[f64; 2]> {
        let mut sorted: Vec<f64> = samples.iter().copied().filter(|x| x.is_finite()).collect();
        let last = sorted.len().checked_sub(1)?;
        let mut at = |n: usize| *sorted.select_nth_unstable_by(n, f64::total_cmp).1;
        let [least, most] = [at(0), at(last)];
        let [low, high] = [at(last / 1000), at(last - last / 1000)];
        // Pulses that are shorter than that are all there is; a spark or two are none.
        let middle = 0.5 * (least + most);
        let above = sorted.iter().filter(|x| **x > middle).count();
        let short = high - low < 0.3 * (most - least) && above.min(sorted.len() - above) >= SPARK;
        Some(if self.extreme || short { [least, most] } else { [low, high] })
    }
}

/// Places of the rising edges [samples].
pub(super) fn edges(samples: &[f64], levels: Levels) -> Vec<f64> {
    let length = samples.len().div_ceil(levels.stretches).max(LEAST);
    let mut of_stretches: Vec<Option<[f64; 2]>> =
        samples.chunks(length).map(|stretch| levels.of(stretch)).collect();
    let mut heights: Vec<f64> = of_stretches.iter().flatten().map(|[low, high]| high - low).collect();
    heights.sort_by(f64::total_cmp);
    let Some(&usual) = heights.get(heights.len() / 2) else { return Vec::new() };
    for of in &mut of_stretches {
        *of = of.filter(|[low, high]| high > low && high - low >= FLAT * usual);
    }
    // The levels of a stretch are those at its middle; between two, and beside one without, they follow
    // straight lines.
    let known: Vec<(f64, [f64; 2])> = (of_stretches.iter().enumerate())
        .filter_map(|(n, of)| Some((((n as f64 + 0.5) * length as f64).min(samples.len() as f64), (*of)?)))
        .collect();
    if known.is_empty() {
        return Vec::new();
    }
    let (mut edges, mut armed, mut before, mut at) = (Vec::new(), false, [f64::NAN; 2], 0);
    let mut crossed = None;
    for (n, &x) in samples.iter().enumerate() {
        if !x.is_finite() {
            continue;
        }
        while at + 2 < known.len() && known[at + 1].0 <= n as f64 {
            at += 1;
        }
        let [low, high] = between(&known[at..(at + 2).min(known.len())], n as f64);
        let level = |part: f64| low + part * (high - low);
        let [reset, set] = levels.between;
        // Height above the middle.
        let over = x - level(0.5 * (reset + set));
        if x < level(reset) {
            armed = true;
            crossed = None;
        }
        if armed && over >= 0.0 && before[1] < 0.0 {
            // The last time that it passes the middle on its way up: a base line at the middle passes it
            // many times.
            crossed = Some(before[0] + (n as f64 - before[0]) * before[1] / (before[1] - over));
        }
        if armed && x >= level(set) {
            edges.extend(crossed.take());
            armed = false;
        }
        before = [n as f64, over];
    }
    edges
}

/// How many times the samples rise at once, by most of their largest rises: the edges of pulses, whatever
/// they stand on.
pub(super) fn steps(samples: &[f64]) -> usize {
    /// Of the largest rise.
    const PART: f64 = 0.75;
    let rises: Vec<f64> = samples.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sorted: Vec<f64> = rises.iter().copied().filter(|rise| rise.is_finite()).collect();
    // A spark or two are none.
    let Some(at) = sorted.len().checked_sub(SPARK) else { return 0 };
    let least = PART * *sorted.select_nth_unstable_by(at, f64::total_cmp).1;
    let is_step = |rise: f64| rise > least && rise > 0.0;
    rises.windows(2).filter(|pair| is_step(pair[1]) && !is_step(pair[0])).count()
}

/// The levels at a place, on the line through those of one or two stretches, and no farther.
fn between(known: &[(f64, [f64; 2])], at: f64) -> [f64; 2] {
    match known {
        [(from, a), (until, b)] => {
            let part = ((at - from) / (until - from)).clamp(0.0, 1.0);
            [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]
        }
        [(_, only), ..] => *only,
        [] => [f64::NAN; 2],
    }
}
