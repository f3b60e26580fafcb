//! Scenes and hosts that several test files share.

use std::ops::ControlFlow;

use stribeck_scene::scene::{GradingScene, Scene};
use stribeck_simulation::run::host::{Host, Progress};
use stribeck_simulation::{resume, simulate};
use stribeck_store::run_info::{RunInfo, Status};
use stribeck_store::{
    run_dir::{Run, RunDir},
    trace::Trace,
};
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

/// Runs a scene in one piece, `whole`, and broken off after `samples` in `pieces`, which goes on with another
/// number of threads: both have the same trace and ledger. What the run says, in one piece and broken off.
pub(crate) fn assert_goes_on_with_the_same_bytes(
    scene: &Scene,
    folder: &Scratch,
    samples: usize,
) -> [RunInfo; 2] {
    let whole = run(scene, folder, "whole", 1);
    assert_eq!(whole.status, Status::Complete, "{:?}", whole.stop_reason);
    let dir = RunDir::create(folder.join("pieces")).expect("the folder is new");
    let mut seen = 0;
    let mut stop = |progress: &Progress| {
        seen += usize::from(progress.phase == "run");
        if seen == samples { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let broken = simulate(scene, &dir, &host(2), &mut stop).expect("the scene is sound");
    assert_eq!((broken.status, broken.samples), (Status::Interrupted, samples));
    drop(dir);
    let dir = RunDir::reopen(folder.join("pieces")).expect("it is there");
    let done = resume(&dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("it goes on");
    assert_eq!(done.status, Status::Complete);
    for file in ["trace.npy", "energy.npy"] {
        let bytes = |name: &str| std::fs::read(folder.join(name).join(file)).expect("readable");
        assert!(bytes("whole") == bytes("pieces"), "{file}");
    }
    [whole, broken]
}

/// Its recorded channels.
pub(crate) fn trace(folder: &Scratch, name: &str) -> Trace {
    Trace::read(folder.join(name).join("trace.npy")).expect("a trace")
}

/// A small bearing on a coarse mesh, dry and quiet by mass damping.
pub(crate) fn small(more: &str) -> Scene {
    let text = format!(
        "(bearing: \"NU 205\", model: reduced(modes_khz: 30, step_us: 0.25), film: None, defect: None,
          mesh: (size_mm: 0.7, roller_facets: 64), output: (frames: None),
          contact: (surface: arc, penalty_scale: 1, friction: 0.05),
          solver: (duration_ms: 2, mass_damping_per_s: 2000, structural_damping: None), {more})"
    );
    Scene::parse(&text, "here").expect("a valid scene")
}

/// A whole run in `folder`, which says how it comes on.
pub(crate) fn run_watched(
    scene: &Scene,
    threads: usize,
    folder: &Scratch,
    watch: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
) -> RunInfo {
    let dir = RunDir::create(folder.path()).expect("the folder is new");
    simulate(scene, &dir, &host(threads), watch).expect("the scene is sound")
}

pub(crate) fn column(run: &Run, name: &str) -> Vec<f64> {
    run.trace.channel(name).expect("readable").unwrap_or_else(|| panic!("the trace has no `{name}`"))
}

/// The same of a trace.
pub(crate) fn channel<'a>(trace: &'a Trace, name: &str) -> &'a [f64] {
    trace.get(name).unwrap_or_else(|| panic!("the trace has no `{name}`"))
}
