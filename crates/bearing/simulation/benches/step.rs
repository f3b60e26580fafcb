//! One step of the paper's bearing (105 000 elements, 24 rollers), and of its graded version where there is
//! one, on one and two threads: everything, without contact, contact alone.
//!
//! The run's own preload takes a minute; here the load pushes the adapter and the outer ring through the
//! clearance while the rollers already turn, so that about as many contacts carry.

mod motion;

use std::path::Path;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use motion::{CLOSING, bearing};
use stribeck_scene::scene::Scene;
use stribeck_solver::Force;
use stribeck_solver::state::NodeForces;
use stribeck_system::{Parts, System, Workers};

fn step(criterion: &mut Criterion) {
    let lean = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fixtures/scenes/lean.ron");
    let mut scenes = vec![("paper", Scene::default())];
    scenes.extend(Scene::read(&lean).ok().map(|scene| ("lean", scene)));
    for (name, scene) in &scenes {
        let mut group = criterion.benchmark_group(format!("step of the {name} scene"));
        group
            .sample_size(20)
            .warm_up_time(Duration::from_millis(500))
            .measurement_time(Duration::from_secs(2));
        for threads in [1, 2] {
            let workers = Workers::new(threads).expect("threads");
            let (mut m, elements) = bearing(scene, threads);
            group.throughput(Throughput::Elements(elements as u64));
            let system = &mut m.system;
            let step = |system: &mut System| system.step().expect("a time step is set");
            workers.run(|| (0..CLOSING).for_each(|_| step(system)));
            let carrying = system.resultants().filter(|r| r.penetration > 0.0).count();
            println!("{name}: {elements} elements, {carrying} pairs carry");
            group.bench_function(format!("everything, {threads} threads"), |bench| {
                workers.run(|| bench.iter(|| step(system)));
            });

            let Parts { mut dynamics, contacts, mut others, .. } = m.system.into_parts();
            let mut contacts = contacts.expect("a bearing has contacts");
            let n = dynamics.state.x.len();
            let mut force = NodeForces::zeros(n);
            let mut at = dynamics.moment();
            group.bench_function(format!("contact alone, {threads} threads"), |bench| {
                workers.run(|| {
                    bench.iter(|| {
                        at.step += 1;
                        contacts.accumulate(at, &mut force);
                    });
                });
            });
            group.bench_function(format!("without contact, {threads} threads"), |bench| {
                workers.run(|| bench.iter(|| dynamics.step(&mut [&mut *others])));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
