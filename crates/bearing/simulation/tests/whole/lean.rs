//! Graded meshes: a quarter of the elements, the same raceways, the same load.

use std::ops::ControlFlow;

use crate::common::host;
use stribeck_mesh::Mesh;
use stribeck_scene::scene::{GradingScene, Scene};
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_simulation::simulate;
use stribeck_store::{
    run_dir::{Run, RunDir},
    run_info::Status,
};
use stribeck_testing::Scratch;

fn lean() -> Scene {
    Scene::parse(include_str!("../../../../../fixtures/scenes/lean.ron"), "lean.ron").expect("a valid scene")
}

fn assembled(scene: &Scene) -> Assembly {
    Assembly::new(&scene.resolve()).expect("a scene that can be meshed")
}

/// A lean scene may have at most 30 % of the elements; facets that roll stay unchanged.
#[test]
fn behaves_lean_scene_has_a_quarter_of_the_elements() {
    const SHARE: f64 = 0.30;
    let (uniform, lean) = (assembled(&Scene::default()), assembled(&lean()));
    let (before, after) = (uniform.mesh_info(), lean.mesh_info());
    let share = (after.quads + after.triangles) as f64 / (before.quads + before.triangles) as f64;
    assert!(share < SHARE, "{share:.3} of the elements");
    assert_eq!(before.quads + before.triangles, 99_500, "the uniform scene is what it was");
    assert_eq!(after.roller_facets, before.roller_facets);
    assert_eq!((after.outer_facets, after.inner_facets), (before.outer_facets, before.inner_facets));
    let mesh = &lean.model.mesh;
    let triangles = |name: &str| {
        let body = mesh.bodies.iter().find(|b| b.name == name).expect("a body of this name");
        body.triangles.len()
    };
    // Three do not divide 1030: two groups of two remain.
    let found = ["outer ring", "inner ring", "adapter"].map(triangles);
    assert_eq!(found, [0, 2, 0], "triangles outside the rollers take the slow path");
}

/// No coarse cell, no transition and no column of the seat holds the time step back; the third layer along
/// the rims of rollers, whose cells become narrower inwards, costs 3 %.
#[test]
fn behaves_lean_scene_keeps_the_critical_step() {
    // Of the elements and dry contact alone: structural damping and oil take their share of any mesh's step.
    let of = |mut scene: Scene| {
        (scene.film, scene.solver.structural_damping) = (None, None);
        let scene = &scene;
        let machine = assembled(scene).build(&scene.resolve(), 1).expect("a model that can be solved");
        let parts = machine.system.into_parts();
        parts.dynamics.critical_time_step(&[&parts.contacts.expect("a bearing has contacts")], 0.0).time_step
    };
    let (before, after) = (of(Scene::default()), of(lean()));
    assert!(before > 76e-9, "{before:e} s of the uniform scene");
    assert!(after > 0.96 * before, "{after:e} s instead of {before:e} s");
}

/// The seat has the nodes of the ring's back and at its ends continues the ring's facets, so that long facets
/// do not press against the vertices of the other surface.
#[test]
fn invariant_seat_and_ring_meet_node_to_node() {
    let lean = assembled(&lean());
    let mesh = &lean.model.mesh;
    let body = |name: &str| mesh.bodies.iter().find(|b| b.name == name).expect("a body of this name");
    let on_the_circle = |n: &usize| (mesh.x[*n].hypot(mesh.y[*n]) - 0.11).abs() < 1e-12;
    let place = |n: usize| [mesh.x[n], mesh.y[n]];
    let back: Vec<[f64; 2]> = body("outer ring").nodes.clone().filter(on_the_circle).map(place).collect();
    assert_eq!(back.len(), 419);
    // 2 · 46.66° of 360°/419 each, the last facet at each end cut or stretched; the seat is the first row.
    let first = body("adapter").nodes.start;
    let seat: Vec<[f64; 2]> = (first..)
        .map(place)
        .scan(f64::NEG_INFINITY, |last, p| (p[0] > std::mem::replace(last, p[0])).then_some(p))
        .collect();
    assert!((108..=110).contains(&seat.len()), "{} nodes", seat.len());
    let [inner @ .., _] = &seat[1..] else { panic!("a seat has nodes") };
    let met = |p: &[f64; 2]| back.iter().any(|q| p == q);
    assert!(inner.iter().all(met), "a node of the seat has none of the ring opposite");
    for (end, x) in [(seat[0], -0.08), (seat[seat.len() - 1], 0.08)] {
        assert_eq!(end[0], x);
        let off = end[0].hypot(end[1]) - 0.11;
        // A chord of 1.65 mm, cut at its middle or continued by less than 0.5 mm / cos 46°, leaves the circle
        // by less than its sagitta of 3.1 µm or by 1.65 · 0.73 / (2 · 110) mm = 5.5 µm.
        assert!((-3.2e-6..5.6e-6).contains(&off), "the seat ends {off:e} m from the circle");
    }
}

