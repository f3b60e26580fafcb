//! Steps of the paper's bearing in the modes below 30 kHz, with a sample after every fifth one as in a run:
//! how long one takes as the rollers turn. The modes are made once and kept in the folder for temporary
//! files.

use std::path::Path;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use stribeck_reduced::bearing::Bearing;
use stribeck_reduced::motion::{BearingInMotion, Saved};
use stribeck_scene::scene::Scene;
use stribeck_simulation::reduction::{cache, dense, modal_bearing};

/// Steps between two samples.
const STEPS: usize = 5;

/// Samples before the first measurement: the start has been left, and rollers have passed the spall.
const FIRST: usize = 2000;

fn step(criterion: &mut Criterion) {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/scenes");
    let scene = Scene::read(scenes.join("reduced.ron")).expect("the scene is sound");
    let (polygons, arcs) = ("polygons", "arcs");
    let arcs = (arcs, scene.clone().with_overrides(&["contact.surface=arc".to_owned()]).expect("a scene"));
    let mut group = criterion.benchmark_group("step of the reduced bearing");
    group.sample_size(50).warm_up_time(Duration::from_millis(500)).measurement_time(Duration::from_secs(3));
    group.throughput(Throughput::Elements(STEPS as u64));
    for (name, scene) in [(polygons, scene), arcs] {
        let kept = std::env::temp_dir().join("stribeck-bench");
        let (mesh, _) = cache::reduced_mesh(&scene, Some(&kept)).expect("the scene can be reduced");
        let scene = scene.resolve();
        let modal = modal_bearing(&scene, mesh.reduction).expect("a sound scene");
        let bearing = Bearing::new(modal, scene.interval / STEPS as f64).expect("a bearing");
        let state = bearing.at_start(&dense::solve).expect("an equilibrium");
        let saved = Saved::first(&bearing, state);
        let mut motion = BearingInMotion::new(bearing, saved);
        let sample = |motion: &mut BearingInMotion| motion.interval(STEPS);
        (0..FIRST).for_each(|_| _ = sample(&mut motion));
        group.bench_function(name, |bench| bench.iter(|| sample(&mut motion)));
    }
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
