//! Bearings by their names, and their elements and defects.

use super::*;
use stribeck_testing::{assert_has, assert_refused};

#[test]
fn behaves_a_bearing_by_its_name_starts_from_rest_or_turns_back() {
    for operation in
        ["speed_rpm: 0", "speed_rpm: -1500", "speed_rpm: 0, speed_profile: ramp(to_ms: 5, to: 1500)"]
    {
        let scene = Scene::parse(&format!("(bearing: \"NU 205\", operation: ({operation}))"), "mine")
            .expect(operation);
        let frames = scene.output.frames.expect("pictures");
        assert!(frames.to_ms <= scene.solver.duration_ms && frames.from_ms < frames.to_ms, "{operation}");
    }
}

#[test]
fn behaves_a_bearing_by_its_name() {
    let scene = Scene::parse("(bearing: \"NU 205\", operation: (speed_rpm: 1500))", "mine").unwrap();
    let b = &scene.bearing;
    assert_eq!((scene.name.as_str(), b.designation.as_str(), b.rollers), ("nu-205", "NU 205", 13));
    assert_eq!((b.inner_race_diameter_mm, b.outer_race_diameter_mm), (31.5, 46.5));
    // Bore 25 and outside diameter 52.
    assert_eq!((b.inner_ring_thickness_mm, b.outer_ring_thickness_mm), (3.25, 2.75));
    assert_eq!(scene.operation.speed_rpm, 1500.0);
    // Facets of the paper's number.
    assert!((scene.mesh.size_mm / b.roller_diameter_mm - 0.5 / 18.0).abs() < 2e-4);
    // Fields of the file or the command line stay; the complete scene reads back to itself.
    let text = "(bearing: \"NU205, elements=12\", cage: (pocket_clearance_um: 80), mesh: (size_mm: 0.4))";
    let own = Scene::parse(text, "mine").unwrap();
    assert_eq!((own.bearing.rollers, own.mesh.size_mm), (12, 0.4));
    let cage = own.cage.as_ref().unwrap();
    assert!(cage.pocket_clearance_um == 80.0 && cage.outer_diameter_mm < 46.5, "{cage:?}");
    assert_eq!((cage.pocket, own.contact.friction), (PocketWalls::Corners, 0.05));
    let straight =
        Scene::parse("(bearing: \"NU 205\", cage: (pocket: straight), contact: (friction: 0.1))", "mine")
            .unwrap();
    assert_eq!((straight.cage.map(|cage| cage.thickness_mm), straight.contact.friction), (Some(2.99), 0.1));
    assert_eq!(Scene::parse(&own.to_ron(), "complete").unwrap(), own);
    let set = ["operation.load_n=1000", "bearing=NU 205"];
    let other = Scene::default().with_overrides(&set).unwrap();
    assert_eq!((other.operation.load_n, other.bearing.rollers), (1000.0, 13));
}

/// A pedestal that an argument puts in the place of the file's housing has been as large as the paper's,
/// about a ring of 52 mm, and modes of a reduced model as few.
#[test]
fn issue_what_arguments_replace_has_the_size_of_the_bearing() {
    let in_file = Scene::parse("(bearing: \"6205\", housing: pedestal(), model: reduced())", "mine").unwrap();
    let HousingScene::Pedestal(pedestal) = &in_file.housing else { panic!("{:?}", in_file.housing) };
    assert!(pedestal.base_mm < 0.5 * PedestalScene::default().base_mm, "{pedestal:?}");
    let ModelScene::Reduced(reduced) = &in_file.model else { panic!("{:?}", in_file.model) };
    assert!(reduced.modes_khz > 60.0, "{reduced:?}");
    let small = Scene::parse("(bearing: \"6205\")", "mine").unwrap();
    let set = small.with_overrides(&["housing=pedestal()", "model=reduced()"]).unwrap();
    assert_eq!((&set.housing, &set.model), (&in_file.housing, &in_file.model));
    let own = ["housing=pedestal(width_mm: 300)", "model=reduced(modes_khz: 30)"];
    let own = small.with_overrides(&own).unwrap();
    let HousingScene::Pedestal(wide) = &own.housing else { panic!("{:?}", own.housing) };
    assert_eq!((wide.width_mm, wide.base_mm), (300.0, pedestal.base_mm));
    let expected = ReducedScene { modes_khz: 30.0, ..reduced.clone() };
    assert_eq!(own.model, ModelScene::Reduced(expected));
    let papers = Scene::default().with_overrides(&["housing=pedestal()", "model=reduced()"]).unwrap();
    assert_eq!(papers.model, ModelScene::Reduced(ReducedScene::default()));
    assert_eq!(papers.housing, HousingScene::Pedestal(PedestalScene::default()));
}

