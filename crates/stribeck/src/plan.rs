//! `stribeck plan`: what to expect of a scene before it is run.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, ensure};
use stribeck_analysis::paper;
use stribeck_analysis::plan::{MeshFacts, Plan};
use stribeck_bearing::assembly::Assembly;
use stribeck_run::channels;
use stribeck_scene::housing::HousingScene;
use stribeck_scene::kinematics::Kinematics;
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::run_info::clock;
use stribeck_scene::scene::{ModelScene, ReducedScene};
use stribeck_simulation::steps_in_a_sample;

use crate::out::say;
use crate::place::Place;

/// Flags of `plan`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file [default: the run of the paper, fixtures/scenes/singh2014.ron]
    scene: Option<PathBuf>,
    /// Overrides a field of the scene, for example --set mesh.size_mm=1.0; may be repeated
    #[arg(long = "set", value_name = "FIELD=VALUE")]
    overrides: Vec<String>,
    /// Processor time for one element and one step [ns], for the estimate of cost
    #[arg(long, default_value_t = 3.5)]
    ns_per_element_step: f64,
    /// Processor time for one roller and one step of the reduced model, dry [ns], for the estimate of cost
    #[arg(long, default_value_t = 250.0)]
    ns_per_roller_step: f64,
}

/// A run of the reduced model that takes longer is worth a word [s of processor time].
const LONG_S: f64 = 3600.0;

/// A step with oil takes so many times as long in the reduced model (docs/PERFORMANCE.md, section 7).
const OIL: f64 = 3.6;

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
    say!("{}", scene.written.name);
    contact_noise(&scene, &plan);
    oil_and_families(&scene, &plan);
    match &scene.written.model {
        ModelScene::Full => {
            let cost = 1e-9 * options.ns_per_element_step * plan.steps * plan.elements as f64;
            say!(
                "  {} elements, steps of at least {:.0} ns, at most {:.0} of them: at most about {cost:.0} s \
                 of processor time at {} ns per element-step",
                plan.elements,
                1e9 * plan.time_step_s,
                plan.steps,
                options.ns_per_element_step
            );
        }
        ModelScene::Reduced(reduced) => {
            plan.advice.extend(reduced_cost(options, place, &scene, reduced, plan.elements)?);
        }
    }
    record(&scene, &plan);
    for advice in &plan.advice {
        say!("  advice: {advice}");
    }
    Ok(ExitCode::SUCCESS)
}

/// Lines that facets make, and how strong.
fn contact_noise(scene: &ResolvedScene, plan: &Plan) {
    say!("  lines of contact noise, without slip");
    for (name, hz) in &plan.lines {
        say!("    {hz:9.1} Hz  {name}");
    }
    let [roller, outer, inner] = plan.sag_m.map(|s| 1e6 * s);
    say!("  sag of the facets: rollers {roller:.2} µm, outer raceway {outer:.2} µm, inner {inner:.2} µm");
    say!(
        "  largest static force {:.0} N: Hertz contact {:.2} mm wide on facets of {:.2} mm",
        plan.load_n,
        2e3 * plan.half_width_m,
        1e3 * plan.facet_m
    );
    say!(
        "  chords, lumped model: {:.0} g at {:.0} Hz (width of the contact leaves {:.2}, phases of the \
         rollers {:.2}){}",
        plan.lumped.level_g,
        plan.lumped.frequency_hz,
        plan.lumped.smoothing.abs(),
        plan.lumped.phases,
        if paper::is_scene_of(&scene.written) {
            "; docs/results/noise.md has two to five times as much"
        } else {
            ""
        }
    );
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
    let k = &Kinematics::of(&scene.written);
    say!(
        "  families, without slip: BPFO {:.2} Hz, BPFI {:.2}, BSF {:.2} (a spot strikes twice as often), FTF \
         {:.2}, shaft {:.2}",
        k.bpfo_hz,
        k.bpfi_hz,
        k.bsf_hz,
        k.cage_hz,
        k.shaft_hz
    );
}

/// What a run of the reduced model costs; advice where that is hours.
fn reduced_cost(
    options: &Options,
    place: &Place,
    scene: &ResolvedScene,
    reduced: &ReducedScene,
    elements: usize,
) -> Result<Option<String>> {
    // The modes are worth keeping for the run where there are runs.
    let runs = Some(place.runs()).filter(|runs| runs.is_dir());
    eprintln!("modes …");
    let per_sample = steps_in_a_sample(scene, runs.as_deref())?;
    let (solver, output) = (&scene.written.solver, &scene.written.output);
    let steps = (per_sample as f64 * 1e3 * solver.duration_ms / output.interval_us).round();
    let (oil, with_oil) = match scene.written.film {
        Some(_) => (OIL, " and 3.6 times as much with oil"),
        None => (1.0, ""),
    };
    let rollers = scene.written.rollers_in_place().count() as f64;
    let cost = 1e-9 * options.ns_per_roller_step * oil * steps * rollers;
    let step_us = output.interval_us / per_sample as f64;
    say!(
        "  reduced model: {steps:.0} steps of {step_us:.3} µs: about {} of processor time at {} ns per \
         roller-step{with_oil}, beside the modes of {elements} elements",
        clock(cost),
        options.ns_per_roller_step,
    );
    if cost <= LONG_S {
        return Ok(None);
    }
    let dampers = match &scene.written.housing {
        HousingScene::Springs(springs) if springs.damping_n_s_m > 0.0 => {
            ", and the dampers of `housing.damping_n_s_m`,"
        }
        _ => "",
    };
    let why = if step_us < 0.99 * reduced.step_us {
        format!(
            ": modes and contacts{dampers} allow steps of {step_us:.3} µs, not the {} µs of `model.step_us`",
            reduced.step_us
        )
    } else {
        String::new()
    };
    Ok(Some(format!("the run takes hours{why}")))
}

/// What the record will hold.
fn record(scene: &ResolvedScene, plan: &Plan) {
    let samples = 1e3 * scene.written.solver.duration_ms / scene.written.output.interval_us;
    say!("  the trace takes {:.3} GB", 8e-9 * samples * channels::names(scene).len() as f64);
    say!("  {:.1} elements in a Rayleigh wave at half the sampling rate", plan.elements_per_wavelength);
    say!("  the record resolves {:.1} Hz", plan.resolution_hz);
    if let Some(needed) = plan.separating_s {
        say!("  {:.0} ms separate the closest two lines", 1e3 * needed);
    }
    match plan.envelope {
        Some((family, record_s)) => {
            say!("  {:.0} ms hold ten periods of {family}, the least for an envelope", 1e3 * record_s);
        }
        None => {
            say!("  nothing turns against the outer ring: there are no periods of a defect, and no envelope")
        }
    }
}
