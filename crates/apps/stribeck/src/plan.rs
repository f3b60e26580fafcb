//! `stribeck plan`: prediction of a run before it is made.

mod json;
mod trial;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, ensure};
use stribeck_analysis::paper;
use stribeck_analysis::plan::{ContactNoise, MeshFacts, Plan};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::ModelScene;
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_store::run_info::{ReducedInfo, clock};

use crate::disk;
use crate::out::say;
use crate::place::Place;
use trial::Trial;

/// Flags of `plan`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file [default: the run of the paper, fixtures/scenes/singh2014.ron]
    scene: Option<PathBuf>,
    /// Overrides a field of the scene, for example --set mesh.size_mm=1.0; may be repeated
    #[arg(long = "set", value_name = "FIELD=VALUE")]
    overrides: Vec<String>,
    /// Does not try the first steps to estimate the cost: the rest of the plan at once
    #[arg(long)]
    no_trial: bool,
    /// Writes the plan to standard output as JSON
    #[arg(long)]
    json: bool,
}

/// A run of the reduced model that takes longer is worth a word [s].
const LONG_S: f64 = 3600.0;

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let scene = place.scene(options.scene.as_deref(), &options.overrides)?.resolve();
    let factor = scene.written.solver.time_step_factor;
    ensure!(
        factor <= 1.0,
        "`solver.time_step_factor` is {factor}: steps longer than the critical one diverge. Take a \
         `solver.time_step_factor` below 1"
    );
    let assembly = Assembly::new(&scene)?;
    let mesh =
        MeshFacts { counts: assembly.mesh_info(), element_time_step_s: assembly.element_time_step_s(&scene) };
    let mut plan = Plan::of(&scene, &mesh)?;
    plan.dangers.extend(disk::too_small(&scene, &place.runs()));
    if options.json {
        let trial = if options.no_trial { None } else { Some(trial::begin(&scene, &plan, place)?) };
        plan.advice.extend(trial.as_ref().and_then(|trial| long(&scene, trial)));
        say!("{}", serde_json::to_string_pretty(&json::of(&scene, &plan, trial.as_ref()))?);
        return Ok(ExitCode::SUCCESS);
    }
    say!("{}", scene.written.name);
    loads(&plan);
    if let Some(noise) = &plan.noise {
        contact_noise(&scene, noise);
    }
    oil_and_families(&scene, &plan);
    record(&scene, &plan);
    for danger in &plan.dangers {
        say!("  warning: {danger}");
    }
    if !options.no_trial {
        let trial = trial::begin(&scene, &plan, place)?;
        cost(&plan, &trial);
        plan.advice.extend(long(&scene, &trial));
    }
    for advice in &plan.advice {
        say!("  advice: {advice}");
    }
    Ok(ExitCode::SUCCESS)
}

fn loads(plan: &Plan) {
    let loads = &plan.loads;
    let [outer, inner] = loads.pressure_pa.map(|pa| 1e-6 * pa);
    say!(
        "  clearance {:.0} µm; {} rolling elements carry, the most loaded one {:.0} N (rigid rings, Stribeck \
         and Sjövall)",
        1e6 * loads.clearance_m,
        loads.loaded,
        loads.largest_n
    );
    say!(
        "  Hertz pressure of its contacts: {outer:.0} MPa at the outer, {inner:.0} MPa at the inner raceway"
    );
    say!(
        "  static safety s₀ = C₀/P₀ = {:.1}, with C₀ = {:.1} kN by ISO 76 from these dimensions",
        loads.static_safety(),
        1e-3 * loads.static_rating_n
    );
}

/// Ratio of wall-clock to processor time above which a computer counts as busy.
const BUSY: f64 = 1.2;

/// Time and memory of the run.
fn cost(plan: &Plan, trial: &Trial) {
    let what = match &trial.info.reduced {
        Some(reduced) => format!("{} modes of {} elements", reduced.modes, plan.elements),
        None => format!("{} elements", plan.elements),
    };
    say!("  {what}, {:.0} steps of {:.3} µs", trial.steps_planned, 1e6 * trial.info.time_step_s);
    let modes = match trial.modes {
        Some(cost) if trial.kept => format!("; its modes took {}, and are kept for it", clock(cost.busy_s)),
        Some(cost) => {
            format!(", {} of it for the modes, which are kept for further runs", clock(cost.quiet_s))
        }
        None => String::new(),
    };
    let all = trial.run();
    let busy = if all.busy_s > BUSY * all.quiet_s {
        format!(", and {} as busy as it is now", clock(all.busy_s))
    } else {
        String::new()
    };
    say!(
        "  the run takes about {} on {} thread{} of this machine{}{busy} (set-up {}{modes}), and its report \
         some seconds more: {:.2} ms of it were tried",
        clock(all.quiet_s),
        trial.threads,
        if trial.threads == 1 { "" } else { "s" },
        if busy.is_empty() { "" } else { " where nothing else runs" },
        clock(trial.before().quiet_s),
        1e3 * trial.info.simulated_s
    );
    for warning in &trial.info.warnings {
        say!("  warning: {warning}");
    }
    if let Some(reason) = &trial.info.stop_reason {
        say!("  warning: the run stops at once: {reason}");
    }
}

