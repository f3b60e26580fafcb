//! Samples that are not numbers: a few are interpolated; with more of them the longest stretch without any is
//! used.

use anyhow::{Result, bail};
use stribeck_formats::Channel;

/// Samples in a row that a straight line may bridge, and how many of all [part].
const BRIDGED: usize = 3;
const PART: f64 = 0.01;

/// A channel whose samples are all numbers.
pub(super) struct Whole {
    pub(super) channel: Channel,
    /// Samples of the file before its first one.
    pub(super) from: usize,
}

/// The channel itself where all samples are numbers; otherwise bridged, or a stretch of it, with a note.
pub(super) fn without(channel: &Channel, notes: &mut Vec<String>) -> Result<Whole> {
    let (mut missing, mut first, mut n) = (0_u64, 0_u64, 0_u64);
    channel.for_each_block(|block| {
        for x in block {
            if !x.is_finite() {
                first = if missing == 0 { n } else { first };
                missing += 1;
            }
            n += 1;
        }
        true
    })?;
    if missing == 0 {
        return Ok(Whole { channel: channel.clone(), from: 0 });
    }
    let mut samples = channel.read()?;
    let (from, until) = stretch(&mut samples);
    if until == from {
        bail!("channel `{}` holds no numbers", channel.name);
    }
    let of = |samples: Vec<f64>| {
        Channel::held(&channel.name, samples)
            .at_rate(channel.rate_hz)
            .from_time(channel.start_s)
            .in_unit(channel.unit.clone())
    };
    if (from, until) == (0, samples.len()) {
        notes.push(format!(
            "{missing} samples of `{}` are no numbers, the first of them sample {first}: \
            straight lines bridge them",
            channel.name
        ));
    } else {
        notes.push(format!(
            "{missing} samples of `{}` are no numbers, the first of them sample {first}: the longest stretch \
             without them is taken, samples {from} to {} of {}",
            channel.name,
            until - 1,
            samples.len()
        ));
    }
    samples.truncate(until);
    samples.drain(..from);
    Ok(Whole { channel: of(samples), from })
}

/// Bridges short gaps, and returns where the longest stretch without others begins and ends.
fn stretch(samples: &mut [f64]) -> (usize, usize) {
    let mut gaps: Vec<(usize, usize)> = Vec::new();
    for (n, x) in samples.iter().enumerate() {
        match gaps.last_mut() {
            _ if x.is_finite() => {}
            Some((_, until)) if *until == n => *until += 1,
            _ => gaps.push((n, n + 1)),
        }
    }
    let short = |gap: &&(usize, usize)| gap.1 - gap.0 <= BRIDGED && gap.0 > 0 && gap.1 < samples.len();
    let few = gaps.iter().filter(short).map(|gap| gap.1 - gap.0).sum::<usize>() as f64
        <= PART * samples.len() as f64;
    let bridged: Vec<(usize, usize)> = gaps.iter().filter(short).filter(|_| few).copied().collect();
    for &(from, until) in &bridged {
        let (before, behind) = (samples[from - 1], samples[until]);
        for n in from..until {
            samples[n] = before + (behind - before) * (n - from + 1) as f64 / (until - from + 1) as f64;
        }
    }
    gaps.retain(|gap| !bridged.contains(gap));
    let starts = std::iter::once(0).chain(gaps.iter().map(|gap| gap.1));
    let ends = gaps.iter().map(|gap| gap.0).chain([samples.len()]);
    starts.zip(ends).max_by_key(|(from, until)| until - from).unwrap_or((0, 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_short_gap_is_bridged_and_a_long_one_cuts() {
        let mut samples: Vec<f64> = (0..1000).map(f64::from).collect();
        samples[500] = f64::NAN;
        samples[501] = f64::NAN;
        assert_eq!(stretch(&mut samples), (0, 1000));
        assert_eq!(samples[500..502], [500.0, 501.0]);
        samples[100..200].fill(f64::NAN);
        assert_eq!(stretch(&mut samples), (200, 1000));
        samples[999] = f64::INFINITY;
        assert_eq!(stretch(&mut samples), (200, 999));
    }
}
