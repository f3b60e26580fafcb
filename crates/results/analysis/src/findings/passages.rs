//! Passages of rollers over the defect: events, and the forces themselves.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::DefectRing;
use stribeck_theory::kinematics::Crossing;

use super::CrossingForce;
use crate::Error;
use crate::events::{self, Passage};
use crate::filtering::Filter;
use crate::floor::{FloorFilm, OverFloor, Strike};
use crate::levels::Visit;
use crate::prediction::{DefectEdges, Prediction, SpallCourse};
use crate::record::{Record, Roller};
use crate::spall_length::Edge;
use crate::statistic::Statistic;
use crate::summary::Event;

/// Passages of rollers that carry less than this part of the largest load are left out: they lie outside the
/// load zone.
const LOADED: f64 = 0.05;

/// Traverses before and behind a passage in which it is looked for.
const ABOUT: f64 = 3.0;

/// Slip below which a passage is expected at its time without slip, as a part of a traverse.
const UNMOVED: f64 = 0.1;

/// Lengths of a spall that scatter by more than this part of their mean are worth a note.
const WIDE: f64 = 0.2;

/// Most notes of one kind that are written out; the others are counted.
const NOTED: usize = 3;

/// Passages over all spalls, found roller by roller.
#[derive(Debug)]
pub(super) struct Passages<'a> {
    bearing: Oiled<'a>,
    time_s: &'a [f64],
    prediction: &'a Prediction,
    /// By spall: events with their notes, by their place among the spall's passages.
    seen: Vec<BTreeMap<usize, (Event, Vec<String>)>>,
}

/// A bearing with its least film thickness.
#[derive(Debug, Clone, Copy)]
struct Oiled<'a> {
    scene: &'a ResolvedScene,
    /// Thickness below which no film on the outer and on the inner raceway falls [m]; `None` without oil.
    least_film_m: Option<[f64; 2]>,
}

impl<'a> Oiled<'a> {
    fn of(scene: &'a ResolvedScene) -> Self {
        let films = scene.loaded_films().ok().flatten();
        Self { scene, least_film_m: films.map(|films| films.map(|film| film.least)) }
    }

    /// The touch of the floor by a roller that the edges cannot carry between two times [s].
    fn strike(
        &self,
        time_s: &[f64],
        orbit_rad: &[f64],
        roller: &Roller<'_>,
        (ring, force_n): (DefectRing, &[f64]),
        between_s: [f64; 2],
    ) -> Option<Strike> {
        let scene = self.scene;
        let least_m = self.least_film_m.map(|[outer, inner]| match ring {
            DefectRing::Outer => outer,
            DefectRing::Inner => inner,
        });
        let film =
            roller.film(ring).zip(least_m).map(|(thickness_m, least_m)| FloorFilm { thickness_m, least_m });
        let section = std::f64::consts::PI * scene.roller_radius * scene.roller_radius;
        let over = OverFloor {
            time_s,
            orbit_rad,
            force_n,
            film,
            mass_kg: scene.material.density * section * scene.thickness * scene.element_share(),
            path_radius_m: scene.path_radius(),
            gravity_m_s2: scene.gravity,
        };
        over.strike(between_s)
    }
}

impl<'a> Passages<'a> {
    /// Before the first roller of a record that is sampled at `time_s`.
    pub(super) fn new(scene: &'a ResolvedScene, time_s: &'a [f64], prediction: &'a Prediction) -> Self {
        Self {
            bearing: Oiled::of(scene),
            time_s,
            prediction,
            seen: vec![BTreeMap::new(); prediction.spalls.len()],
        }
    }

    /// One roller more, with its orbital angle [rad].
    pub(super) fn add(&mut self, roller: &Roller<'_>, orbit: &[f64]) {
        for (course, seen) in self.prediction.spalls.iter().zip(&mut self.seen) {
            seen.extend(passages_of(self.bearing, self.time_s, self.prediction, course, roller, orbit));
        }
    }

