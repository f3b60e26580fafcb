//! The speed of a shaft from the pulses of a tachometer, one a turn.

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
}

/// Part of the range that a pulse must fall by before the next one counts.
const HYSTERESIS: f64 = 0.2;

/// Counts the pulses of a channel sampled `rate_hz` times a second: rising edges through the middle of its
/// range, their times interpolated between samples.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::NoSignal`] when it holds fewer than three pulses.
pub fn turns(channel: &Channel, rate_hz: f64) -> Result<Turns, Error> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    channel.for_each_block(|block| {
        for &x in block {
            low = low.min(x);
            high = high.max(x);
        }
        true
    })?;
    let (middle, reset) = (0.5 * (low + high), (0.5 - HYSTERESIS) * (high - low) + low);
    let (mut edges, mut armed, mut before, mut n) = (Vec::new(), false, f64::NAN, 0_u64);
    channel.for_each_block(|block| {
        for &x in block {
            armed |= x < reset;
            if armed && x >= middle && before < middle {
                edges.push((n as f64 - (x - middle) / (x - before)) / rate_hz);
                armed = false;
            }
            before = x;
            n += 1;
        }
        true
    })?;
    let (Some(first), Some(last)) = (edges.first(), edges.last()) else {
        return Err(Error::NoSignal(format!(
            "tachometer `{}` holds no pulse; is it the right channel?",
            channel.name
        )));
    };
    if edges.len() < 3 {
        return Err(Error::NoSignal(format!(
            "tachometer `{}` holds {} pulses, three are the least",
            channel.name,
            edges.len()
        )));
    }
    let mean_s = (last - first) / (edges.len() - 1) as f64;
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    for pair in edges.windows(2) {
        shortest = shortest.min(pair[1] - pair[0]);
        longest = longest.max(pair[1] - pair[0]);
    }
    Ok(Turns {
        rpm: 60.0 / mean_s,
        count: edges.len() - 1,
        variation: mean_s / shortest - mean_s / longest,
        pulses: edges.iter().map(|at| at * rate_hz).collect(),
    })
}

/// Pulses a turn that are made of a recorded angle: within a sixtieth of a turn the speed is as good as
/// constant.
const PULSES: f64 = 60.0;

/// The same from the angle of a shaft [rad], either sense, as a run records it where its speed changes: sixty
/// pulses a turn.
///
/// # Errors
/// [`Error::File`] when it cannot be read, [`Error::NoSignal`] when the shaft turns back, or less than a twentieth of a turn.
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

    #[test]
    fn refuses_a_channel_without_pulses() {
        assert!(
            turns(&Channel::held("tacho", vec![1.0; 100]), 1e3).unwrap_err().to_string().contains("no pulse")
        );
    }
}
