//! Rings whose meshes come from files.

use std::{fmt::Write, ops::ControlFlow};

use crate::common::host;
use stribeck_mesh::{Mesh, decks::Deck};
use stribeck_scene::scene::Scene;
use stribeck_simulation::bearing::{assembly::Assembly, start::preload};
use stribeck_simulation::simulate;
use stribeck_store::{
    run_dir::{Run, RunDir},
    run_info::Status,
};
use stribeck_testing::Scratch;

const SCENE: &str =
    "(name: \"ring\", bearing: \"NU 205\", film: None, defect: None, output: (frames: None), \
    housing: springs(),
    operation: (load_n: 5000, speed_rpm: 1500), mesh: (size_mm: 0.5, roller_facets: 48), contact: \
    (penalty_scale: 0.3), solver: (duration_ms: 2))";

const NOTCHED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/rings/notched_outer.msh");

fn scene(more: &[String]) -> Scene {
    let more: Vec<&str> = more.iter().map(String::as_str).collect();
    Scene::parse(SCENE, "here").and_then(|scene| scene.with_overrides(&more)).expect("valid")
}

fn notched(more: &str) -> String {
    format!("outer_ring_mesh=(file: \"{NOTCHED}\"{more})")
}

/// Forces on the rollers by outer and inner raceway at the preload [N].
fn forces(scene: &Scene) -> Vec<[f64; 2]> {
    let scene = &scene.resolve();
    let assembly = Assembly::new(scene).expect("a mesh");
    let mut machine = assembly.build(scene, 1).expect("a machine");
    assert_eq!(preload(&mut machine, scene, &assembly.kinematics).expect("an equilibrium"), None);
    let _ = machine.system.contact_forces();
    let all: Vec<[f64; 2]> = machine.system.resultants().map(|r| r.force).collect();
    let pairs = machine.pairs;
    (0..scene.rollers).flat_map(|i| [all[pairs.outer(i)], all[pairs.inner(i)]]).collect()
}

/// A body of a mesh as an Abaqus file, with sets of its nodes between two radii [m].
fn deck(mesh: &Mesh, name: &str, sets: [(&str, f64); 2]) -> String {
    let body = mesh.bodies.iter().find(|body| body.name == name).expect("a body of that name");
    let first = body.nodes.start as u32;
    let one = Mesh {
        x: mesh.x[body.nodes.clone()].to_vec(),
        y: mesh.y[body.nodes.clone()].to_vec(),
        quads: mesh.quads[body.quads.clone()].iter().map(|quad| quad.map(|n| n - first)).collect(),
        triangles: Vec::new(),
        bodies: vec![stribeck_mesh::Body {
            name: name.to_owned(),
            nodes: 0..body.nodes.len(),
            quads: 0..body.quads.len(),
            triangles: 0..0,
        }],
    };
    let mut text = Deck::Abaqus.write(&one, name);
    for (set, radius) in sets {
        let _ = writeln!(text, "*NSET, NSET={set}");
        let on = |n: &usize| (one.x[*n].hypot(one.y[*n]) - radius).abs() < 1e-9;
        for n in (0..one.x.len()).filter(on) {
            let _ = writeln!(text, "{},", n + 1);
        }
    }
    text
}

