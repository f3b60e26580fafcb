//! How far the kernel is from what this machine can do, measured in one run on one thread.
//!
//! Peak arithmetic in double precision, bandwidth beyond the second- and the third-level cache, then the
//! whole step on structured blocks. The limit is the larger of (operations / peak) and (bytes / bandwidth);
//! the fraction is the limit over the time measured. Every measurement is the shortest of many short runs,
//! taken in turn, so that other programs on the machine disturb all of them alike.

use std::hint::black_box;
use std::time::Instant;

use multiversion::multiversion;
use stribeck_mesh::{Mesh, Rectangle};
use stribeck_solver::{Dynamics, Elastic, Model};

/// What one element and its node cost in a strip of congruent quadrilaterals, counted in the sources; a
/// product with a sum in one rounding counts as two operations.
///
/// | where | product with sum | products | sums |
/// |---|---|---|---|
/// | `element.rs`, `QuadMetric::forces`: diagonals | 0 | 0 | 4 |
/// | changes of their inner products | 6 | 0 | 0 |
/// | tensions | 6 | 3 | 0 |
/// | forces along the diagonals | 4 | 4 | 0 |
/// | hourglass forces | 4 | 2 | 6 |
/// | corner forces | 4 | 0 | 8 |
/// | `strip.rs`: sums at the nodes | 0 | 0 | 8 |
/// | `advance.rs`, without damping | 4 | 0 | 2 |
const OPERATIONS: f64 = 2.0 * 28.0 + 9.0 + 28.0;

/// Bytes between the fields of a node and the caches that do not hold them: x, y, vx, vy in and out, Δt/m in.
/// Forces stay in the scratch of a tile, which does not leave the second-level cache.
const BYTES: f64 = 9.0 * 8.0;

/// Columns and rows: fields of 4 MB, beyond most second-level caches, and of 100 MB.
const BLOCKS: [(usize, usize); 2] = [(420, 250), (2000, 1250)];

/// And of 400 MB, on request: beyond most third-level caches too.
const LARGE: (usize, usize) = (4000, 2500);

/// Elements of the arithmetic loop: two arrays that stay in the first-level cache.
const NEAR: usize = 1024;

/// Dependent operations on each of its elements, apart and fused: enough to hide loads and stores, few enough
/// that the processor sees several elements at once. These came out fastest.
const APART: usize = 6;
/// See [`APART`].
const FUSED: usize = 8;

/// Rounds of all measurements.
const ROUNDS: usize = 100;

/// Products and sums in equal number, not fused.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw+avx512cd+avx2+bmi2", "x86_64+avx2+bmi2"))]
fn separate(p: &mut [f64; NEAR], s: &mut [f64; NEAR], factor: f64, term: f64) {
    for i in 0..NEAR {
        let (mut a, mut b) = (p[i], s[i]);
        for _ in 0..APART / 2 {
            a *= factor;
            b += term;
            a += term;
            b *= factor;
        }
        p[i] = a;
        s[i] = b;
    }
}

/// The same number of operations, fused in pairs.
#[multiversion(targets(
    "x86_64+avx512f+avx512vl+avx512dq+avx512bw+avx512cd+avx2+bmi2+fma",
    "x86_64+avx2+bmi2+fma"
))]
fn fused(p: &mut [f64; NEAR], s: &mut [f64; NEAR], factor: f64, term: f64) {
    for i in 0..NEAR {
        let (mut a, mut b) = (p[i], s[i]);
        for _ in 0..FUSED {
            a = a.mul_add(factor, term);
            b = b.mul_add(factor, term);
        }
        p[i] = a;
        s[i] = b;
    }
}

/// The motion of nodes without their forces: the memory traffic of a step, and nothing else.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx512bw+avx512cd+avx2+bmi2", "x86_64+avx2+bmi2"))]
fn stream(fields: &mut [Vec<f64>; 5], dt: f64) {
    let [x, y, vx, vy, kick] = fields;
    let n = x.len();
    let (y, vx, vy, kick) = (&mut y[..n], &mut vx[..n], &mut vy[..n], &kick[..n]);
    for i in 0..n {
        let (a, b) = (vx[i] + kick[i], vy[i] + kick[i]);
        vx[i] = a;
        vy[i] = b;
        x[i] += dt * a;
        y[i] += dt * b;
    }
}

/// Whether this machine multiplies and adds in one instruction; without it `mul_add` is a library call.
fn has_fused() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(target_arch = "x86_64"))]
    cfg!(target_arch = "aarch64")
}

/// Shortest and median time of a repeated measurement [s].
#[derive(Default)]
struct Times(Vec<f64>);

