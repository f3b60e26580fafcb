//! Columns of times: several for one time, rows of which each is one channel's, rows that stand twice.
//!
//! Four unnamed columns may be hours, minutes, seconds and microseconds of the day.
//! Tables of this form have no header (FEMTO-ST, PRONOSTIA: `9,39,39,65664,0.552,-0.146`). The four columns
//! become one, in seconds.

use crate::time::is_clock;
use crate::{Channel, Recording, Result};

/// Ends of the four columns, exclusive.
const ENDS: [f64; 4] = [24.0, 60.0, 60.0, 1e6];
/// Seconds of a unit of each.
const SECONDS: [f64; 4] = [3600.0, 60.0, 1.0, 1e-6];
/// Columns without a name.
const UNNAMED: &str = "column ";
/// Fewest rows that show that a column counts time.
const LEAST: usize = 10;

/// The recording with its first four columns as one of times, where they are a time of the day that rises and no
/// column has a name.
pub(crate) fn joined(mut recording: Recording) -> Result<Recording> {
    let channels = &recording.channels;
    let len = channels.first().map_or(0, |channel| channel.len);
    let unnamed = |channel: &Channel| channel.name.starts_with(UNNAMED) && channel.len == len;
    if channels.len() <= ENDS.len() || len < LEAST as u64 || !channels.iter().all(unnamed) {
        return Ok(recording);
    }
    let mut times = vec![0.0; usize::try_from(len).unwrap_or(0)];
    for ((channel, end), second) in channels.iter().zip(ENDS).zip(SECONDS) {
        let values = channel.read()?;
        // Only the last may be broken, as a counter that was written as a float is.
        let is_part = |x: &f64| (0.0..end).contains(x) && (second < 1.0 || x.fract() == 0.0);
        if values.len() != times.len() || !values.iter().all(is_part) {
            return Ok(recording);
        }
        times.iter_mut().zip(&values).for_each(|(time, x)| *time += second * x);
    }
    if !times.windows(2).all(|pair| pair[1] > pair[0]) {
        return Ok(recording);
    }
    let first = times[0];
    times.iter_mut().for_each(|time| *time -= first);
    let mut time = Channel::held("time", times).in_unit(Some("s".to_owned()));
    time.is_time = true;
    recording.channels.splice(..ENDS.len(), [time]);
    recording.notes.push(
        "the first four columns are taken for hours, minutes, seconds and microseconds of the day".to_owned(),
    );
    Ok(recording)
}

/// The recording with the channels of each of several clocks apart, where the table is a join of tables with times of
/// their own: in each row some channels have a value, and others do not.
pub(crate) fn parted(mut recording: Recording) -> Result<Recording> {
    let channels = &recording.channels;
    let values = channels.iter().map(Channel::read).collect::<Result<Vec<Vec<f64>>>>()?;
    let rows = values.iter().map(Vec::len).min().unwrap_or(0);
    let there = |at: usize| -> Vec<bool> { values[at][..rows].iter().map(|x| x.is_finite()).collect() };
    let Some(clock) = (0..channels.len()).find(|n| is_clock(&channels[*n]) && there(*n).iter().all(|x| *x))
    else {
        return Ok(recording);
    };
    // The rows of each clock, and the channels that have them.
    let mut clocks: Vec<(Vec<bool>, Vec<usize>)> = Vec::new();
    for at in 0..channels.len() {
        let own = there(at);
        match clocks.iter_mut().find(|(rows, _)| *rows == own) {
            _ if own.iter().all(|x| *x) => {}
            Some((_, all)) => all.push(at),
            None => clocks.push((own, vec![at])),
        }
    }
    let count = |of: &[bool]| of.iter().filter(|x| **x).count();
    let joint = |a: &[bool], b: &[bool]| a.iter().zip(b).filter(|(a, b)| **a && **b).count();
    let apart = clocks.iter().enumerate().all(|(n, (a, _))| {
        count(a) >= LEAST && clocks[..n].iter().all(|(b, _)| 2 * joint(a, b) < count(a).min(count(b)))
    });
    if clocks.len() < 2 || !apart || (0..rows).any(|row| clocks.iter().all(|(of, _)| !of[row])) {
        return Ok(recording);
    }
    let mut names = Vec::new();
    for (own, all) in clocks {
        let of_rows = |at: usize| -> Vec<f64> {
            values[at].iter().zip(&own).filter(|(_, there)| **there).map(|(x, _)| *x).collect()
        };
        let group = recording.channels[all[0]].name.clone();
        let mut time = with(recording.channels[clock].clone(), of_rows(clock));
        (time.is_time, time.group) = (true, group.clone());
        for at in all {
            let channel = &mut recording.channels[at];
            names.push(format!("`{}`", channel.name));
            *channel = with(channel.clone(), of_rows(at));
            channel.group = group.clone();
        }
        recording.channels.push(time);
    }
    names.truncate(10);
    recording.notes.push(format!(
        "rows have values of {} in turn: the samples of each are those of its rows, with their times",
        names.join(" or ")
    ));
    Ok(recording)
}