/// A ring too thin for the transition keeps its fine cells; the scene stays valid.
#[test]
fn behaves_thin_rings_stay_fine() {
    let mut scene = Scene::default();
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    let uniform = assembled(&scene).model.mesh;
    scene.mesh.grading = Some(GradingScene { coarse_mm: 8.0, fine_layers: 2 });
    scene.validate().expect("five layers are a healthy ring");
    let graded = assembled(&scene).model.mesh;
    let body = |mesh: &Mesh, i: usize| (mesh.bodies[i].name.clone(), mesh.bodies[i].quads.len());
    for ring in [0, 1] {
        assert_eq!(body(&graded, ring), body(&uniform, ring));
    }
    let [(name, coarse), (_, fine)] = [body(&graded, 2), body(&uniform, 2)];
    assert!(name == "adapter" && 2 * coarse < fine, "{name}: {coarse} quadrilaterals instead of {fine}");
}

/// `--set mesh.grading.fine_layers=1` grades a scene that was not, with the default for the other field.
#[test]
fn behaves_an_override_opens_the_grading() {
    let set = |what: &str| Scene::default().with_overrides(&[what]).expect("a field of a scene").mesh.grading;
    let default = GradingScene::default();
    assert_eq!(set("mesh.grading.fine_layers=1"), Some(GradingScene { fine_layers: 1, ..default }));
    assert_eq!(set("mesh.grading=()"), Some(GradingScene::default()));
    assert_eq!(set("mesh.grading=None"), None);
}

#[test]
fn refuses_with_field_and_remedy() {
    let refused =
        |text: &str| Scene::parse(text, "scene.ron").expect_err("an impossible grading").to_string();
    for (text, parts) in [
        ("(mesh: (grading: (coarse_mm: 0.3)))", ["coarse_mm", "at least 0.5 mm"]),
        ("(mesh: (grading: (fine_layers: 0)))", ["fine_layers", "1 to 1000"]),
        ("(mesh: (grading: (corse_mm: 2.0)))", ["corse_mm", "coarse_mm"]),
    ] {
        let message = refused(text);
        assert!(parts.iter().all(|p| message.contains(p)), "{text}: {message}");
    }
}

/// Vertical force on the outer raceway from each roller at the first sample [N].
fn first_forces(scene: &Scene) -> Vec<f64> {
    let folder = Scratch::new("lean");
    let dir = RunDir::create(folder.path()).expect("the folder is new");
    let info = simulate(scene, &dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(info.status, Status::Complete);
    let run = Run::read(folder.path()).expect("a finished run can be read");
    let force = |i: usize, c: &str| {
        run.trace
            .channel(&format!("roller.{i}.outer_f{c}_n"))
            .expect("readable")
            .expect("a column of this name")[0]
    };
    (1..=scene.bearing.rollers).map(|i| force(i, "x").hypot(force(i, "y"))).collect()
}

/// Static load distribution, uniform and graded: rings that are coarse outside and rollers that are coarse
/// inside must share the load as fine ones do.
#[test]
fn behaves_graded_bearing_carries_its_load_like_the_uniform_one() {
    // Of the largest force. The project's limit for a lean scene is 5 %; compliance of the coarse cells
    // costs less.
    const TOLERANCE: f64 = 0.02;
    let mut scene = Scene::default();
    scene.mesh.size_mm = 1.0;
    scene.solver.duration_ms = 0.02;
    let uniform = first_forces(&scene);
    scene.mesh.grading = Some(GradingScene { coarse_mm: 3.0, fine_layers: 2 });
    let graded = first_forces(&scene);
    let largest = uniform.iter().fold(0.0_f64, |a, &b| a.max(b));
    assert!(largest > 1e4, "the most loaded roller carries {largest} N");
    for (i, (a, b)) in uniform.iter().zip(&graded).enumerate() {
        assert!((a - b).abs() < TOLERANCE * largest, "roller {}: {b} N instead of {a} N", i + 1);
    }
}
