//! The whole bearing in slow motion: rings, cage, rollers and the forces between them, from the trace.
//!
//! The page carries angles of every [`ANGLES_EVERY`]th frame, between which they are straight lines to the
//! eye, and forces of every frame as shares of the largest. `assets/bearing.js` draws them.

use std::f64::consts::TAU;
use std::ops::Range;

use maud::{Markup, PreEscaped, html};
use serde::Serialize;
use stribeck_analysis::findings::Findings;
use stribeck_analysis::record::{Record, Roller};
use stribeck_analysis::summary::Event;
use stribeck_diagnosis::words::numbers::significant;
use stribeck_scene::deviation::RollingSurface;
use stribeck_scene::resolved::{ResolvedScene, pocket_half_width};
use stribeck_scene::scene::DefectRing;

use super::Subject;
use crate::Error;
use crate::page::Section;
use crate::plot::base64;

/// Frames at most.
const FRAMES: usize = 600;
/// Least number of frames in the time between two rollers at one place: a passage over a spall then covers
/// about ten of them.
const FRAMES_A_PASSAGE: usize = 40;
/// Frames between two angles.
const ANGLES_EVERY: usize = 8;
/// Most events that the scrubber labels.
const NAMED: usize = 400;

/// What `bearing.js` reads; lengths [mm], angles [rad], counter-clockwise from the x axis.
#[derive(Debug, Serialize)]
struct Sent<'a> {
    radii: Radii,
    start_s: f64,
    step_s: f64,
    frames: usize,
    angles_every: usize,
    /// Word for a rolling element, which the page of a ball bearing replaces.
    element: &'static str,
    /// Numbers of the rollers.
    rollers: Vec<usize>,
    /// Angles of the pockets at the start.
    pockets: Vec<f64>,
    /// Half the angle that a pocket takes of the cage.
    pocket_half_rad: f64,
    /// Angle of each roller's centre, and its rotation: u16 of a turn, roller by roller at each angle.
    orbit: String,
    spin: String,
    /// Normal forces: u8 of `largest_n`, roller by roller in each frame.
    outer: String,
    inner: String,
    largest_n: f64,
    /// u16 of a turn; cage where there is one.
    cage: Option<String>,
    shaft: String,
    ring: String,
    /// Least and largest acceleration in each frame: u16 from `-peak_g` to `peak_g`.
    trace: Option<SentTrace<'a>>,
    spalls: Vec<SentSpall>,
    faulty: Vec<usize>,
    /// Time [s] and words, ascending.
    events: Vec<(f64, String)>,
    load: [f64; 2],
    /// Frame that is shown first.
    first: usize,
    /// Time between two rollers at one place [s].
    passage_s: f64,
}

#[derive(Debug, Serialize)]
struct Radii {
    outer_back: f64,
    outer: f64,
    inner: f64,
    inner_back: f64,
    path: f64,
    roller: f64,
    cage: Option<[f64; 2]>,
}

#[derive(Debug, Serialize)]
struct SentTrace<'a> {
    sensor: &'a str,
    peak_g: f64,
    extremes: String,
}

#[derive(Debug, Serialize)]
struct SentSpall {
    inner: bool,
    angle: f64,
    half_rad: f64,
}

/// The samples that are shown, and how many of them make a frame.
#[derive(Debug, Clone, PartialEq)]
struct Stretch {
    samples: Range<usize>,
    per_frame: usize,
}

impl Stretch {
    /// Of a record of `len` samples every `interval_s`: all of it, or as many passages about the first event
    /// at `event_s` behind its beginning as the frames can show.
    fn of(len: usize, interval_s: f64, passage_s: f64, event_s: Option<f64>) -> Self {
        let whole = len.div_ceil(FRAMES).max(1);
        let finest = passage_s / (FRAMES_A_PASSAGE as f64 * interval_s);
        let finest = if finest.is_finite() { (finest as usize).max(1) } else { whole };
        let per_frame = whole.min(finest);
        let shown = (len / per_frame).min(FRAMES) * per_frame;
        let before = event_s.map_or(0.0, |at| (at - passage_s) / interval_s).round().max(0.0) as usize;
        let first = before.min(len - shown);
        Self { samples: first..first + shown, per_frame }
    }

    fn frames(&self) -> usize {
        self.samples.len() / self.per_frame
    }

