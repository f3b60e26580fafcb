//! What geometry predicts of the paper's bearing.

use stribeck_analysis::prediction::{Prediction, StaticCurve};
use stribeck_scene::deviation::{DeviationScene, FormScene, RollingSurface};
use stribeck_scene::scene::Scene;
use stribeck_store::run_info::MeshInfo;

fn mesh(outer_facets: usize, inner_facets: usize) -> MeshInfo {
    MeshInfo { nodes: 0, quads: 0, triangles: 0, roller_facets: 112, outer_facets, inner_facets }
}

/// The paper's bearing with the counts of its 0.5 mm mesh.
/// Source: Singh et al. 2014, table 1; THEORY §5.2.
#[test]
fn analytic_paper_events_and_lines() {
    // Entries and exits of rollers 1 to 3 computed from Table 1 apart from this program [ms].
    const EXPECTED_MS: [(f64, f64); 3] =
        [(0.839_98, 5.079_51), (11.939_03, 16.178_56), (23.038_08, 27.277_61)];
    let prediction = Prediction::of(&Scene::default().resolve(), &mesh(1257, 1030));
    assert_eq!(prediction.passages().len(), 3);
    for (roller, (found, (entry, exit))) in prediction.passages().iter().zip(EXPECTED_MS).enumerate() {
        assert_eq!(found.roller, roller + 1);
        assert!((1e3 * found.entry_s - entry).abs() < 1e-4, "{found:?}");
        assert!((1e3 * found.exit_s - exit).abs() < 1e-4, "{found:?}");
    }
    let hz: Vec<f64> = prediction.facet_lines.iter().map(|l| l.1).collect();
    // 1235 facets outside the defect's 5.73° stand for 1255 on a whole turn, two fewer than there are.
    for (found, wanted) in hz.iter().zip([4671.5, 4711.4, 4716.0]) {
        assert!((found - wanted).abs() < 1.0, "{hz:?}");
    }
}

#[test]
fn behaves_static_curve_has_a_hole_and_relieving_neighbours() {
    let mut scene = Scene::default();
    scene.bearing.thickness_mm = 20.0;
    let prediction = Prediction::of(&scene.resolve(), &mesh(1257, 1030));
    let curve = prediction.static_curve(&scene.resolve(), 50_000.0).unwrap();
    // At thirty places of the cage.
    assert_eq!(curve.angle_deg.len(), 24 * 30);
    assert!(curve.angle_deg.is_sorted());
    let at = |deg: f64| curve.force_n[curve.angle_deg.partition_point(|&a| a < deg)];
    assert_eq!((at(89.9), at(270.0)), (0.0, 0.0));
    // 10.40 kN at 20 mm thickness, a roller under the load; its neighbours gain 22 % when it unloads.
    assert!((curve.largest_sound_n / 10.40e3 - 1.0).abs() < 0.01, "{}", curve.largest_sound_n);
    // Over the defect's middle its neighbours stand at 75° and 105°, by symmetry equally loaded.
    assert!((at(75.0) / at(105.0) - 1.0).abs() < 0.02, "{} {}", at(75.0), at(105.0));
    assert!(at(105.0) > 0.97 * curve.largest_sound_n, "{}", at(105.0));
}

/// Every roller passes every place, also with missing neighbours: the curve is as smooth as that of a
/// full bearing.
#[test]
fn issue_a_missing_roller_makes_no_sawtooth_of_the_static_curve() {
    let full = Scene { defect: None, ..Scene::default() };
    let missing = DeviationScene {
        on: RollingSurface::Roller(5),
        form: FormScene::Missing,
        ..DeviationScene::default()
    };
    let curve = |scene: &Scene| {
        Prediction::of(&scene.resolve(), &mesh(1257, 1030)).static_curve(&scene.resolve(), 50_000.0).unwrap()
    };
    let steepest = |curve: &StaticCurve| {
        curve.force_n.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max)
    };
    let (sound, gap) = (curve(&full), curve(&Scene { defects: vec![missing], ..full.clone() }));
    assert!(gap.angle_deg.len() <= sound.angle_deg.len() + 1, "{}", gap.angle_deg.len());
    assert!(steepest(&gap) < 2.0 * steepest(&sound), "{} {}", steepest(&gap), steepest(&sound));
    assert!(gap.largest_n > 1.05 * sound.largest_n, "neighbours of the gap carry more");
}

#[test]
fn behaves_a_sound_bearing_has_no_passage() {
    let scene = Scene { defect: None, ..Scene::default() };
    let prediction = Prediction::of(&scene.resolve(), &mesh(0, 0));
    assert!(prediction.passages().is_empty() && prediction.standing().is_none());
    assert!((prediction.facet_period_s() - 1.0 / 4672.0).abs() < 1e-6);
}
