//! A bearing that follows its handles, on this machine: it is the bearing of the program until one is turned.

use std::ops::ControlFlow;

use stribeck_lab::{
    Engine,
    content::Content,
    handles::{HANDLES, at},
    page,
    readings::PER_SAMPLE,
};
use stribeck_reduced::motion::{BearingInMotion, Saved};
use stribeck_scene::scene::{ModelScene, ReducedScene, Scene};
use stribeck_simulation::run::host::Host;
use stribeck_simulation::{
    reduced::{Prepared, prepared},
    simulate,
};
use stribeck_store::run_dir::RunDir;
use stribeck_testing::{Scratch, assert_refused};

/// The paper's bearing, coarse.
fn coarse(duration_ms: f64) -> Scene {
    let mut scene = Scene { name: "coarse".into(), ..Scene::default() };
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, ..ReducedScene::default() });
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    scene.contact.penalty_scale = 0.2;
    scene.solver.duration_ms = duration_ms;
    scene.output.frames = None;
    scene
}

fn content(folder: &Scratch) -> Content {
    page::content(&coarse(2.0), Some(folder.path())).expect("a valid scene")
}

fn engine(content: &Content) -> Engine {
    Engine::new(content.clone()).expect("a bearing")
}

fn mean(samples: &[f64], column: usize) -> f64 {
    let rows = samples.len() / PER_SAMPLE;
    samples.iter().skip(column).step_by(PER_SAMPLE).sum::<f64>() / rows as f64
}

/// The page's step is the program's: the same bits, though the page has other sensors.
/// `invariant_a_prepared_bearing_is_that_of_a_run` of `stribeck-simulation` holds `prepared` against a run.
#[test]
fn invariant_the_first_samples_are_those_of_the_program() {
    let folder = Scratch::create("lab-run");
    let Prepared { steps_per_sample, bearing, start, .. } =
        prepared(&coarse(2.0).resolve(), Some(folder.path())).expect("a valid scene");
    let start = Saved::first(&bearing, start);
    let mut motion = BearingInMotion::new(bearing, start);
    let mut engine = engine(&content(&folder));
    for sample in 0..200 {
        motion.interval(steps_per_sample);
        engine.run(1).expect("a sound run");
        let there: Vec<f64> =
            motion.rollers().flat_map(|roller| [roller.outer, roller.inner].concat()).collect();
        assert_eq!(engine.forces(), there, "sample {sample}");
    }
}

#[test]
fn roundtrip_content_in_bytes() {
    let folder = Scratch::create("lab-bytes");
    let content = content(&folder);
    let bytes = content.to_bytes().expect("memory");
    let back = Content::from_bytes(&bytes).expect("whole");
    // What moves the bearing is kept to the last bit; what sensors measure beyond the modes to single
    // precision.
    assert_eq!(back.start, content.start);
    assert_eq!(back.modal.parameters, content.modal.parameters);
    assert_eq!(back.modal.reduction.shapes, content.modal.reduction.shapes);
    assert_eq!(
        back.modal.reduction.springs.as_ref().map(|s| &s.stiffness),
        content.modal.reduction.springs.as_ref().map(|s| &s.stiffness)
    );
    let [a, b] = [&back, &content].map(|c| c.modal.reduction.sensors[0].residual[7][1]);
    assert!((a - b).abs() <= 1e-7 * b.abs(), "{a} {b}");
    for end in [0, 100, bytes.len() / 2, bytes.len() - 1] {
        assert_refused(Content::from_bytes(&bytes[..end]), "the file is damaged, or of another version");
    }
}

/// In the guide's lab, whose ring is out of round under its load, a spall that was moved left a part of its
/// floor behind; films over that made the run diverge within 20 ms.
#[test]
fn issue_a_spall_moves_in_a_bearing_with_oil() {
    let folder = Scratch::create("lab-oil");
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/lab.ron");
    let scene = Scene::read(file).expect("a scene of the repository");
    let content = page::content(&scene, Some(folder.path())).expect("a valid scene");
    for (handle, value) in [(at::SPALL_RING, 0.0), (at::SPALL_LENGTH, 10.5), (at::SPALL_ANGLE, 93.0)] {
        let mut engine = engine(&content);
        engine.ask(handle, value).expect("in range");
        assert!(engine.apply().expect("a bearing"), "it starts anew");
        if let Err(why) = engine.run(2000) {
            panic!("handle {handle} at {value}: {why}");
        }
    }
}

/// Rollers carry the load and the weight of ring and housing, on average over the passing of some rollers;
/// after the load is turned, the new one.
#[test]
fn conserves_the_load_that_rollers_carry_after_it_was_turned() {
    // Balance of momentum of ring and housing over a time in which their velocity hardly changes.
    const TOLERANCE: f64 = 1e-3;
    let folder = Scratch::create("lab-load");
    let content = content(&folder);
    let mut engine = engine(&content);
    let weight = content.modal.parameters.gravity * content.modal.reduction.structure_mass;
    for load in [content.handles[at::LOAD], 0.6 * content.handles[at::LOAD]] {
        engine.ask(at::LOAD, load).expect("in range");
        assert!(!engine.apply().expect("a bearing"), "the load is turned while the bearing runs");
        engine.run(2000).expect("a sound run");
        engine.run(5000).expect("a sound run");
        let carried = mean(engine.samples(), 6);
        assert!((carried / (load + weight) - 1.0).abs() < TOLERANCE, "{carried} N of {} N", load + weight);
    }
}

