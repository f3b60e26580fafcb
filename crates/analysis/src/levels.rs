//! How strong the impulses at the exits are, and what lies between them.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::events::span;

/// Standard acceleration of gravity [m/s²] (CGPM 1901): the unit of every level.
pub const STANDARD_GRAVITY: f64 = 9.806_65;
/// Half width of the window about an exit in which its impulse is sought [s].
pub const IMPULSE_HALF_WIDTH_S: f64 = 1e-3;
/// Time before an entry that counts as part of the event [s].
pub const BEFORE_ENTRY_S: f64 = 0.5e-3;
/// Time after an exit that counts as part of the event [s]: its ringing.
pub const AFTER_EXIT_S: f64 = 2e-3;

/// Size of a signal over some samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SignalLevel {
    /// Largest magnitude [unit of the signal].
    pub peak: f64,
    /// Magnitude that one sample in a hundred exceeds: a peak that a single sample cannot set.
    pub p99: f64,
    /// Root mean square.
    pub rms: f64,
}

/// Level of `signal` over the union of `spans`; `None` when they hold no sample.
pub fn level(signal: &[f64], spans: &[Range<usize>]) -> Option<SignalLevel> {
    let mut sizes: Vec<f64> =
        spans.iter().flat_map(|s| signal.get(s.clone()).unwrap_or(&[])).map(|v| v.abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let peak = *sizes.last()?;
    let rank = (0.99 * (sizes.len() - 1) as f64).round() as usize;
    let rms = (sizes.iter().map(|v| v * v).sum::<f64>() / sizes.len() as f64).sqrt();
    Some(SignalLevel { peak, p99: sizes[rank], rms })
}

/// Samples within [`IMPULSE_HALF_WIDTH_S`] of an exit.
pub fn impulse_span(time_s: &[f64], exit_s: f64) -> Range<usize> {
    span(time_s, exit_s - IMPULSE_HALF_WIDTH_S, exit_s + IMPULSE_HALF_WIDTH_S)
}

/// Samples from `from_s` on that belong to no event, given the entry and exit [s] of each passage.
///
/// An event reaches from [`BEFORE_ENTRY_S`] before the entry to [`AFTER_EXIT_S`] after the exit.
pub fn quiet_spans(time_s: &[f64], passages: &[(f64, f64)], from_s: f64) -> Vec<Range<usize>> {
    let mut busy: Vec<Range<usize>> = passages
        .iter()
        .map(|&(entry, exit)| span(time_s, entry - BEFORE_ENTRY_S, exit + AFTER_EXIT_S))
        .collect();
    busy.sort_by_key(|s| s.start);
    let mut quiet = Vec::new();
    let mut free = time_s.partition_point(|&t| t < from_s);
    for event in busy {
        if event.start > free {
            quiet.push(free..event.start);
        }
        free = free.max(event.end);
    }
    if free < time_s.len() {
        quiet.push(free..time_s.len());
    }
    quiet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn example_level_of_a_sine() {
        let sine: Vec<f64> =
            (0..1000).map(|n| 50.0 * (std::f64::consts::TAU * 0.05 * n as f64).sin()).collect();
        let found = level(&sine, &[0..500, 500..1000]).unwrap();
        // Whole periods: peak A, root mean square A/√2 to rounding.
        assert!((found.peak - 50.0).abs() < 1e-9 && (found.rms - 50.0 / 2f64.sqrt()).abs() < 1e-9);
        assert_eq!(level(&sine, &[]), None);
        let outside = 2000..2100;
        assert_eq!(level(&sine, &[outside]), None);
    }

    #[test]
    fn invariant_quiet_spans_avoid_events_and_cover_the_rest() {
        let time: Vec<f64> = (0..3000).map(|n| n as f64 * 1e-5).collect();
        let passages = [(11.94e-3, 16.18e-3), (0.84e-3, 5.08e-3), (23.04e-3, 27.28e-3)];
        let quiet = quiet_spans(&time, &passages, 0.0);
        let in_ms: Vec<(f64, f64)> =
            quiet.iter().map(|s| (1e3 * time[s.start], 1e3 * time[s.end - 1])).collect();
        let expected = [(0.0, 0.33), (7.09, 11.43), (18.19, 22.53), (29.29, 29.99)];
        assert_eq!(in_ms.len(), expected.len());
        for (found, wanted) in in_ms.iter().zip(expected) {
            assert!((found.0 - wanted.0).abs() < 0.015 && (found.1 - wanted.1).abs() < 0.015, "{in_ms:?}");
        }
        assert_eq!(quiet_spans(&time, &[(-1.0, 1.0)], 0.0), []);
        assert_eq!(quiet_spans(&time, &passages, 8e-3)[0].start, 800);
    }
}
