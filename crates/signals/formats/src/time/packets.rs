//! Stamps that all samples of a packet share, as radio sensors send them, and why other times say no rate.

use std::collections::HashMap;

use super::{Course, LEAST, SAME_RATE, own_name, says_time, unit_of};
use crate::units::{self, Unit};
use crate::{Channel, Result};

/// Part of the packets that have as many samples as most.
const REGULAR: f64 = 0.9;
/// Fewest packets that show a rate.
const FEWEST: usize = 8;
/// Packets that are kept.
const MOST: usize = 1 << 22;
/// From how many usual distances of two stamps on a packet lacks between them.
const LACKS: f64 = 1.7;

/// Samples that share a stamp.
struct Packets {
    /// Row and stamp at which each begins.
    starts: Vec<(f64, f64)>,
    /// Rows of the whole channel.
    rows: f64,
}

impl Packets {
    /// Those of a channel that never falls and stands for two rows or more at a time; `None` for others.
    fn of(channel: &Channel) -> Result<Option<Self>> {
        let (mut starts, mut row, mut rises) = (Vec::<(f64, f64)>::new(), 0.0, true);
        channel.for_each_block(|block| {
            for &value in block {
                match starts.last() {
                    Some((_, before)) if value == *before => {}
                    Some((_, before)) if value.is_nan() || value < *before => rises = false,
                    _ => starts.push((row, value)),
                }
                row += 1.0;
            }
            // Where hardly any repeats, they are stamps of samples.
            rises &= starts.len() < MOST && (row < 100.0 || 2.0 * starts.len() as f64 <= row + 2.0);
            rises
        })?;
        Ok((rises && starts.len() >= FEWEST).then_some(Self { starts, rows: row }))
    }

    /// Samples a packet, where nearly all have as many.
    fn size(&self) -> Option<f64> {
        let mut counts: HashMap<u64, usize> = HashMap::new();
        // The first and the last may be cut.
        let inner = &self.starts[1..];
        inner.windows(2).for_each(|w| *counts.entry((w[1].0 - w[0].0) as u64).or_default() += 1);
        let (size, count) = counts.into_iter().max_by_key(|(size, count)| (*count, *size))?;
        (size > 1 && count as f64 >= REGULAR * (inner.len() - 1) as f64).then_some(size as f64)
    }

    /// The usual distance of two stamps, which may be rounded: the mean of those between which none lacks.
    fn period(&self) -> f64 {
        let mut steps: Vec<f64> = self.starts.windows(2).map(|w| w[1].1 - w[0].1).collect();
        steps.sort_by(f64::total_cmp);
        let usual = steps[steps.len() / 2];
        steps.retain(|step| *step < LACKS * usual);
        steps.iter().sum::<f64>() / steps.len() as f64
    }

    /// Whether stamps are farther from even ones than their last digit: those of arrival, by which the rate is not
    /// known to [`SAME_RATE`].
    fn are_uneven(&self, period: f64) -> bool {
        let mut steps: Vec<f64> = self.starts.windows(2).map(|w| w[1].1 - w[0].1).collect();
        let mut place = 0.0;
        let places: Vec<f64> = steps
            .iter()
            .map(|step| {
                place += (step / period).round().max(1.0);
                place
            })
            .collect();
        let first = self.starts[0].1;
        let span = self.starts[self.starts.len() - 1].1 - first;
        let due = |at: f64| first + span * at / place;
        let off = self.starts[1..].iter().zip(&places).map(|((_, stamp), at)| (stamp - due(*at)).abs());
        let worst = off.fold(0.0, f64::max);
        steps.sort_by(f64::total_cmp);
        let differ = steps.windows(2).map(|w| w[1] - w[0]).filter(|d| *d > 1e-6 * period);
        let digit = differ.fold(f64::INFINITY, f64::min);
        worst > 1.01 * digit && worst > SAME_RATE * span
    }
}

