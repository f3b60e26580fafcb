//! `cargo xtask study spall_size`: does the force at the exit of a spall grow with its depth and its width?
//!
//! The question is that of Li, Yan and others (J. Vibroengineering 2022, doi 10.21595/jve.2022.22773): an
//! explicit model in the plane of shaft, bearing and pedestal, and an indicator, the contact force with a
//! defect over that without.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use stribeck_analysis::record::Record;
use stribeck_analysis::summary::Summary;
use stribeck_scene::scene::Scene;
use stribeck_store::campaign::Campaign;
use stribeck_store::run_dir::Run;

use crate::page::decimals;
use crate::sample::Sample;
use crate::{Plan, Rows, Runner, figure};

/// The spalls.
const CAMPAIGN: &str = "fixtures/campaigns/spall_size.ron";
/// The blow is looked for so far behind the trailing edge, and the force before the spall as far before the
/// leading one, but not nearer to it than the second, where a ball gives way to the edge [mm].
const REACH_MM: [f64; 2] = [1.5, 0.3];
/// Passages count from here on, when the bearing has settled [s].
const FROM_S: f64 = 0.03;
/// The indicators and their standard errors.
const OVER: [[&str; 2]; 2] =
    [["over the bearing without", "its standard error"], ["over before", "its standard error, over before"]];

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<()> {
    let host = runner.host;
    let campaign = Campaign::read(&host.root().join(CAMPAIGN))?;
    let out = runner.folder.join("campaign");
    if !runner.flags.runs_nothing() {
        let mut command = host.stribeck()?;
        command.arg("campaign").arg(host.root().join(CAMPAIGN)).arg("--out").arg(&out);
        let done = command.args(runner.flags.of_a_command()).status();
        let done = done.context("`stribeck campaign` does not start")?;
        ensure!(done.success(), "`stribeck campaign {CAMPAIGN}` did not come to its end: see above");
    }
    // The same bearing without a spall.
    let plan = Plan::read(runner.study)?;
    let healthy =
        plan.run(runner, &[], rows)?.into_iter().flatten().map(|run| run.folder).collect::<Vec<_>>();
    ensure!(!healthy.is_empty(), "the bearing without a spall has not been run");
    let mut sizes: Vec<(f64, f64, Vec<PathBuf>, &Scene)> = Vec::new();
    for scene in campaign.runs.iter().filter_map(|run| run.scene.as_ref().ok()) {
        let spall = scene.defect.as_ref().context("a spall")?;
        let folder = out.join("runs").join(scene.hash());
        match sizes.iter_mut().find(|size| size.0 == spall.length_mm && size.1 == spall.depth_mm) {
            Some(size) => size.2.push(folder),
            None => sizes.push((spall.length_mm, spall.depth_mm, vec![folder], scene)),
        }
    }
    for (length_mm, depth_mm, folders, scene) in sizes {
        let degrees = scene.defect.as_ref().context("a spall")?.angle_deg;
        let behind = |forces: &[[f64; 2]]| forces.iter().map(|pair| pair[1]).collect::<Vec<f64>>();
        let without = Sample::of(&behind(&forces_of(&healthy, degrees, length_mm)?)).mean;
        let name = format!("{length_mm} mm");
        if rows.get("healthy", &name, "force N").is_none() {
            rows.value("healthy", &name, "force N", without);
        }
        let forces = forces_of(&folders, degrees, length_mm)?;
        let over_without: Vec<f64> = behind(&forces).iter().map(|force| force / without).collect();
        let over_before: Vec<f64> = forces.iter().map(|[before, behind]| behind / before).collect();
        let samples = [over_without, over_before].map(|ratios| Sample::of(&ratios));
        let name = format!("{length_mm} × {depth_mm} mm");
        for ([mean, error], sample) in OVER.iter().zip(&samples) {
            rows.values("sizes", &name, [(mean, sample.mean), (error, sample.error())]);
        }
        let [free, floor] = shares(&folders)?;
        let values = [
            ("standard deviation, over before", samples[1].scatter),
            ("share free", free),
            ("share that touches the floor", floor),
            ("width mm", length_mm),
            ("depth mm", depth_mm),
            ("sagitta mm", sagitta_mm(scene, length_mm)),
            ("passages", forces.len() as f64),
        ];
        rows.values("sizes", &name, values.map(|(what, v)| (what, Some(v).filter(|v| v.is_finite()))));
    }
    plan.figures.iter().try_for_each(|drawing| figure::draw(runner.study, &drawing.of(rows)))
}

/// Forces of all passages of several runs over a place as wide as this.
fn forces_of(folders: &[PathBuf], degrees: f64, length_mm: f64) -> Result<Vec<[f64; 2]>> {
    let mut all = Vec::new();
    for folder in folders {
        let run = Run::read(folder)?;
        let record = Record::whole(&run)?;
        for roller in record.rollers() {
            let orbit = roller.orbit();
            let ahead = if orbit.last() < orbit.first() { -1e3 } else { 1e3 } * run.scene.outer_race_radius;
            let around = |angle: f64| angle - TAU * (angle / TAU).round();
            let past_mm: Vec<f64> =
                orbit.iter().map(|at| ahead * around(at - degrees.to_radians())).collect();
            let from = record.time_s().iter().position(|t| *t >= FROM_S).unwrap_or(past_mm.len());
            let force = roller.outer_normal();
            all.extend(forces(&past_mm[from..], &force[from..], 0.5 * length_mm));
        }
    }
    Ok(all)
}

