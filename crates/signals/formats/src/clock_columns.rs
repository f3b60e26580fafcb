//! Times in four unnamed columns: hours, minutes, seconds and microseconds of the day.
//!
//! Tables of this form have no header (FEMTO-ST, PRONOSTIA: `9,39,39,65664,0.552,-0.146`). The four columns
//! become one, in seconds.

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
