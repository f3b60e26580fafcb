//! Rollers that slide or stop, and cages that stray.

use stribeck_analysis::kinematics::{KinematicsFinding, RollerMotion};
use stribeck_analysis::prediction::Prediction;
use stribeck_analysis::rolling::{flats, friction_over_edge, least_support_n, straying, warnings};
use stribeck_scene::deviation::{DeviationScene, FormScene, RollingSurface, SpallScene};
use stribeck_scene::resolved::ResolvedScene;
use stribeck_scene::scene::{CageScene, PocketWalls, Scene};
use stribeck_store::run_info::MeshInfo;
use stribeck_theory::static_load::RigidRings;

/// By hand: a roller of 6 mm in radius whose raceways approach each other by δ = 16 µm takes ½ √(2 ·
/// 16/6000) = 0.037 to turn over the edge of a deep spall, ½ √(2 · 5/6000) = 0.020 over one of 5 µm, and
/// no more than a quarter of 0.3 mm over 6 mm, 0.0125, over a short one.
#[test]
fn by_hand_friction_that_turns_a_roller_over_an_edge() {
    let scene = Scene::default();
    let geometry = ResolvedScene { roller_radius: 6e-3, ..scene.resolve() };
    let rings = RigidRings::new(&geometry, geometry.contact_law);
    let (mut low, mut high): (f64, f64) = (0.0, 1e6);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if rings.approach_m(middle) < 16e-6 { low = middle } else { high = middle }
    }
    let needs = |length_mm: f64, depth_mm: f64| {
        friction_over_edge(&geometry, &SpallScene { length_mm, depth_mm, ..SpallScene::default() }, low)
    };
    for (found, by_hand) in
        [(needs(4.0, 0.25), 0.0365), (needs(4.0, 5e-3), 0.0204), (needs(0.3, 0.25), 0.0125)]
    {
        assert!((found - by_hand).abs() < 1e-4, "{found}, {by_hand}");
    }
    let spall = FormScene::Spall(SpallScene { length_mm: 4.0, depth_mm: 0.25, ..SpallScene::default() });
    let mut spalled = Scene {
        defects: vec![DeviationScene {
            on: RollingSurface::Roller(5),
            form: spall,
            ..DeviationScene::default()
        }],
        ..scene
    };
    spalled.contact.friction = 0.005;
    assert!(
        flats(&spalled.resolve(), 10e3)[0].contains("roller 5 may stop on its spall"),
        "{:?}",
        flats(&spalled.resolve(), 10e3)
    );
    spalled.contact.friction = 0.2;
    assert_eq!(flats(&spalled.resolve(), 10e3), [""; 0]);
}

#[test]
fn planted_a_roller_that_has_stopped_is_named() {
    let of = |roller: usize, spin_hz: f64| RollerMotion { roller, orbit_hz: 8.0, spin_hz, loaded: true };
    let motion = KinematicsFinding {
        expected_roller_spin_hz: 52.9,
        roller_spin_hz: Some(52.8),
        rollers: vec![of(4, 52.8), of(5, 3.1)],
        ..Default::default()
    };
    let said = warnings(8e3, None, &motion);
    assert!(said.len() == 1 && said[0].contains("roller 5 has lost its spin: 3.1 Hz"), "{said:?}");
}

#[test]
fn planted_a_cage_that_strays_is_named() {
    // Pockets of 100 µm.
    let scene = Scene::default();
    let path = |far: f64| straying(&scene.resolve(), &[1e-3, 1e-3 + 0.6 * far, 1e-3], &[0.0, 0.8 * far, 0.0]);
    assert!(path(0.9e-3).is_none());
    assert!(
        path(1.2e-3)
            .expect("twelve clearances")
            .contains("strays by 1200 µm, where its pockets leave 100 µm")
    );
    // Rollers of 18 mm on a pitch circle of 182 mm: corners on a diameter of 184 mm are 18.2 mm apart,
    // those on 188 mm 17.5 mm.
    for (inner_mm, words) in [(184.0, "go through"), (188.0, "from one side only")] {
        let cage = CageScene {
            pocket: PocketWalls::Corners,
            outer_diameter_mm: inner_mm + 8.0,
            thickness_mm: 4.0,
            ..CageScene::default()
        };
        let said = straying(&Scene { cage: Some(cage), ..scene.clone() }.resolve(), &[0.0, 0.9], &[0.0, 0.0]);
        assert!(
            said.as_ref().is_some_and(|said| said.contains(words) && said.contains("900 mm")),
            "{said:?}"
        );
    }
    assert!(straying(&Scene { cage: None, ..scene.clone() }.resolve(), &[0.0, 1.0], &[0.0, 0.0]).is_none());
}

/// The paper's bearing by hand: 0.3 N m s² … I = ½ m r² with m = 7850 · π · 9² · 30 mm³ = 59.9 g.
#[test]
fn by_hand_the_paper_s_load_spins_rollers_up_many_times_over() {
    let scene = Scene::default();
    let mesh = MeshInfo {
        nodes: 0,
        quads: 0,
        triangles: 0,
        roller_facets: 112,
        outer_facets: 1257,
        inner_facets: 1030,
    };
    let curve = Prediction::of(&scene.resolve(), &mesh).static_curve(&scene.resolve(), 50e3).unwrap();
    let least_n = least_support_n(&scene.resolve(), &curve, 50e3).unwrap();
    // The spin in space is 2π · 37.96 Hz = 238.5 rad/s, so I ω = 5.79e-4 N m s. A roller's passage adds
    // at most 2 · 0.005 · 9 mm times its load over time. All rollers carry 50 kN along y; by the cosine
    // the mean load of a place times the 24 rollers is 4/π · 50 kN or less, so in a turn of 266 ms a
    // roller has 600 to 710 N s, and 53 to 64 mN m s.
    assert!((430.0..560.0).contains(&least_n), "{least_n}");
    let rolling =
        KinematicsFinding { expected_roller_spin_hz: 41.7, roller_spin_hz: Some(41.6), ..Default::default() };
    assert_eq!(warnings(50e3, Some(least_n), &rolling), [""; 0]);
    let sliding = KinematicsFinding { roller_spin_hz: Some(30.0), ..rolling };
    let said = warnings(100.0, Some(least_n), &sliding);
    assert!(said[0].contains("0.10 kN do not keep") && said[1].contains("28.1 % slower"), "{said:?}");
    let smooth =
        Scene { contact: stribeck_scene::scene::ContactScene { friction: 0.0, ..scene.contact }, ..scene };
    assert_eq!(least_support_n(&smooth.resolve(), &curve, 50e3), Some(f64::INFINITY));
}
