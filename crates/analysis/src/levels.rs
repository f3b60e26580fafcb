//! Levels of a signal, phase by phase: start-up, entry into the defect, in it, exit, and the gaps between.
//!
//! Every sample of a record belongs to one [`Phase`]. *Start-up* extends from the first sample to the window
//! of the first entry, [`START_UP_S`] at the most: the preload is released and rollers settle in the cage,
//! unlike in a bearing that has been running. *Entry* extends from [`BEFORE_ENTRY_S`] before a roller's
//! centre passes the leading edge or the roller unloads, whichever is first, to [`AFTER_UNLOADING_S`] after
//! it has unloaded; *exit* from [`IMPULSE_HALF_WIDTH_S`] before it is loaded again to [`AFTER_EXIT_S`] after
//! that or after its centre has passed the trailing edge, whichever is last; the time between the two is *in
//! the defect*, and the rest is *gap*. Where windows of two rollers overlap, an exit counts before an entry,
//! and an entry before the time in the defect.

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

/// Time after the unloading that counts as the entry [s]: its ringing.
pub const AFTER_UNLOADING_S: f64 = 1e-3;
/// Longest start-up [s]: as long as an exit may ring.
pub const START_UP_S: f64 = 2e-3;

/// Phase of a passage that a sample belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// The first moments of a record.
    StartUp,
    /// A roller runs into the defect.
    Entry,
    /// A roller is over the defect.
    Defect,
    /// A roller leaves the defect.
    Exit,
    /// None of these.
    Gap,
}

/// When a roller was over the defect [s], all on the record's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Visit {
    /// Earliest sign of the entry: centre over the leading edge or unloading.
    pub from_s: f64,
    /// Unloading; without one, the centre over the leading edge.
    pub entry_s: f64,
    /// Loaded again; without that, the centre over the trailing edge.
    pub exit_s: f64,
    /// Latest sign of the exit.
    pub until_s: f64,
}

impl Visit {
    /// A visit of which two times are known.
    pub fn between(entry_s: f64, exit_s: f64) -> Self {
        Self { from_s: entry_s, entry_s, exit_s, until_s: exit_s }
    }
}

/// The phase of every sample of a record.
pub fn phases(time_s: &[f64], visits: &[Visit]) -> Vec<Phase> {
    let mut phases = vec![Phase::Gap; time_s.len()];
    let mut paint = |phase: Phase, from: f64, to: f64| phases[span(time_s, from, to)].fill(phase);
    for v in visits {
        paint(Phase::Defect, v.entry_s, v.exit_s);
    }
    for v in visits {
        paint(Phase::Entry, v.from_s - BEFORE_ENTRY_S, v.entry_s + AFTER_UNLOADING_S);
    }
    for v in visits {
        paint(Phase::Exit, v.exit_s - IMPULSE_HALF_WIDTH_S, v.until_s + AFTER_EXIT_S);
    }
    if let Some(&start) = time_s.first() {
        let first = visits.iter().map(|v| v.from_s - BEFORE_ENTRY_S).fold(f64::INFINITY, f64::min);
        let end = time_s.partition_point(|&t| t < first.min(start + START_UP_S));
        phases[..end].fill(Phase::StartUp);
    }
    phases
}

/// Level of `signal` over the samples of one phase; `None` where the record has none.
pub fn phase_level(signal: &[f64], phases: &[Phase], phase: Phase) -> Option<SignalLevel> {
    let of_phase = signal.iter().zip(phases).filter(|(_, p)| **p == phase);
    level_of(of_phase.map(|(v, _)| v.abs()).collect())
}

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
    level_of(spans.iter().flat_map(|s| signal.get(s.clone()).unwrap_or(&[])).map(|v| v.abs()).collect())
}

