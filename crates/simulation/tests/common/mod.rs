//! Scenes and hosts that several test files share.
#![allow(dead_code, reason = "each test file uses its own part of it")]

use std::ops::ControlFlow;

use stribeck_scene::scene::{GradingScene, Scene};
use stribeck_simulation::run::host::Host;
use stribeck_simulation::simulate;
use stribeck_store::{run_dir::RunDir, run_info::RunInfo, trace::Trace};
use stribeck_testing::Scratch;

/// The paper's bearing, coarse: 2 mm elements, with rollers of 88 facets so that they still roll.
pub(crate) fn coarse(duration_ms: f64) -> Scene {
    let mut scene = Scene { name: "coarse".into(), ..Scene::default() };
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    // The contact is as stiff as a layer of these elements: a smaller share of E/h would swallow the defect.
    scene.bearing.thickness_mm = 20.0;
    scene.contact.penalty_scale = 1.0;
    scene.contact.points_per_facet = 4;
    scene.solver.duration_ms = duration_ms;
    scene
}

/// The same on facets of 1 mm where bodies roll on each other, and elements of up to 3 mm elsewhere.
pub(crate) fn fine_where_it_rolls(duration_ms: f64) -> Scene {
    let mut scene = coarse(duration_ms);
    (scene.mesh.size_mm, scene.mesh.roller_facets) = (1.0, 112);
    scene.mesh.grading = Some(GradingScene { coarse_mm: 3.0, fine_layers: 2 });
    scene
}

/// A program around the run whose clocks stand still.
pub(crate) fn host(threads: usize) -> Host<'static> {
    Host {
        threads,
        version: "test".into(),
        commit: "test".into(),
        machine: "test".into(),
        wall_s: &|| 0.0,
        cpu_s: &|| 0.0,
    }
}

/// A whole run in a folder of its own.
pub(crate) fn run(scene: &Scene, folder: &Scratch, name: &str, threads: usize) -> RunInfo {
    let dir = RunDir::create(folder.join(name)).expect("the folder is new");
    simulate(scene, &dir, &host(threads), &mut |_| ControlFlow::Continue(())).expect("the scene is sound")
}

/// Its recorded channels.
pub(crate) fn trace(folder: &Scratch, name: &str) -> Trace {
    Trace::read(folder.join(name).join("trace.npy")).expect("a trace")
}