/// Advice where a reduced run takes hours.
fn long(scene: &ResolvedScene, trial: &Trial) -> Option<String> {
    let ModelScene::Reduced(reduced) = &scene.written.model else { return None };
    if trial.run().quiet_s <= LONG_S {
        return None;
    }
    let step_us = 1e6 * trial.info.time_step_s;
    let why = match &trial.info.reduced {
        Some(ReducedInfo { step_of, .. }) if step_us < 0.99 * reduced.step_us => {
            format!(": its steps are {step_us:.3} µs long, none longer than {step_of}")
        }
        _ => String::new(),
    };
    Some(format!("the run takes hours{why}"))
}

/// Lines that facets make, and how strong.
fn contact_noise(scene: &ResolvedScene, noise: &ContactNoise) {
    say!("  lines of contact noise, without slip");
    for (name, hz) in &noise.lines {
        say!("    {hz:9.1} Hz  {name}");
    }
    let [roller, outer, inner] = noise.sag_m.map(|s| 1e6 * s);
    say!("  sag of the facets: rollers {roller:.2} µm, outer raceway {outer:.2} µm, inner {inner:.2} µm");
    say!(
        "  under the largest force a Hertz contact is {:.2} mm wide, on facets of {:.2} mm",
        2e3 * noise.half_width_m,
        1e3 * noise.facet_m
    );
    say!(
        "  chords, lumped model: {:.0} g at {:.0} Hz (width of the contact leaves {:.2}, phases of the \
         rollers {:.2}){}",
        noise.lumped.level_g,
        noise.lumped.frequency_hz,
        noise.lumped.smoothing.abs(),
        noise.lumped.phases,
        if paper::is_scene_of(&scene.written) {
            "; docs/results/noise.md has two to five times as much"
        } else {
            ""
        }
    );
    if let Some(needed) = noise.separating_s {
        say!("  {:.0} ms separate the closest two lines", 1e3 * needed);
    }
}

/// Film of the most loaded contact, and frequencies of defects.
fn oil_and_families(scene: &ResolvedScene, plan: &Plan) {
    if let Some([outer, inner]) = plan.films {
        say!(
            "  oil under it (Dowson and Higginson): {:.2} and {:.2} µm at the outer and inner raceway, {:.1} \
             and {:.1} times the roughness",
            1e6 * outer.thickness,
            1e6 * inner.thickness,
            outer.lambda,
            inner.lambda
        );
    }
    let k = &scene.written.mean_kinematics();
    let speed = if scene.written.operation.speed_varies() { " at the mean speed" } else { "" };
    say!(
        "  families{speed}, without slip: BPFO {:.2} Hz, BPFI {:.2}, BSF {:.2} (a spot strikes twice as \
         often), FTF {:.2}, shaft {:.2}",
        k.bpfo_hz,
        k.bpfi_hz,
        k.bsf_hz,
        k.cage_hz,
        k.shaft_hz
    );
}

/// Length and resolution of the record.
fn record(scene: &ResolvedScene, plan: &Plan) {
    say!("  the trace takes {:.3} GB", 1e-9 * disk::trace_bytes(scene));
    if let Some(elements) = plan.elements_per_wavelength {
        say!(
            "  the mesh has {elements:.0} elements a wavelength of surface (Rayleigh) waves at half the sampling rate"
        );
    }
    let digits = if plan.resolution_hz < 0.1 { 5 } else { 1 };
    say!("  the record resolves {:.digits$} Hz", plan.resolution_hz);
    match plan.envelope {
        Some((family, record_s)) => {
            say!("  {:.0} ms hold ten periods of {family}, the least for an envelope", 1e3 * record_s);
        }
        None => {
            say!("  nothing turns against the outer ring: there are no periods of a defect, and no envelope")
        }
    }
}