/// Grading and facets that an argument gave had elements of another size than in the file: forces differed by a
/// tenth, since no row of the ring became coarse.
#[test]
fn issue_one_bearing_has_one_mesh_however_it_is_named() {
    let mesh = "mesh: (roller_facets: 80, grading: ())";
    let scene = |text: &str, set: &[&str]| {
        Scene::parse(text, "mine").and_then(|scene| scene.with_overrides(set)).expect(text).mesh
    };
    let named = scene(&format!("(bearing: \"6203\", {mesh})"), &[]);
    assert_eq!((named.size_mm, named.grading.as_ref().map(|g| g.coarse_mm)), (0.262, Some(0.75)));
    for (text, set) in [
        (&*format!("({mesh})"), &["bearing=6203"][..]),
        ("()", &["bearing=6203", "mesh.grading=()", "mesh.roller_facets=80"]),
        ("()", &["mesh.roller_facets=80", "mesh.grading=()", "bearing=6203"]),
        ("(bearing: \"6203\")", &["mesh.roller_facets=80", "mesh.grading=()"]),
        ("(bearing: \"6203\")", &["mesh=(roller_facets: 80, grading: ())"]),
    ] {
        assert_eq!(scene(text, set), named, "{text} {set:?}");
    }
    let own = scene("(bearing: \"6203\", mesh: (size_mm: 0.4))", &["mesh.roller_facets=80"]);
    assert_eq!((own.size_mm, own.roller_facets), (0.4, 80));
    let papers = scene("()", &["mesh.roller_facets=88", "mesh.grading=()"]);
    assert_eq!((papers.size_mm, papers.grading.map(|g| g.coarse_mm)), (0.5, Some(2.0)));
}

#[test]
fn behaves_every_bearing_of_the_catalogue_makes_a_scene_or_says_why_not() {
    let mut refused = Vec::new();
    for bearing in stribeck_theory::catalogue::all() {
        let text = format!("(bearing: \"{}\")", bearing.name);
        match Scene::parse(&text, "mine") {
            Ok(scene) if bearing.name == stribeck_theory::catalogue::PAPER => {
                assert_eq!(scene, Scene::default())
            }
            Ok(scene) => assert_eq!(scene.bearing.designation, bearing.name),
            Err(why) => {
                let why = why.to_string();
                let kinds = ["contact angle", "self-aligning", "spherical"];
                assert!(kinds.iter().any(|kind| why.contains(kind)), "{text}: {why}");
                if bearing.angle_deg == 0.0 || bearing.elements.is_some() {
                    refused.push(bearing.name.as_str());
                }
            }
        }
    }
    assert_eq!(refused, ["ZA-2115"]);
    let fewer = Scene::parse("(bearing: \"paper, elements=20\")", "mine").unwrap();
    assert_eq!(fewer.bearing, BearingScene { rollers: 20, ..BearingScene::default() });
    let other = Scene::parse("(bearing: \"paper, diameter_mm=17\")", "mine").unwrap_err();
    assert!(other.to_string().contains("as fields of `bearing`"), "{other}");
}

#[test]
fn invariant_balls_have_films_of_cylinders_of_their_own_stiffness_between_rings_of_their_width() {
    use stribeck_theory::{line_contact::LineContacts, point_contact};
    let scene = Scene::parse("(bearing: \"6205\", operation: (load_n: 2000))", "mine").unwrap();
    let g = scene.resolve();
    let load = 4.37 * 2000.0 / 9.0;
    let modulus = g.material.youngs_modulus / (1.0 - g.material.poissons_ratio.powi(2));
    let ball = |race| point_contact::approach(g.roller_radius, race, 1.04 * g.roller_radius, load, modulus);
    let ratio = LineContacts::of(&g).approach(load / g.contact_length).0
        / (ball(g.inner_race_radius) + ball(-g.outer_race_radius));
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
    assert_eq!(g.thickness, 15e-3);
    // Whatever said the load, and wherever.
    let later = Scene::parse("(bearing: \"6205\")", "mine").unwrap();
    let later = later.with_overrides(&["operation.load_n=2000"]).unwrap().resolve();
    assert_eq!(later.contact_length, g.contact_length);
}

