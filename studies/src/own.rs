//! `cargo xtask study own`: whether bearings by their own fields run at the first try, by both models.

use anyhow::Result;
use stribeck_analysis::plan::Loads;
use stribeck_scene::scene::Assumed;
use stribeck_store::run_info::Status;

use crate::plan::Kernel;
use crate::{Answer, Finished, Plan, Rows, Runner};

const KERNELS: &[Kernel] = &[
    ("energy", |run| Some(run.info.as_ref()?.energy.of_larger())),
    ("warnings", |run| Some(run.info.as_ref()?.warnings.len() as f64)),
    ("elements", |run| run.info.as_ref().map(|info| (info.mesh.quads + info.mesh.triangles) as f64)),
    ("bore_mm", |run| {
        let bearing = &run.written.bearing;
        Some(bearing.inner_race_diameter_mm - 2.0 * bearing.inner_ring_thickness_mm)
    }),
    ("clearance_um", |run| Some(1e6 * run.scene.clearance)),
    ("load_kn", |run| Some(1e-3 * run.scene.written.operation.load_n)),
    ("largest_kn", |run| Some(1e-3 * Loads::of(&run.scene).ok()?.largest_n)),
    ("pressure_mpa", |run| Some(1e-6 * Loads::of(&run.scene).ok()?.pressure_pa[1])),
    ("safety", |run| Some(Loads::of(&run.scene).ok()?.static_safety())),
    ("room_mm", |run| {
        let [inner, outer] = run.scene.cage.as_ref()?.radii();
        Some(1e3 * (run.scene.outer_race_radius - outer).min(inner - run.scene.inner_race_radius))
    }),
];

pub(crate) fn measure(runner: &Runner<'_>, rows: &mut Rows) -> Result<Answer> {
    let plan = Plan::read(runner.study)?;
    let groups = plan.run(runner, KERNELS, rows)?;
    let mut failed = Vec::new();
    for (group, run) in
        plan.groups.iter().zip(&groups).flat_map(|(group, runs)| runs.iter().map(move |r| (group, r)))
    {
        rows.word(&group.table, &run.variant.name, "assumed", &assumed(run));
        let ended = match &run.info {
            Some(info) if info.status == Status::Complete => "complete".to_owned(),
            Some(info) => info.stop_reason.clone().unwrap_or_else(|| "not complete".to_owned()),
            None => run.summary.as_ref().err().cloned().unwrap_or_default(),
        };
        if ended != "complete" {
            failed.push(run.variant.name.as_str());
        }
        rows.word(&group.table, &run.variant.name, "ended", &ended);
    }
    let failure = (!failed.is_empty()).then(|| format!("not complete: {}", failed.join(", ")));
    Ok(Answer { failure, ..Answer::default() })
}

/// What of the bearing was not given, and follows from the rest.
fn assumed(run: &Finished) -> String {
    let word = |what: &Assumed| match what {
        Assumed::Clearance => "clearance",
        Assumed::Pitch => "pitch",
        Assumed::OuterRing => "outer ring",
        Assumed::InnerRing => "inner ring",
        Assumed::Rollers => "number",
        Assumed::Length => "length",
    };
    run.written.bearing.assumed.iter().map(word).collect::<Vec<_>>().join(", ")
}
