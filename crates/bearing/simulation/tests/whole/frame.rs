//! A ring in a frame on soft springs: modes, dampers and mass damping of the two.

use std::f64::consts::TAU;

use crate::common::small;
use stribeck_scene::scene::Scene;
use stribeck_simulation::reduction::{ReducedMesh, modal_bearing};
use stribeck_testing::ledger::compare;

/// Of a frame on springs so soft that the ring stays round: both move together, in either direction, without
/// resistance, or against each other with ω² = k (1/m + 1/M). Dampers of c take c (1/m + 1/M) of such a
/// motion's momentum a second.
/// Source: two masses on a spring, Meirovitch 2001, §5.1.
#[test]
fn analytic_a_ring_on_springs_bounces_in_its_frame() {
    // The ring gives way by 1 % of the springs' deflection.
    const TOLERANCE: f64 = 0.01;
    let (k, c, frame) = (1e6, 100.0, 1.5);
    let scene = small(
        "housing: springs(stiffness_n_um: 1, damping_n_s_m: 100, mass_kg: 1.5), operation: (load_n: 100)",
    );
    let reduction = ReducedMesh::new(&scene.resolve()).expect("modes").reduction;
    let ring = reduction.structure_mass - frame;
    let both = 1.0 / ring + 1.0 / frame;
    let lowest: Vec<f64> =
        reduction.squares[..reduction.modes].iter().map(|square| square.max(0.0).sqrt() / TAU).collect();
    println!("modes at {lowest:.1?} Hz");
    let expected = (k * both).sqrt() / TAU;
    assert!(lowest[..2].iter().all(|hz| hz.abs() < 1.0), "{lowest:?}");
    let mut bouncing: Vec<usize> =
        (0..reduction.modes).filter(|&n| (lowest[n] / expected - 1.0).abs() < 0.05).collect();
    bouncing.truncate(2);
    assert_eq!(bouncing.len(), 2, "{lowest:?}");
    for n in bouncing {
        let source = "two masses on a spring, Meirovitch 2001, §5.1";
        compare("a ring bounces in its frame", source, "Hz", lowest[n], expected, TOLERANCE);
        let damping = reduction.dampers[n * reduction.padded + n];
        compare("dampers of the frame", source, "1/s", damping, c * both, TOLERANCE);
    }
}

/// A ring of the mass m in a frame of M on soft springs, which bounce against each other: α brakes the ring
/// alone and takes α M/(m + M) of such a motion's momentum a second. In a rigid housing it takes nothing.
/// With the housing's mass braked, too, the paper's ring in one of 10 kg had 25 dB too little where it
/// bounces on its rollers.
/// Source: two masses on a spring, Meirovitch 2001, §5.1.
#[test]
fn analytic_mass_damping_brakes_no_frame() {
    const TOLERANCE: f64 = 0.01;
    let of = |housing: &str| {
        let text = format!(
            "(bearing: \"NU 205\", model: reduced(modes_khz: 30), film: None, defect: None, \
             operation: (load_n: 100), housing: {housing},
              mesh: (size_mm: 0.7, roller_facets: 64), \
             solver: (mass_damping_per_s: 2000, structural_damping: None))"
        );
        let scene = Scene::parse(&text, "here").expect("a valid scene");
        let mesh = ReducedMesh::new(&scene.resolve()).expect("modes");
        modal_bearing(&scene.resolve(), mesh.reduction).expect("a valid scene")
    };
    let frame = 1.5;
    let bearing = of("springs(stiffness_n_um: 1, damping_n_s_m: 0, mass_kg: 1.5)");
    let reduction = &bearing.reduction;
    let ring = reduction.structure_mass - frame;
    let hz = (1e6 * (1.0 / ring + 1.0 / frame)).sqrt() / TAU;
    let bounces = |n: &usize| (reduction.squares[*n].max(0.0).sqrt() / TAU / hz - 1.0).abs() < 0.05;
    // The third turns them against each other.
    for n in (0..reduction.modes).filter(bounces).take(2) {
        let braked = bearing.parameters.damping.mass_of_modes + reduction.dampers[n * reduction.padded + n];
        let expected = 2000.0 * frame / (ring + frame);
        compare(
            "mass damping of a ring in its frame",
            "two masses on a spring, Meirovitch 2001, §5.1",
            "1/s",
            braked,
            expected,
            TOLERANCE,
        );
    }
    assert_eq!(of("rigid(mass_kg: 10)").parameters.damping.mass_of_modes, 0.0);
}
