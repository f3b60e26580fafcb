//! Largest static force on a roller in one bearing with several meshes: what the elements are is no property of a
//! bearing.
//!
//! ```text
//!       load
//!   ┌────▼────┐  columns of the adapter stand on nodes of the ring's back: on all of them, or on every other one
//!   │         │  beyond 30°, where they would become too narrow
//!   └─╲_____╱─┘
//!   ring, rollers, ring: squares of one size, or 1 → 3 → 9 away from the raceways
//! ```

use stribeck_scene::scene::Scene;
use stribeck_simulation::bearing::{assembly::Assembly, start::preload};
use stribeck_testing::side_by_side;

/// Balls and rollers from bores of 15 to 60 mm, with rings from 2 to 6 mm thick.
const BEARINGS: [&str; 12] = [
    "6203", "6205", "6209", "6305", "6308", "NU 205", "NU 206", "NU 208", "NU 210", "NU 305", "NU 308",
    "NU 1010",
];

/// With the number of meshes for each: a ring that does not deform has its seat in none, and one in a bore has its
/// polygon in all.
const HOUSINGS: [(&str, usize); 3] = [("adapter", MESHES.len()), ("pedestal()", 4), ("rigid()", 2)];

/// A mesh: facets of a rolling element, elements over the size that goes with them, and coarse elements over that, or
/// all alike. Below three no row of a ring becomes coarse, and its back has as short facets as the raceway.
const MESHES: [(usize, f64, Option<f64>); 7] = [
    (56, 1.0, Some(3.1)),
    (48, 1.0, None),
    (56, 1.0, Some(9.5)),
    (48, 1.0, Some(2.9)),
    (64, 1.3, Some(2.9)),
    (48, 1.0, Some(1.1)),
    (64, 1.3, Some(3.1)),
];

/// Largest force on a roller in equilibrium [N].
fn largest_force(bearing: &str, housing: &str, (facets, larger, ratio): (usize, f64, Option<f64>)) -> f64 {
    let set = [
        format!("bearing={bearing}"),
        format!("housing={housing}"),
        format!("mesh.roller_facets={facets}"),
        "film=None".into(),
        "defect=None".into(),
        "cage=None".into(),
        "bearing.first_roller_deg=90".into(),
        // On chords a load at a node sinks in deeper than one between two: 2 % by the number of facets alone.
        "contact.interpolation=spline".into(),
    ];
    let scene = Scene::default().with_overrides(&set).expect("a scene");
    let size_mm = larger * scene.mesh.size_mm;
    let grading = ratio.map_or("None".into(), |ratio| format!("(coarse_mm: {})", ratio * size_mm));
    let mesh = [format!("mesh.size_mm={size_mm}"), format!("mesh.grading={grading}")];
    let scene = scene.with_overrides(&mesh).expect("a scene").resolve();
    let assembly = Assembly::new(&scene).expect("a mesh");
    let mut machine = assembly.build(&scene, 1).expect("a machine");
    let warning = preload(&mut machine, &scene, &assembly.kinematics).expect("an equilibrium");
    assert_eq!(warning, None, "{bearing} {housing} {facets} {grading}");
    let _ = machine.system.contact_forces();
    let force: Vec<f64> = machine.system.resultants().map(|r| r.force[0].hypot(r.force[1])).collect();
    (0..machine.rollers.len()).map(|i| force[machine.pairs.outer(i)]).fold(0.0, f64::max)
}

/// Where facets of an adapter spanned two of the ring in it, their chords pressed on the vertices between, and opened
/// the seat beside the load: 6203 carried 197, 267 or 298 N by its mesh.
/// Source: THEORY §6.5.
#[test]
fn converges_the_largest_force_is_that_of_the_bearing_not_of_its_mesh() {
    /// From the first mesh.
    const SHARE: f64 = 0.01;
    let in_housings = |bearing: &&'static str| HOUSINGS.map(|(housing, meshes)| (*bearing, housing, meshes));
    let cases: Vec<(&str, &str, usize)> = BEARINGS.iter().flat_map(in_housings).collect();
    let off = side_by_side(&cases, |(bearing, housing, meshes)| {
        let force: Vec<f64> =
            MESHES[..*meshes].iter().map(|mesh| largest_force(bearing, housing, *mesh)).collect();
        let percent: Vec<f64> = force.iter().map(|n| 100.0 * (n / force[0] - 1.0)).collect();
        println!("{bearing} {housing}: {:.0} N, {percent:.2?} %", force[0]);
        percent.into_iter().fold(0.0_f64, |most, off| most.max(0.01 * off.abs()))
    });
    for ((bearing, housing, _), off) in cases.iter().zip(off) {
        assert!(off < SHARE, "{bearing} {housing}: off by {off}");
    }
}