    /// One event for every passage of a loaded roller that begins within the record, in order of expected
    /// entry; `fullest_n` [N] is the largest static force.
    pub(super) fn events(
        mut self,
        record: &Record<'_>,
        fullest_n: f64,
        notes: &mut Vec<String>,
    ) -> Result<Vec<Event>, Error> {
        let recorded = record.roller_numbers();
        let levels = self.seen.iter().flat_map(BTreeMap::values).filter_map(|(event, _)| event.level_n);
        let least_n = LOADED * levels.fold(fullest_n, f64::max);
        let mut events = Vec::new();
        for (number, (course, seen)) in self.prediction.spalls.iter().zip(&mut self.seen).enumerate() {
            for (at, passage) in course.passages.iter().enumerate() {
                if !recorded.contains(&passage.roller) {
                    notes.push(format!("roller {} is not in the trace", passage.roller));
                    seen.insert(at, (Event::expected(passage, course.spall.ring), Vec::new()));
                }
            }
            let seen = std::mem::take(seen).into_values().collect();
            let mut of_spall = events_of(record, self.prediction, course, seen, least_n, notes)?;
            of_spall.iter_mut().for_each(|event| event.spall = number + 1);
            scatter(&mut of_spall, notes);
            events.extend(of_spall);
        }
        events.sort_by(|a, b| a.expected_entry_ms.total_cmp(&b.expected_entry_ms));
        Ok(events)
    }
}

/// When a roller's centre passes the edges of a spall, as recorded.
struct Path {
    /// Over the leading edge, the middle and the trailing edge [s].
    leading: Vec<f64>,
    middle: Vec<f64>,
    trailing: Vec<f64>,
    /// How much later than without slip it came last [s]. Cages slip a little, so that this grows over a long
    /// record.
    late_s: f64,
    /// Between two passages without slip [s]; `None` where there is only one.
    period_s: Option<f64>,
}

impl Path {
    /// Of a roller with this orbital angle [rad]. `turned_rad` is the angle of the raceway at a time [s].
    fn of(
        orbit: &[f64],
        time: &[f64],
        edges: DefectEdges,
        period_s: Option<f64>,
        turned_rad: impl Fn(f64) -> f64,
    ) -> Self {
        // In the frame of the raceway.
        let orbit: Vec<f64> = orbit.iter().zip(time).map(|(angle, &t)| angle - turned_rad(t)).collect();
        let over = |edge: f64| events::crossings(time, &orbit, edge.to_radians());
        Self {
            leading: over(edges.leading_deg),
            middle: over(edges.middle_deg),
            trailing: over(edges.trailing_deg),
            late_s: 0.0,
            period_s,
        }
    }

    /// Entry and exit [s] of the next passage, with its delay. `None` outside of the record, or when it is
    /// further away than half a period or, of a single passage, a traverse.
    fn next(&mut self, passage: &Crossing) -> [Option<f64>; 2] {
        let found = [
            self.near(&self.leading, passage.entry_s, passage),
            self.near(&self.trailing, passage.exit_s, passage),
        ];
        let late = |found: Option<f64>, expected: f64| found.map(|t| t - expected);
        self.late_s =
            late(found[0], passage.entry_s).or(late(found[1], passage.exit_s)).unwrap_or(self.late_s);
        found
    }

    /// When it was over the middle [s].
    fn middle(&self, passage: &Crossing) -> Option<f64> {
        self.near(&self.middle, passage.centre_s, passage)
    }

    /// The crossing nearest to where one is expected after the slip so far.
    fn near(&self, all: &[f64], expected_s: f64, passage: &Crossing) -> Option<f64> {
        let traverse = passage.exit_s - passage.entry_s;
        let reach = self.period_s.map_or(traverse, |period| 0.5 * period);
        let gap = |t: &f64| (t - expected_s - self.late_s).abs();
        let nearest = all.iter().copied().min_by(|a, b| gap(a).total_cmp(&gap(b)));
        nearest.filter(|t| gap(t) < reach)
    }
}

