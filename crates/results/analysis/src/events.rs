//! When a roller unloads at the leading edge of a defect and when it is loaded again at the trailing edge.
//!
//! **The rule.** The normal force of the spall's raceway on the roller (compression positive) is passed
//! through a running median as wide as one facet period, at most a tenth of the traverse: a median keeps the
//! times of steps, and removes both the facet tone and shocks shorter than half its width. The level before
//! the defect is the median over half a traverse before the expected entry, less its last tenth. The record
//! around the passage is split where the roller is in the middle of the defect. *Entry* is the start of the
//! longest stretch below half that level in the first part (from half a traverse before the expected entry),
//! *exit* the end of the longest such stretch in the second part (up to half a traverse after the expected
//! exit). Splitting excludes impacts and rebounds on the floor of the defect. A stretch counts from an eighth
//! of a traverse on.

use std::ops::Range;

use stribeck_dsp::median;

/// Shortest unloaded stretch that counts, as a fraction of the traverse.
const SHORTEST_STRETCH: f64 = 0.125;
/// Half of the level before the defect is the threshold of both events.
const THRESHOLD: f64 = 0.5;

/// When a roller should meet and leave a defect [s], and how long the force is smoothed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Expected time over the leading edge [s].
    pub entry_s: f64,
    /// Expected time over the trailing edge [s], later than `entry_s`.
    pub exit_s: f64,
    /// Time in the middle of the defect [s]: from the recorded path when there is one.
    pub middle_s: f64,
    /// Width of the running median [s]: one facet period, at most a tenth of the traverse.
    pub smoothing_s: f64,
}

/// Events read from the force.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Picked {
    /// Unloading [s]; `None` with a note when it cannot be determined.
    pub entry_s: Option<f64>,
    /// Re-stressing [s]; `None` with a note when it cannot be determined.
    pub exit_s: Option<f64>,
    /// Level before the defect [N].
    pub level_n: Option<f64>,
    /// Why something is missing.
    pub notes: Vec<String>,
}

/// Picks both events from the normal force `force_n` [N] sampled at `time_s` [s], both of one length.
pub fn pick(time_s: &[f64], force_n: &[f64], passage: &Passage) -> Picked {
    let mut picked = Picked::default();
    let traverse = passage.exit_s - passage.entry_s;
    let before = span(time_s, passage.entry_s - 0.5 * traverse, passage.entry_s - 0.05 * traverse);
    if before.is_empty() || time_s[before.end - 1] - time_s[before.start] < passage.smoothing_s {
        picked.notes.push(format!(
            "the record holds less than the smoothing ({:.3} ms) before the expected entry at {:.3} ms, so \
             there is no level to compare with",
            1e3 * passage.smoothing_s,
            1e3 * passage.entry_s
        ));
        return picked;
    }
    let level = median(&mut force_n[before].to_vec());
    picked.level_n = Some(level);
    if level <= 0.0 {
        picked.notes.push("the roller carries no load before the defect".into());
        return picked;
    }

    let whole = span(time_s, passage.entry_s - 0.5 * traverse, passage.exit_s + 0.5 * traverse);
    let time = &time_s[whole.clone()];
    let smooth = running_median(time, &force_n[whole], passage.smoothing_s);
    let threshold = THRESHOLD * level;
    let split = time.partition_point(|&t| t < passage.middle_s);
    let least = SHORTEST_STRETCH * traverse;

    match longest_below(time, &smooth, 0..split, threshold, least) {
        None => picked.notes.push("the roller never unloads in the first half of the defect".into()),
        Some(stretch) if stretch.start == 0 => {
            picked.notes.push("the roller is unloaded already half a traverse before the defect".into());
        }
        Some(stretch) => picked.entry_s = Some(crossing(time, &smooth, stretch.start, threshold)),
    }
    if split == time.len() {
        picked.notes.push("the record ends before the roller is in the middle of the defect".into());
        return picked;
    }
    match longest_below(time, &smooth, split..time.len(), threshold, least) {
        None if time[time.len() - 1] < passage.exit_s - least => {
            picked.notes.push("the record ends before the roller leaves the defect".into());
        }
        None => picked.notes.push("the roller never unloads in the second half of the defect".into()),
        Some(stretch) if stretch.end == time.len() => {
            let last = time[time.len() - 1];
            let until =
                if last < passage.exit_s + 0.45 * traverse { "the record ends" } else { "the search ends" };
            picked.notes.push(format!(
                "the roller carries less than half its load until {until} at {:.3} ms; its exit is expected \
                 at {:.3} ms",
                1e3 * last,
                1e3 * passage.exit_s
            ));
        }
        Some(stretch) => picked.exit_s = Some(crossing(time, &smooth, stretch.end, threshold)),
    }
    picked
}

/// Times [s] at which a body rotating from `angle` [rad] (unwrapped, one a sample) passes `edge` [rad],
/// modulo a turn.
pub fn crossings(time_s: &[f64], angle: &[f64], edge: f64) -> Vec<f64> {
    let turns = |a: f64| (a - edge) / std::f64::consts::TAU;
    let passed = |n: usize| turns(angle[n]).floor() != turns(angle[n - 1]).floor();
    (1..time_s.len().min(angle.len()))
        .filter(|&n| passed(n))
        .map(|n| {
            let (a, b) = (turns(angle[n - 1]), turns(angle[n]));
            let whole = a.max(b).floor();
            time_s[n - 1] + (time_s[n] - time_s[n - 1]) * (whole - a) / (b - a)
        })
        .collect()
}

/// Samples between two times.
pub fn span(time_s: &[f64], from: f64, to: f64) -> Range<usize> {
    let start = time_s.partition_point(|&t| t < from);
    start..time_s.partition_point(|&t| t <= to).max(start)
}

/// Running median over `width_s`, centred; shorter at the ends of the record.
pub fn running_median(time_s: &[f64], values: &[f64], width_s: f64) -> Vec<f64> {
    let mut window = Vec::new();
    time_s
        .iter()
        .map(|&t| {
            window.clear();
            window.extend_from_slice(&values[span(time_s, t - 0.5 * width_s, t + 0.5 * width_s)]);
            median(&mut window)
        })
        .collect()
}

/// Longest run of samples below `threshold` inside `within`, if it lasts `least` seconds.
fn longest_below(
    time: &[f64],
    values: &[f64],
    within: Range<usize>,
    threshold: f64,
    least: f64,
) -> Option<Range<usize>> {
    let mut best: Option<Range<usize>> = None;
    let mut start = within.start;
    while start < within.end {
        let below = values[start..within.end].iter().take_while(|&&v| v < threshold).count();
        if below > best.as_ref().map_or(0, ExactSizeIterator::len) {
            best = Some(start..start + below);
        }
        start += below.max(1);
    }
    best.filter(|run| time[run.end - 1] - time[run.start] >= least)
}

/// Time at which the straight line between samples `n − 1` and `n` meets `threshold`.
fn crossing(time: &[f64], values: &[f64], n: usize, threshold: f64) -> f64 {
    let (a, b) = (values[n - 1], values[n]);
    let part = if a == b { 0.5 } else { ((threshold - a) / (b - a)).clamp(0.0, 1.0) };
    time[n - 1] + (time[n] - time[n - 1]) * part
}
