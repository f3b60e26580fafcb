//! Bearings by their own fields run at the first try: omitted fields of the scene fit their size.

use std::path::PathBuf;

use crate::common::run;
use stribeck_scene::scene::Scene;
use stribeck_store::run_info::Status;
use stribeck_testing::{Scratch, side_by_side};
use stribeck_theory::catalogue::Element;

/// Elements as a test can afford them, in proportion to the rollers, with contact as stiff as they are.
const COARSE: [&str; 4] = [
    "mesh.roller_facets=48",
    "mesh.grading=(fine_layers: 1)",
    "contact.penalty_scale=0.3",
    "output.frames=None",
];

fn files() -> Vec<PathBuf> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/own");
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
        assert!(info.energy.share() < 0.05, "{name}: energy is off by {}", info.energy.in_words());
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

/// Bearings of makers' catalogues by what those print: bore, outside diameter and width, number and diameter of
/// the balls, load [N]. Source: ISO 15 for the first three; balls as makers fit them (d_w = 0.3 (D − d), to the
/// next of the diameters that balls are made in).
const BALLS: [([f64; 3], u32, f64, f64); 12] = [
    ([10.0, 26.0, 8.0], 7, 4.762, 300.0),
    ([12.0, 28.0, 8.0], 8, 4.762, 350.0),
    ([15.0, 32.0, 9.0], 9, 4.762, 400.0),
    ([20.0, 42.0, 12.0], 9, 6.35, 700.0),
    ([25.0, 47.0, 12.0], 10, 6.35, 800.0),
    ([40.0, 68.0, 15.0], 12, 7.938, 1200.0),
    ([15.0, 35.0, 11.0], 8, 5.953, 500.0),
    ([20.0, 47.0, 14.0], 8, 7.938, 900.0),
    ([35.0, 72.0, 17.0], 9, 11.112, 2000.0),
    ([50.0, 90.0, 20.0], 10, 12.7, 2500.0),
    ([20.0, 52.0, 15.0], 7, 9.525, 1000.0),
    ([40.0, 90.0, 23.0], 8, 15.081, 3000.0),
];

/// The same of cylindrical roller bearings NU 204, NJ 207, N 208 and NU 1010, with the inner raceway F.
const ROLLERS: [([f64; 3], u32, f64, f64, f64); 4] = [
    ([20.0, 47.0, 14.0], 11, 7.5, 26.5, 1500.0),
    ([35.0, 72.0, 17.0], 13, 10.0, 44.0, 4000.0),
    ([40.0, 80.0, 18.0], 14, 11.0, 49.5, 5000.0),
    ([50.0, 80.0, 16.0], 18, 7.5, 57.5, 3000.0),
];

/// Sixteen bearings in the words of catalogues run by both models as they stand, with a spall.
#[test]
fn behaves_sixteen_bearings_of_catalogues_run_at_the_first_try() {
    let scene = |[bore, outside, width]: [f64; 3], elements: String, load: f64| {
        format!(
            "(bearing: (bore_mm: {bore}, outside_mm: {outside}, width_mm: {width}, {elements}), operation: (load_n: \
             {load}, speed_rpm: 1500), defect: (ring: outer, length_mm: 1))"
        )
    };
    let balls = BALLS.iter().map(|&(boundary, balls, mm, load)| {
        let pitch = 0.5 * (boundary[0] + boundary[1]);
        let elements = format!("balls: {balls}, ball_diameter_mm: {mm}, pitch_mm: {pitch}");
        (scene(boundary, elements, load), Element::Ball)
    });
    let rollers = ROLLERS.iter().map(|&(boundary, count, mm, inner, load)| {
        let elements = format!("elements: {count}, roller_diameter_mm: {mm}, pitch_mm: {}", inner + mm);
        (scene(boundary, elements, load), Element::Roller)
    });
    let all: Vec<(String, Element)> = balls.chain(rollers).collect();
    side_by_side(&all, |(text, element)| {
        let scene = Scene::parse(text, "own.ron").unwrap_or_else(|why| panic!("{why}"));
        assert_eq!(scene.element(), *element, "{text}");
        let full = ["solver.duration_ms=0.02"];
        let reduced = ["model=reduced()", "solver.duration_ms=10", "output.interval_us=50"];
        for set in [&full[..], &reduced] {
            let set: Vec<&str> = COARSE.iter().chain(set).copied().collect();
            let scene = scene.with_overrides(&set).unwrap_or_else(|why| panic!("{text}: {why}"));
            let folder = Scratch::create("own-of-catalogues");
            let info = run(&scene, &folder, "run", 1);
            assert_eq!((info.status, &info.stop_reason), (Status::Complete, &None), "{text} {set:?}");
        }
    });
}
