//! One step of one body on one thread, motion of nodes included: time per element, by kind of element and
//! size.
//!
//! `strips` a structured block; `gather` the same block with its node numbers shuffled; `congruent` equal
//! discs, eight to a tile, quadrilaterals and triangles. Ten million elements need some gigabytes: set
//! `STRIBECK_BENCH_LARGE`.

use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use stribeck_mesh::{Disc, Mesh, Rectangle};
use stribeck_solver::{Dynamics, Elastic, Model};

/// Edge of an element [m].
const SIZE: f64 = 0.5e-3;

/// Columns and rows of blocks from 10³ to 10⁶ elements.
const BLOCKS: [(usize, usize); 7] =
    [(40, 5), (400, 2), (40, 25), (100, 100), (420, 250), (625, 400), (1250, 800)];

/// And the block that is measured on request.
const LARGE: (usize, usize) = (4000, 2500);

/// Numbers of discs of 1064 elements.
const DISCS: [usize; 4] = [8, 24, 96, 960];

fn block(columns: usize, rows: usize) -> Mesh {
    let (width, height) = (columns as f64 * SIZE, rows as f64 * SIZE);
    let mut mesh = Mesh::new();
    let rectangle = Rectangle { x0: 0.0, y0: 0.0, width, height, columns, rows };
    mesh.add("block", &rectangle.part().expect("a rectangle that can be made"));
    mesh
}

/// Gives the nodes of a mesh numbers without pattern (Knuth's linear congruential generator).
fn shuffle(mesh: &mut Mesh) {
    let n = mesh.x.len();
    let mut number: Vec<u32> = (0..n as u32).collect();
    let mut noise = 1_u64;
    for i in (1..n).rev() {
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        number.swap(i, (noise >> 33) as usize % (i + 1));
    }
    let (x, y) = (mesh.x.clone(), mesh.y.clone());
    for (old, &new) in number.iter().enumerate() {
        (mesh.x[new as usize], mesh.y[new as usize]) = (x[old], y[old]);
    }
    mesh.quads.iter_mut().for_each(|q| *q = q.map(|c| number[c as usize]));
}

fn discs(count: usize) -> Mesh {
    let disc = Disc { radius: 9e-3, facets: 112, size: SIZE, rotation: 0.0 };
    let disc = disc.part().expect("a disc that can be made");
    let mut mesh = Mesh::new();
    (0..count).for_each(|i| {
        mesh.add(format!("disc {i}"), &disc.translated(0.02 * i as f64, 0.0));
    });
    mesh
}

/// A mesh of steel in motion, small enough to stay elastic for ever.
fn in_motion(mesh: Mesh) -> Dynamics {
    let steel = Elastic::new(200e9, 0.3, 7850.0).expect("steel is a possible material");
    let model = Model::new(mesh, steel, 0.02).expect("a positive thickness");
    let mut d = Dynamics::new(&model, &vec![false; model.mesh.x.len()], 1).expect("a model that can run");
    // A third of the critical step of a square; the smallest cells of a disc need it.
    d.set_time_step(25e-9).expect("a positive time step");
    d.state.vx.iter_mut().enumerate().for_each(|(n, v)| *v = 1e-2 * (0.37 * n as f64).sin());
    d
}

fn kernel(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("kernel");
    group.sample_size(20).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    let mut blocks = BLOCKS.to_vec();
    if std::env::var_os("STRIBECK_BENCH_LARGE").is_some() {
        blocks.push(LARGE);
    }
    // Made one at a time: all of them together would not fit.
    let strips = blocks
        .iter()
        .map(|&(c, r)| ("strips", c * r, Box::new(move || block(c, r)) as Box<dyn Fn() -> Mesh>));
    let gather = blocks.iter().map(|&(c, r)| {
        let mesh = move || {
            let mut mesh = block(c, r);
            shuffle(&mut mesh);
            mesh
        };
        ("gather", c * r, Box::new(mesh) as Box<dyn Fn() -> Mesh>)
    });
    let one = discs(1).elements();
    let congruent =
        DISCS.iter().map(|&n| ("congruent", n * one, Box::new(move || discs(n)) as Box<dyn Fn() -> Mesh>));
    for (kind, elements, mesh) in strips.chain(gather).chain(congruent) {
        let id = BenchmarkId::new(kind, elements);
        group.throughput(Throughput::Elements(elements as u64));
        // Only the models named on the command line are made.
        let mut d = None;
        group.bench_function(id, |bench| {
            let d = d.get_or_insert_with(|| in_motion(mesh()));
            bench.iter(|| d.step(&mut []));
        });
    }
    group.finish();
}

criterion_group!(benches, kernel);
criterion_main!(benches);