/// Handles that are turned back leave the scene as it was, to the last bit.
#[test]
fn invariant_handles_turned_back_give_the_scene_again() {
    let folder = Scratch::create("lab-back");
    let content = content(&folder);
    let mut fresh = engine(&content);
    fresh.run(50).expect("a sound run");
    let mut turned = engine(&content);
    for (handle, to) in [
        (at::SPALL_RING, 0.0),
        (at::SPALL_DEPTH, 0.1),
        (at::ARCS, 1.0),
        (at::FACETS, 56.0),
        (at::CLEARANCE, 20.0),
        (at::VISCOSITY, 0.1),
        (at::SPEED, 900.0),
    ] {
        turned.ask(handle, to).expect("in range");
        turned.apply().unwrap_or_else(|error| panic!("{}: {error}", HANDLES[handle].name));
        turned.run(50).unwrap_or_else(|error| panic!("{}: {error}", HANDLES[handle].name));
    }
    content.handles.iter().enumerate().for_each(|(n, value)| turned.ask(n, *value).expect("in range"));
    assert!(turned.apply().expect("the scene"), "it starts anew");
    turned.run(50).expect("a sound run");
    assert_eq!(turned.forces(), fresh.forces());
}

/// A spall that is moved is met where it lies: the roller over it is unloaded there and nowhere else.
#[test]
fn behaves_a_spall_that_is_moved_unloads_the_roller_over_it() {
    let folder = Scratch::create("lab-spall");
    let content = content(&folder);
    let mut engine = engine(&content);
    let start = content.modal.parameters.rollers.clone();
    // Two rollers of the load zone, which lies at the top.
    let over = |angle: f64| {
        start.iter().position(|r| (r.angle - angle.to_radians()).abs() < 0.14).expect("a roller")
    };
    let forces = |engine: &mut Engine, place: f64| {
        engine.ask(at::SPALL_ANGLE, place).expect("in range");
        engine.apply().expect("a bearing");
        engine.run(1).expect("a sound run");
        engine.forces()
    };
    let size = |forces: &[f64], roller: usize| forces[4 * roller].hypot(forces[4 * roller + 1]);
    let roller = over(109.0);
    let place = start[roller].angle.to_degrees();
    let [away, under] = [forces(&mut engine, place + 60.0), forces(&mut engine, place)];
    let [away, under] = [away, under].map(|forces| size(&forces, roller));
    assert!(away > 1e3 && under < 0.05 * away, "{away} N without, {under} N over the spall");
}

#[test]
fn refuses_handles_that_no_bearing_has() {
    let folder = Scratch::create("lab-refused");
    let content = content(&folder);
    let mut engine = engine(&content);
    assert_refused(engine.ask(at::SPEED, f64::NAN), "must be between -30000 and 30000");
    // Walls that leave no floor: the handles stay as they were, and the bearing runs on.
    engine.ask(at::SPALL_LENGTH, 0.2).expect("in range");
    engine.ask(at::SPALL_DEPTH, 2.0).expect("in range");
    engine.ask(at::SPALL_SLOPE, 20.0).expect("in range");
    assert_refused(engine.apply(), "floor");
    assert_eq!(engine.handles(), &content.handles);
    engine.run(10).expect("a sound run");
}

/// A run that goes wrong stops at the same step as the program's, and says the same.
#[test]
fn issue_a_run_that_stops_says_what_the_program_says() {
    let folder = Scratch::create("lab-stops");
    type Change = fn(&mut Scene);
    let kinds: [(&str, Change); 3] = [
        ("energy is off by", |scene| scene.operation.speed_rpm = 20_000.0),
        ("the penetration of a contact has reached", |scene| scene.guards.penetration_stop_percent = 1.0),
        ("the cage has cut through a ring", |scene| scene.solver.duration_ms = 300.0),
    ];
    for (n, (words, change)) in kinds.into_iter().enumerate() {
        let mut scene = coarse(2.0);
        scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, step_us: 5.0 });
        change(&mut scene);
        let dir = RunDir::create(folder.join(format!("run {n}"))).expect("a new folder");
        let info =
            simulate(&scene, &dir, &host(), &mut |_| ControlFlow::Continue(())).expect("a valid scene");
        let said = info.stop_reason.expect("it stops");
        assert!(said.contains(words), "{said}");
        let content = page::content(&scene, Some(folder.path())).expect("a valid scene");
        let mut engine = Engine::new(content).expect("a bearing");
        let why = (0..30_000).find_map(|_| match engine.run(1) {
            Ok(began) => began,
            Err(error) => Some(error.to_string()),
        });
        assert_eq!(why.as_ref(), Some(&said));
        // Where nothing but the cage was lost, the page begins again.
        assert_eq!(engine.picture()[0] == 0.0, words.contains("cage"), "{words}");
    }
}

/// A program around the run whose clocks stand still.
fn host() -> Host<'static> {
    let clock: &dyn Fn() -> f64 = &|| 0.0;
    let [version, commit, machine] = ["test"; 3].map(String::from);
    Host { threads: 1, version, commit, machine, wall_s: clock, cpu_s: clock }
}
