//! Contact of 24 discs between two rings, 0.5 mm facets, one thread: friction and damping included. On
//! splines, with points one by one as well.
//!
//! `forces` one evaluation, the searches that fall due included; `search` one evaluation with a search.
//! Positions rest while the step number advances, so that candidates become inactive and active as they do in
//! motion.

use std::f64::consts::TAU;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Smoothing, Surface};
use stribeck_mesh::{Annulus, Disc, Mesh, Placed};
use stribeck_solver::{Dynamics, Elastic, Force, Model, state::NodeForces};

/// Radii of the two circles that the discs roll on, and of the discs [m].
const OUTER: f64 = 0.1;
const INNER: f64 = 0.082;
const DISC: f64 = 9e-3;

/// Edge of a facet [m].
const SIZE: f64 = 0.5e-3;

/// How far the discs sink into the outer ring [m]: about what 5 kN on 20 mm do.
const SUNK: f64 = 5e-6;

const DISCS: usize = 24;

/// Time step [s] and surface speed of rolling [m/s], which set how often a search falls due.
const TIME_STEP: f64 = 35e-9;
const SPEED: f64 = 5.0;

fn ring(inner_radius: f64, outer_radius: f64, at: f64) -> Annulus {
    let facets = (TAU * at / SIZE).round() as usize;
    Annulus { inner_radius, outer_radius, facets, layers: 4, start_angle: 0.0, grooves: Vec::new() }
}

/// Mean of the nodes.
fn centre_of(slots: &[u32], x: &[f64], y: &[f64]) -> [f64; 2] {
    [x, y].map(|x| slots.iter().map(|&n| x[n as usize]).sum::<f64>() / slots.len() as f64)
}

/// The bodies laid out, their contacts, and rolling velocities.
fn scene(method: Method, splines: bool) -> (Dynamics, Contacts) {
    let mut mesh = Mesh::new();
    let mut add = |name: &str, part| mesh.add(name, &part);
    let outer = add("outer", ring(OUTER, OUTER + 2e-3, OUTER).part().expect("a ring that can be made"));
    let inner = add("inner", ring(INNER - 2e-3, INNER, INNER).part().expect("a ring that can be made"));
    let disc = Disc { radius: DISC, facets: 112, size: SIZE, rotation: 0.0 };
    let disc = disc.part().expect("a disc that can be made");
    let path = OUTER - DISC + SUNK;
    let discs: Vec<Placed> = (0..DISCS)
        .map(|i| {
            let (s, c) = (TAU * i as f64 / DISCS as f64).sin_cos();
            add("disc", disc.translated(path * c, path * s))
        })
        .collect();
    let steel = Elastic::new(200e9, 0.3, 7850.0).expect("steel is a possible material");
    let model = Model::new(mesh, steel, 0.02).expect("a positive thickness");
    let mut d = Dynamics::new(&model, &vec![true; model.mesh.x.len()], 1).expect("a model that can run");
    d.set_time_step(TIME_STEP).expect("a positive time step");
    let (x, y) = (d.state.x.clone(), d.state.y.clone());
    for n in 0..x.len() {
        (d.state.vx[n], d.state.vy[n]) = (-SPEED / OUTER * y[n], SPEED / OUTER * x[n]);
    }

    let named = discs.iter().map(|p| (p, "rim"));
    let surfaces = [(&outer, "inner"), (&inner, "outer")].into_iter().chain(named).map(|(placed, name)| {
        let surface = placed.surface(name).expect("a surface of that name");
        let slots = surface.nodes.iter().map(|&n| d.layout().slot_of_node[n as usize]).collect();
        let surface = Surface::new(name, slots, surface.closed, &x, &y).expect("a surface with facets");
        if !splines {
            return surface;
        }
        let centre = centre_of(&surface.slots, &x, &y);
        let arcs = surface.smoothed(Smoothing::Arc { centre }, &x, &y).expect("circles");
        arcs.splined(&x, &y)
    });
    let law = Law::penalty(200e9 / SIZE).and_then(|law| law.with_damping(0.1, 0.5 * 7850.0 * SIZE));
    let law = law.and_then(|law| law.with_friction(0.005));
    let law = law.and_then(|law| law.with_onset(if splines { 5e-7 } else { 0.0 })).expect("a possible law");
    let pairs: Vec<PairSpec> = (0..DISCS)
        .flat_map(|i| [0, 1].map(|second| PairSpec { first: 2 + i, second, law, method, sides: Sides::Both }))
        .collect();
    let contacts = Contacts::new(surfaces.collect(), &pairs, 0.02, &x, &y).expect("surfaces that exist");
    (d, contacts)
}

fn contact(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("contact");
    group.sample_size(30).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
    for (name, points, splines, together) in [
        ("collocated", None, false, true),
        ("integrated, 4 points", Some(4), false, true),
        ("integrated, 16 points", Some(16), false, true),
        ("splines, 8 points", Some(8), true, true),
        ("splines, 12 points", Some(12), true, true),
        ("splines, 12 points one by one", Some(12), true, false),
    ] {
        let method = points.map_or(Method::Collocated, |points| Method::Integrated { points });
        let (d, mut contacts) = scene(method, splines);
        contacts.set_together(together);
        let n = d.state.x.len();
        let mut force = NodeForces::zeros(n);
        let mut at = d.moment();
        contacts.accumulate(at, &mut force);
        let touching = contacts.resultants().filter(|r| r.penetration > 0.0).count();
        assert_eq!(touching, DISCS, "every disc touches the outer ring");
        group.bench_function(format!("forces, {name}"), |bench| {
            bench.iter(|| {
                at.step += 1;
                contacts.accumulate(at, &mut force);
            });
        });
        group.bench_function(format!("search, {name}"), |bench| {
            bench.iter(|| {
                // Whatever was found is out of date by then.
                at.step += 1000;
                contacts.accumulate(at, &mut force);
            });
        });
    }
    group.finish();
}

criterion_group!(benches, contact);
criterion_main!(benches);
