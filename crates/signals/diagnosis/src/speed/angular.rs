//! A record of a shaft whose speed varies, at equal angles: lines that were smeared stand still.

use stribeck_dsp::channel::Channel;
use stribeck_dsp::order_track;

use crate::Error;

/// Longest record that is held for it [samples]: 270 MB with its copy.
const LONGEST: u64 = 1 << 24;

/// The channel over the angle of the shaft, and the rate at which it would be sampled at the mean speed [Hz],
/// so that frequencies are those at the mean speed; `pulses` are the times of whole turns, in samples. `None`
/// for a record that is too long to be held.
///
/// The number of samples a turn keeps every sample at the lowest speed.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::Signal`] for pulses that do not ascend or leave the
/// record.
pub fn over_angle(channel: &Channel, rate_hz: f64, pulses: &[f64]) -> Result<Option<(Channel, f64)>, Error> {
    if channel.len > LONGEST || pulses.len() < 3 {
        return Ok(None);
    }
    let slowest = pulses.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let per_turn = slowest.ceil() as usize;
    let tracked = order_track(&channel.read()?, pulses, per_turn).map_err(Error::Signal)?;
    let mean = (pulses[pulses.len() - 1] - pulses[0]) / (pulses.len() - 1) as f64;
    let rate = per_turn as f64 / mean * rate_hz;
    let even = Channel::held(channel.name.clone(), tracked.values).in_unit(channel.unit.clone());
    Ok(Some((even.at_rate(Some(rate)), rate)))
}
