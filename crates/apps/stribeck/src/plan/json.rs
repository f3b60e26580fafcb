//! A plan as JSON, for scripts.

use serde_json::{Map, Value, json};
use stribeck_analysis::plan::{ContactNoise, Plan};
use stribeck_scene::resolved::ResolvedScene;

use super::trial::{Cost, Trial};
use crate::disk::trace_bytes;

/// The plan; `cost` is `null` where nothing was tried, `contact_noise` where contact has no mesh.
pub(super) fn of(scene: &ResolvedScene, plan: &Plan, trial: Option<&Trial>) -> Value {
    let loads = &plan.loads;
    let k = &scene.written.kinematics();
    let mut warnings = plan.dangers.clone();
    if let Some(trial) = trial {
        warnings.extend(trial.info.warnings.iter().cloned());
        let stops = trial.info.stop_reason.iter().map(|reason| format!("the run stops at once: {reason}"));
        warnings.extend(stops);
    }
    json!({
        "name": scene.written.name,
        "loads": {
            "clearance_um": 1e6 * loads.clearance_m,
            "loaded": loads.loaded,
            "largest_n": loads.largest_n,
            "pressure_outer_mpa": 1e-6 * loads.pressure_pa[0],
            "pressure_inner_mpa": 1e-6 * loads.pressure_pa[1],
            "static_rating_n": loads.static_rating_n,
            "static_safety": loads.static_safety(),
        },
        "families_hz": {
            "bpfo": k.bpfo_hz,
            "bpfi": k.bpfi_hz,
            "bsf": k.bsf_hz,
            "ftf": k.cage_hz,
            "shaft": k.shaft_hz,
        },
        "contact_noise": plan.noise.as_ref().map(contact_noise),
        "films": plan.films.map(|films| films.map(|film| json!({
            "thickness_um": 1e6 * film.thickness,
            "lambda": film.lambda,
        }))),
        "record": {
            "duration_ms": scene.written.solver.duration_ms,
            "resolution_hz": plan.resolution_hz,
            "separating_ms": plan.noise.as_ref().and_then(|noise| noise.separating_s).map(|s| 1e3 * s),
            "envelope_ms": plan.envelope.map(|(_, s)| 1e3 * s),
            "envelope_family": plan.envelope.map(|(name, _)| name),
            "elements_per_wavelength": plan.elements_per_wavelength,
            "bytes": trace_bytes(scene),
        },
        "elements": plan.elements,
        "cost": trial.map(cost),
        "warnings": warnings,
        "advice": plan.advice,
    })
}

fn contact_noise(noise: &ContactNoise) -> Value {
    let lines: Map<String, Value> = noise.lines.iter().map(|(name, hz)| (name.clone(), json!(hz))).collect();
    json!({
        "lines_hz": lines,
        "sag_um": noise.sag_m.map(|m| 1e6 * m),
        "half_width_um": 1e6 * noise.half_width_m,
        "facet_um": 1e6 * noise.facet_m,
        "level_g": noise.lumped.level_g,
    })
}

fn cost(trial: &Trial) -> Value {
    let times = |cost: Cost| json!({ "quiet_s": cost.quiet_s, "busy_s": cost.busy_s });
    json!({
        "threads": trial.threads,
        "modes": trial.info.reduced.as_ref().map(|reduced| reduced.modes),
        "step_us": 1e6 * trial.info.time_step_s,
        "steps": trial.steps_planned,
        "before_first_step": times(trial.before()),
        "steps_take": times(trial.steps),
        "run": times(trial.run()),
        "tried_ms": 1e3 * trial.info.simulated_s,
    })
}
