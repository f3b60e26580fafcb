//! The same bits for any number of threads and across a checkpoint; rigid bodies keep their shape.

mod common;

use common::*;
use stribeck_mesh::{Annulus, Disc, Groove, Mesh};
use stribeck_solver::{Behaviour, Dynamics, Force, Model, NodeMotion, force::NodalLoad};
use stribeck_testing::Noise;

/// A scene with every kind of tile: a plate and a ring of several tiles, congruent discs, a driven
/// ring, a rigid block.
fn everything() -> Model {
    let mut mesh = Mesh::new();
    mesh.add("plate", &rectangle(0.15, 0.15, 149, 149));
    let disc = Disc { radius: 0.01, facets: 24, size: 3e-3, rotation: 0.0 }.part().expect("a disc");
    for i in 0..10 {
        mesh.add(format!("disc {i}"), &disc.rotated(0.4 * i as f64).translated(0.03 * i as f64, 0.2));
    }
    let ring = Annulus {
        inner_radius: 0.04,
        outer_radius: 0.05,
        facets: 60,
        layers: 3,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    // Wide enough for several tiles, cut across its rows.
    let grooves = vec![Groove::rectangular(0.3, 0.02, 1e-3)];
    let wide = Annulus { inner_radius: 0.2, outer_radius: 0.21, facets: 700, layers: 12, grooves, ..ring };
    mesh.add("wide ring", &wide.part().expect("a ring").translated(0.8, 0.0));
    let ring = mesh.add("ring", &ring.part().expect("a ring").translated(0.3, 0.3));
    let block = mesh.add("block", &rectangle(0.01, 0.02, 4, 8).translated(-0.1, 0.0));
    let mut model = Model::new(mesh, steel(), THICKNESS).expect("a positive thickness");
    model.gravity = [0.3, -9.81];
    model.behaviour[block.body] = Behaviour::Rigid;
    let first = model.mesh.bodies[ring.body].nodes.start;
    for n in first..first + 60 {
        model.motion[n] = NodeMotion::Rotating { centre: [0.3, 0.3], rate: -50.0 };
    }
    model
}

/// The scene, stirred, with a load on the rigid block.
fn ready_to_run(threads: usize) -> (Dynamics, NodalLoad) {
    let model = everything();
    let mut d =
        Dynamics::new(&model, &vec![true; model.mesh.x.len()], threads).expect("a model that can run");
    d.set_time_step(1e-7).expect("a positive time step");
    let mut noise = Noise::new(5);
    for node in 0..model.mesh.x.len() {
        let n = slot(&d, node);
        d.state.vx[n] = noise.uniform();
        d.state.vy[n] = noise.uniform();
    }
    d.launch_rigid(0, [0.5, 0.0], 20.0);
    let corner = model.mesh.bodies.last().expect("bodies").nodes.start;
    let load = NodalLoad::new(vec![(d.layout().slot_of_node[corner], 40.0, 7.0)]);
    (d, load)
}

/// All that a checkpoint holds, as text: floats are written so that they read back to the same bits.
fn checkpoint(d: &Dynamics) -> String {
    serde_json::to_string(&d.snapshot()).expect("numbers are finite")
}

fn run_on(threads: usize, steps: usize) -> String {
    let pool = micropool::ThreadPoolBuilder::default().num_threads(threads.max(2) - 1).build();
    pool.install(|| {
        let (mut d, mut load) = ready_to_run(threads);
        run(&mut d, &mut [&mut load], steps);
        checkpoint(&d)
    })
}

#[test]
fn invariant_bits_do_not_depend_on_threads() {
    let one = run_on(1, 60);
    assert!(one == run_on(2, 60), "one thread and two");
    assert!(one == run_on(3, 60), "one thread and three");
    assert!(one == run_on(4, 60), "one thread and four");
}

#[test]
fn invariant_a_resumed_run_has_the_same_bits() {
    let (mut whole, mut load) = ready_to_run(1);
    run(&mut whole, &mut [&mut load], 60);

    let (mut first, mut load) = ready_to_run(1);
    run(&mut first, &mut [&mut load], 25);
    let saved = checkpoint(&first);

    let (mut second, mut load) = ready_to_run(1);
    second
        .restore(serde_json::from_str(&saved).expect("what was written can be read"))
        .expect("the same model");
    run(&mut second, &mut [&mut load], 35);
    assert!(checkpoint(&whole) == checkpoint(&second));
}

#[test]
fn refuses_a_snapshot_of_another_model() {
    let (mut d, _) = ready_to_run(1);
    let before = checkpoint(&d);
    let other = Dynamics::new(&body(&rectangle(0.01, 0.01, 4, 4)), &[true; 25], 1).expect("a valid model");
    let error = d.restore(other.snapshot()).expect_err("other slots").to_string();
    assert!(error.contains("slots of the snapshot") && error.contains("those of the model"), "{error}");
    assert!(before == checkpoint(&d), "a refused snapshot changed something");
}

#[test]
fn behaves_forces_on_nodes_that_were_not_announced_are_lost() {
    // The contract of `loaded`: it lets the sweep leave the other nodes alone.
    let model = body(&rectangle(0.01, 0.01, 4, 4));
    let mut loaded = vec![true; 25];
    loaded[0] = false;
    let mut d = Dynamics::new(&model, &loaded, 1).expect("a model that can run");
    d.set_time_step(1e-8).expect("a positive time step");
    let (dropped, taken) = (slot(&d, 0), slot(&d, 24));
    d.step(&mut [&mut NodalLoad::new(vec![(dropped as u32, 1.0, 0.0), (taken as u32, 1.0, 0.0)])]);
    // A body at rest moves by the rounding of its own positions.
    assert!(d.state.vx[dropped].abs() < 1e-9 * d.state.vx[taken], "{}", d.state.vx[dropped]);
}

#[test]
fn invariant_held_components_stay() {
    let mut model = body(&rectangle(0.01, 0.01, 4, 4));
    model.gravity = [1.0, -9.81];
    model.motion[0] = NodeMotion::Held;
    model.motion[1] = NodeMotion::HeldX;
    model.motion[2] = NodeMotion::HeldY;
    let mut d = ready(&model, 0.9);
    let mut push = NodalLoad::new((0..25).map(|n| (slot(&d, n) as u32, 50.0, 70.0)).collect());
    run(&mut d, &mut [&mut push as &mut dyn Force], 500);
    let moved = |n: usize| {
        let s = slot(&d, n);
        [d.state.x[s] - model.mesh.x[n], d.state.y[s] - model.mesh.y[n]]
    };
    assert_eq!(moved(0), [0.0, 0.0]);
    assert!(moved(1)[0] == 0.0 && moved(1)[1] != 0.0);
    assert!(moved(2)[1] == 0.0 && moved(2)[0] != 0.0);
    assert!(moved(24)[0] != 0.0 && moved(24)[1] != 0.0);
}

#[test]
fn behaves_one_of_two_like_bodies_is_held() {
    // Bodies of one shape share a tile, but not when their nodes move by different rules.
    let part = rectangle(0.01, 0.01, 4, 4);
    let mut mesh = Mesh::new();
    mesh.add("free", &part);
    mesh.add("held", &part.translated(0.02, 0.0));
    let mut model = Model::new(mesh, steel(), THICKNESS).expect("a positive thickness");
    model.gravity = [0.0, -9.81];
    model.motion[25..].fill(NodeMotion::Held);
    let mut d = ready(&model, 0.9);
    run(&mut d, &mut [], 100);
    assert!((0..25).all(|n| d.state.y[slot(&d, n)] < model.mesh.y[n]), "one falls");
    assert!((25..50).all(|n| d.state.y[slot(&d, n)] == model.mesh.y[n]), "the other stays");
}

#[test]
fn invariant_rigid_bodies_keep_the_order_of_the_mesh() {
    let mut mesh = Mesh::new();
    for (i, n) in [2, 9, 4, 7].into_iter().enumerate() {
        mesh.add(format!("block {i}"), &rectangle(0.01, 0.01, n, n).translated(0.1 * i as f64, 0.0));
    }
    let mut model = Model::new(mesh, steel(), THICKNESS).expect("a positive thickness");
    for i in [0, 2, 3] {
        model.behaviour[i] = Behaviour::Rigid;
    }
    let mut d = lay_out(&model);
    assert_eq!(d.rigid_body_numbers().collect::<Vec<_>>(), [0, 2, 3]);
    d.set_time_step(1e-6).expect("a positive time step");
    d.launch_rigid(1, [1.0, 0.0], 0.0);
    run(&mut d, &mut [], 10);
    let moved = |body: usize| {
        let n = model.mesh.bodies[body].nodes.start;
        d.state.x[slot(&d, n)] - model.mesh.x[n]
    };
    assert!((moved(2) - 1e-5).abs() < 1e-12 && moved(0) == 0.0 && moved(3) == 0.0);
}

#[test]
fn invariant_a_rigid_body_keeps_its_shape() {
    let mut model = body(&rectangle(0.02, 0.01, 6, 3));
    model.behaviour[0] = Behaviour::Rigid;
    let mut d = lay_out(&model);
    d.set_time_step(1e-6).expect("a positive time step");
    d.launch_rigid(0, [3.0, -2.0], 500.0);
    let mut load = NodalLoad::new(vec![(slot(&d, 0) as u32, 10.0, 20.0)]);
    run(&mut d, &mut [&mut load], 20_000);
    assert!(d.rigid[0].angle > 9.0, "it has turned: {} rad", d.rigid[0].angle);
    let distance = |x: &[f64], y: &[f64], a: usize, b: usize| (x[a] - x[b]).hypot(y[a] - y[b]);
    for n in 1..model.mesh.x.len() {
        let before = distance(&model.mesh.x, &model.mesh.y, 0, n);
        let after = distance(&d.state.x, &d.state.y, slot(&d, 0), slot(&d, n));
        // Nodes are placed from the angle, not moved step by step: two roundings, however long it runs.
        assert!((after - before).abs() < 1e-15, "node {n}");
    }
}

/// Kinetic energy, work of gravity and elastic energies [J] about the third step, and the first two by their
/// definitions.
fn energies_on(threads: usize) -> ([f64; 4], [f64; 2]) {
    let pool = micropool::ThreadPoolBuilder::default().num_threads(threads.max(2) - 1).build();
    pool.install(|| {
        let (mut d, mut load) = ready_to_run(threads);
        run(&mut d, &mut [&mut load], 2);
        let (vx, vy, rigid) = (d.state.vx.clone(), d.state.vy.clone(), d.rigid[0]);
        let before = d.velocities();
        run(&mut d, &mut [&mut load], 1);
        let model = everything();
        let block = model.mesh.bodies.last().expect("bodies").nodes.clone();
        let (mut kinetic, mut gravity, mut mass, mut inertia) = (0.0, 0.0, 0.0, 0.0);
        let at = &d.rigid[0];
        for node in 0..model.mesh.x.len() {
            let n = slot(&d, node);
            let (m, x, y) = (d.mass()[n], d.state.x[n], d.state.y[n]);
            gravity += m * (0.3 * x - 9.81 * y);
            if block.contains(&node) {
                mass += m;
                inertia += m * ((x - at.centre[0]).powi(2) + (y - at.centre[1]).powi(2));
            } else {
                kinetic += 0.5 * m * (vx[n] * d.state.vx[n] + vy[n] * d.state.vy[n]);
            }
        }
        let [u, v] = [rigid.velocity, at.velocity];
        kinetic += 0.5 * mass * (u[0] * v[0] + u[1] * v[1]) + 0.5 * inertia * rigid.spin * at.spin;
        let elastic = d.elastic_energy();
        ([d.kinetic_energy(&before), d.gravity_work(), elastic.strain, elastic.hourglass], [kinetic, gravity])
    })
}

#[test]
fn invariant_energies_are_sums_over_nodes_whatever_the_threads() {
    let (one, defined) = energies_on(1);
    // Some ten thousand terms of one sign, or nearly so.
    for (found, expected) in one.iter().zip(defined) {
        assert!((found - expected).abs() < 1e-12 * expected.abs(), "{found} J, {expected} J by definition");
    }
    for threads in 2..=4 {
        assert_eq!(energies_on(threads).0.map(f64::to_bits), one.map(f64::to_bits), "{threads} threads");
    }
}