    fn means(&self, values: &[f64]) -> Vec<f64> {
        values.chunks_exact(self.per_frame).map(|c| c.iter().sum::<f64>() / c.len() as f64).collect()
    }

    /// The value in the middle of every [`ANGLES_EVERY`]th frame, and of the last.
    fn angles(&self, values: &[f64]) -> Vec<f64> {
        let last = self.frames().saturating_sub(1);
        (0..angles(self.frames()))
            .map(|n| (n * ANGLES_EVERY).min(last) * self.per_frame + self.per_frame / 2)
            .map(|at| values.get(at).copied().unwrap_or(0.0))
            .collect()
    }
}

/// Number of stored angles for this many frames.
fn angles(frames: usize) -> usize {
    frames.saturating_sub(1).div_ceil(ANGLES_EVERY) + 1
}

/// The section; `None` where fewer than two frames or no roller are on record.
pub(super) fn section(of: &Subject<'_>) -> Result<Option<Section>, Error> {
    let (record, findings) = (of.record, of.findings);
    let (scene, interval_s) = (&of.run.scene, record.interval_s());
    let motion = &findings.prediction.kinematics;
    let passage_s = 1.0 / motion.bpfo_hz.abs();
    let events = &findings.summary.events;
    let event_s = events.first().map(|event| event.visit().entry_s - findings.start_s);
    let stretch = Stretch::of(record.len(), interval_s, passage_s, event_s);
    let numbers = record.roller_numbers();
    if numbers.is_empty() || stretch.frames() < 2 {
        return Ok(None);
    }
    let part = record.with_rollers(&numbers, stretch.samples.clone())?;
    let forces = Rolling::of(&part.rollers(), &stretch);
    let time = record.time_s();
    let start_s = time.get(stretch.samples.start).copied().unwrap_or(0.0);
    let turning = |name: &str, rad_s: f64| {
        let recorded = record.channel(name).map(|all| stretch.angles(&all[stretch.samples.clone()]));
        let steady = || stretch.angles(&time[stretch.samples.clone()]).iter().map(|t| rad_s * t).collect();
        turns(&recorded.unwrap_or_else(steady))
    };
    let end_s = start_s + stretch.samples.len() as f64 * interval_s;
    let named = named(events, start_s..end_s);
    let step_s = stretch.per_frame as f64 * interval_s;
    let middle = events.iter().map(Event::visit).find(|v| v.entry_s >= start_s && v.exit_s < end_s);
    let first = middle.map_or(0.0, |v| (0.5 * (v.entry_s + v.exit_s) - start_s) / step_s) as usize;
    let sent = Sent {
        radii: radii(scene),
        start_s,
        step_s,
        frames: stretch.frames(),
        angles_every: ANGLES_EVERY,
        element: "roller",
        pockets: numbers.iter().map(|n| scene.pocket_angle(n - 1)).collect(),
        pocket_half_rad: pocket_half_rad(scene),
        orbit: turns(&forces.orbit),
        spin: turns(&forces.spin),
        outer: shares(&forces.outer_n, forces.largest_n()),
        inner: shares(&forces.inner_n, forces.largest_n()),
        largest_n: forces.largest_n(),
        cage: record
            .channel("cage.angle_rad")
            .map(|angle| turns(&stretch.angles(&angle[stretch.samples.clone()]))),
        shaft: turning("shaft.angle_rad", motion.shaft_rad_s),
        ring: turning("outer_ring.angle_rad", motion.outer_rad_s),
        trace: trace(findings, &stretch),
        spalls: spalls(scene),
        faulty: faulty(scene, &numbers),
        rollers: numbers,
        events: named,
        load: scene.written.load_direction(),
        first: first.min(stretch.frames() - 1),
        passage_s,
    };
    let moving = markup(&sent, &stretch, record)?;
    Ok(Some(Section::new("motion", "The bearing in motion").linked("In motion").after(moving)))
}

/// Motion and forces of all rollers, interleaved.
#[derive(Debug, Default)]
struct Rolling {
    orbit: Vec<f64>,
    spin: Vec<f64>,
    outer_n: Vec<f64>,
    inner_n: Vec<f64>,
}

