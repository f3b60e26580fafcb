//! Pulses that are missing are put in, those that are too many are taken out.

/// Pulses on either side that say how far apart pulses are.
const NEIGHBOURS: usize = 4;
/// Part of the pulses that may be put in or left out.
const FEW: f64 = 0.05;
/// Fewest samples from pulse to pulse.
const LEAST: f64 = 3.0;
/// Largest variation of the speed between two pulses and the next two that a shaft follows.
const SUDDEN: f64 = 0.5;
/// Shortest gap whose variation counts [samples]: shorter ones vary by the grid of the samples.
const FINE: f64 = 4.0;

/// Pulses at times that a shaft follows.
#[derive(Debug, Clone)]
pub(super) struct Mended {
    pub(super) pulses: Vec<f64>,
    /// Pulses a turn: those that were asked for, or one where only whole turns are even.
    pub(super) per_turn: usize,
    missing: Vec<f64>,
    double: Vec<f64>,
    /// One that was not asked for, by which the turns are counted.
    wheel: Option<Wheel>,
}

impl Mended {
    /// Pulses that were put in or taken out.
    pub(super) fn odd(&self) -> usize {
        self.missing.len() + self.double.len()
    }

    /// Pulses that would fit before the first and after the last, in a record of `samples` samples.
    pub(super) fn outside(&self, samples: usize) -> usize {
        let [first, second, .., before, last] = self.pulses[..] else { return 0 };
        let room = |gap: f64, step: f64| if gap < 1.5 * step { 0 } else { (gap / step) as usize };
        room(first, second - first) + room(samples as f64 - last, last - before)
    }

    /// A note on where pulses begin late, or end early, in a record of `samples` samples.
    pub(super) fn ends(&self, name: &str, rate_hz: f64, samples: usize) -> Option<String> {
        let [first, .., last] = self.pulses[..] else { return None };
        let gap = (last - first) / (self.pulses.len() - 1) as f64;
        let room = |of: f64| of > (3.0 * gap).max(0.02 * samples as f64);
        let behind = room(samples as f64 - last).then(|| format!("after {:.2} s", last / rate_hz));
        let before = room(first).then(|| format!("before {:.2} s", first / rate_hz));
        let places: Vec<String> = before.into_iter().chain(behind).collect();
        (!places.is_empty()).then(|| {
            let places = places.join(" and ");
            format!("tachometer `{name}`: no pulses {places}; the speed is that between")
        })
    }

    /// What was done, for the user.
    pub(super) fn notes(&self, name: &str, rate_hz: f64) -> Vec<String> {
        let told = |what: &str, of: &[f64], done: &str| {
            const SHOWN: usize = 5;
            let times: Vec<String> =
                of.iter().take(SHOWN).map(|at| format!("{:.4} s", at / rate_hz)).collect();
            let more =
                if of.len() > SHOWN { format!(" and {} more", of.len() - SHOWN) } else { String::new() };
            let (pulses, are) = if of.len() == 1 { ("a pulse", "is") } else { ("pulses", "are") };
            let number = if of.len() == 1 { String::new() } else { format!("{} ", of.len()) };
            let times = times.join(", ");
            format!("tachometer `{name}`: {number}{pulses} {are} {what}, at {times}{more}: {done}")
        };
        let mut notes = Vec::new();
        if let Some(Wheel { pulses, teeth, .. }) = self.wheel {
            notes.push(format!(
                "tachometer `{name}`: the distances of its pulses recur every {pulses}, with the room of {teeth}: these \
                 are taken for one turn. Give `--pulses-per-turn` if they are not"
            ));
        }
        if !self.missing.is_empty() {
            notes.push(told("missing", &self.missing, "put in at even distances"));
        }
        if !self.double.is_empty() {
            notes.push(told("too many", &self.double, "left out"));
        }
        notes
    }
}