/// Events of one roller over one spall that begin within the record, with notes, by their number among the
/// spall's passages.
fn passages_of(
    bearing: Oiled<'_>,
    time_s: &[f64],
    prediction: &Prediction,
    course: &SpallCourse,
    roller: &Roller<'_>,
    orbit: &[f64],
) -> Vec<(usize, (Event, Vec<String>))> {
    let passages: Vec<(usize, &Crossing)> =
        course.passages.iter().enumerate().filter(|(_, passage)| passage.roller == roller.number).collect();
    let [(_, first), ..] = &passages[..] else { return Vec::new() };
    let [begin, last] = [time_s.first(), time_s.last()].map(|t| t.copied().unwrap_or(f64::NEG_INFINITY));
    let (scene, ring) = (bearing.scene, course.spall.ring);
    let edge = Edge::of(scene, ring);
    let duty = &scene.duty;
    let turned_rad = |t: f64| match ring {
        _ if !course.turns => 0.0,
        DefectRing::Inner => duty.shaft_rad(t),
        DefectRing::Outer => duty.outer_rad(t),
    };
    let period_s = passages.get(1).map(|(_, later)| later.entry_s - first.entry_s);
    let mut path = Path::of(orbit, time_s, course.edges, period_s, turned_rad);
    let mut events = Vec::new();
    for (at, passage) in passages {
        let mut event = Event::expected(passage, ring);
        let traverse = passage.exit_s - passage.entry_s;
        let found = path.next(passage);
        [event.path_entry_ms, event.path_exit_ms] = found.map(|t| t.map(|t| 1e3 * t));
        // The recorded path predicts the time better than rolling without slip.
        let late = path.late_s;
        let beyond = found == [None; 2] && (late != 0.0 || passage.exit_s < begin);
        if beyond || passage.entry_s + late >= last {
            continue;
        }
        let late = if late.abs() > UNMOVED * traverse { late } else { 0.0 };
        // A long record is looked at about the passage alone.
        let [from, until] = [passage.entry_s - ABOUT * traverse, passage.exit_s + ABOUT * traverse];
        let near = events::span(time_s, from + late, until + late);
        let (time, orbit, roller) = (&time_s[near.clone()], &orbit[near.clone()], roller.within(near));
        // A shaft whose speed changes has another one at each passage.
        let speed_m_s = if scene.written.operation.speed_varies() {
            1e-3 * course.spall.length_mm / traverse
        } else {
            prediction.kinematics.contact_speed_m_s
        };
        let race_radius = match ring {
            DefectRing::Outer => scene.outer_race_radius,
            DefectRing::Inner => scene.inner_race_radius,
        };
        let reach_rad = edge.floor_m(1e-3 * course.spall.depth_mm) / race_radius;
        let seen = Passage {
            entry_s: passage.entry_s + late,
            exit_s: passage.exit_s + late,
            middle_s: path.middle(passage).unwrap_or(passage.centre_s + late),
            smoothing_s: prediction.smoothing_s(traverse),
        };
        let normal = roller.normal(ring);
        let picked = events::pick(time, &normal, &seen);
        event.entry_ms = picked.entry_s.map(|t| 1e3 * t);
        event.exit_ms = picked.exit_s.map(|t| 1e3 * t);
        event.level_n = picked.level_n;
        // Where the roller is counts: one that strikes an edge is slower than one that rolls.
        let edges = course.edges;
        let half_rad = 0.5 * (edges.leading_deg - edges.trailing_deg).abs().to_radians() - reach_rad;
        let over_floor = |n: &usize| {
            let off = orbit[*n] - turned_rad(time[*n]) - edges.middle_deg.to_radians();
            (off - TAU * (off / TAU).round()).abs() < half_rad
        };
        let inside: Vec<usize> = events::span(time, seen.entry_s, seen.exit_s).filter(over_floor).collect();
        let between = inside.first().zip(inside.last()).map(|(first, last)| [time[*first], time[*last]]);
        let floor =
            between.and_then(|between| bearing.strike(time, orbit, &roller, (ring, &normal), between));
        event.floor_ms = floor.map(|strike| 1e3 * strike.at_s);
        event.floor_n = floor.map(|strike| strike.force_n);
        event.floor_by = floor.map(|strike| strike.by);
        let run_s = picked.exit_s.zip(picked.entry_s).map(|(exit, entry)| exit - entry);
        event.free_ms = run_s.map(|run_s| 1e3 * run_s);
        let length = |(run_s, load_n)| 1e3 * edge.length_m(speed_m_s * run_s, load_n);
        event.spall_mm = run_s.zip(picked.level_n).map(length);
        events.push((at, (event, picked.notes)));
    }
    events
}

/// Events of one spall, from those `seen` over it in the order of its passages, of rollers with a load of at
/// least `least_n`.
fn events_of(
    record: &Record<'_>,
    prediction: &Prediction,
    course: &SpallCourse,
    mut events: Vec<(Event, Vec<String>)>,
    least_n: f64,
    notes: &mut Vec<String>,
) -> Result<Vec<Event>, Error> {
    let all = events.len();
    events.retain(|(event, _)| event.level_n.is_none_or(|level| level > least_n));
    if events.len() < all {
        notes.push(format!(
            "{} of {all} passages over the spall of the {} raceway lie outside the load zone and are no \
             events",
            all - events.len(),
            course.spall.ring.name()
        ));
    }
    let mut of_spall = Vec::new();
    let mut kinds: BTreeMap<String, usize> = BTreeMap::new();
    for (event, picked) in events {
        for note in picked {
            // Notes of passages differ in their numbers only.
            let kind: String = note.chars().filter(|c| !c.is_ascii_digit()).collect();
            let said = kinds.entry(kind).or_default();
            *said += 1;
            if *said <= NOTED {
                notes.push(format!("roller {}: {note}", event.roller));
            }
        }
        of_spall.push(event);
    }
    let more: usize = kinds.values().map(|said| said.saturating_sub(NOTED)).sum();
    if more > 0 {
        notes.push(format!("{more} more such notes on passages of rollers over the spall are left out"));
    }
    // Where the spall turns a neighbour's load changes by its way through the load zone.
    if !course.turns {
        compensate(record, prediction, &mut of_spall)?;
    }
    Ok(of_spall)
}

