//! Whole bearings through the defect, on a mesh that resolves it.

use anyhow::Result;
use stribeck_analysis::summary::Event;
use stribeck_scene::scene::Scene;

use super::scenes::{Row, carried, concluded, ended, run_rows};
use super::{Case, Chapter};
use crate::{Finished, Flags, Host, Runner, Variant};

/// The default bearing on a mesh that resolves the defect.
const LEAN: &str = "fixtures/scenes/lean.ron";

/// Until a millisecond behind the exit of the first roller at 500 rpm, with contact ten times as stiff as by
/// default: that one is softer than the bearing, so that every case would have this warning.
const BASE: &[&str] = &["solver.duration_ms=6.5", "contact.penalty_scale=0.5"];

/// Right is a mean support within this of load and weight …
const SUPPORT: f64 = 0.02;

/// … or off by so little that outer ring and adapter move at less than this speed [m/s], …
const RATTLING: f64 = 0.1;

/// … and a roller that crosses the defect in the time that rolling without slip takes, within this share, …
const CROSSING: f64 = 0.05;

/// … and that unloads and is loaded again within this share of that time of passing the edges, when it
/// carries load.
const EVENTS: f64 = 0.15;

#[rustfmt::skip]
const ROWS: &[Row] = &[
    ("through-base", "nothing else changed", &[]),
    ("through-default", "the lean scene as it is, penalty × 0.1", &["contact.penalty_scale=0.05"]),
    ("through-dt-0999", "time step 0.999 of the limit", &["solver.time_step_factor=0.999"]),
    ("through-dt-101", "time step 1.01 of the limit", &["solver.time_step_factor=1.01"]),
    ("through-penalty-1e-2", "penalty × 0.01", &["contact.penalty_scale=0.005"]),
    ("through-penalty-1e1", "penalty × 10", &["contact.penalty_scale=5.0"]),
    ("through-load-20", "20 N, less than the weight", &["operation.load_n=20.0"]),
    ("through-load-500", "500 N", &["operation.load_n=500.0"]),
    ("through-load-5e3", "5 kN", &["operation.load_n=5000.0"]),
    ("through-load-5e5", "500 kN, beyond yield", &["operation.load_n=5e5"]),
    ("through-depth-002", "defect 0.02 mm deep", &["defect.depth_mm=0.02"]),
    ("through-depth-1", "defect 1 mm deep", &["defect.depth_mm=1.0"]),
    ("through-depth-3", "defect 3 mm deep", &["defect.depth_mm=3.0"]),
    ("through-length-1", "defect 1 mm long", &["defect.length_mm=1.0"]),
    ("through-length-30", "defect 30 mm long, more than a pitch", &["defect.length_mm=30.0", "solver.duration_ms=12.0"]),
    ("through-bottom", "defect at the bottom, no load", &["defect.angle_deg=266.0", "bearing.first_roller_deg=270.0"]),
    ("through-rpm-100", "100 rpm", &["operation.speed_rpm=100.0", "solver.duration_ms=30.0"]),
    ("through-rpm-2000", "2000 rpm", &["operation.speed_rpm=2000.0", "solver.duration_ms=2.0"]),
    ("through-rpm-1e4", "10 000 rpm", &["operation.speed_rpm=1e4", "solver.duration_ms=0.6", "output.interval_us=1.0"]),
    ("through-pocket-0", "pockets without room", &["cage.pocket_clearance_um=0.0"]),
    ("through-pocket-1000", "pockets with 1 mm of room", &["cage.pocket_clearance_um=1000.0"]),
    ("through-no-cage", "no cage", &["cage=None"]),
    ("through-seat-0", "no friction in the seat", &["contact.seat_friction=0.0"]),
    ("through-friction-0", "no friction on rollers", &["contact.friction=0.0"]),
    ("through-friction-03", "µ = 0.3", &["contact.friction=0.3"]),
    ("through-undamped", "dry, no damping at all", &["film=None", "solver.structural_damping=None", "contact.damping_ratio=0.0"]),
    ("through-dry", "dry", &["film=None"]),
    ("through-film-thin", "oil of 0.005 Pa s", &["film.viscosity_pa_s=0.005"]),
    ("through-film-thick", "oil of 1 Pa s", &["film.viscosity_pa_s=1.0"]),
    ("through-mass-damping", "mass damping 5000/s across the track", &["solver.mass_damping_per_s=5000.0"]),
    ("through-corners", "pocket corners above the rollers' centres", &["cage.pocket=corners"]),
    ("through-collocated", "node-to-segment contact", &["contact.method=collocated"]),
    ("through-one-pass", "one pass", &["contact.passes=one"]),
    ("through-arc", "arcs", &["contact.surface=arc"]),
    ("through-nagata", "Nagata patches", &["contact.surface=nagata"]),
    ("through-spline", "splines", &["contact.interpolation=spline"]),
    ("through-smooth", "arcs, splines and a soft onset", &["contact.surface=arc", "contact.interpolation=spline", "contact.points_per_facet=8", "contact.onset_um=8.0"]),
    ("through-clearance-200", "clearance 0.2 mm", &["bearing.inner_race_diameter_mm=163.8"]),
    ("through-clearance-0", "no clearance", &["bearing.inner_race_diameter_mm=164.0"]),
    ("through-thin", "thickness 1 mm", &["bearing.thickness_mm=1.0"]),
    ("through-thick", "thickness 1 m", &["bearing.thickness_mm=1000.0"]),
];