/// At least three pulses as a shaft gives them, `per_turn` a turn; otherwise why no speed follows. The wheel is that
/// by which the distances of its pulses recur: of one with long gaps, and of uneven teeth, each turn is one pulse.
pub(super) fn mended(edges: &[f64], name: &str, rate_hz: f64, per_turn: usize) -> Result<Mended, String> {
    let gaps: Vec<f64> = edges.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mean = (edges[edges.len() - 1] - edges[0]) / gaps.len() as f64;
    if mean < LEAST {
        return Err(format!(
            "tachometer `{name}`: pulses come every {mean:.2} samples, {:.0} a second at {rate_hz} samples a second, or \
             faster than these show: no speed follows. Record it faster, or give the speed by `--speed-rpm`",
            rate_hz / mean
        ));
    }
    let whole = even(edges, name, rate_hz, per_turn);
    if let Some(wheel) = Wheel::of(&gaps) {
        let Wheel { pulses, teeth, first } = wheel;
        let one: Vec<f64> = edges[first..].iter().copied().step_by(pulses).collect();
        let turns = even(&one, name, rate_hz, 1).ok().filter(|turns| one.len() > 2 && turns.odd() == 0);
        return match turns {
            Some(turns) if per_turn == pulses || per_turn == teeth => Ok(turns),
            Some(turns) if per_turn == 1 => Ok(Mended { wheel: Some(wheel), ..turns }),
            _ if per_turn == teeth || per_turn.is_multiple_of(pulses) && per_turn > pulses => whole,
            _ => Err(format!(
                "tachometer `{name}`: the distances of its pulses recur every {pulses}, with the room of {teeth}, and \
                 {per_turn} are said to make a turn: no speed follows. Give `--pulses-per-turn {pulses}`"
            )),
        };
    }
    if per_turn == 1 || whole.is_ok() {
        return whole;
    }
    let one: Vec<f64> = edges.iter().copied().step_by(per_turn).collect();
    match even(&one, name, rate_hz, 1) {
        Ok(turns) if one.len() > 2 && turns.odd() == 0 => Ok(turns),
        _ => whole,
    }
}

/// A wheel whose pulses are unevenly apart, in the same way each turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wheel {
    /// Pulses a turn, and how many even ones would have its room.
    pulses: usize,
    teeth: usize,
    /// A pulse behind the longest distance.
    first: usize,
}

impl Wheel {
    /// By the distances that differ from those around them: they recur after as many pulses, all over the record.
    fn of(gaps: &[f64]) -> Option<Self> {
        let over: Vec<f64> = (0..gaps.len()).map(|n| gaps[n] / around(gaps, n)).collect();
        // Edges lie between two samples.
        let grid = |n: usize| 1.5 / gaps[n];
        let differs = |n: usize| (over[n] - 1.0).abs() > 0.15 + grid(n);
        let odd: Vec<usize> = (0..gaps.len()).filter(|n| differs(*n)).collect();
        let alike =
            |a: usize, b: usize| b < over.len() && (over[a] / over[b] - 1.0).abs() < 0.1 + grid(a) + grid(b);
        let apart = odd.iter().skip(1).map(|n| n - odd[0]).take(64);
        let pulses = apart.filter(|n| *n > 1).find(|pulses| {
            let inner = odd.iter().filter(|n| *n + pulses < gaps.len()).count();
            let recur =
                odd.iter().filter(|n| differs_at(&odd, *n + pulses) && alike(**n, *n + pulses)).count();
            let turns = gaps.len() / pulses;
            turns > 2 && 10 * recur >= 9 * inner && 10 * odd.len() >= 8 * turns
        })?;
        let of_turn = &over[odd[0]..(odd[0] + pulses).min(over.len())];
        let shortest = of_turn.iter().copied().fold(f64::INFINITY, f64::min);
        let teeth = of_turn.iter().map(|of| (of / shortest).round()).sum::<f64>() as usize;
        let longest = (odd[0]..odd[0] + pulses).max_by(|a, b| over[*a].total_cmp(&over[*b]))?;
        Some(Self { pulses, teeth, first: longest % pulses + 1 })
    }
}

