//! Whole bearings, coarse and short, at and beyond the limits of scenes; and through the defect, on a mesh
//! that resolves it.

use anyhow::Result;
use stribeck_analysis::summary::Event;
use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Run;
use stribeck_store::run_info::{RunInfo, Status};

use super::{Case, Verdict};
use crate::plan::Group;
use crate::{Finished, Plan, Runner, Variant};

/// Relative error of the rollers' load of a coarse bearing above which a case without warning is wrong …
const COARSE_SUPPORT: f64 = 0.3;
/// … and of one on a finer mesh, …
const SUPPORT: f64 = 0.02;
/// … unless the error accelerates outer ring and adapter to less than this speed [m/s].
const RATTLING: f64 = 0.1;
/// A roller crosses the defect in the time that rolling without slip takes, within this share, …
const CROSSING: f64 = 0.05;
/// … and unloads and is loaded again within this share of that time of passing the edges, when it carries
/// load.
const EVENTS: f64 = 0.15;
/// The reduced model of a case, which is another way to the same answer.
const REDUCED: &str = "model=reduced(step_us: 1.0)";

/// Runs the scenes of a group and judges the outcomes; a refused scene has its reason.
pub(super) fn cases(runner: &Runner<'_>, plan: &Plan, group: &Group) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for variant in plan.variants(group).into_iter().filter(|variant| runner.flags.wants(&variant.name)) {
        let done = variant.name.clone();
        if let Err(error) = Scene::read_with(runner.host.root().join(&variant.scene), &variant.set) {
            let seen = error.problems().first().map_or(String::new(), |p| {
                format!("{} (allowed: {})", p.message, p.allowed).replace(" (allowed: )", "")
            });
            cases.push(Case { done, energy: None, verdict: Verdict::Refused, seen });
            continue;
        }
        for run in &runner.run(&[variant])? {
            let case = match ended(&done, run) {
                Err(case) => case,
                Ok(info) if group.table == "Whole bearings" => coarse(&done, run, info),
                Ok(info) => {
                    let other = beside(runner, run)?;
                    crossed(&done, run, info, other)
                }
            };
            cases.push(case);
        }
    }
    Ok(cases)
}

/// How roller 1 crosses by the reduced model; none where it does not have the scene.
fn beside(runner: &Runner<'_>, run: &Finished) -> Result<Option<Passage>> {
    let variant =
        Variant { name: format!("{}-reduced", run.variant.name), ..run.variant.clone() }.with(REDUCED);
    if Scene::read_with(runner.host.root().join(&variant.scene), &variant.set).is_err() {
        return Ok(None);
    }
    Ok(runner.run(&[variant])?.first().and_then(passage))
}

/// The account of a run that came to its end; the case of one that did not, refused by the preload or stopped
/// by a guard.
fn ended<'a>(done: &str, run: &'a Finished) -> Result<&'a RunInfo, Case> {
    let Some(info) = &run.info else {
        let why = run.summary.as_ref().err().cloned().unwrap_or_default();
        // Case and finding; the advice after them is the same each time.
        let seen = why.split("; check that").next().unwrap_or(&why).to_owned();
        return Err(Case { done: done.to_owned(), energy: None, verdict: Verdict::Refused, seen });
    };
    if info.status != Status::Diverged {
        return Ok(info);
    }
    let (energy, seen) = (Some(info.energy.max_relative_error), info.stop_reason.clone().unwrap_or_default());
    Err(Case { done: done.to_owned(), energy, verdict: Verdict::Stopped, seen })
}

/// Mean load on the rollers over the expected one [-], and the speed [m/s] of outer ring and adapter by the
/// difference.
fn carried(run: &Finished, info: &RunInfo) -> [f64; 2] {
    let carried = Run::read(&run.folder).ok().map(|r| support(&r));
    let share = carried.map_or(f64::NAN, |n| n / info.expected_support_n);
    // A force that is not carried, or too much of it, moves outer ring and adapter; a little of that is
    // rattling.
    let mass = (info.expected_support_n - run.written.operation.load_n) / run.written.operation.gravity_m_s2;
    let time = info.steps as f64 * info.time_step_s;
    [share, (share - 1.0).abs() * info.expected_support_n * time / mass]
}

fn coarse(done: &str, run: &Finished, info: &RunInfo) -> Case {
    let [share, gained] = carried(run, info);
    let right = (share - 1.0).abs() < COARSE_SUPPORT || gained < RATTLING;
    let seen = format!("carried {share:.3}, {} steps of {:.3} ns", info.steps, 1e9 * info.time_step_s);
    concluded(done, info, right, seen)
}

/// How roller 1 crossed the defect.
fn passage(run: &Finished) -> Option<Passage> {
    run.numbers()?.events.iter().find(|event| event.roller == 1).map(Passage::of)
}

fn crossed(done: &str, run: &Finished, info: &RunInfo, reduced: Option<Passage>) -> Case {
    let [share, gained] = carried(run, info);
    let supported = (share - 1.0).abs() < SUPPORT || gained < RATTLING;
    let room = run.written.cage.as_ref().map_or(0.0, |cage| 1e-3 * cage.pocket_clearance_um)
        / run.written.defect.as_ref().map_or(f64::INFINITY, |defect| defect.length_mm);
    let passed = passage(run);
    let rolls = passed.is_none_or(|p| p.is_right(room));
    let right =
        supported && (rolls || passed.zip(reduced).is_some_and(|(p, other)| p.is_that_of(other, room)));
    let mut words = passed.map_or("no roller crosses the defect".to_owned(), Passage::words);
    if let (false, Some(other)) = (rolls, reduced) {
        words += &format!("; by the reduced model it {}", other.course());
    }
    let sunk_um = 1e3 * run.written.mesh.size_mm * info.guards.penetration_share;
    let seen = format!("carried {share:.3}; {words}; contact sinks in by {sunk_um:.1} µm");
    concluded(done, info, right, seen)
}

/// The case of a run that came to its end.
fn concluded(done: &str, info: &RunInfo, right: bool, mut seen: String) -> Case {
    let verdict = match (info.warnings.is_empty(), right) {
        (false, _) => Verdict::Warned,
        (true, true) => Verdict::Right,
        (true, false) => Verdict::Undetected,
    };
    for warning in &info.warnings {
        seen += &format!("; {warning}");
    }
    Case { done: done.to_owned(), energy: Some(info.energy.max_relative_error), verdict, seen }
}

/// Mean vertical force of the rollers on the outer ring [N].
fn support(run: &Run) -> f64 {
    let mut sum = 0.0;
    for i in 1..=run.scene.written.bearing.rollers {
        let force = run.trace.channel(&format!("roller.{i}.outer_fy_n")).ok().flatten();
        sum -= force.map_or(f64::NAN, |f| f.iter().sum());
    }
    sum / run.trace.len() as f64
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
