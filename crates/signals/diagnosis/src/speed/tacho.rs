//! The speed of a shaft from a tachometer: its pulses, its angle, or its speed over time.
//!
//! A wheel with long gaps or uneven teeth is recognised by the turns in which their distances recur, before any pulse
//! is put in or left out. Pulses that are missing are bridged, and those that are too many are dropped, up to a
//! twentieth of all; a record in which they are more is refused, because its speed would be one of the tachometer and
//! not of the shaft.

mod course;
mod edges;
mod mended;

use stribeck_dsp::channel::Channel;

use self::edges::{Levels, edges, steps};
use self::mended::{Mended, mended};
use crate::Error;

pub use self::course::{of_angle, turns_a_minute};

/// Speed from a tachometer.
#[derive(Debug, Clone, PartialEq)]
pub struct Turns {
    /// Mean speed [1/min].
    pub rpm: f64,
    /// Whole turns counted.
    pub count: usize,
    /// Largest less smallest speed from one pulse to the next, over the mean; of wheels with several teeth
    /// that of whole turns.
    pub variation: f64,
    /// Times of the pulses, in samples.
    pub pulses: Vec<f64>,
    /// Notes on irregularities of the tachometer.
    pub notes: Vec<String>,
}

/// Fewest pulses that other levels than the usual ones must give: among fewer, chance finds even ones.
const LEAST: usize = 8;

/// Few shafts are faster [1/min]; wheels with teeth look so.
const FAST: f64 = 20_000.0;

/// The speed from a channel sampled `rate_hz` times a second: from the angle of the shaft where its name ends
/// in `_rad`, from the speed over time where its unit or its name says so (`rpm`, `1/min`, `rad/s` …),
/// otherwise from `per_turn` pulses a turn, which need not be a whole number: those of another shaft of a gear,
/// or of every other turn.
///
/// # Errors
/// As [`of_angle`] and [`pulses`]; [`Error::NoSignal`] for a speed over time that goes through zero.
pub fn of(channel: &Channel, rate_hz: f64, per_turn: f64) -> Result<Turns, Error> {
    if channel.name.ends_with("_rad") {
        return of_angle(channel, rate_hz);
    }
    match course::of_speed(channel, rate_hz)? {
        Some(turns) => Ok(turns),
        None => marks(channel, rate_hz, per_turn),
    }
}

/// Counts the pulses of a channel sampled `rate_hz` times a second, one a turn.
pub fn turns(channel: &Channel, rate_hz: f64) -> Result<Turns, Error> {
    pulses(channel, rate_hz, 1)
}

/// Counts the pulses of a channel sampled `rate_hz` times a second, `per_turn` of them a turn: rising edges
/// through the middle between its low and its high level, their times interpolated between samples. Pulses
/// that are missing are put in, and those that are too many taken out, with a note of their number and times.
/// Where that fails or much is mended, the levels are those of each stretch of the record, or nearer to one
/// end: a base line that drifts and pulses of changing height are followed so.
///
/// The times of a wheel with several teeth are means over whole turns, so that uneven teeth and the grid of
/// the samples do not look like a speed that varies.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::NoSignal`] when it holds fewer than three pulses, or when
/// too many are missing or surplus for a speed to follow.
pub fn pulses(channel: &Channel, rate_hz: f64, per_turn: u32) -> Result<Turns, Error> {
    marks(channel, rate_hz, f64::from(per_turn.max(1)))
}

/// The same with any number a turn; pulses of a part of one are at even angles.
fn marks(channel: &Channel, rate_hz: f64, each_turn: f64) -> Result<Turns, Error> {
    let samples = channel.read()?;
    let name = &channel.name;
    let per_turn = if each_turn.fract() == 0.0 { each_turn as usize } else { 1 };
    // Of a part of a turn the pulses are as those of a shaft that turns faster, or slower.
    let faster = each_turn / per_turn as f64;
    let steps = steps(&samples);
    // With the pulses that were mended, or were missed.
    let mut best: Option<(usize, Mended)> = None;
    let mut refused = None;
    for levels in Levels::all() {
        let edges = edges(&samples, levels);
        let found = match edges.len() {
            0 => Err(format!(
                "tachometer `{name}` holds no pulse; is it the right channel? A speed over time needs its \
                 unit, such as `rpm`, behind its name"
            )),
            few @ 1..=2 => Err(format!("tachometer `{name}` holds {few} pulses, three are the least")),
            few if few < LEAST && refused.is_some() => continue,
            _ => mended(&edges, name, rate_hz, per_turn),
        };
        match found {
            Err(why) => drop(refused.get_or_insert(why)),
            Ok(found) => {
                let (count, outside) = (found.pulses.len(), found.outside(samples.len()));
                // A base line that swings evenly hides the pulses on it, and passes for some of its own.
                let hidden = if 4 * steps > 5 * count + 8 { steps - count } else { 0 };
                let lost = found.odd() + outside + hidden;
                // Other levels must do better by half.
                if best.as_ref().is_none_or(|(least, _)| 2 * lost < *least) {
                    best = Some((lost, found));
                }
                if lost == 0 {
                    break;
                }
            }
        }
    }
    let Some((_, found)) = best else {
        return Err(Error::NoSignal(refused.unwrap_or_default()));
    };
    let Mended { per_turn, .. } = found;
    let mut notes = found.notes(name, rate_hz);
    notes.extend(found.ends(name, rate_hz, samples.len()));
    let count = ((found.pulses.len() - 1) as f64 / per_turn as f64 / faster) as usize;
    let pulses = over_turns(found.pulses, per_turn);
    let (mean, variation) = mean_and_variation(&pulses);
    let rpm = 60.0 * rate_hz / (mean * per_turn as f64 * faster);
    if each_turn == 1.0 && rpm > FAST {
        notes.push(format!(
            "tachometer `{name}`: with one pulse a turn the shaft turns at {rpm:.0} rpm; if its wheel has \
             several teeth, give their number by `--pulses-per-turn`"
        ));
    }
    Ok(Turns { rpm, count, variation, pulses, notes })
}

/// Means of the times of `per_turn` pulses, from each on; the pulses themselves where there are not two turns
/// of them.
fn over_turns(pulses: Vec<f64>, per_turn: usize) -> Vec<f64> {
    if per_turn == 1 || pulses.len() < 2 * per_turn + 2 {
        return pulses;
    }
    pulses.windows(per_turn).map(|turn| turn.iter().sum::<f64>() / per_turn as f64).collect()
}

/// Mean gap, and largest less smallest speed over the mean, of at least two pulses.
fn mean_and_variation(pulses: &[f64]) -> (f64, f64) {
    let mean = (pulses[pulses.len() - 1] - pulses[0]) / (pulses.len() - 1) as f64;
    let gaps = pulses.windows(2).map(|pair| pair[1] - pair[0]);
    let (shortest, longest) =
        gaps.fold((f64::INFINITY, 0.0_f64), |(short, long), gap| (short.min(gap), long.max(gap)));
    (mean, mean / shortest - mean / longest)
}