/// How far lengths of one spall scatter from passage to passage: where few elements carry the load, the rings
/// shift as one of them comes free, and its events are not where its contact passes the edges.
fn scatter(events: &mut [Event], notes: &mut Vec<String>) {
    let lengths: Vec<f64> = events.iter().filter_map(|event| event.spall_mm).collect();
    let Some(all) = Statistic::of(&lengths, events.len()) else { return };
    let Some(off_mm) = all.of_a_further_one() else { return };
    events
        .iter_mut()
        .filter(|event| event.spall_mm.is_some())
        .for_each(|e| e.spall_scatter_mm = Some(off_mm));
    if off_mm > WIDE * all.mean {
        notes.push(format!(
            "lengths of spall {} by the events of its passages scatter by ±{off_mm:.1} mm about {:.1} mm (95 %): \
             the force of an element does not show its edges",
            events[0].spall, all.mean
        ));
    }
}

/// Event #3: the largest force that a roller carries while a neighbour is in the defect.
fn compensate(record: &Record<'_>, prediction: &Prediction, events: &mut [Event]) -> Result<(), Error> {
    let time = record.time_s();
    let count = record.pockets();
    let spans: Vec<(usize, f64, f64)> = events
        .iter()
        .map(|e| (e.roller, e.extent_s()))
        .map(|(roller, [from, until])| (roller, from, until))
        .collect();
    // In a long record a neighbour passes again; the relevant passage is a roller spacing before or after.
    let spacing_s = 1.0 / prediction.kinematics.bpfo_hz;
    for event in events.iter_mut() {
        let [own_from, own_until] = event.extent_s();
        let neighbours = spans.iter().filter(|s| {
            let apart = event.roller.abs_diff(s.0);
            apart.min(count.saturating_sub(apart)) == 1 && (s.1 - own_from).abs() < 2.0 * spacing_s
        });
        let mut most: Option<(f64, f64, f64)> = None;
        for &(_, from, to) in neighbours {
            let smoothing = prediction.smoothing_s(to - from);
            let seen = events::span(time, from - 0.5 * (to - from), to);
            let part = record.with_rollers(&[event.roller], seen.clone())?;
            let Some(roller) = part.roller(event.roller) else { continue };
            let time = &time[seen];
            let force = events::running_median(time, &roller.outer_normal(), smoothing);
            let during = events::span(time, from, to);
            // A roller over the defect, or just behind it, shows its own re-loading instead.
            let free = |n: &usize| time[*n] < own_from - smoothing || time[*n] > own_until + 4.0 * smoothing;
            let Some(at) = during.clone().filter(free).max_by(|&a, &b| force[a].total_cmp(&force[b])) else {
                continue;
            };
            let before = stribeck_dsp::median(&mut force[..during.start].to_vec());
            let gain = force[at] / before;
            if before > 0.0 && force[at] > before && most.is_none_or(|(_, most, _)| gain >= most) {
                most = Some((time[at], gain, force[at]));
            }
        }
        if let Some((at, gain, force_n)) = most {
            event.compensation_ms = Some(1e3 * at);
            event.compensation_n = Some(force_n);
            event.compensation_gain = Some(gain);
        }
    }
    Ok(())
}

/// Forces over the whole record of the rollers that cross a spall first, in the first `most` passages.
pub(super) fn crossing_forces(
    record: &Record<'_>,
    prediction: &Prediction,
    events: &[Event],
    filter: Option<&Filter>,
    most: usize,
) -> Result<Vec<CrossingForce>, Error> {
    let mut forces = Vec::new();
    for event in events.iter().take(most) {
        let part = record.with_rollers(&[event.roller], 0..record.len())?;
        let Some(roller) = part.roller(event.roller) else { continue };
        // The paper's figure has the vertical force; only over a spall that stands still does it show the
        // passage.
        let standing = prediction.spalls.get(event.spall - 1).is_some_and(|course| !course.turns);
        let vertical = event.ring == DefectRing::Outer && standing;
        let raw_n: Vec<f64> =
            if vertical { roller.outer_fy.iter().map(|f| -f).collect() } else { roller.normal(event.ring) };
        let filtered_n = filter.map(|f| f.force(&raw_n)).transpose()?.unwrap_or_default();
        forces.push(CrossingForce { spall: event.spall, roller: event.roller, vertical, raw_n, filtered_n });
    }
    Ok(forces)
}

