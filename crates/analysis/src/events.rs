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
             there is \
             no level to compare with",
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

#[cfg(test)]
mod tests {
    use super::*;

    const INTERVAL: f64 = 1e-5;
    const PASSAGE: Passage =
        Passage { entry_s: 0.84e-3, exit_s: 5.08e-3, middle_s: 2.96e-3, smoothing_s: 0.214e-3 };
    /// A twentieth of a millisecond: the median moves a step under a strong tone by a fraction of the tone's
    /// period.
    const TOLERANCE_S: f64 = 0.05e-3;

    /// 10 kN, unloaded from `entry` to `exit`, with a facet tone of 60 %, deterministic noise of 20 % and a
    /// shock of 25 kN on the floor that lasts 0.06 ms.
    fn force(entry: f64, exit: f64, samples: usize) -> (Vec<f64>, Vec<f64>) {
        let mut seed = 1u64;
        (0..samples)
            .map(|n| {
                let t = n as f64 * INTERVAL;
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let noise = (seed >> 40) as f64 / (1u64 << 24) as f64 - 0.5;
                let loaded = if (entry..exit).contains(&t) { 0.0 } else { 10e3 };
                let tone = 0.6 * (std::f64::consts::TAU * 4671.0 * t).sin();
                let floor = if (entry + 0.8e-3..entry + 0.86e-3).contains(&t) { 25e3 } else { 0.0 };
                (t, (loaded * (1.0 + tone + 0.4 * noise)).max(0.0) + floor)
            })
            .unzip()
    }

    #[test]
    fn example_events_are_found_under_facet_noise_and_a_floor_shock() {
        let (entry, exit) = (1.1e-3, 4.8e-3);
        let (time, force) = force(entry, exit, 800);
        let picked = pick(&time, &force, &PASSAGE);
        assert!(picked.notes.is_empty(), "{:?}", picked.notes);
        assert!((picked.entry_s.unwrap() - entry).abs() < TOLERANCE_S, "{:?}", picked);
        assert!((picked.exit_s.unwrap() - exit).abs() < TOLERANCE_S, "{:?}", picked);
    }

    #[test]
    fn example_a_trapped_roller_has_no_exit_and_says_why() {
        let (time, force) = force(1.1e-3, 1.0, 3000);
        let picked = pick(&time, &force, &PASSAGE);
        assert!(picked.exit_s.is_none() && picked.entry_s.is_some());
        assert!(
            picked.notes[0].contains("less than half its load until the search ends"),
            "{:?}",
            picked.notes
        );
    }

    #[test]
    fn example_a_record_that_ends_early_invents_no_event() {
        let (time, force) = force(1.1e-3, 4.8e-3, 350);
        let picked = pick(&time, &force, &PASSAGE);
        assert!(picked.entry_s.is_some() && picked.exit_s.is_none());
        assert!(picked.notes[0].contains("the record ends"), "{:?}", picked.notes);
        let (time, force) = (&time[..20], &force[..20]);
        assert!(pick(time, force, &PASSAGE).notes[0].contains("no level to compare"));
        assert_eq!(pick(&[], &[], &PASSAGE).entry_s, None);
    }

    #[test]
    fn example_a_sound_raceway_gives_no_event() {
        let (time, force) = force(2.0, 3.0, 800);
        let picked = pick(&time, &force, &PASSAGE);
        assert_eq!((picked.entry_s, picked.exit_s), (None, None));
    }

    #[test]
    fn example_crossings_of_a_steady_rotation() {
        // 94° at −1351.4672 °/s passes 92.86479° after 0.84 ms and again one turn later.
        let time: Vec<f64> = (0..30_000).map(|n| n as f64 * INTERVAL).collect();
        let rate = -1_351.467_194_2_f64.to_radians();
        let angle: Vec<f64> = time.iter().map(|t| 94f64.to_radians() + rate * t).collect();
        let found = crossings(&time, &angle, (90.0 + 2.864_788_98f64).to_radians());
        assert_eq!(found.len(), 2);
        assert!((found[0] - 0.839_984e-3).abs() < 1e-8, "{}", found[0]);
        assert!((found[1] - found[0] - std::f64::consts::TAU / rate.abs()).abs() < 1e-8);
    }
}
