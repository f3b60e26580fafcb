//! Graded meshes: a quarter of the elements, the same raceways, the same load.

use std::ops::ControlFlow;

use stribeck_bearing::{
    assembly::Assembly,
    run_dir::{Run, RunDir},
    run_info::Status,
    scene::{GradingScene, Scene},
    simulation::{Host, simulate},
};
use stribeck_mesh::Quality;

fn lean() -> Scene {
    Scene::parse(include_str!("../../../fixtures/scenes/lean.ron"), "lean.ron").expect("a sound scene")
}

fn assembled(scene: &Scene) -> Assembly {
    Assembly::new(scene).expect("a scene that can be meshed")
}

/// 30 % of the elements is what a lean scene may have at most; facets that roll stay what they are.
#[test]
fn invariant_lean_scene_has_a_quarter_of_the_elements() {
    const SHARE: f64 = 0.30;
    let (uniform, lean) = (assembled(&Scene::default()), assembled(&lean()));
    let (before, after) = (uniform.mesh_info(), lean.mesh_info());
    let share = (after.quads + after.triangles) as f64 / (before.quads + before.triangles) as f64;
    assert!(share < SHARE, "{share:.3} of the elements");
    assert_eq!(before.quads + before.triangles, 102_828, "the uniform scene is what it was");
    assert_eq!(after.roller_facets, before.roller_facets);
    // 1257 = 3 · 419; 1030 is not a multiple of 3.
    assert_eq!((after.outer_facets, after.inner_facets), (before.outer_facets, 1029));
    let mesh = &lean.model.mesh;
    for body in mesh.bodies.iter().filter(|b| !b.name.starts_with("roller")) {
        assert!(body.triangles.is_empty(), "{} has triangles", body.name);
    }
}

/// No coarse cell, no transition and no column of the seat is smaller than the smallest cell of the uniform scene.
#[test]
fn invariant_lean_scene_keeps_the_critical_step() {
    let (poisson, wave_speed) = (0.3, 5857.0);
    let of = |scene: &Scene| Quality::of(&assembled(scene).model.mesh, poisson, wave_speed);
    let (uniform, lean) = (of(&Scene::default()), of(&lean()));
    let (before, after) = (uniform.overall.critical_time_step, lean.overall.critical_time_step);
    assert!(after >= before, "{after:e} s instead of {before:e} s\n{lean}");
}

/// The seat has a node wherever the back of the ring has one, except at its two ends, so that long facets do not
/// press against the vertices of the other surface.
#[test]
fn invariant_seat_and_ring_meet_node_to_node() {
    let lean = assembled(&lean());
    let mesh = &lean.model.mesh;
    let body = |name: &str| mesh.bodies.iter().find(|b| b.name == name).expect("a body of this name");
    let place = |n: usize| [mesh.x[n], mesh.y[n]];
    let on_the_circle = |n: &usize| (mesh.x[*n].hypot(mesh.y[*n]) - 0.11).abs() < 1e-12;
    let back: Vec<[f64; 2]> = body("outer ring").nodes.clone().filter(on_the_circle).map(place).collect();
    let seat: Vec<[f64; 2]> = body("adapter").nodes.clone().filter(on_the_circle).map(place).collect();
    assert_eq!(back.len(), 419);
    // 2 · 46.66° of 360°/419 each, the last facet at each end cut or stretched.
    assert!((108..=110).contains(&seat.len()), "{} nodes", seat.len());
    let met = |p: &&[f64; 2]| back.iter().any(|q| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-12);
    assert_eq!(seat.iter().filter(met).count(), seat.len() - 2);
}

/// A ring too thin for the transition keeps its fine cells; the scene stays valid.
#[test]
fn invariant_thin_rings_stay_fine() {
    let mut scene = Scene::default();
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    let uniform = assembled(&scene).mesh_info();
    scene.mesh.grading = Some(GradingScene { coarse_mm: 8.0, fine_layers: 2 });
    scene.validate().expect("five layers are a sound ring");
    let graded = assembled(&scene).mesh_info();
    assert_eq!((graded.outer_facets, graded.inner_facets), (uniform.outer_facets, uniform.inner_facets));
    assert!(graded.quads < uniform.quads, "the adapter is coarser");
}

#[test]
fn invariant_refusals_name_field_and_remedy() {
    let refused =
        |text: &str| Scene::parse(text, "scene.ron").expect_err("an impossible grading").to_string();
    for (text, parts) in [
        ("(mesh: (grading: (coarse_mm: 0.3)))", ["coarse_mm", "0.5 mm or more"]),
        ("(mesh: (grading: (fine_layers: 0)))", ["fine_layers", "from 1"]),
        ("(mesh: (outer_facets: 1256, grading: ()))", ["a multiple of 3", "`mesh.outer_facets: 1257`"]),
        ("(mesh: (inner_facets: 1030, grading: ()))", ["a multiple of 3", "`mesh.inner_facets: 1029`"]),
        ("(mesh: (grading: (corse_mm: 2.0)))", ["corse_mm", "coarse_mm"]),
    ] {
        let message = refused(text);
        assert!(parts.iter().all(|p| message.contains(p)), "{text}: {message}");
    }
}

/// Vertical force on the outer raceway from each roller at the first sample [N].
fn first_forces(scene: &Scene, folder: &str) -> Vec<f64> {
    let folder = std::env::temp_dir().join(format!("stribeck-lean-{}-{folder}", std::process::id()));
    let dir = RunDir::create(&folder).expect("the folder is new");
    let host = Host {
        threads: 1,
        version: "test".into(),
        commit: "test".into(),
        machine: "test".into(),
        wall_s: &|| 0.0,
        cpu_s: &|| 0.0,
    };
    let info = simulate(scene, &dir, &host, &mut |_| ControlFlow::Continue(())).expect("a sound scene");
    assert_eq!(info.status, Status::Complete);
    let run = Run::read(&folder).expect("a finished run can be read");
    let _ = std::fs::remove_dir_all(&folder);
    let force = |i: usize, c: &str| {
        run.trace.get(&format!("roller.{i}.outer_f{c}_n")).expect("a column of this name")[0]
    };
    (1..=scene.bearing.rollers).map(|i| force(i, "x").hypot(force(i, "y"))).collect()
}

/// Static load distribution, uniform and graded: rings that are coarse outside and rollers that are coarse inside must
/// share the load as fine ones do.
#[test]
fn peer_graded_bearing_carries_its_load_like_the_uniform_one() {
    // Of the largest force. What the project asks of a lean scene is 5 %; compliance of the coarse cells costs less.
    const TOLERANCE: f64 = 0.02;
    let mut scene = Scene::default();
    scene.mesh.size_mm = 1.0;
    scene.solver.duration_ms = 0.02;
    let uniform = first_forces(&scene, "uniform");
    scene.mesh.grading = Some(GradingScene { coarse_mm: 3.0, fine_layers: 2 });
    let graded = first_forces(&scene, "graded");
    let largest = uniform.iter().fold(0.0_f64, |a, &b| a.max(b));
    assert!(largest > 1e4, "the most loaded roller carries {largest} N");
    for (i, (a, b)) in uniform.iter().zip(&graded).enumerate() {
        assert!((a - b).abs() < TOLERANCE * largest, "roller {}: {b} N instead of {a} N", i + 1);
    }
}