impl Event {
    /// An event with its expected times only.
    fn expected(passage: &Crossing, ring: DefectRing) -> Self {
        Self {
            roller: passage.roller,
            spall: 1,
            ring,
            entry_ms: None,
            exit_ms: None,
            free_ms: None,
            expected_entry_ms: 1e3 * passage.entry_s,
            expected_exit_ms: 1e3 * passage.exit_s,
            path_entry_ms: None,
            path_exit_ms: None,
            level_n: None,
            impulse_g: None,
            floor_ms: None,
            floor_n: None,
            floor_by: None,
            compensation_ms: None,
            compensation_n: None,
            compensation_gain: None,
            spall_mm: None,
            spall_scatter_mm: None,
        }
    }

    /// The passage as the levels see it.
    pub fn visit(&self) -> Visit {
        let ([from_s, until_s], [entry, exit]) = (self.extent_s(), self.on_path_ms());
        Visit {
            from_s,
            entry_s: 1e-3 * self.entry_ms.unwrap_or(entry),
            exit_s: 1e-3 * self.exit_ms.unwrap_or(exit),
            until_s,
        }
    }

    /// Earliest and latest time [s] that belongs to the passage, measured or expected.
    fn extent_s(&self) -> [f64; 2] {
        let [entry, exit] = self.on_path_ms();
        let from = self.entry_ms.map_or(entry, |t| t.min(entry));
        [1e-3 * from, 1e-3 * self.exit_ms.map_or(exit, |t| t.max(exit))]
    }

    /// When its roller should unload and be loaded again [ms]: without slip, or moved to its path where that
    /// is elsewhere.
    fn on_path_ms(&self) -> [f64; 2] {
        let [entry, exit] = [self.expected_entry_ms, self.expected_exit_ms];
        let late = |path: Option<f64>, expected: f64| path.map(|t| t - expected);
        let late = late(self.path_entry_ms, entry).or(late(self.path_exit_ms, exit)).unwrap_or(0.0);
        let late = if late.abs() > UNMOVED * (exit - entry) { late } else { 0.0 };
        [entry + late, exit + late]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thirty-seven orbits of a roller whose cage turns 0.4 % slower than without slip, and so is ten
    /// traverses late in the end, or 0.4 % faster.
    #[test]
    fn planted_a_slipping_roller_is_followed_through_a_long_record() {
        for slip in [0.004, -0.004] {
            follow(slip);
        }
    }

    fn follow(slip: f64) {
        let (interval, expected_hz) = (1e-4, 3.754);
        let turn = std::f64::consts::TAU;
        let time: Vec<f64> = (0..100_000).map(|n| n as f64 * interval).collect();
        let angle = |t: f64| 1.7 - turn * expected_hz * (1.0 - slip) * t;
        let orbit: Vec<f64> = time.iter().map(|&t| angle(t)).collect();
        let edges = DefectEdges { leading_deg: 92.9, middle_deg: 90.0, trailing_deg: 87.1 };
        let over =
            |edge: f64, hz: f64, orbit: usize| (1.7 - edge.to_radians() + turn * orbit as f64) / (turn * hz);
        let mut path = Path::of(&orbit, &time, edges, Some(1.0 / expected_hz), |_| 0.0);
        for orbit in 0..37 {
            let at = |edge| over(edge, expected_hz, orbit);
            let passage = Crossing {
                roller: 1,
                entry_s: at(edges.leading_deg),
                centre_s: at(edges.middle_deg),
                exit_s: at(edges.trailing_deg),
            };
            let real = |edge| over(edge, expected_hz * (1.0 - slip), orbit);
            let [entry, exit] = path.next(&passage).map(|t| t.expect("on record"));
            assert!((entry - real(edges.leading_deg)).abs() < 1e-6, "orbit {orbit}: {entry}");
            assert!((exit - real(edges.trailing_deg)).abs() < 1e-6, "orbit {orbit}: {exit}");
            let middle = path.middle(&passage).expect("on record");
            assert!((middle - real(edges.middle_deg)).abs() < 1e-6, "orbit {orbit}: {middle}");
        }
    }
}