/// The same nodes and elements, once made and once read, under the same load.
#[test]
fn invariant_rings_from_files_carry_as_those_that_are_made() {
    let made = scene(&[]);
    let mesh = Assembly::new(&made.resolve()).expect("a mesh").model.mesh;
    let folder = Scratch::new("rings");
    std::fs::create_dir_all(folder.path()).expect("a folder");
    let b = &made.bearing;
    let [race, bore] = [
        0.5e-3 * b.inner_race_diameter_mm,
        1e-3 * (0.5 * b.inner_race_diameter_mm - b.inner_ring_thickness_mm),
    ];
    let [outer_race, back] = [
        0.5e-3 * b.outer_race_diameter_mm,
        1e-3 * (0.5 * b.outer_race_diameter_mm + b.outer_ring_thickness_mm),
    ];
    let of = |ring: &str, sets| {
        let file = folder.path().join(format!("{ring}.inp"));
        std::fs::write(&file, deck(&mesh, &format!("{ring} ring"), sets)).expect("written");
        format!("{ring}_ring_mesh=(file: {:?}, unit_mm: 1000)", file.display().to_string())
    };
    let read = scene(&[
        of("outer", [("raceway", outer_race), ("fit", back)]),
        of("inner", [("raceway", race), ("fit", bore)]),
    ]);
    // Scenes hold the meshes that they have read, and write the same fields again.
    assert_eq!(Scene::parse(&read.to_ron(), "here").expect("valid"), read);
    let [made, read] = [forces(&made), forces(&read)];
    let most = made.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
    let off = made.iter().zip(&read).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
    println!("forces up to {most:.0} N differ by {off:.1e} N at most");
    // The deck has thirteen digits, the equilibrium is found to 10⁻⁶ of the load.
    assert!(most > 1000.0 && off < 1e-5 * most, "{off} N of {most} N");
}

