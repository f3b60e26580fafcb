//! The speed of a shaft from the pulses of a tachometer.
//!
//! Pulses that are missing are bridged, and those that are too many are dropped, as long as they are few; a
//! record in which they are many is refused, because its speed would be one of the tachometer and not of the
//! shaft.

use stribeck_formats::Channel;

use crate::Error;

/// Speed from a tachometer.
#[derive(Debug, Clone, PartialEq)]
pub struct Turns {
    /// Mean speed [1/min].
    pub rpm: f64,
    /// Whole turns counted.
    pub count: usize,
    /// Largest less smallest speed of single turns, over the mean.
    pub variation: f64,
    /// Times of the pulses, in samples.
    pub pulses: Vec<f64>,
    /// Notes on irregularities of the tachometer.
    pub notes: Vec<String>,
}

/// Levels between which a pulse must rise and fall to count, as parts of the way from its low to its high
/// level: noise and glitches that stay between them are none.
const LOW: f64 = 0.3;
const HIGH: f64 = 0.7;
/// Samples that show the two levels, at most.
const SHOWN: usize = 200_000;
/// Pulses on either side that say how far apart pulses are.
const NEIGHBOURS: usize = 4;
/// Part of the pulses that may be missing or too many.
const FEW: f64 = 0.15;
/// Largest variation of the speed between two pulses and the next two that a shaft follows.
const SUDDEN: f64 = 0.5;

/// Counts the pulses of a channel sampled `rate_hz` times a second, one a turn.
///
/// # Errors
/// As [`pulses`].
pub fn turns(channel: &Channel, rate_hz: f64) -> Result<Turns, Error> {
    pulses(channel, rate_hz, 1)
}

/// Counts the pulses of a channel sampled `rate_hz` times a second, `per_turn` of them a turn: rising edges
/// through the middle between its low and its high level, their times interpolated between samples. Pulses
/// that are missing are put in, and those that are too many taken out, with a note of their number and times.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::NoSignal`] when it holds fewer than three pulses, or when
/// too many are missing or surplus for a speed to follow.
pub fn pulses(channel: &Channel, rate_hz: f64, per_turn: u32) -> Result<Turns, Error> {
    let edges = edges(channel)?;
    let name = &channel.name;
    if edges.is_empty() {
        return Err(Error::NoSignal(format!("tachometer `{name}` holds no pulse; is it the right channel?")));
    }
    if edges.len() < 3 {
        let count = edges.len();
        return Err(Error::NoSignal(format!(
            "tachometer `{name}` holds {count} pulses, three are the least"
        )));
    }
    let (edges, notes) = mended(&edges, name, rate_hz)?;
    let gaps = || edges.windows(2).map(|pair| pair[1] - pair[0]);
    let mean = (edges[edges.len() - 1] - edges[0]) / (edges.len() - 1) as f64;
    let (shortest, longest) =
        gaps().fold((f64::INFINITY, 0.0_f64), |(short, long), gap| (short.min(gap), long.max(gap)));
    let per_turn = f64::from(per_turn.max(1));
    Ok(Turns {
        rpm: 60.0 * rate_hz / (mean * per_turn),
        count: ((edges.len() - 1) as f64 / per_turn) as usize,
        variation: mean / shortest - mean / longest,
        pulses: edges,
        notes,
    })
}