/// Leaves out rows that stand twice, time and values, beside the clock `clock`; with a note.
pub(crate) fn without_doubles(channels: &mut [Channel], clock: usize) -> Result<Option<String>> {
    let times = channels[clock].read()?;
    let double: Vec<bool> = (0..times.len()).map(|row| row > 0 && times[row] == times[row - 1]).collect();
    let count = double.iter().filter(|is| **is).count();
    if count == 0 || 2 * count > times.len() {
        return Ok(None);
    }
    let (len, group) = (channels[clock].len, channels[clock].group.clone());
    let beside = || (0..channels.len()).filter(|n| channels[*n].len == len && channels[*n].group == group);
    let mut kept = Vec::new();
    for n in beside() {
        let values = channels[n].read()?;
        let same = |row: usize| values[row].to_bits() == values[row - 1].to_bits();
        if (1..values.len().min(double.len())).any(|row| double[row] && !same(row)) {
            return Ok(None);
        }
        kept.push((
            n,
            values.into_iter().zip(&double).filter(|(_, is)| !**is).map(|(x, _)| x).collect::<Vec<f64>>(),
        ));
    }
    let first = double.iter().position(|is| *is).unwrap_or(0);
    kept.into_iter().for_each(|(n, values)| channels[n] = with(channels[n].clone(), values));
    Ok(Some(format!("rows stand twice: {count}, the first of them row {}; each is taken once", first + 1)))
}

/// A channel with other samples.
fn with(channel: Channel, samples: Vec<f64>) -> Channel {
    let len = samples.len() as u64;
    let mut channel = channel.through(|_| samples);
    channel.len = len;
    channel
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: impl Iterator<Item = [f64; 6]>) -> Recording {
        let rows: Vec<[f64; 6]> = rows.collect();
        let column = |at: usize| {
            let name = format!("{UNNAMED}{}", at + 1);
            Channel::held(name, rows.iter().map(|row| row[at]).collect())
        };
        Recording {
            path: "acc.csv".into(),
            format: "a table",
            channels: (0..6).map(column).collect(),
            notes: Vec::new(),
        }
    }

    #[test]
    fn by_hand_four_columns_are_one_time() {
        // 25.6 kHz, microseconds rounded, over the turn of a second.
        let row = |n: u32| {
            let us = (999_000.0 + 39.0625 * f64::from(n)).round();
            [9.0, 59.0, 58.0 + (us / 1e6).floor(), us % 1e6, 0.1, f64::from(n % 7)]
        };
        let found = joined(table((0..100).map(row))).unwrap();
        let times = found.channels[0].read().unwrap();
        assert_eq!((found.channels.len(), found.channels[0].is_time), (3, true));
        assert!((times[99] - 99.0 * 39.0625e-6).abs() < 1e-6, "{}", times[99]);
        // Signals that happen to be small are none.
        let other = joined(table((0..100).map(|n| [1.0, 2.0, 3.0, f64::from(n % 5), 0.0, 1.0]))).unwrap();
        assert_eq!(other.channels.len(), 6);
    }
}
