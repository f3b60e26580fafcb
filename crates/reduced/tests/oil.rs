//! Oil in the reduced model: beside the full one from the same start, its energy, and that a run goes on to the same bytes.

use std::{fs, ops::ControlFlow};

use stribeck_bearing::simulation::{Host, Progress};
use stribeck_reduced::simulation::{resume, simulate};
use stribeck_scene::{
    lubrication::loaded_films,
    run_dir::RunDir,
    run_info::{RunInfo, Status},
    scene::{ModelScene, ReducedScene, Scene},
    trace::Trace,
};
use stribeck_testing::Scratch;

/// The paper's bearing, coarse, with its oil.
fn coarse(duration_ms: f64) -> Scene {
    let mut scene = Scene { name: "oil".into(), ..Scene::default() };
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, ..ReducedScene::default() });
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    scene.contact.penalty_scale = 0.2;
    scene.solver.duration_ms = duration_ms;
    scene.output.frames = None;
    scene
}

fn host() -> Host<'static> {
    Host {
        threads: 2,
        version: "test".into(),
        commit: "test".into(),
        machine: "test".into(),
        wall_s: &|| 0.0,
        cpu_s: &|| 0.0,
        ranks: None,
    }
}

fn run(scene: &Scene, folder: &Scratch, name: &str) -> RunInfo {
    let dir = RunDir::create(folder.join(name)).expect("the folder is new");
    let info = simulate(scene, &dir, &host(), &mut |_| ControlFlow::Continue(())).expect("the scene is sound");
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    info
}

fn trace(folder: &Scratch, name: &str, file: &str) -> Trace {
    Trace::read(folder.join(name).join(file)).expect("a trace")
}

fn channel<'a>(trace: &'a Trace, name: &str) -> &'a [f64] {
    trace.get(name).unwrap_or_else(|| panic!("the trace has no `{name}`"))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// In pieces: the same trace and ledger, films and all.
#[test]
fn invariant_a_run_with_oil_in_pieces_writes_the_same_bytes() {
    let folder = Scratch::create("oil-pieces");
    // Roller 1 goes into the defect, where films end and begin; another is not round, so that films remember a place on its rim.
    let scene = coarse(3.0).with_overrides(&["defects=[(on: roller(9), form: waviness(order: 8, amplitude_um: 1.0))]"
        .to_owned()]);
    let scene = scene.expect("a scene");
    run(&scene, &folder, "whole");
    let dir = RunDir::create(folder.join("pieces")).expect("the folder is new");
    let mut seen = 0;
    let mut stop = |progress: &Progress| {
        seen += usize::from(progress.phase == "run");
        if seen == 161 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let broken = simulate(&scene, &dir, &host(), &mut stop).expect("the scene is sound");
    assert_eq!((broken.status, broken.samples), (Status::Interrupted, 161));
    drop(dir);
    let dir = RunDir::reopen(folder.join("pieces")).expect("it is there");
    let done = resume(&dir, &host(), &mut |_| ControlFlow::Continue(())).expect("it goes on");
    assert_eq!(done.status, Status::Complete);
    for file in ["trace.npy", "energy.npy"] {
        let bytes = |name: &str| fs::read(folder.join(name).join(file)).expect("readable");
        assert!(bytes("whole") == bytes("pieces"), "{file}");
    }
}