/// Level of magnitudes.
fn level_of(mut sizes: Vec<f64>) -> Option<SignalLevel> {
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

/// Spans of samples from `from_s` on that belong to no event and not to the start-up.
pub fn gap_spans(time_s: &[f64], phases: &[Phase], from_s: f64) -> Vec<Range<usize>> {
    let first = time_s.partition_point(|&t| t < from_s);
    let mut spans: Vec<Range<usize>> = Vec::new();
    for n in (first..time_s.len().min(phases.len())).filter(|&n| phases[n] == Phase::Gap) {
        match spans.last_mut() {
            Some(last) if last.end == n => last.end = n + 1,
            _ => spans.push(n..n + 1),
        }
    }
    spans
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

    /// The paper's three passages: unloading 0.1 ms behind the leading edge, loaded again 0.2 ms before the
    /// trailing one.
    fn visits() -> Vec<Visit> {
        [(0.84e-3, 5.08e-3), (11.94e-3, 16.18e-3), (23.04e-3, 27.28e-3)]
            .map(|(from_s, until_s)| Visit {
                from_s,
                entry_s: from_s + 0.1e-3,
                exit_s: until_s - 0.2e-3,
                until_s,
            })
            .to_vec()
    }

    #[test]
    fn example_every_sample_has_one_phase() {
        let time: Vec<f64> = (0..3000).map(|n| n as f64 * 1e-5).collect();
        let found = phases(&time, &visits());
        // By hand [ms]: 0.84 − 0.5, 0.94 + 1, 4.88 − 1, 5.08 + 2, 11.94 − 0.5.
        let ends = [
            (Phase::StartUp, 0.34),
            (Phase::Entry, 1.94),
            (Phase::Defect, 3.88),
            (Phase::Exit, 7.08),
            (Phase::Gap, 11.44),
        ];
        let mut from = 0;
        for (phase, end_ms) in ends {
            let length = found[from..].iter().take_while(|p| **p == phase).count();
            from += length;
            assert!((1e3 * time[from] - end_ms).abs() < 0.015, "{phase:?} ends at {} ms", 1e3 * time[from]);
        }
        assert_eq!(found[2999], Phase::Gap);
        // One value a phase, and a peak that belongs to the start alone.
        let value = |p: &Phase| [40.0, 30.0, 20.0, 10.0, 5.0][*p as usize];
        let signal: Vec<f64> = found.iter().map(value).collect();
        for (phase, g) in [Phase::StartUp, Phase::Entry, Phase::Defect, Phase::Exit, Phase::Gap]
            .into_iter()
            .zip([40.0, 30.0, 20.0, 10.0, 5.0])
        {
            let level = phase_level(&signal, &found, phase).unwrap();
            assert!((level.peak - g).abs() < 1e-12 && (level.rms - g).abs() < 1e-12, "{phase:?} {level:?}");
        }
        assert_eq!(phase_level(&signal[..20], &found[..20], Phase::Exit), None);
    }

    #[test]
    fn example_a_sound_bearing_has_start_up_and_gap_only() {
        let time: Vec<f64> = (0..1000).map(|n| n as f64 * 1e-5).collect();
        let found = phases(&time, &[]);
        assert!(found[..200].iter().all(|p| *p == Phase::StartUp));
        assert!(found[200..].iter().all(|p| *p == Phase::Gap));
        let gap = gap_spans(&time, &found, 0.0);
        assert!(gap.len() == 1 && gap[0] == (200..1000), "{gap:?}");
        assert_eq!(phases(&[], &visits()), []);
    }

    #[test]
    fn invariant_gaps_avoid_events_and_the_start() {
        let time: Vec<f64> = (0..3000).map(|n| n as f64 * 1e-5).collect();
        let found = phases(&time, &visits());
        let in_ms: Vec<(f64, f64)> = gap_spans(&time, &found, 0.0)
            .iter()
            .map(|s| (1e3 * time[s.start], 1e3 * time[s.end - 1]))
            .collect();
        let expected = [(7.09, 11.43), (18.19, 22.53), (29.29, 29.99)];
        assert_eq!(in_ms.len(), expected.len());
        for (found, wanted) in in_ms.iter().zip(expected) {
            assert!((found.0 - wanted.0).abs() < 0.015 && (found.1 - wanted.1).abs() < 0.015, "{in_ms:?}");
        }
        assert_eq!(gap_spans(&time, &found, 8e-3)[0].start, 800);
    }
}