/// It was the paper's bearing by that name, without a word.
#[test]
fn issue_a_name_among_the_fields_is_that_bearing() {
    let by_name = Scene::parse("(bearing: \"NU 205\")", "a.ron").expect("a scene");
    let beside = Scene::parse("(bearing: (designation: \"NU 205\", clearance_change_um: -10))", "a.ron")
        .expect("a scene");
    let mut expected = by_name.clone();
    expected.bearing.clearance_change_um = -10.0;
    assert_eq!(beside, expected);
    let argument = "bearing=(designation: \"NU 205\", clearance_change_um: -10)";
    let replaced = Scene::default().with_overrides(&[argument]).expect("a scene");
    assert_eq!((&replaced.bearing, &replaced.cage), (&expected.bearing, &expected.cage));
    let fewer = Scene::parse("(bearing: (designation: \"NU 205\", rollers: 12))", "a.ron").expect("a scene");
    assert_eq!(
        (fewer.bearing.rollers, fewer.bearing.roller_diameter_mm),
        (12, by_name.bearing.roller_diameter_mm)
    );
    // One with a dimension of its own is no bearing of the catalogue.
    let own = "(bearing: (designation: \"NU 205\", rollers: 12, roller_diameter_mm: 9, pitch_mm: 50))";
    assert_eq!(Scene::parse(own, "a.ron").expect("a scene").bearing.roller_diameter_mm, 9.0);
}

/// The preload did not converge, and said no more.
#[test]
fn refuses_a_load_far_beyond_the_static_rating() {
    let why =
        Scene::parse("(bearing: \"NU 205\", operation: (load_n: 1000000))", "a.ron").unwrap_err().to_string();
    assert_has(&why, &["times the static rating", "is the unit right?", "at most 310000 N", "a.ron:1:"]);
}

#[test]
fn refuses_a_bearing_that_nobody_knows() {
    for set in ["bearing=NU 999", "bearing=\"NU 999\""] {
        let why = Scene::default().with_overrides(&[set]).unwrap_err();
        assert!(why.to_string().contains("no bearing `NU 999`"), "{why}");
    }
    for set in ["bearing=NU 205, elements=200", "bearing=NU 205, diameter_mm=20"] {
        let why = Scene::default().with_overrides(&[set]).unwrap_err().to_string();
        assert!(why.contains(&format!("--set {set}")) && why.contains("^^^^"), "{why}");
    }
    let why = Scene::parse("(\n  bearing: \"NU 999\",\n)", "mine").unwrap_err().to_string();
    assert!(why.contains("mine:2:12"), "{why}");
    assert!(why.contains("`bearing: (rollers: 13") && !why.contains("--bearing"), "{why}");
    // A slip elsewhere in the line leaves the name as it was written.
    assert_refused(
        Scene::parse("(bearing: \"NU 205\", mesh: (sise_mm: 1))", "mine"),
        "(bearing: \"NU 205\", mesh: (sise_mm: 1))",
    );
}

#[test]
fn behaves_defects_on_either_ring_with_sloped_edges() {
    let scene = parse("(defect: (ring: inner, edge_slope_deg: 30))").unwrap();
    let defect = scene.resolve().grooves[0];
    assert_eq!(defect.ring, crate::scene::DefectRing::Inner);
    assert!((defect.edge_slope.to_degrees() - 30.0).abs() < 1e-12);
    for (text, field) in [
        ("(defect: (edge_slope_deg: 120))", "defect.edge_slope_deg"),
        ("(film: None, defect: (edge_slope_deg: 6))", "defect.edge_slope_deg"),
        // A film across the edge would act on a roller.
        ("(defect: (edge_slope_deg: 20))", "defect.edge_slope_deg"),
        ("(defect: (ring: middle))", "defect.ring"),
        ("(defect: (ring: inner, depth_mm: 7))", "defect.depth_mm"),
    ] {
        assert_eq!(only(parse(text)).field, field, "{text}");
    }
}
