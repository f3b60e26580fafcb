//! Whole bearings, coarse and short, at and beyond the limits of scenes.

use stribeck_scene::scene::Scene;
use stribeck_store::run_dir::Run;
use stribeck_store::run_info::{RunInfo, Status};

use super::{Case, Chapter, Verdict};
use crate::{Finished, Flags, Host, Runner, Variant};

/// Coarse bearing of every case, and how long it runs.
const SCENE: &str = "fixtures/scenes/studies/quick.ron";
const BASE: &[&str] = &["solver.duration_ms=0.4"];

/// Relative error of the rollers' load above which a case without warning is wrong.
const SUPPORT: [f64; 2] = [0.7, 1.3];

/// … unless the error accelerates outer ring and adapter to less than this speed [m/s].
const RATTLING: f64 = 0.1;

/// Name, description, overrides.
pub(super) type Row = (&'static str, &'static str, &'static [&'static str]);

#[rustfmt::skip]
const ROWS: &[Row] = &[
    ("base", "the quick scene as it is", &[]),
    ("dt-099", "time step 0.99 of the limit", &["solver.time_step_factor=0.99"]),
    ("dt-101", "time step 1.01 of the limit", &["solver.time_step_factor=1.01"]),
    ("dt-120", "time step 1.2 of the limit", &["solver.time_step_factor=1.2"]),
    ("dt-150", "time step 1.5 of the limit", &["solver.time_step_factor=1.5"]),
    ("penalty-1e-2", "penalty × 10⁻²", &["contact.penalty_scale=0.01"]),
    ("penalty-1e-1", "penalty × 10⁻¹", &["contact.penalty_scale=0.1"]),
    ("penalty-1e1", "penalty × 10", &["contact.penalty_scale=10.0"]),
    ("penalty-1e2", "penalty × 10²", &["contact.penalty_scale=100.0", "solver.duration_ms=0.1"]),
 ("penalty-1e2-sudden", "penalty × 10², load at once", &["contact.penalty_scale=100.0", "solver.duration_ms=0.1", "solver.start=sudden"]),
    ("penalty-1e3-sudden", "penalty × 10³, load at once", &["contact.penalty_scale=1000.0", "solver.duration_ms=0.05", "solver.start=sudden"]),
    ("penalty-1e4", "penalty × 10⁴", &["contact.penalty_scale=1e4"]),
    ("load-5e5", "500 kN", &["operation.load_n=5e5"]),
    ("load-5e6", "5 MN", &["operation.load_n=5e6"]),
    ("load-5e7", "50 MN", &["operation.load_n=5e7"]),
    ("sudden-5e4", "50 kN at once", &["solver.start=sudden"]),
    ("sudden-5e5", "500 kN at once", &["solver.start=sudden", "operation.load_n=5e5"]),
    ("sudden-5e6", "5 MN at once", &["solver.start=sudden", "operation.load_n=5e6"]),
    ("sudden-5e7", "50 MN at once", &["solver.start=sudden", "operation.load_n=5e7"]),
    ("load-100", "100 N", &["operation.load_n=100.0"]),
    ("clearance-10", "clearance 10 µm", &["bearing.inner_race_diameter_mm=163.99"]),
    ("clearance-100", "clearance 100 µm", &["bearing.inner_race_diameter_mm=163.9"]),
    ("clearance-500", "clearance 0.5 mm", &["bearing.inner_race_diameter_mm=163.5"]),
    ("interference-10", "interference 10 µm", &["bearing.inner_race_diameter_mm=164.01"]),
    ("interference-100", "interference 100 µm", &["bearing.inner_race_diameter_mm=164.1"]),
    ("friction-0", "µ = 0", &["contact.friction=0.0", "contact.seat_friction=0.0"]),
    ("friction-03", "µ = 0.3", &["contact.friction=0.3", "contact.seat_friction=0.3"]),
    ("friction-1", "µ = 1", &["contact.friction=1.0", "contact.seat_friction=1.0"]),
    ("clearance-500-sudden", "clearance 0.5 mm, load at once", &["bearing.inner_race_diameter_mm=163.5", "solver.start=sudden"]),
    ("rpm-1", "1 rpm", &["operation.speed_rpm=1.0"]),
    ("rpm-1-sudden", "1 rpm, load at once", &["operation.speed_rpm=1.0", "solver.start=sudden"]),
    ("rpm-1e4", "10 000 rpm", &["operation.speed_rpm=1e4"]),
    ("rpm-1e5", "100 000 rpm", &["operation.speed_rpm=1e5"]),
    ("defect-deep", "defect as deep as a roller radius", &["defect.depth_mm=9.0"]),
    ("defect-half", "defect half as deep as the ring", &["defect.depth_mm=5.0"]),
    ("defect-none", "defect of no length", &["defect.length_mm=0.0"]),
    ("defect-tiny", "defect of 0.1 mm", &["defect.length_mm=0.1"]),
    ("defect-long", "defect as long as the load zone", &["defect.length_mm=120.0", "defect.depth_mm=0.2"]),
    ("rollers-3", "3 rollers", &["bearing.rollers=3"]),
    ("rollers-3-sudden", "3 rollers, load at once", &["bearing.rollers=3", "solver.start=sudden"]),
    ("rollers-200", "200 rollers of 2.5 mm", &[
        "bearing.rollers=200", "bearing.roller_diameter_mm=2.5", "bearing.inner_race_diameter_mm=194.96",
        "cage=None", "mesh.roller_facets=24", "mesh.size_mm=1.0", "solver.duration_ms=0.1",
    ]),
    ("rollers-200-sudden", "200 rollers of 2.5 mm, load at once", &[
        "bearing.rollers=200", "bearing.roller_diameter_mm=2.5", "bearing.inner_race_diameter_mm=194.96", "solver.start=sudden",
        "cage=None", "mesh.roller_facets=24", "mesh.size_mm=1.0", "solver.duration_ms=0.3",
    ]),
    ("thin-sudden", "thickness 0.1 mm, load at once", &["bearing.thickness_mm=0.1", "solver.start=sudden"]),
    ("rubber-sudden", "E = 1 MPa, load at once", &["material.youngs_modulus_gpa=0.001", "solver.start=sudden", "solver.duration_ms=20.0"]),
    ("light-sudden", "ρ = 1 kg/m³, load at once", &["material.density_kg_m3=1.0", "solver.duration_ms=0.02", "solver.start=sudden"]),
    ("thin", "thickness 0.1 mm", &["bearing.thickness_mm=0.1"]),
    ("thick", "thickness 10 m", &["bearing.thickness_mm=10000.0"]),
    ("rubber", "E = 1 MPa", &["material.youngs_modulus_gpa=0.001"]),
    ("incompressible", "ν = 0.4999", &["material.poissons_ratio=0.4999", "solver.duration_ms=0.05"]),
    ("nu-0", "ν = 0", &["material.poissons_ratio=0.0"]),
    ("light", "ρ = 1 kg/m³", &["material.density_kg_m3=1.0", "solver.duration_ms=0.02"]),
    ("undamped", "no damping at all", &["solver.mass_damping_per_s=0.0", "contact.damping_ratio=0.0"]),
    ("collocated", "node-to-segment contact", &["contact.method=collocated"]),
];