/// Source: equilibrium; the rollers carry load and weight (THEORY §4).
#[test]
fn analytic_a_notched_ring_in_a_pedestal_runs_and_carries_its_load() {
    let set = [
        notched(", raceway: \"raceway\", fit: \"fit\", unit_mm: 1"),
        "housing=pedestal(width_mm: 90, base_mm: 45, top_mm: 38)".to_owned(),
        "mesh.grading=(coarse_mm: 1.5)".to_owned(),
        "defects=[(on: outer, angle_deg: 90, form: spall(length_mm: 2, depth_mm: 0.06, edge_mm: 0.5))]"
            .to_owned(),
    ];
    let (scene, folder) = (scene(&set), Scratch::new("notched"));
    let dir = RunDir::create(folder.path()).expect("the folder is new");
    let info = simulate(&scene, &dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("the scene runs");
    assert_eq!(info.status, Status::Complete);
    assert!(info.energy.max_relative_error < 2e-3, "{:?}", info.energy);
    // As many facets as the file has.
    assert_eq!(info.mesh.outer_facets, 292);
    let run = Run::read(folder.path()).expect("readable");
    let carried: f64 = (1..=scene.bearing.rollers)
        .map(|i| run.trace.channel(&format!("roller.{i}.outer_fy_n")).expect("readable").expect("a channel"))
        .map(|force| force.iter().sum::<f64>() / force.len() as f64)
        .sum();
    assert!((-carried / info.expected_support_n - 1.0).abs() < 0.02, "{carried} N");
}

/// A ring as other programs write it, with parts that are no mesh, is the ring; and the run lists the ignored
/// parts.
#[test]
fn issue_a_run_lists_what_of_its_meshes_was_passed_over() {
    let plain = scene(&[]);
    let mesh = Assembly::new(&plain.resolve()).expect("a mesh").model.mesh;
    let race = 0.5e-3 * plain.bearing.outer_race_diameter_mm;
    let back = race + 1e-3 * plain.bearing.outer_ring_thickness_mm;
    let text = deck(&mesh, "outer ring", [("raceway", race), ("fit", back)]);
    let folder = Scratch::create("passed_over");
    let (nodes, rest) = text.split_at(text.find("*ELEMENT").expect("elements"));
    let more =
        "*ELEMENT, TYPE=T3D2, ELSET=Line1\n900001, 1, 2\n*Nset, nset=RACE\nRaceway\n*MATERIAL, NAME=steel\n";
    for (name, text) in
        [("other.inp", format!("{nodes}*SURFACE, NAME=s\n{rest}{more}")), ("whole.inp", text.clone())]
    {
        std::fs::write(folder.join(name), text).expect("written");
    }
    let with = |name: &str, raceway: &str| {
        let file = folder.join(name).display().to_string();
        let ring = format!("outer_ring_mesh=(file: {file:?}, unit_mm: 1000, raceway: {raceway:?})");
        scene(&[ring, "solver.duration_ms=0.02".to_owned()])
    };
    let other = with("other.inp", "race");
    let meshed = |scene: &Scene| Assembly::new(&scene.resolve()).expect("a mesh").model.mesh;
    assert_eq!(meshed(&other), meshed(&with("whole.inp", "raceway")));
    let dir = RunDir::create(folder.join("run")).expect("the folder is new");
    simulate(&other, &dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("the scene runs");
    let notes = Run::read(folder.join("run")).expect("readable").info.notes;
    let line = 1 + nodes.lines().count();
    assert!(notes[0].starts_with("of `outer_ring_mesh.file` `") && notes.len() == 3, "{notes:?}");
    for words in [
        format!("line {line}: `*SURFACE` is not read"),
        "elements of type `T3D2` are passed over".to_owned(),
        "`*MATERIAL` is not read".to_owned(),
    ] {
        assert!(notes.iter().any(|note| note.contains(&words)), "{words}: {notes:?}");
    }
    // A set that was passed over is asked for.
    let mut none = with("other.inp", "race");
    let ring = none.outer_ring_mesh.as_mut().expect("a ring");
    ring.text = ring.text.replace("\nRaceway\n", "\nNothing\n");
    let said = Assembly::new(&none.resolve()).expect_err("no set").to_string();
    assert!(
        said.contains("no set of nodes `race`") && said.contains("there is no set of nodes `Nothing`"),
        "{said}"
    );
}

/// A file of a whole bearing would leave rollers and inner ring free to go anywhere.
#[test]
fn refuses_a_ring_with_bodies_that_hang_on_nothing() {
    let plain = scene(&[]);
    let mesh = Assembly::new(&plain.resolve()).expect("a mesh").model.mesh;
    let folder = Scratch::create("loose");
    let file = folder.join("whole.inp");
    let body = |name: &str| mesh.bodies.iter().find(|body| body.name == name).expect("a body").nodes.clone();
    let race = 0.5e-3 * plain.bearing.outer_race_diameter_mm;
    let back = race + 1e-3 * plain.bearing.outer_ring_thickness_mm;
    let mut text = Deck::Abaqus.write(&mesh, "whole");
    for (set, radius) in [("raceway", race), ("fit", back)] {
        let _ = writeln!(text, "*NSET, NSET={set}");
        let on = |n: &usize| (mesh.x[*n].hypot(mesh.y[*n]) - radius).abs() < 1e-9;
        for n in body("outer ring").filter(on) {
            let _ = writeln!(text, "{},", n + 1);
        }
    }
    std::fs::write(&file, text).expect("writable");
    let set = format!("outer_ring_mesh=(file: {file:?}, raceway: \"raceway\", fit: \"fit\", unit_mm: 1000)");
    let said = Assembly::new(&scene(&[set]).resolve()).expect_err("loose bodies").to_string();
    assert!(
        said.contains("`INNER_RING`, `FRAME`, `ROLLER_1`, `ROLLER_2` and 12 more hang on nothing"),
        "{said}"
    );
}

#[test]
fn refuses_a_mesh_that_is_no_ring_of_the_bearing() {
    let ring = |more: &str| notched(more);
    for (set, words) in [
        (
            ring(", raceway: \"track\""),
            "no set of nodes `track`, which `outer_ring_mesh.raceway` names; sets: `fit`, `raceway`",
        ),
        (
            ring(", unit_mm: 1000"),
            "its raceway does not fit the one of `bearing`: a node lies 23250.0000 mm from the centre, 23.25",
        ),
        (ring(", raceway: \"fit\""), "its raceway does not fit the one of `bearing`: a node lies 26.000"),
        (
            ring(", fit: \"raceway\""),
            "thickness of the ring: a node lies 23.2500 mm from the centre, 23.250000 in the file",
        ),
        (ring("").replace("outer_ring", "inner_ring"), "its raceway does not fit the one of `bearing`"),
    ] {
        let said = Assembly::new(&scene(std::slice::from_ref(&set)).resolve()).expect_err(&set).to_string();
        assert!(said.contains(words) && said.contains("_ring_mesh.file` `"), "{set}: {said}");
    }
}
