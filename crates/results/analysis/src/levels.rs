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
