//! The speed of a shaft without a tachometer: the line that stands out in a range of speeds.

use stribeck_dsp::channel::Channel;
use stribeck_dsp::{BandEnvelopes, Ridge, Spectrogram, Spectrograph, WelchOptions, ridge};

use crate::Error;

/// Turns of the slowest shaft in a segment: neighbouring lines are resolved at a sixteenth of the speed.
const TURNS: f64 = 16.0;
/// Segments in which the speed may cross the whole range.
const CROSSING: f64 = 4.0;
/// Least mean height of the line above the median of the range [dB]. The best path through white noise stands
/// 3 to 8 dB up, most in the shortest records.
const HEIGHT_DB: f64 = 12.0;

/// Follows the shaft's line between two speeds [1/min] in a channel sampled `rate_hz` times a second.
///
/// # Errors
/// [`Error::NoSignal`] for a range that is none or in which no line stands out, [`Error::File`],
/// [`Error::Signal`].
pub fn speed(channel: &Channel, rate_hz: f64, low_rpm: f64, high_rpm: f64) -> Result<Ridge, Error> {
    let (low_hz, high_hz) = (low_rpm / 60.0, high_rpm / 60.0);
    if !(low_hz > 0.0 && low_hz < high_hz && high_hz < 0.25 * rate_hz) {
        return Err(Error::NoSignal(format!(
            "speeds of {low_rpm} to {high_rpm} rpm: they must ascend from above 0, and lie below a quarter \
             of the sample rate"
        )));
    }
    let samples = (TURNS / low_hz * rate_hz) as usize;
    if (channel.len as usize) < 4 * samples {
        return Err(Error::NoSignal(format!(
            "the record is too short to follow a speed: {:.1} s hold 64 turns at {low_rpm} rpm; give \
             `--speed-rpm` one number",
            4.0 * TURNS / low_hz
        )));
    }
    let segment = BandEnvelopes::segment_of(samples, samples);
    let options = WelchOptions { overlap: segment - segment / 4, ..WelchOptions::new(segment) };
    let mut plan = Spectrograph::new(rate_hz, &options).map_err(Error::Signal)?;
    // Two lines beyond either end, so that a line at an end has neighbours.
    let grid_hz = plan.frequencies_hz()[1];
    let first = ((low_hz / grid_hz) as usize).saturating_sub(2).max(1);
    let end = ((high_hz / grid_hz).ceil() as usize + 3).min(plan.frequencies_hz().len());
    let mut all = Spectrogram {
        times_s: Vec::new(),
        frequencies_hz: plan.frequencies_hz()[first..end].to_vec(),
        values: Vec::new(),
    };
    let mut failed = None;
    channel.for_each_block(|block| {
        failed = plan
            .add(block, |time_s, values| {
                all.times_s.push(time_s);
                all.values.extend_from_slice(&values[first..end]);
            })
            .err();
        failed.is_none()
    })?;
    if let Some(why) = failed {
        return Err(Error::Signal(why));
    }
    let steepest_hz_s = (high_hz - low_hz) * rate_hz / (CROSSING * segment as f64);
    let found = ridge(&all, steepest_hz_s).map_err(Error::Signal)?;
    if found.height_db < HEIGHT_DB {
        return Err(Error::NoSignal(format!(
            "no line stands out between {low_rpm} and {high_rpm} rpm: the best is {:.1} dB up, {HEIGHT_DB} \
             are needed. Give another range, one `--speed-rpm`, or `--tacho`",
            found.height_db
        )));
    }
    Ok(found)
}
