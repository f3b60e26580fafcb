//! A real run of the coarse bearing through the report: the data of events and pictures are
//! simulated here.

use std::path::Path;

use crate::common::complete;
use stribeck_analysis::plan::{MeshFacts, Plan};
use stribeck_report as report;
use stribeck_scene::scene::Scene;
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_store::mesh_file::RunMesh;
use stribeck_store::run_info::RunInfo;
use stribeck_testing::Scratch;

/// Events may be this far from the centre over the edge: contacts have a width.
const EVENT_MS: f64 = 0.5;
/// Length of the defect from the events.
const LENGTH: f64 = 0.05;

/// A plan's step, by the stiffest element alone, is within a fifth of the run's.
const PLANNED_STEP: f64 = 0.2;

fn its_plan_holds(scene: &Scene, info: &RunInfo) {
    let scene = &scene.resolve();
    let assembly = Assembly::new(scene).expect("a valid scene");
    let element_time_step_s = assembly.element_time_step_s(scene);
    let mesh = MeshFacts { counts: assembly.mesh_info(), element_time_step_s };
    let plan = Plan::of(scene, &mesh).expect("a loaded bearing");
    assert_eq!(plan.elements, info.mesh.quads + info.mesh.triangles);
    let ratio = plan.time_step_s / info.time_step_s;
    assert!((ratio - 1.0).abs() < PLANNED_STEP, "{} s instead of {} s", plan.time_step_s, info.time_step_s);
}

/// Bit for bit the mesh that the scene makes: displacements of frames count from it.
fn its_mesh_reads_back(scene: &Scene, folder: &Path) {
    let read = RunMesh::read(folder.join("mesh.vtu")).expect("a mesh");
    let made = Assembly::new(&scene.resolve()).expect("a valid scene").model.mesh;
    let places = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(&x, &y)| [x, y]).collect::<Vec<_>>();
    assert!(read.reference == places(&made.x, &made.y));
    assert!(read.quads == made.quads && read.triangles == made.triangles);
    for (read, made) in read.bodies.iter().zip(&made.bodies) {
        assert_eq!((&read.name, &read.quads, &read.triangles), (&made.name, &made.quads, &made.triangles));
    }
    assert_eq!(read.bodies.len(), made.bodies.len());
    // The load of 50 kN has pressed the bearing together by tens of micrometres, and by less than half a
    // millimetre.
    let moved = read.start.iter().zip(&read.reference).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
    let most = moved.fold(0.0, f64::max);
    assert!((1e-5..5e-4).contains(&most), "{most} m");
}

#[test]
fn behaves_a_simulated_passage_gives_events_length_and_pictures() {
    let scene = Scene::parse(include_str!("../../../../../fixtures/scenes/quick.ron"), "quick.ron")
        .expect("a valid scene");
    let folder = Scratch::new("quick");
    let info = complete(&scene, folder.path());
    its_plan_holds(&scene, &info);
    its_mesh_reads_back(&scene, folder.path());
    let summary = report::write(folder.path()).expect("a report");

    let [event] = &summary.events[..] else { panic!("{:?}", summary.events) };
    assert_eq!(event.roller, 1);
    for (found, truth) in [(event.entry_ms, event.expected_entry_ms), (event.exit_ms, event.expected_exit_ms)]
    {
        let found = found.expect("an event");
        assert!((found - truth).abs() < EVENT_MS, "{found} ms instead of {truth} ms");
    }
    let (length, truth) = (event.spall_mm.expect("a length"), scene.defect.expect("a defect").length_mm);
    assert!((length / truth - 1.0).abs() < LENGTH, "{length} mm instead of {truth} mm");

    // Frames from 0.2 to 5.6 ms, every 0.1 ms.
    let frames = std::fs::read_dir(folder.join("frames")).expect("frames").count();
    assert_eq!(frames, 55);
    let page = std::fs::read_to_string(folder.join("report.html")).expect("a page");
    assert!(page.contains("<figure id=\"stress\""), "the stress is missing: {:?}", summary.notes);
}
