//! Pulses that are missing are put in, those that are too many are taken out.

/// Pulses on either side that say how far apart pulses are.
const NEIGHBOURS: usize = 4;
/// Part of the pulses that may be missing or too many.
const FEW: f64 = 0.15;
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
        if !self.missing.is_empty() {
            notes.push(told("missing", &self.missing, "put in at even distances"));
        }
        if !self.double.is_empty() {
            notes.push(told("too many", &self.double, "left out"));
        }
        notes
    }
}

/// At least three pulses as a shaft gives them, `per_turn` a turn; otherwise why no speed follows. Where the
/// teeth of a wheel are too uneven, one of them gives the turns.
pub(super) fn mended(edges: &[f64], name: &str, rate_hz: f64, per_turn: usize) -> Result<Mended, String> {
    let whole = even(edges, name, rate_hz, per_turn);
    if per_turn == 1 || whole.is_ok() {
        return whole;
    }
    let one: Vec<f64> = edges.iter().copied().step_by(per_turn).collect();
    match even(&one, name, rate_hz, 1) {
        Ok(turns) if one.len() > 2 && turns.odd() == 0 => Ok(turns),
        _ => whole,
    }
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
    let refuse = |what: &str, of: &[f64]| {
        format!(
            "tachometer `{name}`: {} of {count} pulses are {what}, the first at {:.4} s: no speed follows. \
             Is it the right channel, or give the speed by `--speed-rpm`",
            of.len(),
            of.first().unwrap_or(&0.0) / rate_hz
        )
    };
    for (what, of) in [("missing", &missing), ("too many", &double)] {
        if of.len() as f64 > FEW * count as f64 {
            return Err(refuse(what, of));
        }
    }
    match sudden(&pulses) {
        Some((at, percent)) => Err(format!(
            "tachometer `{name}`: the speed changes by {percent:.0} % from one pulse to the next at {:.4} s, \
             as no shaft does: no speed follows. Is it the right channel, does its wheel have more teeth \
             (`--pulses-per-turn`), or give the speed by `--speed-rpm`",
            at / rate_hz
        )),
        None => Ok(Mended { pulses, per_turn, missing, double }),
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