impl Rolling {
    fn of(rollers: &[Roller<'_>], stretch: &Stretch) -> Self {
        let all = |of: &dyn Fn(&Roller<'_>) -> Vec<f64>| {
            let each: Vec<Vec<f64>> = rollers.iter().map(of).collect();
            let rows = each.first().map_or(0, Vec::len);
            (0..rows).flat_map(|row| each.iter().map(move |values| values[row])).collect()
        };
        Self {
            orbit: all(&|r| stretch.angles(&r.orbit())),
            spin: all(&|r| stretch.angles(r.spin)),
            outer_n: all(&|r| stretch.means(&r.outer_normal())),
            inner_n: all(&|r| stretch.means(&r.inner_normal())),
        }
    }

    fn largest_n(&self) -> f64 {
        let all = self.outer_n.iter().chain(&self.inner_n);
        all.copied().fold(f64::MIN_POSITIVE, f64::max)
    }
}

/// Angles as u16 of a turn.
fn turns(angles: &[f64]) -> String {
    let of_turn = |angle: &f64| ((angle / TAU).rem_euclid(1.0) * 65_536.0) as u16;
    base64::bytes(&angles.iter().map(of_turn).flat_map(u16::to_le_bytes).collect::<Vec<u8>>())
}

/// Forces as u8 of the largest; a pull counts as nothing.
fn shares(forces: &[f64], largest: f64) -> String {
    let share = |force: &f64| (255.0 * (force / largest).clamp(0.0, 1.0)).round() as u8;
    base64::bytes(&forces.iter().map(share).collect::<Vec<u8>>())
}

fn radii(scene: &ResolvedScene) -> Radii {
    let mm = |metres: f64| (1e6 * metres).round() * 1e-3;
    Radii {
        outer_back: mm(scene.outer_race_radius + scene.outer_ring_thickness),
        outer: mm(scene.outer_race_radius),
        inner: mm(scene.inner_race_radius),
        inner_back: mm((scene.inner_race_radius - scene.inner_ring_thickness).max(0.0)),
        // Without clearance a roller would lie on both raceways; drawn it lies between them.
        path: mm(0.5 * (scene.outer_race_radius + scene.inner_race_radius)),
        roller: mm(scene.roller_radius),
        cage: scene.cage.as_ref().map(|cage| cage.radii().map(mm)),
    }
}

fn pocket_half_rad(scene: &ResolvedScene) -> f64 {
    let Some(cage) = &scene.cage else { return 0.0 };
    let path = scene.path_radius();
    let [inner, outer] = cage.radii();
    let half = pocket_half_width(inner, outer, path, scene.roller_radius + cage.pocket_clearance);
    (half / path.clamp(inner, outer)).clamp(0.0, 1.0).asin()
}

fn spalls(scene: &ResolvedScene) -> Vec<SentSpall> {
    let of = |ring: DefectRing, radius: f64| {
        scene.grooves_of(ring).map(move |groove| SentSpall {
            inner: ring == DefectRing::Inner,
            angle: groove.angle,
            half_rad: 0.5 * groove.length / radius,
        })
    };
    of(DefectRing::Outer, scene.outer_race_radius)
        .chain(of(DefectRing::Inner, scene.inner_race_radius))
        .collect()
}

fn faulty(scene: &ResolvedScene, numbers: &[usize]) -> Vec<usize> {
    let faults = scene.written.faults();
    numbers.iter().copied().filter(|number| faults.contains(&RollingSurface::Roller(*number))).collect()
}

/// Events of a stretch of time, in words and in order.
fn named(events: &[Event], time_s: Range<f64>) -> Vec<(f64, String)> {
    let of_event = |event: &Event| {
        let roller = event.roller;
        let at = |ms: Option<f64>, what: &str| ms.map(|ms| (1e-3 * ms, format!("roller {roller} {what}")));
        [
            at(event.entry_ms, "unloads at the spall"),
            at(event.impact_ms(), "strikes the floor of the spall"),
            at(event.landing_ms(), "lands on the oil above the floor of the spall"),
            at(event.exit_ms, "is loaded again behind the spall"),
        ]
    };
    let all = events.iter().flat_map(of_event).flatten();
    let mut named: Vec<(f64, String)> = all.filter(|(at, _)| time_s.contains(at)).take(NAMED).collect();
    named.sort_by(|a, b| a.0.total_cmp(&b.0));
    named
}

/// Extremes of the leading sensor in each frame.
fn trace<'a>(findings: &'a Findings, stretch: &Stretch) -> Option<SentTrace<'a>> {
    let leading = findings.sensors.first()?;
    let raw = leading.raw_g.get(stretch.samples.clone())?;
    let peak_g = raw.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
    let short = |g: f64| ((0.5 + 0.5 * g / peak_g.max(f64::MIN_POSITIVE)) * 65_535.0).round() as u16;
    let extremes = raw.chunks_exact(stretch.per_frame).flat_map(|frame| {
        [
            frame.iter().fold(f64::INFINITY, |a, b| a.min(*b)),
            frame.iter().fold(-f64::INFINITY, |a, b| a.max(*b)),
        ]
    });
    let bytes: Vec<u8> = extremes.map(short).flat_map(u16::to_le_bytes).collect();
    Some(SentTrace { sensor: &leading.name, peak_g, extremes: base64::bytes(&bytes) })
}