/// Shares of the passages over a spall in which the ball comes free, and in which it touches the floor.
fn shares(folders: &[PathBuf]) -> Result<[f64; 2]> {
    let (mut events, mut free, mut floor) = (0.0, 0.0, 0.0);
    for folder in folders {
        let path: &Path = &folder.join("summary.json");
        let text =
            std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        let summary: Summary = serde_json::from_str(&text).context("summary.json")?;
        events += summary.events.len() as f64;
        free += summary.events.iter().filter(|event| event.free_ms.is_some()).count() as f64;
        floor += summary.events.iter().filter(|event| event.floor_n.is_some()).count() as f64;
    }
    Ok([free / events, floor / events])
}

/// Mean force before a place of this half width and the largest behind it, of each passage that is wholly on
/// record. `past_mm` is how far the ball is past the middle.
fn forces(past_mm: &[f64], force: &[f64], half_mm: f64) -> Vec<[f64; 2]> {
    let [far, near] = REACH_MM;
    let mut all = Vec::new();
    let (mut sum, mut count, mut largest) = (0.0, 0, 0.0_f64);
    for (past, force) in past_mm.iter().zip(force) {
        if *past < -half_mm - far || *past > half_mm + far {
            if count > 0 && largest > 0.0 {
                all.push([sum / f64::from(count), largest]);
            }
            (sum, count, largest) = (0.0, 0, 0.0);
        } else if *past < -half_mm - near {
            sum += force;
            count += 1;
        } else if *past > half_mm {
            largest = largest.max(*force);
        }
    }
    all
}

/// Depth [mm] from which on a ball that does not give rests on both edges of a spall this wide and cannot
/// reach its floor: the sagitta of the ball's circle less that of the raceway's.
fn sagitta_mm(scene: &Scene, length_mm: f64) -> f64 {
    let sagitta = |diameter_mm: f64| 0.5 * (diameter_mm - (diameter_mm.powi(2) - length_mm.powi(2)).sqrt());
    sagitta(scene.bearing.roller_diameter_mm) - sagitta(scene.bearing.outer_race_diameter_mm)
}

/// How an indicator goes with depth at each width, and with width at each depth.
pub(crate) fn derive(rows: &mut Rows) {
    for ([mean, error], table) in OVER.iter().zip(["course over the bearing without", "course over before"]) {
        let sizes: Vec<([f64; 2], [f64; 2])> = rows
            .column("sizes", mean)
            .into_iter()
            .filter_map(|(name, value)| {
                let (width, depth) = name.trim_end_matches(" mm").split_once(" × ")?;
                let error = rows.number("sizes", name, error)?;
                Some(([width.parse().ok()?, depth.parse().ok()?], [value, error]))
            })
            .collect();
        for (fixed, along, of) in [(0, 1, "width"), (1, 0, "depth")] {
            let mut values: Vec<f64> = sizes.iter().map(|(at, _)| at[fixed]).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            for value in values {
                let mut line: Vec<(f64, [f64; 2])> = sizes
                    .iter()
                    .filter(|(at, _)| at[fixed] == value)
                    .map(|(at, mean)| (at[along], *mean))
                    .collect();
                line.sort_by(|a, b| a.0.total_cmp(&b.0));
                rows.word(table, &format!("{of} {value} mm"), "goes", &course(&line));
            }
        }
    }
}

/// Whether a mean rises to its largest and falls from there on by more than two standard errors.
fn course(line: &[(f64, [f64; 2])]) -> String {
    let last = line.len() - 1;
    let mean = |n: usize| line[n].1[0];
    let largest = (0..=last).max_by(|a, b| mean(*a).total_cmp(&mean(*b))).unwrap_or(last);
    let apart = |end: usize| (mean(largest) - mean(end)) / line[largest].1[1].hypot(line[end].1[1]);
    let [rises, falls] = [0, last].map(|end| end != largest && apart(end) > 2.0);
    let at = |n: usize| decimals(mean(n), 3);
    let (first, end, top) = (at(0), at(last), format!("{} at {} mm", at(largest), line[largest].0));
    match (rises, falls) {
        (true, false) => format!("grows from {first} to {top}"),
        (true, true) => format!("grows from {first} to {top}, then falls to {end}"),
        (false, true) => format!("falls from {first} to {end}"),
        (false, false) => format!("stays, {first} to {end}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of 7.94 mm over 2 mm of a raceway of 46.98 mm: c²/8 (1/r − 1/R) = 0.105 mm for short chords.
    #[test]
    fn by_hand_sagitta_of_a_ball_over_a_spall() {
        let set = ["bearing=6205".to_owned()];
        let scene = Scene::singh2014().with_overrides(&set).expect("a scene");
        assert!((sagitta_mm(&scene, 2.0) - 0.105).abs() < 2e-3, "{}", sagitta_mm(&scene, 2.0));
    }

    #[test]
    fn by_hand_forces_before_and_behind_of_passages_that_are_wholly_on_record() {
        let past: Vec<f64> = (0..81).map(|n| 0.1 * (f64::from(n) - 40.5)).collect();
        let force: Vec<f64> = past.iter().map(|x| if *x < 0.0 { 2.0 } else { 3.0 + x }).collect();
        let [pair] = forces(&past, &force, 1.0)[..] else { panic!("one passage") };
        assert!((pair[0] - 2.0).abs() < 1e-12 && (pair[1] - 5.45).abs() < 1e-12, "{pair:?}");
        // One that begins over the place, and one that ends there.
        assert!(forces(&past[40..], &force[40..], 1.0).is_empty());
        assert!(forces(&past[..40], &force[..40], 1.0).is_empty());
    }
}
