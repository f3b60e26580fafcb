//! One step of one body on one thread, motion of nodes included: time per element, by kind of element and
//! size.
//!
//! `strips` a structured block; `gather` the same block with its node numbers shuffled; `congruent` equal
//! discs, eight to a tile, quadrilaterals and triangles. Ten million elements need some gigabytes: set
//! `STRIBECK_BENCH_LARGE`. A kind named on the command line is measured alone.

use std::time::{Duration, Instant};

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

/// Median time of a step, measured for a second after a warm-up.
fn step_time(d: &mut Dynamics) -> Duration {
    let timed = |d: &mut Dynamics| {
        let start = Instant::now();
        d.step(&mut []);
        start.elapsed()
    };
    let start = Instant::now();
    while start.elapsed() < Duration::from_millis(300) {
        timed(d);
    }
    let (start, mut times) = (Instant::now(), Vec::new());
    while start.elapsed() < Duration::from_secs(1) || times.len() < 20 {
        times.push(timed(d));
    }
    times.sort_unstable();
    times[times.len() / 2]
}

fn main() {
    // `cargo test` runs benches too, with this flag: nothing to measure then.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let wanted = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let mut blocks = BLOCKS.to_vec();
    if std::env::var_os("STRIBECK_BENCH_LARGE").is_some() {
        blocks.push(LARGE);
    }
    let measure = |kind: &str, sizes: &[(usize, usize)], mesh: fn((usize, usize)) -> Mesh| {
        if wanted.as_ref().is_some_and(|wanted| !kind.contains(wanted.as_str())) {
            return;
        }
        for &size in sizes {
            let mesh = mesh(size);
            let elements = mesh.elements();
            let time = step_time(&mut in_motion(mesh));
            println!("{kind:<10}{elements:>9} elements {:>7.2} ns", time.as_nanos() as f64 / elements as f64);
        }
    };
    measure("strips", &blocks, |(columns, rows)| block(columns, rows));
    measure("gather", &blocks, |(columns, rows)| {
        let mut mesh = block(columns, rows);
        shuffle(&mut mesh);
        mesh
    });
    measure("congruent", &DISCS.map(|count| (count, 1)), |(count, _)| discs(count));
}
