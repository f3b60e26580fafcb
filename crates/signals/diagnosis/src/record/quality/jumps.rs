//! What changes from one sample to the next: the range is crossed, gain or offset change for good.

use super::inspection::Stretch;

/// A step over this part of the range crosses it.
const CROSSED: f64 = 0.75;

/// Steps that cross the range.
pub(super) fn crossings(samples: &[f64], range: f64) -> usize {
    samples.windows(2).filter(|pair| (pair[1] - pair[0]).abs() > CROSSED * range).count()
}

/// Widths of numbers of converters and files [bits].
const BITS: [i32; 10] = [8, 10, 12, 14, 16, 18, 20, 24, 31, 32];

/// The width of numbers of which whole values in steps of `quantum` fill the range, and whether it is that of numbers
/// without a sign.
pub(super) fn full_range(low: f64, high: f64, quantum: f64) -> Option<(i32, bool)> {
    BITS.into_iter().find_map(|bits| {
        let all = f64::from(bits).exp2();
        let fills = |lowest: f64| {
            let near = |value: f64, end: f64| (value / quantum - end).abs() <= 0.01 * all;
            near(low, lowest) && near(high, lowest + all - 1.0)
        };
        (fills(-0.5 * all) || fills(0.0)).then(|| (bits, fills(0.0)))
    })
}

/// The width of numbers [bytes] whose bytes, read in the other order, lie much nearer to each other.
pub(super) fn swapped_bytes(samples: &[f64], quantum: f64) -> Option<usize> {
    let codes = || samples.iter().filter(|x| x.is_finite()).map(|x| (x / quantum).round() as i64);
    let square = |code: i64| (code as f64).powi(2);
    let own: f64 = codes().map(square).sum();
    [2, 3, 4].into_iter().find(|bytes| {
        let bits = 8 * bytes;
        let half = 1_i64 << (bits - 1);
        let turned = |code: i64| {
            let mask = (code as u64) & ((1 << bits) - 1);
            let back = (mask.swap_bytes() >> (64 - bits)) as i64;
            if back >= half { back - 2 * half } else { back }
        };
        // Numbers with or without a sign.
        codes().all(|code| (-half..2 * half).contains(&code))
            && codes().map(|code| square(turned(code))).sum::<f64>() < 0.25 * own
    })
}

/// Stretches on either side of a change that are compared, and the fewest.
const SIDE: usize = 8;
const FEWEST: usize = 2;
/// How many times as strong, and by how many times its spread, a signal is behind a change.
const GAIN: f64 = 4.0;
const OFFSET: f64 = 4.0;

/// Where all frequencies become as much stronger, or weaker, at once: the stretch, and the ratio of what is behind it
/// to what is before it.
pub(super) fn gain(stretches: &[Stretch]) -> Option<(usize, f64)> {
    changes(stretches).find_map(|(at, before, behind)| {
        // Spreads of the samples, of their steps, and of the steps of these: shares of low and high frequencies.
        let ratios = [0, 1, 2].map(|order| {
            let [(a, b), (c, d)] =
                [before, behind].map(|side| range(side.iter().map(|s| s.spreads()[order])));
            if c > GAIN * b {
                c / b
            } else if a > GAIN * d && d > 0.0 {
                d / a
            } else {
                1.0
            }
        });
        let (least, most) = range(ratios.into_iter());
        ((least > 1.0 || most < 1.0) && most < 2.0 * least).then_some((at, ratios[0]))
    })
}

/// Where the mean moves at once, and stays: the stretch, and by how much.
pub(super) fn offset(stretches: &[Stretch], usual: f64) -> Option<(usize, f64)> {
    changes(stretches).find_map(|(at, before, behind)| {
        let [(a, b), (c, d)] = [before, behind].map(|side| range(side.iter().map(Stretch::mean)));
        let by = if c > b { c - b } else { d - a };
        let moved = c > b || d < a;
        (moved && by.abs() > OFFSET * usual && by.abs() > 2.0 * (b - a).max(d - c)).then_some((at, by))
    })
}

/// The stretches in which a change may lie, with those before and behind.
fn changes(stretches: &[Stretch]) -> impl Iterator<Item = (usize, &[Stretch], &[Stretch])> {
    (FEWEST..stretches.len().saturating_sub(FEWEST)).map(|at| {
        let (before, behind) = (&stretches[at.saturating_sub(SIDE)..at], &stretches[at + 1..]);
        (at, before, &behind[..behind.len().min(SIDE)])
    })
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}