/// Places of the rising edges [samples].
fn edges(channel: &Channel) -> Result<Vec<f64>, Error> {
    // The levels are those that one sample in a thousand lies beyond: a spark does not set them.
    let step = (channel.len as usize / SHOWN).max(1);
    let (mut shown, mut n) = (Vec::new(), 0_usize);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    channel.for_each_block(|block| {
        for &x in block.iter().filter(|x| x.is_finite()) {
            least = least.min(x);
            most = most.max(x);
            if n.is_multiple_of(step) {
                shown.push(x);
            }
            n += 1;
        }
        true
    })?;
    shown.sort_by(f64::total_cmp);
    let Some(last) = shown.len().checked_sub(1) else { return Ok(Vec::new()) };
    let (mut low, mut high) = (shown[last / 1000], shown[last - last / 1000]);
    // Pulses that are shorter than that are all there is; a spark or two are none.
    let beyond = |level: f64| shown.iter().rev().take_while(|x| **x > level).count();
    if high - low < 0.3 * (most - least) && beyond(0.5 * (least + most)) >= 3 {
        (low, high) = (least, most);
    }
    let level = |part: f64| low + part * (high - low);
    let (reset, middle, set) = (level(LOW), level(0.5), level(HIGH));
    let (mut edges, mut armed, mut before, mut n) = (Vec::new(), false, f64::NAN, 0_u64);
    let mut crossed = None;
    channel.for_each_block(|block| {
        for &x in block {
            if x < reset {
                armed = true;
                crossed = None;
            }
            if armed && x >= middle && before < middle {
                // The first time that it passes the middle on its way up.
                crossed.get_or_insert(n as f64 - (x - middle) / (x - before));
            }
            if armed && x >= set && high > low {
                edges.extend(crossed.take());
                armed = false;
            }
            before = if x.is_finite() { x } else { before };
            n += 1;
        }
        true
    })?;
    Ok(edges)
}

/// Pulses with those that are missing put in and those that are too many taken out.
fn mended(edges: &[f64], name: &str, rate_hz: f64) -> Result<(Vec<f64>, Vec<String>), Error> {
    let gaps: Vec<f64> = edges.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // The usual gap about each pulse: that in the middle of the neighbours'.
    let usual = |n: usize| {
        let (from, until) = (n.saturating_sub(NEIGHBOURS), (n + NEIGHBOURS + 1).min(gaps.len()));
        let mut near = gaps[from..until].to_vec();
        near.sort_by(f64::total_cmp);
        near[near.len() / 2]
    };
    let (mut mended, mut missing, mut double) = (vec![edges[0]], Vec::new(), Vec::new());
    for n in 0..gaps.len() {
        let (last, step) = (mended[mended.len() - 1], usual(n));
        let gap = edges[n + 1] - last;
        let whole = (gap / step).round();
        if gap < 0.5 * step && n + 1 < gaps.len() {
            double.push(edges[n + 1]);
            continue;
        }
        let off = (gap / step - whole).abs();
        if whole >= 2.0 && off < 0.1 * whole {
            for k in 1..whole as usize {
                missing.push(last + gap * k as f64 / whole);
                mended.push(missing[missing.len() - 1]);
            }
        }
        mended.push(edges[n + 1]);
    }
    let count = mended.len() as f64;
    let too_many = |what: &str, of: &[f64]| {
        Error::NoSignal(format!(
            "tachometer `{name}`: {} of {count} pulses are {what}, the first at {:.4} s: no speed follows. \
             Is it the right channel, \
             or give the speed by `--speed-rpm`",
            of.len(),
            of.first().unwrap_or(&0.0) / rate_hz
        ))
    };
    if missing.len() as f64 > FEW * count {
        return Err(too_many("missing", &missing));
    }
    if double.len() as f64 > FEW * count {
        return Err(too_many("too many", &double));
    }
    let sudden = mended.windows(3).find(|w| {
        let (a, b) = (w[1] - w[0], w[2] - w[1]);
        a.max(b) > (1.0 + SUDDEN) * a.min(b) && a.min(b) > 4.0
    });
    if let Some(at) = sudden {
        return Err(Error::NoSignal(format!(
            "tachometer `{name}`: the speed changes by {:.0} % from one pulse to the next at {:.4} s, as no \
             shaft does: no speed \
             follows. Is it the right channel, or give the speed by `--speed-rpm`",
            100.0 * ((at[2] - at[1]) / (at[1] - at[0])).max((at[1] - at[0]) / (at[2] - at[1])) - 100.0,
            at[1] / rate_hz
        )));
    }
    let told = |what: &str, of: &[f64]| {
        const SHOWN: usize = 5;
        let times: Vec<String> = of.iter().take(SHOWN).map(|at| format!("{:.4} s", at / rate_hz)).collect();
        let more = if of.len() > SHOWN { format!(" and {} more", of.len() - SHOWN) } else { String::new() };
        let (pulses, are) = if of.len() == 1 { ("a pulse", "is") } else { ("pulses", "are") };
        let number = if of.len() == 1 { String::new() } else { format!("{} ", of.len()) };
        format!("tachometer `{name}`: {number}{pulses} {are} {what}, at {}{more}", times.join(", "))
    };
    let mut notes = Vec::new();
    if !missing.is_empty() {
        notes.push(told("missing", &missing) + ": put in at even distances");
    }
    if !double.is_empty() {
        notes.push(told("too many", &double) + ": left out");
    }
    Ok((mended, notes))
}