/// The reduced model of a case, which is another way to the same answer.
const REDUCED: &str = "model=reduced(step_us: 1.0)";

pub(super) fn chapter(runner: &Runner<'_>, flags: &Flags, host: &dyn Host) -> Result<Chapter> {
    let beside = |done: &str, run: &Finished| {
        let mut variant = Variant { name: format!("{}-reduced", run.variant.name), ..run.variant.clone() };
        variant.set.push(REDUCED.to_owned());
        if Scene::read_with(host.root().join(variant.scene), &variant.set).is_err() {
            return Ok(judge(done, run, None));
        }
        let reduced = runner.run(&[variant])?;
        Ok(judge(done, run, reduced.first().and_then(passage)))
    };
    Ok(Chapter {
        title: "Through the defect",
        words: "The lean scene (0.5 mm elements where bodies roll on each other) with contact ten times as \
            stiff as by default, until the \
                first roller has left the defect and has rung for a millisecond, with one thing changed. \
                *Right* is: the rollers carry load \
                and weight within 2 % on average (or outer ring and adapter are moved at less than 0.1 m/s \
                by what they lack), and roller 1 \
                crosses the defect as it should. It does when it takes the time of rolling without slip \
                within 5 % and the room in its \
                pocket, and when, where it carries load, its force vanishes and comes back within 15 % of \
                that time of its centre's passing \
                the edges. Friction drives rollers and a cage holds them: where one of them is missing a \
                roller does slip, and from a short \
                defect it carries on. There it should cross as it does by the reduced model (`model: \
                reduced(step_us: 1.0)`, THEORY §9), \
                within the same limits. A case that is not right and has no warning is *undetected*.",
        cases: run_rows(runner, flags, host, (LEAN, BASE), ROWS, &beside)?,
        figures: Vec::new(),
    })
}

/// How roller 1 crossed the defect.
fn passage(run: &Finished) -> Option<Passage> {
    run.numbers()?.events.iter().find(|event| event.roller == 1).map(Passage::of)
}

fn judge(done: &str, run: &Finished, reduced: Option<Passage>) -> Case {
    let info = match ended(done, run) {
        Ok(info) => info,
        Err(case) => return case,
    };
    let [share, gained] = carried(run, info);
    let supported = (share - 1.0).abs() < SUPPORT || gained < RATTLING;
    let room = run.scene.written.cage.as_ref().map_or(0.0, |cage| 1e-3 * cage.pocket_clearance_um)
        / run.scene.written.defect.as_ref().map_or(f64::INFINITY, |defect| defect.length_mm);
    let passed = passage(run);
    let rolls = passed.is_none_or(|p| p.is_right(room));
    let right =
        supported && (rolls || passed.zip(reduced).is_some_and(|(p, other)| p.is_that_of(other, room)));
    let mut words = passed.map_or("no roller crosses the defect".to_owned(), Passage::words);
    if let (false, Some(other)) = (rolls, reduced) {
        words += &format!("; by the reduced model it {}", other.course());
    }
    let size_um = 1e3 * run.scene.written.mesh.size_mm;
    let seen = format!(
        "carried {share:.3}; {words}; contact sinks in by {:.1} µm",
        size_um * info.guards.penetration_share
    );
    concluded(done, info, right, seen)
}

