//! What holds the outer ring of a reduced bearing, and how it turns, beside the full model and beside closed forms.

mod common;

use std::f64::consts::TAU;

use common::{run, trace};
use stribeck_reduced::reduction::Reduction;
use stribeck_scene::{
    run_info::Status,
    scene::{ModelScene, Scene},
};
use stribeck_testing::{Scratch, ledger::compare};

/// A small bearing on a coarse mesh, dry and quiet by mass damping.
fn small(more: &str) -> Scene {
    let text = format!(
        "(bearing: \"NU 205\", model: reduced(modes_khz: 30, step_us: 0.25), film: None, defect: None,
          mesh: (size_mm: 0.7, roller_facets: 64), output: (frames: None),
          contact: (surface: arc, penalty_scale: 1, friction: 0.05),
          solver: (duration_ms: 2, mass_damping_per_s: 2000, structural_damping: None), {more})"
    );
    Scene::parse(&text, "here").expect("a sound scene")
}

/// Of a frame on springs so soft that the ring stays round: both move together, in either direction, without resistance, or against
/// each other with ω² = k (1/m + 1/M). Dampers of c take c (1/m + 1/M) of such a motion's momentum a second.
/// Source: two masses on a spring, Meirovitch 2001, §5.1.
#[test]
fn analytic_a_ring_on_springs_bounces_in_its_frame() {
    // The ring gives way by 1 % of what the springs do.
    const TOLERANCE: f64 = 0.01;
    let (k, c, frame) = (1e6, 100.0, 1.5);
    let scene = small(
        "housing: springs(stiffness_n_um: 1, damping_n_s_m: 100, mass_kg: 1.5), operation: (load_n: 100)",
    );
    let reduction = Reduction::new(&scene).expect("modes");
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

/// From one start both models have the same forces in arrangements of which each is something else's limit: springs and dampers under
/// a load that turns, a rigid housing under one, an outer ring that turns with a spall, a roller that is missing, and steep walls on
/// both rings.
#[test]
fn example_arrangements_are_felt_as_by_the_full_model() {
    // Means over a quarter of a millisecond, of the largest of them: where nodes of a coarse mesh lie changes the stiffness of
    // contacts by ±4 % (THEORY §9.6).
    const FORCES: f64 = 0.03;
    const SHAFT: &str = "operation: (load_n: 3000, load_angle_deg: 200, speed_rpm: 1500";
    let spall = "defects: [(on: outer, angle_deg: 20, form: spall(length_mm: 3, depth_mm: 0.05))]";
    let steep = "form: spall(length_mm: 3, depth_mm: 0.05, edge: rectangular)";
    for (name, more) in [
        (
            "springs",
            format!(
                "housing: springs(stiffness_n_um: 200, damping_n_s_m: 3000, mass_kg: 1), {SHAFT}, rotating_load: (force_n: 1500, angle_deg: 10))"
            ),
        ),
        (
            "rigid",
            format!("housing: rigid(mass_kg: 1), {SHAFT}, rotating_load: (force_n: 1500, angle_deg: 10))"),
        ),
        ("turning", format!("housing: rigid(mass_kg: 1), {spall}, {SHAFT}, outer_speed_rpm: -1000)")),
        ("missing", "defects: [(on: roller(4), form: missing)], operation: (load_n: 3000)".to_owned()),
        (
            "grooves",
            format!(
                "defects: [(on: outer, angle_deg: 45, {steep}), (on: outer, angle_deg: 95, {steep}), (on: inner, angle_deg: 84, {steep})]"
            ),
        ),
    ] {
        let scene = small(&more);
        let folder = Scratch::create("reduced-arrangement");
        let reduced = run(&scene, &folder, "reduced", 1);
        assert_eq!(reduced.status, Status::Complete, "{name}: {:?}", reduced.stop_reason);
        let off = reduced.energy.max_relative_error;
        assert!(off < 0.01, "{name}: energy off by {off}");
        let full = Scene { model: ModelScene::Full, ..scene.clone() };
        assert_eq!(run(&full, &folder, "full", 2).status, Status::Complete, "{name}");
        let means = |of: &str| -> Vec<f64> {
            let trace = trace(&folder, of);
            let channel =
                |i: usize, c: &str| trace.get(&format!("roller.{i}.outer_f{c}_n")).expect("recorded");
            let forces = scene.rollers_in_place().flat_map(|i| [channel(i, "x"), channel(i, "y")]);
            let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
            forces.flat_map(|force| force.chunks(25).map(mean).collect::<Vec<_>>()).collect()
        };
        let [reduced, full] = ["reduced", "full"].map(means);
        assert_eq!(reduced.len(), full.len());
        let largest = full.iter().copied().fold(0.0, |most, force| force.abs().max(most));
        let square = reduced.iter().zip(&full).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        let apart = (square / full.len() as f64).sqrt() / largest;
        println!(
            "{name}: forces {:.2} % of {largest:.0} N apart, energy off by {:.3} %",
            100.0 * apart,
            100.0 * off
        );
        assert!(apart < FORCES, "{name}: {apart}");
    }
}