/// Pulses a turn that are made of a recorded angle: within a sixtieth of a turn the speed is as good as
/// constant.
const PULSES: f64 = 60.0;

/// The same from the angle of a shaft [rad], either sense, as a run records it where its speed changes: sixty
/// pulses a turn.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::NoSignal`] when the shaft turns back, or less than a
/// twentieth of a turn.
pub fn of_angle(channel: &Channel, rate_hz: f64) -> Result<Turns, Error> {
    let angle = channel.read()?;
    let (first, last) = (angle.first().copied().unwrap_or(0.0), angle.last().copied().unwrap_or(0.0));
    let places: Vec<f64> =
        angle.iter().map(|rad| PULSES * (rad - first).abs() / std::f64::consts::TAU).collect();
    if places.windows(2).any(|pair| pair[1] < pair[0]) {
        return Err(Error::NoSignal(format!(
            "`{}` turns back on the way: cut the record to a part in which the shaft turns one way",
            channel.name
        )));
    }
    let mut pulses = Vec::new();
    for (n, pair) in places.windows(2).enumerate() {
        let whole = (pair[0].floor() as u64 + 1)..=(pair[1].floor() as u64);
        pulses.extend(whole.map(|place| n as f64 + (place as f64 - pair[0]) / (pair[1] - pair[0])));
    }
    let (Some(start), Some(end), true) = (pulses.first(), pulses.last(), pulses.len() > 2) else {
        return Err(Error::NoSignal(format!(
            "`{}` turns by {:.3} rad, a twentieth of a turn is the least",
            channel.name,
            (last - first).abs()
        )));
    };
    let mean = (end - start) / (pulses.len() - 1) as f64;
    let gaps = pulses.windows(2).map(|pair| pair[1] - pair[0]);
    let (shortest, longest) =
        gaps.fold((f64::INFINITY, 0.0_f64), |(short, long), gap| (short.min(gap), long.max(gap)));
    Ok(Turns {
        rpm: 60.0 * rate_hz / (PULSES * mean),
        count: (pulses.len() as f64 / PULSES) as usize,
        variation: mean / shortest - mean / longest,
        pulses,
        notes: Vec::new(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_pulses_give_the_speed_between_samples() {
        // 1234 rpm, pulses of a tenth of a turn, sampled 1000 times a second.
        let pulse = |n: usize| (1234.0 / 60.0 * n as f64 / 1e3).fract();
        let samples = (0..10_000).map(|n| if pulse(n) < 0.1 { 5.0 } else { 0.1 }).collect();
        let found = turns(&Channel::held("tacho", samples), 1e3).unwrap();
        // Each edge is off by half a sample at most: 1 ms over 9.9 s.
        assert!((found.rpm / 1234.0 - 1.0).abs() < 1.1e-4, "{found:?}");
        assert_eq!(found.count, 204);
        assert!(found.variation < 0.05, "{found:?}");
    }

    #[test]
    fn example_an_angle_gives_pulses_and_the_mean_speed() {
        // From 10 to 30 turns a second, counter-clockwise, in a second of 10 000 samples.
        let angle = (0..10_000)
            .map(|n| 1e-4 * f64::from(n))
            .map(|t| std::f64::consts::TAU * (10.0 * t + 10.0 * t * t));
        let found = of_angle(&Channel::held("shaft.angle_rad", angle.collect()), 1e4).unwrap();
        assert!((found.rpm / 1200.0 - 1.0).abs() < 2e-3, "{}", found.rpm);
        assert_eq!((found.count, found.pulses.len()), (19, 1199));
        assert!((found.variation - 1.0).abs() < 0.02, "{}", found.variation);
        // The first turn is over when 10 t + 10 t² = 1.
        let turn = 1e4 * (0.35_f64.sqrt() - 0.5);
        assert!((found.pulses[59] - turn).abs() < 1e-2, "{} {turn}", found.pulses[59]);
        let back = Channel::held("shaft.angle_rad", vec![0.0, 1.0, 0.5]);
        assert!(of_angle(&back, 1.0).unwrap_err().to_string().contains("turns back"));
        assert!(of_angle(&Channel::held("shaft.angle_rad", vec![0.0; 9]), 1.0).is_err());
    }

    /// Pulses of a tenth of a turn at 1200 rpm, 12 800 samples a second, `n` turns; `keep` says whether turn
    /// k has one.
    fn wheel(n: usize, keep: impl Fn(usize) -> bool) -> Vec<f64> {
        let turn = |at: usize| at as f64 / 640.0 + 0.003;
        (0..640 * n).map(|at| f64::from(turn(at).fract() < 0.1 && keep(turn(at) as usize))).collect()
    }

    #[test]
    fn example_missing_and_double_pulses_are_bridged_and_noted() {
        let one = turns(&Channel::held("tacho", wheel(26, |k| k != 12)), 12_800.0).unwrap();
        assert!((one.rpm / 1200.0 - 1.0).abs() < 1e-4 && one.variation < 0.01, "{one:?}");
        assert!(
            one.notes[0].contains("a pulse is missing, at 0.5999 s") && one.notes.len() == 1,
            "{:?}",
            one.notes
        );
        let tenth = turns(&Channel::held("tacho", wheel(60, |k| k % 10 != 5)), 12_800.0).unwrap();
        assert!(
            (tenth.rpm / 1200.0 - 1.0).abs() < 1e-4 && tenth.notes[0].contains("6 pulses are missing"),
            "{tenth:?}"
        );
        let mut double = wheel(26, |_| true);
        double[640 * 9 + 200..640 * 9 + 210].fill(1.0);
        let double = turns(&Channel::held("tacho", double), 12_800.0).unwrap();
        assert!((double.rpm / 1200.0 - 1.0).abs() < 1e-4, "{double:?}");
        assert!(double.notes[0].contains("a pulse is too many, at 0.465"), "{:?}", double.notes);
        let teeth = pulses(&Channel::held("tacho", wheel(120, |_| true)), 12_800.0, 60).unwrap();
        assert!((teeth.rpm / 20.0 - 1.0).abs() < 1e-4 && teeth.count == 1, "{teeth:?}");
    }

    #[test]
    fn example_noise_and_sparks_are_no_pulses() {
        let mut state = 1_u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) - 0.5
        };
        let mut samples: Vec<f64> =
            wheel(40, |_| true).into_iter().map(|x| 5.0 * x + 1.5 * noise()).collect();
        samples[5000] = 90.0;
        let found = turns(&Channel::held("tacho", samples), 12_800.0).unwrap();
        assert!((found.rpm / 1200.0 - 1.0).abs() < 1e-3 && found.count >= 38, "{found:?}");
    }

    #[test]
    fn refuses_a_tachometer_that_is_none() {
        let mut state = 1_u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        let samples = (0..20_000).map(|_| noise()).collect();
        let why = turns(&Channel::held("tacho", samples), 12_800.0).unwrap_err().to_string();
        assert!(why.contains("no speed follows"), "{why}");
    }

    #[test]
    fn refuses_a_channel_without_pulses() {
        assert!(
            turns(&Channel::held("tacho", vec![1.0; 100]), 1e3).unwrap_err().to_string().contains("no pulse")
        );
    }
}
