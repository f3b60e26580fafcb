//! A run takes memory at its start, at searches and at samples, but not for its steps.

use std::ops::ControlFlow;

use stribeck_scene::scene::{FilmScene, Scene, Start};
use stribeck_simulation::run::host::Host;
use stribeck_simulation::simulate;
use stribeck_store::{run_dir::RunDir, run_info::RunInfo};
use stribeck_testing::Scratch;

/// One allocation anywhere in a step would be twenty times this share of the steps; searches that find more
/// than those before them, and grow a list, are far fewer.
const PER_STEP: f64 = 0.05;

/// Allocations of a short run of a coarse bearing, oiled or dry.
fn run(film: Option<FilmScene>, time_step_factor: f64) -> (RunInfo, u64) {
    let mut scene = Scene { name: "coarse".into(), ..Scene::default() };
    scene.film = film;
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    scene.solver.duration_ms = 0.3;
    scene.solver.start = Start::Sudden;
    scene.solver.time_step_factor = time_step_factor;
    let folder = Scratch::new("memory");
    let dir = RunDir::create(folder.path()).expect("the folder is new");
    let host = Host {
        threads: 1,
        version: "test".into(),
        commit: "test".into(),
        machine: "test".into(),
        wall_s: &|| 0.0,
        cpu_s: &|| 0.0,
    };
    let mut info = None;
    let taken = allocation_counter::measure(|| {
        info = simulate(&scene, &dir, &host, &mut |_| ControlFlow::Continue(())).ok();
    });
    (info.expect("the scene is sound"), taken.count_total)
}

/// Mass damping, contact with damping and friction, oil, gravity, cage, sensors, energies: two runs of the
/// same samples, one with three times the steps of the other, take the same memory.
#[test]
fn invariant_more_steps_between_samples_allocate_nothing_more() {
    for film in [None, Some(FilmScene::default())] {
        let (few, memory_of_few) = run(film.clone(), 0.9);
        let (many, memory_of_many) = run(film, 0.3);
        assert_eq!(few.samples, many.samples);
        let more = many.steps.abs_diff(few.steps) as f64;
        assert!(more > few.steps as f64, "{} and {} steps", few.steps, many.steps);
        let taken = memory_of_many.abs_diff(memory_of_few) as f64;
        assert!(
            taken < PER_STEP * more,
            "{taken} more allocations for {more} more steps, {memory_of_few} in all"
        );
    }
}