pub(super) fn chapter(runner: &Runner<'_>, flags: &Flags, host: &dyn Host) -> anyhow::Result<Chapter> {
    let cases = run_rows(runner, flags, host, (SCENE, BASE), ROWS, &|done, run| Ok(judge(done, run)))?;
    Ok(Chapter {
        title: "Whole bearings",
        words: "The quick scene (2 mm elements, 24 rollers) for 0.4 ms with one thing changed. *Carried* is \
            the vertical force of \
                all rollers over load and weight, on average.",
        cases,
        figures: Vec::new(),
    })
}

/// Runs a scene with the overrides of each row and judges the outcome; a refused scene has its reason.
pub(super) fn run_rows(
    runner: &Runner<'_>,
    flags: &Flags,
    host: &dyn Host,
    (scene, base): (&'static str, &[&str]),
    rows: &[Row],
    judge: &dyn Fn(&str, &Finished) -> anyhow::Result<Case>,
) -> anyhow::Result<Vec<Case>> {
    let mut cases = Vec::new();
    for (name, done, set) in rows {
        if !flags.wants(name) {
            continue;
        }
        let variant = set.iter().fold(Variant::new(*name, scene, base), |variant, s| variant.with(*s));
        if let Err(error) = Scene::read_with(host.root().join(scene), &variant.set) {
            let first = error.problems().first().map_or(String::new(), |p| {
                format!("{} (allowed: {})", p.message, p.allowed).replace(" (allowed: )", "")
            });
            cases.push(Case { done: (*done).into(), energy: None, verdict: Verdict::Refused, seen: first });
            continue;
        }
        for run in &runner.run(&[variant])? {
            cases.push(judge(done, run)?);
        }
    }
    Ok(cases)
}

/// The account of a run that came to its end; the case of one that did not, refused by the preload or stopped
/// by a guard.
pub(super) fn ended<'a>(done: &str, run: &'a Finished) -> Result<&'a RunInfo, Case> {
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
pub(super) fn carried(run: &Finished, info: &RunInfo) -> [f64; 2] {
    let carried = Run::read(&run.folder).ok().map(|r| support(&r));
    let share = carried.map_or(f64::NAN, |n| n / info.expected_support_n);
    // A force that is not carried, or too much of it, moves outer ring and adapter; a little of that is
    // rattling.
    let mass = (info.expected_support_n - run.scene.written.operation.load_n)
        / run.scene.written.operation.gravity_m_s2;
    let time = info.steps as f64 * info.time_step_s;
    [share, (share - 1.0).abs() * info.expected_support_n * time / mass]
}

fn judge(done: &str, run: &Finished) -> Case {
    let info = match ended(done, run) {
        Ok(info) => info,
        Err(case) => return case,
    };
    let [share, gained] = carried(run, info);
    let right = (share > SUPPORT[0] && share < SUPPORT[1]) || gained < RATTLING;
    let seen = format!("carried {share:.3}, {} steps of {:.3} ns", info.steps, 1e9 * info.time_step_s);
    concluded(done, info, right, seen)
}

/// The case of a run that came to its end.
pub(super) fn concluded(done: &str, info: &RunInfo, right: bool, mut seen: String) -> Case {
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