impl Times {
    fn take(&mut self, work: impl FnOnce()) {
        let start = Instant::now();
        work();
        self.0.push(start.elapsed().as_secs_f64());
    }

    fn shortest(&self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }

    fn median(&self) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    }
}

fn block(columns: usize, rows: usize) -> Dynamics {
    let size = 0.5e-3;
    let (width, height) = (columns as f64 * size, rows as f64 * size);
    let rectangle = Rectangle { x0: 0.0, y0: 0.0, width, height, columns, rows };
    let mut mesh = Mesh::new();
    mesh.add("block", &rectangle.part().expect("a rectangle that can be made"));
    let steel = Elastic::new(200e9, 0.3, 7850.0).expect("steel is a possible material");
    let model = Model::new(mesh, steel, 0.02).expect("a positive thickness");
    let mut d = Dynamics::new(&model, &vec![false; model.mesh.x.len()], 1).expect("a model that can run");
    d.set_time_step(50e-9).expect("a positive time step");
    d.state.vx.iter_mut().enumerate().for_each(|(n, v)| *v = 1e-2 * (0.37 * n as f64).sin());
    d
}

fn main() {
    // `cargo test` runs benches too, with this flag: nothing to measure then.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let mut near = (Box::new([1.0; NEAR]), Box::new([0.0; NEAR]));
    let (factor, term) = (black_box(0.999_999), black_box(1e-3));
    let repeats = 400;
    let mut sizes = BLOCKS.to_vec();
    if std::env::var_os("STRIBECK_BENCH_LARGE").is_some() {
        sizes.push(LARGE);
    }
    let mut blocks: Vec<_> =
        sizes.iter().map(|&(columns, rows)| (columns * rows, block(columns, rows))).collect();
    let mut fields: Vec<_> = sizes
        .iter()
        .map(|(columns, rows)| [(); 5].map(|()| vec![1e-9; (columns + 1) * (rows + 1)]))
        .collect();
    let steps: Vec<_> = blocks.iter().map(|(elements, _)| (4_000_000 / elements).max(2)).collect();

    let (mut apart, mut together) = (Times::default(), Times::default());
    let times = || sizes.iter().map(|_| Times::default()).collect::<Vec<_>>();
    let (mut streams, mut sweeps) = (times(), times());
    for _ in 0..ROUNDS {
        apart.take(|| (0..repeats).for_each(|_| separate(&mut near.0, &mut near.1, factor, term)));
        if has_fused() {
            together.take(|| (0..repeats).for_each(|_| fused(&mut near.0, &mut near.1, factor, term)));
        }
        for b in 0..sizes.len() {
            streams[b].take(|| (0..steps[b]).for_each(|_| stream(&mut fields[b], black_box(1e-9))));
            sweeps[b].take(|| (0..steps[b]).for_each(|_| blocks[b].1.step(&mut [])));
        }
    }
    black_box((&near, &fields));

    let chains = (repeats * NEAR * 2) as f64;
    let peak = chains * APART as f64 / apart.shortest();
    println!("one thread, double precision");
    println!("  products and sums apart   {:6.1} GFlop/s", 1e-9 * peak);
    let mut best = peak;
    if has_fused() {
        best = 2.0 * chains * FUSED as f64 / together.shortest();
        println!("  fused                     {:6.1} GFlop/s", 1e-9 * best);
    }
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    println!("  load average              {}", load.split_whitespace().next().unwrap_or("unknown"));
    let arithmetic = 1e9 * OPERATIONS / best;
    for (b, (elements, _)) in blocks.iter().enumerate() {
        let nodes = fields[b][0].len() as f64;
        let bandwidth = BYTES * nodes * steps[b] as f64 / streams[b].shortest();
        let traffic = 1e9 * BYTES / bandwidth;
        let ns = |seconds: f64| 1e9 * seconds / (elements * steps[b]) as f64;
        let limit = arithmetic.max(traffic);
        println!("{elements} quads, {:.0} MB of fields", 40e-6 * nodes);
        println!("  streaming                 {:6.1} GB/s", 1e-9 * bandwidth);
        println!("  {:.0} operations           {arithmetic:6.2} ns", OPERATIONS);
        println!("  {BYTES:.0} bytes                  {traffic:6.2} ns");
        let (shortest, median) = (ns(sweeps[b].shortest()), ns(sweeps[b].median()));
        println!("  whole step                {shortest:6.2} ns per element (median {median:.2})");
        println!("  of the limit              {:6.0} %", 100.0 * limit / shortest);
    }
}