/// The usual one of sixteen gaps about the gap `n`, the longer of two that are as frequent.
fn around(gaps: &[f64], n: usize) -> f64 {
    let until = (n + 8).max(16).min(gaps.len());
    let mut near = gaps[until.saturating_sub(16)..until].to_vec();
    near.sort_by(f64::total_cmp);
    near[near.len() / 2]
}

/// Whether a place is among ascending ones.
fn differs_at(odd: &[usize], place: usize) -> bool {
    odd.binary_search(&place).is_ok()
}

fn even(edges: &[f64], name: &str, rate_hz: f64, per_turn: usize) -> Result<Mended, String> {
    let gaps: Vec<f64> = edges.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = |n: usize| usual(&gaps, n);
    let (mut pulses, mut missing, mut double): (Vec<f64>, Vec<f64>, Vec<f64>) = Default::default();
    for (n, &edge) in edges.iter().enumerate() {
        let step = usual(n.saturating_sub(1));
        let off = |gap: f64| (gap / step - 1.0).abs();
        let next = edges.get(n + 1).copied();
        let Some(&last) = pulses.last() else {
            // The first one is too many where the second begins even gaps.
            let lone = gaps.len() > 2 && off(gaps[0]) > 0.25 && gaps[0] < step && off(gaps[1]) < 0.1;
            if lone {
                double.push(edge)
            } else {
                pulses.push(edge)
            }
            continue;
        };
        let gap = edge - last;
        let is_double = match next {
            // One of two that lie too near to each other: the other one is nearer to its place.
            Some(next) => next - last < 1.5 * step && off(next - last) < off(gap),
            None => gap < 0.5 * step,
        };
        if is_double {
            double.push(edge);
            continue;
        }
        let whole = (gap / step).round();
        if whole >= 2.0 && (gap / step - whole).abs() < 0.1 * whole {
            for k in 1..whole as usize {
                missing.push(last + gap * k as f64 / whole);
                pulses.push(missing[missing.len() - 1]);
            }
        }
        pulses.push(edge);
    }
    let count = pulses.len();
    let patched = missing.len() + double.len();
    if patched as f64 > FEW * count as f64 {
        let first = missing.iter().chain(&double).copied().fold(f64::INFINITY, f64::min);
        return Err(format!(
            "tachometer `{name}`: {} of {count} pulses are missing and {} too many, the first at {:.4} s: no speed \
             follows. Is it the right channel, or give the speed by `--speed-rpm`",
            missing.len(),
            double.len(),
            first / rate_hz
        ));
    }
    match sudden(&pulses) {
        Some((at, percent)) => Err(format!(
            "tachometer `{name}`: the speed changes by {percent:.0} % from one pulse to the next at {:.4} s, \
             as no shaft does: no speed follows. Is it the right channel, does its wheel have more teeth \
             (`--pulses-per-turn`), or give the speed by `--speed-rpm`",
            at / rate_hz
        )),
        None => Ok(Mended { pulses, per_turn, missing, double, wheel: None }),
    }
}

/// The usual gap about the gap `n`: that in the middle of its neighbours.
fn usual(gaps: &[f64], n: usize) -> f64 {
    let (from, until) = (n.saturating_sub(NEIGHBOURS), (n + NEIGHBOURS + 1).min(gaps.len()));
    let mut near = gaps[from..until].to_vec();
    near.sort_by(f64::total_cmp);
    near[near.len() / 2]
}

/// The first pulse at which the speed changes more than a shaft's does, and by how many per cent.
fn sudden(pulses: &[f64]) -> Option<(f64, f64)> {
    let found = pulses.windows(3).find_map(|w| {
        let (a, b) = (w[1] - w[0], w[2] - w[1]);
        (a.max(b) > (1.0 + SUDDEN) * a.min(b) && a.min(b) > FINE).then_some((w[1], a.max(b) / a.min(b)))
    });
    found.map(|(at, ratio)| (at, 100.0 * ratio - 100.0))
}