fn markup(sent: &Sent<'_>, stretch: &Stretch, record: &Record<'_>) -> Result<Markup, Error> {
    let data = serde_json::to_string(sent)
        .map_err(|why| Error::Drawing { figure: "moving".into(), why: why.to_string() })?
        .replace('<', "\\u003c");
    let shown_ms = 1e3 * record.interval_s() * stretch.samples.len() as f64;
    let part = if stretch.samples.len() + stretch.per_frame > record.len() {
        String::new()
    } else {
        format!(
            " Of the record of {} s, {} ms from {} ms on are shown.",
            significant(record.interval_s() * record.len() as f64, 3),
            significant(shown_ms, 3),
            significant(1e3 * sent.start_s, 4)
        )
    };
    Ok(html! {
        figure id="moving" class="moving-bearing" tabindex="0" aria-label="The bearing in slow motion" {
            p class="caption" {
                "Bars outside: force of the outer raceway on each roller; inside: that of the inner one. "
                "Click a roller to follow its force; click any trace of the page to go to that time."
            }
            div class="stage" {
                canvas class="bearing" role="img" aria-label="Rings, cage, rollers with a mark that turns, forces" {}
                canvas class="strips" role="img" aria-label="Acceleration and force about the time shown" {}
            }
            div class="controls" {
                button type="button" class="play" title="Space" { "▶ Play" }
                input type="range" min="0" max=(sent.frames - 1) value=(sent.first) step="1" aria-label="Time";
                label { "Slowed " select class="slow" aria-label="How many times slower than it is" {} }
                output {}
            }
            p class="note" {
                "Keys: space plays and stops, ← and → go one frame, with Shift ten; Home and End. "
                "A frame is " (significant(1e6 * sent.step_s, 3)) " µs long; forces are means over it, "
                "acceleration its extremes. Drawn to scale: the radial play of micrometres is not to be seen."
                (part)
            }
            script type="application/json" { (PreEscaped(data)) }
            script { (PreEscaped(include_str!("../../assets/bearing.js"))) }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples every 10 µs, rollers 10 ms apart.
    #[test]
    fn behaves_a_short_record_is_shown_whole_and_a_long_one_about_its_first_event() {
        let whole = Stretch::of(3000, 1e-5, 0.01, Some(0.005));
        assert_eq!(whole, Stretch { samples: 0..3000, per_frame: 5 });
        // 40 frames in 10 ms are 25 samples each: 600 of them are 150 ms of the second.
        let long = Stretch::of(100_000, 1e-5, 0.01, Some(0.5));
        assert_eq!(long, Stretch { samples: 49_000..64_000, per_frame: 25 });
        assert_eq!(Stretch::of(100_000, 1e-5, 0.01, Some(0.999)).samples, 85_000..100_000);
        assert_eq!(Stretch::of(100_000, 1e-5, 0.01, None).samples, 0..15_000);
        // Nothing turns: the whole record, coarsely; and next to no record.
        assert_eq!(Stretch::of(6000, 1e-5, f64::INFINITY, None).frames(), 600);
        assert_eq!(Stretch::of(0, 1e-5, 0.01, None).frames(), 0);
    }

    #[test]
    fn roundtrip_angles_and_forces_keep_their_place() {
        // A quarter, and a quarter backwards.
        assert_eq!(turns(&[0.25 * TAU, -0.25 * TAU]), base64::bytes(&[0x00, 0x40, 0x00, 0xc0]));
        assert_eq!(shares(&[-5.0, 0.0, 50.0, 100.0], 100.0), base64::bytes(&[0, 0, 128, 255]));
        assert_eq!((angles(1), angles(2), angles(9), angles(10)), (1, 2, 2, 3));
    }
}