/// Sets the rate of channels whose clock stamps packets, with notes on packets that lack; returns the places of
/// such clocks.
pub(super) fn told(
    channels: &mut [Channel],
    courses: &[Option<Course>],
    notes: &mut Vec<String>,
) -> Result<Vec<usize>> {
    let mut found = Vec::new();
    for n in 0..channels.len() {
        let clock = &channels[n];
        let unit = unit_of(clock);
        let is_clock = matches!(unit, Unit::Time(..)) || unit == Unit::Unsaid && says_time(own_name(clock));
        let is_told = courses[n].as_ref().is_some_and(|course| course.change.is_none() && course.is_even());
        if is_told || !is_clock || clock.len < LEAST as u64 {
            continue;
        }
        let Some(packets) = Packets::of(clock)? else { continue };
        let Some(size) = packets.size() else { continue };
        let period = packets.period();
        let first_stamp = packets.starts[0].1;
        let second = match unit {
            Unit::Time(_, second) => second,
            _ => units::epoch_unit_s(first_stamp).unwrap_or(1.0),
        };
        let gaps: Vec<&[(f64, f64)]> =
            packets.starts.windows(2).filter(|w| w[1].1 - w[0].1 > LACKS * period).collect();
        let lost: f64 = gaps.iter().map(|w| ((w[1].1 - w[0].1) / period).round() - 1.0).sum();
        // All packets between the first and the last stamp, and those that lack.
        let count = (packets.starts.len() - 1) as f64 + lost;
        let span = packets.starts[packets.starts.len() - 1].1 - first_stamp;
        let exact_hz = size * count / (span * second);
        // The first and the last stamp are rounded; where a round rate lies within that, it is the rate.
        let digit =
            packets.starts.windows(2).map(|w| w[1].1 - w[0].1).fold(f64::INFINITY, f64::min).min(period);
        let round_hz = (exact_hz / 100.0).round() * 100.0;
        let is_round = (exact_hz / round_hz - 1.0).abs() < digit / span;
        let hz = if is_round { round_hz } else { units::rounded(exact_hz) };
        let name = clock.name.clone();
        if packets.are_uneven(period) {
            notes.push(arrive(&name, size, exact_hz));
            found.push(n);
            channels[n].is_time = true;
            continue;
        }
        notes.push(format!(
            "`{name}` stamps packets of {size} samples, not samples: {hz} Hz by {} packets",
            packets.starts.len()
        ));
        if let Some(first) = gaps.first() {
            let more = match gaps.len() - 1 {
                0 => String::new(),
                more => format!(", and so at {more} more places"),
            };
            notes.push(format!(
                "packets lack: {lost} of {:.0}, the first after row {}{more}. Impacts before and after them do not \
                 line up: cut the file there and take the longest part",
                packets.rows / size + lost,
                first[1].0
            ));
        }
        let (len, group) = (clock.len, clock.group.clone());
        found.push(n);
        channels[n].is_time = true;
        for channel in channels.iter_mut().filter(|c| c.len == len && c.group == group) {
            channel.rate_hz = channel.rate_hz.or(Some(hz).filter(|hz| hz.is_finite() && *hz > 0.0));
        }
    }
    Ok(found)
}

/// Why stamps of packets of a size that rise unevenly say no rate, and which they say on average [Hz].
pub(super) fn arrive(name: &str, size: f64, hz: f64) -> String {
    format!(
        "`{name}` stamps packets of about {size:.0} samples, and the stamps rise unevenly, as those of their arrival \
         do: {hz:.0} Hz on average. Give the rate by hand"
    )
}

/// Why a channel that is called a time says no rate.
pub(super) fn why_uneven(channel: &Channel) -> Result<Option<String>> {
    let (mut row, mut before) = (0_u64, f64::NAN);
    let (mut falls, mut stands, mut first_fall) = (0_u64, 0_u64, 0);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    channel.for_each_block(|block| {
        for &value in block {
            row += 1;
            let step = value - before;
            if step < 0.0 {
                first_fall = if falls == 0 { row } else { first_fall };
                falls += 1;
            } else if step == 0.0 {
                stands += 1;
            } else if step > 0.0 {
                (least, most) = (least.min(step), most.max(step));
            }
            before = value;
        }
        true
    })?;
    let name = &channel.name;
    Ok(if falls + 1 >= row {
        Some(format!("the times of `{name}` fall from row to row: turn the order of the rows round"))
    } else if falls > 0 {
        Some(format!(
            "the times of `{name}` go back at {falls} of {row} rows, the first of them row {first_fall}: two \
             recordings in one file, or dates with day and month in two orders. Cut it there, or give the rate by \
             hand"
        ))
    } else if stands > 0 {
        Some(format!(
            "the times of `{name}` stand still at {stands} of {row} rows, in groups of different length: they are \
             those of packets, or have too few digits. Give the rate by hand"
        ))
    } else if most > 0.0 {
        Some(format!(
            "the times of `{name}` rise unevenly, by {least:.6} to {most:.6} from row to row: give the rate by hand \
             if only the times are uneven, or resample the record"
        ))
    } else {
        None
    })
}
