//! One step of the paper's bearing (105 000 elements, 24 rollers), and of its graded version where there is one, on one
//! and two threads: everything, without contact, contact alone.
//!
//! The run's own preload takes a minute; here the load pushes the adapter and the outer ring through the clearance
//! while the rollers already turn, so that about as many contacts carry.

mod motion;

use std::path::Path;
use std::time::Duration;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use motion::{CLOSING, machine};
use stribeck_bearing::assembly::Machine;
use stribeck_scene::scene::Scene;
use stribeck_solver::Force;
use stribeck_solver::state::NodeForces;

/// Runs work inside a pool of that many threads, or right here for one.
fn within<T: Send>(pool: Option<&micropool::ThreadPool>, work: impl FnOnce() -> T + Send) -> T {
    match pool {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

fn step(criterion: &mut Criterion) {
    let lean = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/scenes/lean.ron");
    let mut scenes = vec![("paper", Scene::default())];
    scenes.extend(Scene::read(&lean).ok().map(|scene| ("lean", scene)));
    for (name, scene) in &scenes {
        let mut group = criterion.benchmark_group(format!("step of the {name} scene"));
        group
            .sample_size(20)
            .warm_up_time(Duration::from_millis(500))
            .measurement_time(Duration::from_secs(2));
        for threads in [1, 2] {
            let pool = (threads > 1).then(|| {
                micropool::ThreadPoolBuilder::default()
                    .num_threads(threads - 1)
                    .idle_spin_cycles(20_000)
                    .build()
            });
            let pool = pool.as_ref();
            let (mut m, elements) = machine(scene, threads);
            group.throughput(Throughput::Elements(elements as u64));
            within(pool, || {
                (0..CLOSING).for_each(|_| m.dynamics.step(&mut [&mut m.load, &mut m.contacts]));
            });
            let carrying = m.contacts.resultants().filter(|r| r.penetration > 0.0).count();
            println!("{name}: {elements} elements, {carrying} pairs carry");

            let Machine { dynamics, contacts, load, .. } = &mut m;
            let n = dynamics.state.x.len();
            let mut force = NodeForces::zeros(n);
            let mut at = dynamics.moment();
            group.bench_function(format!("contact alone, {threads} threads"), |bench| {
                within(pool, || {
                    bench.iter(|| {
                        at.step += 1;
                        contacts.accumulate(at, &mut force);
                    });
                });
            });
            group.bench_function(format!("everything, {threads} threads"), |bench| {
                within(pool, || bench.iter(|| dynamics.step(&mut [load, contacts])));
            });
            group.bench_function(format!("without contact, {threads} threads"), |bench| {
                within(pool, || bench.iter(|| dynamics.step(&mut [load])));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
