//! `stribeck plan`: what to expect of a scene before it is run.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, ensure};
use stribeck_analysis::paper;
use stribeck_analysis::plan::{MeshFacts, Plan};
use stribeck_bearing::{assembly::Assembly, recorder};
use stribeck_scene::kinematics::Kinematics;
use stribeck_scene::scene::ModelScene;

use crate::place::Place;

/// Flags of `plan`.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Scene file [default: the bearing of the paper, as in fixtures/scenes/singh2014.ron]
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

/// A step with oil takes so many times as long in the reduced model (docs/PERFORMANCE.md, section 7).
const OIL: f64 = 3.6;

pub(crate) fn run(options: &Options, place: &Place) -> Result<ExitCode> {
    let scene = place.scene(options.scene.as_deref(), &options.overrides)?;
    let factor = scene.solver.time_step_factor;
    ensure!(
        factor <= 1.0,
        "`solver.time_step_factor` is {factor}: steps longer than the critical one diverge. Take a `solver.time_step_factor` below 1"
    );
    let assembly = Assembly::new(&scene)?;
    let mesh =
        MeshFacts { counts: assembly.mesh_info(), element_time_step_s: assembly.element_time_step_s(&scene) };
    let plan = Plan::of(&scene, &mesh)?;
    let [roller, outer, inner] = plan.sag_m.map(|s| 1e6 * s);
    println!("{}", scene.name);
    println!("  lines of contact noise, without slip");
    for (name, hz) in &plan.lines {
        println!("    {hz:9.1} Hz  {name}");
    }
    println!("  sag of the facets: rollers {roller:.2} µm, outer raceway {outer:.2} µm, inner {inner:.2} µm");
    println!(
        "  largest static force {:.0} N: Hertz contact {:.2} mm wide on facets of {:.2} mm",
        plan.load_n,
        2e3 * plan.half_width_m,
        1e3 * plan.facet_m
    );
    println!(
        "  chords, lumped model: {:.0} g at {:.0} Hz (width of the contact leaves {:.2}, phases of the rollers {:.2}){}",
        plan.lumped.level_g,
        plan.lumped.frequency_hz,
        plan.lumped.smoothing,
        plan.lumped.phases,
        if paper::is_scene_of(&scene) { "; docs/results/noise.md has two to five times as much" } else { "" }
    );
    if let Some([outer, inner]) = plan.films {
        println!(
            "  oil under it (Dowson and Higginson): {:.2} and {:.2} µm at the outer and inner raceway, {:.1} and {:.1} times the roughness",
            1e6 * outer.thickness,
            1e6 * inner.thickness,
            outer.lambda,
            inner.lambda
        );
    }
    let k = &Kinematics::of(&scene);
    println!(
        "  families, without slip: BPFO {:.2} Hz, BPFI {:.2}, BSF {:.2} (a spot strikes twice as often), FTF {:.2}, shaft {:.2}",
        k.bpfo_hz, k.bpfi_hz, k.bsf_hz, k.cage_hz, k.shaft_hz
    );
    match &scene.model {
        ModelScene::Full => {
            let cost = 1e-9 * options.ns_per_element_step * plan.steps * plan.elements as f64;
            println!(
                "  {} elements, steps of at least {:.0} ns, at most {:.0} of them: at most about {cost:.0} s of processor time at {} ns per element-step",
                plan.elements,
                1e9 * plan.time_step_s,
                plan.steps,
                options.ns_per_element_step
            );
        }
        ModelScene::Reduced(reduced) => {
            let per_sample = (scene.output.interval_us / reduced.step_us).ceil().max(1.0);
            let steps = per_sample * (1e3 * scene.solver.duration_ms / scene.output.interval_us).round();
            let oil = if scene.film.is_some() { OIL } else { 1.0 };
            let cost =
                1e-9 * options.ns_per_roller_step * oil * steps * scene.rollers_in_place().count() as f64;
            println!(
                "  reduced model: {steps:.0} steps of {} µs: about {cost:.1} s of processor time at {} ns per roller-step{}, beside the modes of {} elements",
                scene.output.interval_us / per_sample,
                options.ns_per_roller_step,
                if scene.film.is_some() { " and 3.6 times as much with oil" } else { "" },
                plan.elements
            );
        }
    }
    let samples = 1e3 * scene.solver.duration_ms / scene.output.interval_us;
    println!("  the trace takes {:.3} GB", 8e-9 * samples * recorder::names(&scene).len() as f64);
    println!("  {:.1} elements in a Rayleigh wave at half the sampling rate", plan.elements_per_wavelength);
    println!("  the record resolves {:.1} Hz", plan.resolution_hz);
    if let Some(needed) = plan.separating_s {
        println!("  {:.0} ms separate the closest two lines", 1e3 * needed);
    }
    println!("  {:.0} ms hold ten periods of the defect, the least for an envelope", 1e3 * plan.envelope_s);
    for advice in &plan.advice {
        println!("  advice: {advice}");
    }
    Ok(ExitCode::SUCCESS)
}
