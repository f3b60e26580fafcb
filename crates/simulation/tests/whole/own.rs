//! Bearings by their own fields run at the first try: omitted fields of the scene fit their size.

use std::path::PathBuf;

use crate::common::run;
use stribeck_scene::scene::Scene;
use stribeck_store::run_info::Status;
use stribeck_testing::{Scratch, side_by_side};

/// Elements as a test can afford them, in proportion to the rollers, with contact as stiff as they are.
const COARSE: [&str; 4] = [
    "mesh.roller_facets=48",
    "mesh.grading=(fine_layers: 1)",
    "contact.penalty_scale=0.3",
    "output.frames=None",
];

fn files() -> Vec<PathBuf> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scenes/own");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("fixtures").flatten().map(|entry| entry.path()).collect();
    files.sort();
    assert_eq!(files.len(), 10);
    files
}

fn scene(file: &PathBuf, set: &[&str]) -> Scene {
    let set: Vec<&str> = COARSE.iter().chain(set).copied().collect();
    Scene::read_with(file, &set).unwrap_or_else(|why| panic!("{why}"))
}

/// The cage of an NU 2210 by fields had strayed by a millimetre after 21 ms, and its run diverged.
#[test]
fn issue_ten_own_bearings_run_in_their_modes() {
    side_by_side(&files(), |file| {
        let scene = scene(file, &["model=reduced()", "solver.duration_ms=30", "output.interval_us=50"]);
        let folder = Scratch::create("own-reduced");
        let info = run(&scene, &folder, "run", 1);
        let name = &scene.name;
        println!("{name}: {:?}, {} modes", info.status, info.reduced.as_ref().map_or(0, |r| r.modes));
        assert_eq!((info.status, &info.stop_reason), (Status::Complete, &None), "{name}");
        let cage = scene.resolve().cage.expect("a cage");
        assert!(info.guards.cage_offset_m < cage.thickness, "{name}: {} m", info.guards.cage_offset_m);
        let energy = info.energy.of_larger();
        assert!(energy < 0.05, "{name}: energy is off by {energy}");
    });
}

#[test]
fn issue_ten_own_bearings_run_in_finite_elements() {
    side_by_side(&files(), |file| {
        let scene = scene(file, &["solver.duration_ms=0.05"]);
        let folder = Scratch::create("own-full");
        let info = run(&scene, &folder, "run", 1);
        let name = &scene.name;
        println!("{name}: {:?}, {} elements", info.status, info.mesh.quads + info.mesh.triangles);
        assert_eq!((info.status, &info.stop_reason), (Status::Complete, &None), "{name}");
        assert_eq!(info.warnings, [""; 0], "{name}");
    });
}