/// How roller 1 crossed the defect, in shares of the time that it takes without slip.
#[derive(Debug, Clone, Copy)]
struct Passage {
    /// Time between the edges, by the recorded path; `None` when it did not reach both.
    crossing: Option<f64>,
    /// Unloading and loading after the passing of either edge; `None` where the force does not show it.
    events: [Option<f64>; 2],
    /// It carried load before.
    loaded: bool,
}

impl Passage {
    fn of(event: &Event) -> Self {
        let whole = event.expected_exit_ms - event.expected_entry_ms;
        let path = event.path_entry_ms.zip(event.path_exit_ms);
        let after = |time: Option<f64>, edge: Option<f64>| Some((time? - edge?) / whole);
        Self {
            crossing: path.map(|(entry, exit)| (exit - entry) / whole),
            events: [after(event.entry_ms, event.path_entry_ms), after(event.exit_ms, event.path_exit_ms)],
            loaded: event.level_n.is_some(),
        }
    }

    /// Whether it rolled without slip, within the share `room` of the way that its pocket's clearance allows.
    fn is_right(self, room: f64) -> bool {
        let crossed = self.crossing.is_some_and(|share| (share - 1.0).abs() < CROSSING + room);
        let shown = self.events.iter().all(|share| share.is_some_and(|share| share.abs() < EVENTS));
        crossed && (shown || !self.loaded)
    }

    /// Whether another model's roller crossed likewise.
    fn is_that_of(self, other: Self, room: f64) -> bool {
        let alike = |pair: (Option<f64>, Option<f64>), limit: f64| match pair {
            (Some(a), Some(b)) => (a - b).abs() < limit,
            (a, b) => a.is_none() && b.is_none(),
        };
        let [entries, exits] = [0, 1].map(|n| alike((self.events[n], other.events[n]), EVENTS));
        alike((self.crossing, other.crossing), CROSSING + room) && entries && exits
    }

    fn words(self) -> String {
        format!("roller 1 {}", self.course())
    }

    fn course(self) -> String {
        let share = |share: Option<f64>| {
            share.map_or("never".to_owned(), |s| format!("{:+.1} %", 100.0 * s).replace('-', "−"))
        };
        let crossing = self.crossing.map_or("does not reach both edges".to_owned(), |s| {
            format!("crosses in {s:.3} of the time without slip")
        });
        let [entry, exit] = self.events.map(share);
        let load = if self.loaded { "" } else { ", carries nothing" };
        format!("{crossing}{load}; unloads {entry}, loads {exit} of that after the edges")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_roller_that_slips_or_floats_is_not_right() {
        let rolling = Passage { crossing: Some(1.01), events: [Some(0.02), Some(-0.05)], loaded: true };
        let slips = Passage { crossing: Some(1.2), ..rolling };
        assert!(rolling.is_right(0.0) && !slips.is_right(0.0) && slips.is_right(0.2));
        assert!(!Passage { events: [Some(0.02), None], ..rolling }.is_right(0.0));
        assert!(Passage { events: [None; 2], loaded: false, ..rolling }.is_right(0.0));
        assert!(!Passage { crossing: None, ..rolling }.is_right(0.0));
        assert!(rolling.words().contains("loads −5.0 %"), "{}", rolling.words());
        // By another model it slips as much, or does not.
        assert!(slips.is_that_of(Passage { crossing: Some(1.17), ..slips }, 0.0));
        assert!(!slips.is_that_of(rolling, 0.0));
        assert!(!slips.is_that_of(Passage { events: [None, slips.events[1]], ..slips }, 0.0));
    }
}
