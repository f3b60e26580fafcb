//! Turns from the recorded angle of a shaft, and from its recorded speed.

use std::f64::consts::TAU;

use stribeck_dsp::channel::Channel;

use super::{Turns, mean_and_variation};
use crate::Error;

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
    of_angles(&channel.read()?, &channel.name, rate_hz)
}

/// The same from the angles [rad] themselves.
fn of_angles(angle: &[f64], name: &str, rate_hz: f64) -> Result<Turns, Error> {
    let first = angle.first().copied().unwrap_or(0.0);
    // An angle that begins anew each turn goes on by less than half of one.
    let (mut before, mut turned) = (first, 0.0);
    let unwrapped = angle.iter().map(|rad| {
        let step = rad - before;
        turned += step - TAU * (step / TAU).round();
        before = *rad;
        turned
    });
    let unwrapped: Vec<f64> = unwrapped.collect();
    let last = unwrapped.last().copied().unwrap_or(0.0);
    let places: Vec<f64> = unwrapped.iter().map(|rad| PULSES * rad.abs() / TAU).collect();
    if places.windows(2).any(|pair| pair[1] < pair[0]) {
        return Err(Error::NoSignal(format!(
            "`{name}` turns back on the way: cut the record to a part in which the shaft turns one way"
        )));
    }
    let mut pulses = Vec::new();
    for (n, pair) in places.windows(2).enumerate() {
        let whole = (pair[0].floor() as u64 + 1)..=(pair[1].floor() as u64);
        pulses.extend(whole.map(|place| n as f64 + (place as f64 - pair[0]) / (pair[1] - pair[0])));
    }
    if pulses.len() < 3 {
        return Err(Error::NoSignal(format!(
            "`{name}` turns by {:.3} rad, a twentieth of a turn is the least",
            last.abs()
        )));
    }
    let (mean, variation) = mean_and_variation(&pulses);
    Ok(Turns {
        rpm: 60.0 * rate_hz / (PULSES * mean),
        count: (pulses.len() as f64 / PULSES) as usize,
        variation,
        pulses,
        notes: Vec::new(),
    })
}

/// Units of speed, in small letters without blanks, and their turns a minute.
const UNITS: [(&[&str], f64); 6] = [
    (
        &[
            "rpm", "1/min", "/min", "min-1", "min^-1", "min⁻¹", "min**-1", "u/min", "r/min", "rev/min",
            "tr/min", "umdr/min", "upm",
        ],
        1.0,
    ),
    (&["rev/s", "r/s", "rps"], 60.0),
    (&["rad/s", "rad*s-1", "rad·s⁻¹", "rad/sec"], 60.0 / TAU),
    (&["deg/s", "°/s"], 1.0 / 6.0),
    (&["krpm"], 1e3),
    (&["hz", "1/s"], 60.0),
];

/// Parts of names of speeds: in hertz other numbers are, too.
const SPEEDS: [&str; 7] = ["speed", "rpm", "omega", "drehzahl", "rotat", "shaft_hz", "shaft_freq"];

/// Most volts that pulses of a wheel have.
const PULSES_V: f64 = 30.0;

/// Factor between the speeds of two samples that no shaft reaches.
const JUMP: f64 = 3.0;

/// Largest speed of a shaft [1/min].
const FASTEST: f64 = 1e6;

/// The turns from a speed over time; none where neither unit nor name says that the channel is one.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::NoSignal`] for a speed that goes through zero, is no
/// number, or is too large.
pub(super) fn of_speed(channel: &Channel, rate_hz: f64) -> Result<Option<Turns>, Error> {
    let Some((factor, of_unit)) = turns_a_minute(channel) else { return Ok(None) };
    let name = &channel.name;
    let rpm: Vec<f64> = channel.read()?.iter().map(|x| factor * x).collect();
    let there = || rpm.iter().copied().enumerate().filter(|(_, x)| x.is_finite());
    let most = there().fold(0.0_f64, |most, (_, x)| most.max(x.abs()));
    let sign = there().next().map_or(1.0, |(_, x)| if x < 0.0 { -1.0 } else { 1.0 });
    let stands = there().find(|(_, x)| sign * x <= STANDS * most);
    match stands {
        // A name alone may be that of pulses, which have some volts.
        Some(_) if !of_unit && most < PULSES_V => return Ok(None),
        Some((at, _)) => {
            return Err(Error::NoSignal(format!(
                "`{name}` says that the shaft stands still at {:.4} s: cut the record to a part in which it \
                 turns",
                at as f64 / rate_hz
            )));
        }
        None => {}
    }
    if most == 0.0 || most > FASTEST {
        return Err(Error::NoSignal(format!(
            "`{name}` holds speeds up to {most} 1/min: a shaft's lie above 0 and below {FASTEST}"
        )));
    }
    let jumps = there().zip(there().skip(1)).find(|((_, a), (_, b))| a / b > JUMP || b / a > JUMP);
    if let Some(((_, from), (at, to))) = jumps {
        return Err(Error::NoSignal(format!(
            "`{name}` goes from {from:.1} to {to:.1} 1/min from one sample to the next at {:.4} s, which no shaft does: \
             remove such marks from it",
            at as f64 / rate_hz
        )));
    }
    // A value that is missing is that before it; the first ones are those behind them.
    let mut before = there().next().map_or(0.0, |(_, x)| x);
    let mut angle = 0.0;
    let mut last = None;
    let angles: Vec<f64> = (rpm.iter())
        .map(|&x| {
            before = if x.is_finite() { x } else { before };
            // Half of this speed and half of the one before.
            angle += last.map_or(0.0, |last: f64| 0.5 * (last + before) / 60.0 * TAU / rate_hz);
            last = Some(before);
            angle
        })
        .collect();
    let mut turns = of_angles(&angles, name, rate_hz)?;
    turns.notes.push(format!(
        "`{name}` is taken as the speed of the shaft over time, {:.1} rpm in the mean",
        turns.rpm
    ));
    Ok(Some(turns))
}

/// A shaft that is slower than this part of its largest speed stands still.
const STANDS: f64 = 1e-3;

/// How many turns a minute one unit of the channel is, and whether its unit says so; none where it is no
/// speed. A name alone counts with its end: `Speed (rpm)`, `omega_rad_s`, `rpm`.
pub fn turns_a_minute(channel: &Channel) -> Option<(f64, bool)> {
    let plain = |text: &str| text.to_lowercase().replace([' ', '[', ']', '(', ')'], "");
    let name = channel.name.trim().to_lowercase();
    let is_speed = SPEEDS.iter().any(|part| name.contains(part)) && !name.contains("sampl");
    let all = UNITS.iter().flat_map(|(all, factor)| all.iter().map(move |unit| (*unit, *factor)));
    let mut all = all.filter(|(unit, _)| is_speed || !matches!(*unit, "hz" | "1/s"));
    if let Some(unit) = channel.unit.as_deref().map(plain).filter(|unit| !unit.is_empty()) {
        return all.find(|(of, _)| *of == unit).map(|(_, factor)| (factor, true));
    }
    if let Some((_, unit)) = name.trim_end_matches([')', ']']).rsplit_once(['(', '['])
        && let Some((_, factor)) = all.clone().find(|(of, _)| *of == plain(unit))
    {
        return Some((factor, true));
    }
    let ends = |unit: &str| {
        let before = name.strip_suffix(unit).or_else(|| name.strip_suffix(&unit.replace('/', "_")));
        before.is_some_and(|before| !before.ends_with(char::is_alphanumeric))
    };
    all.find(|(unit, _)| !unit.starts_with('/') && ends(unit)).map(|(_, factor)| (factor, false))
}
