//! Speed, load and housing: profiles over time, housings of each kind, and those that cannot be.

use super::*;
use stribeck_testing::assert_refused;

#[test]
fn behaves_profiles_are_written_in_files_and_behind_set() {
    let set = |arguments: &[&str]| Scene::default().with_overrides(arguments).expect("valid").operation;
    let ramp = RampScene { from_ms: 5.0, to_ms: 25.0, to: 1500.0 };
    let in_file =
        parse("(operation: (speed_profile: ramp(from_ms: 5, to_ms: 25, to: 1500)))").expect("valid");
    assert_eq!(in_file.operation.speed_profile, Some(ProfileScene::Ramp(ramp.clone())));
    // Beside the fields that the section has already, whole or field by field, of the same kind or of
    // another.
    let whole =
        set(&["operation.speed_rpm=0", "operation.speed_profile=ramp(from_ms: 5, to_ms: 25, to: 1500)"]);
    assert_eq!((whole.speed_rpm, whole.speed_profile), (0.0, Some(ProfileScene::Ramp(ramp))));
    let pieces = set(&["operation.load_profile.amplitude=4000", "operation.load_profile.hz=30"]);
    let sine = HarmonicScene { amplitude: 4000.0, hz: 30.0, phase_deg: 0.0 };
    assert_eq!((pieces.load_n, pieces.load_profile), (50_000.0, Some(ProfileScene::Harmonic(sine))));
    let points = set(&[
        "operation.speed_profile=points([(0, 500), (20, -100)])",
        "operation.rotating_load.force_n=50",
    ]);
    assert_eq!(points.speed_profile, Some(ProfileScene::Points(vec![(0.0, 500.0), (20.0, -100.0)])));
    assert_eq!(points.rotating_load.map(|load| load.force_n), Some(50.0));
    assert_eq!(set(&["operation.speed_rpm=-500"]).speed_rpm, -500.0);
    let scene =
        parse("(operation: (load_profile: points([(1, 2.5)]), rotating_load: (force_n: 1)))").expect("valid");
    assert_eq!(parse(&scene.to_ron()).expect("valid"), scene);
    let text = Scene::default().to_ron();
    assert!(!text.contains("profile") && !text.contains("rotating"), "{text}");
}

#[test]
fn refuses_profiles_that_cannot_be_followed() {
    for (operation, field, words) in [
        ("speed_profile: ramp(to: 1e6)", "operation.speed_profile.to", "outside its range"),
        (
            "speed_profile: ramp(from_ms: 5, to_ms: 5)",
            "operation.speed_profile.to_ms",
            "not after it begins (5 ms)",
        ),
        ("speed_profile: rmp(to: 10)", "operation.speed_profile", "not one of its words"),
        ("speed_profile: ramp(til: 10)", "", "unknown field `til`"),
        ("speed_profile: points([])", "operation.speed_profile", "no points"),
        (
            "speed_profile: points([(0, 1), (0, 2)])",
            "operation.speed_profile",
            "[1]` is at 0 ms: times must ascend",
        ),
        ("speed_profile: points([(inf, 1)])", "operation.speed_profile", "times must ascend"),
        ("speed_profile: points([(0, 1), (1, 2e5)])", "operation.speed_profile[1]", "outside its range"),
        ("load_profile: ramp(to: -5)", "operation.load_profile.to", "outside its range"),
        ("load_profile: harmonic(amplitude: 6e4)", "operation.load_profile.amplitude", "come to -10000"),
        ("load_profile: harmonic(hz: 0)", "operation.load_profile.hz", "outside its range"),
        ("rotating_load: (force_n: 6e4)", "operation.rotating_load.force_n", "would lift the adapter"),
        ("speed_rpm: -200000", "operation.speed_rpm", "outside its range"),
    ] {
        let problem = only(parse(&format!("(operation: ({operation}))")));
        assert!(field.is_empty() || problem.field == field, "{problem}");
        assert!(problem.to_string().contains(words), "{operation}\n{problem}");
        assert!(!problem.allowed.is_empty(), "{operation}\n{problem}");
    }
    let mut unread = Scene::default();
    unread.operation.load_profile = Some(ProfileScene::Table("load.csv".into()));
    assert!(unread.validate().expect_err("in memory").to_string().contains("was not read"));
}

/// The paper's would be cut into millions of elements as fine as those of a small bearing.
#[test]
fn issue_a_pedestal_is_as_large_as_its_bearing_asks_where_its_sides_are_not_given() {
    let sides = |text: &str| match parse(text).expect("valid").housing {
        HousingScene::Pedestal(of) => [of.width_mm, of.base_mm, of.top_mm],
        other => panic!("{other:?}"),
    };
    // 52 mm across instead of 220.
    assert_eq!(sides("(bearing: \"NU 205\", housing: pedestal())"), [75.6, 37.8, 33.1]);
    assert_eq!(sides("(bearing: \"NU 205\", housing: pedestal(width_mm: 90))"), [90.0, 37.8, 33.1]);
    assert_eq!(sides("(housing: pedestal())"), [320.0, 160.0, 140.0]);
}

#[test]
fn behaves_housings_are_written_in_files_and_behind_set() {
    let set = |arguments: &[&str]| Scene::default().with_overrides(arguments).expect("valid");
    let pedestal = parse("(housing: pedestal(width_mm: 300, base_mm: 150))").expect("valid");
    let HousingScene::Pedestal(of) = &pedestal.housing else { panic!("{:?}", pedestal.housing) };
    assert_eq!([of.width_mm, of.base_mm, of.top_mm], [300.0, 150.0, 140.0]);
    assert_eq!(parse(&pedestal.to_ron()).expect("valid"), pedestal);
    let turning =
        set(&["housing=rigid(mass_kg: 3)", "operation.outer_speed_rpm=-200", "operation.load_angle_deg=10"]);
    assert_eq!(parse(&turning.to_ron()).expect("valid"), turning);
    assert_eq!(turning.load_zone_deg(), 190.0);
    assert!(turning.housing.is_rigid() && turning.operation.outer_speed_rpm == -200.0);
    assert_eq!(
        set(&["housing.mass_kg=3"]).housing,
        HousingScene::Rigid(RigidHousingScene { mass_kg: 3.0, ..Default::default() })
    );
    // Either speed over time beside the other.
    let ramps = set(&[
        "housing=rigid()",
        "operation.speed_profile=ramp(to: 900)",
        "operation.outer_speed_profile.amplitude=30",
    ]);
    assert!(
        matches!(ramps.operation.outer_speed_profile, Some(ProfileScene::Harmonic(ref s)) if s.amplitude == 30.0)
    );
    assert_eq!(parse(&ramps.to_ron()).expect("valid"), ramps);
    let springs = set(&["housing=springs()", "housing.stiffness_n_um=50"]);
    assert!(matches!(springs.housing, HousingScene::Springs(ref s) if s.stiffness_n_um == 50.0));
    // Omitted fields are not written: hashes of older scenes stay.
    let text = Scene::default().to_ron();
    assert!(
        !text.contains("housing") && !text.contains("load_angle") && !text.contains("outer_speed"),
        "{text}"
    );
}

#[test]
fn refuses_what_a_ring_from_a_file_leaves_to_the_file() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/rings/notched_outer.msh");
    for (more, field, words) in [
        // The file does not mention the paper's spall: the message names the field that it does mention.
        (
            "",
            "outer_ring_mesh",
            "`defect` has steep walls on a ring whose mesh is that of `outer_ring_mesh.file`",
        ),
        (
            "film: None, defect: None, defects: [(on: inner, form: spall(edge: rectangular)), (on: outer, \
             form: spall(edge: rectangular))]",
            "defects[1].form.edge",
            "`defects[1]` has steep walls",
        ),
        (
            "defect: None, mesh: (outer_facets: 200)",
            "mesh.outer_facets",
            "the facets of that raceway are those of",
        ),
    ] {
        let text = format!("(outer_ring_mesh: (file: {file:?}), {more})");
        let error = parse(&text).expect_err(more);
        let problem = &error.problems()[0];
        assert_eq!((problem.field.as_str(), problem.message.contains(words)), (field, true), "{error}");
    }
    let inner = format!("(inner_ring_mesh: (file: {file:?}), bearing: (clearance_change_um: 3))");
    assert_refused(parse(&inner), "let the file have it");
    let none = only(parse("(outer_ring_mesh: (file: \"none.msh\"))"));
    assert_eq!(none.field, "outer_ring_mesh.file");
    assert!(none.message.contains("cannot read the mesh `none.msh`"), "{none}");
    // Leaning walls are moved out of any raceway.
    parse(&format!(
        "(film: None, defect: None, outer_ring_mesh: (file: {file:?}), defects: [(form: spall(edge_mm: 1))])"
    ))
    .expect("valid");
    assert!(!Scene::default().to_ron().contains("ring_mesh"));
}

#[test]
fn refuses_housings_that_do_not_fit() {
    for (scene, field, words) in [
        (
            "housing: pedestal(width_mm: 200)",
            "housing.width_mm",
            "no pedestal around the outer ring (220 mm across)",
        ),
        ("housing: pedestal(top_mm: -1)", "housing.top_mm", "outside its range"),
        ("housing: pedestal(height_mm: 1)", "", "unknown field `height_mm`"),
        ("housing: pedestral()", "housing", "not one of its words"),
        ("housing: mesh(file: \"none.msh\")", "housing.file", "cannot read the mesh `none.msh`"),
        ("housing: springs(stiffness_n_um: 0)", "housing.stiffness_n_um", "outside its range"),
        ("housing: rigid(mass_kg: -1)", "housing.mass_kg", "outside its range"),
        ("operation: (load_angle_deg: 90)", "operation.load_angle_deg", "does not take a load from there"),
        (
            "housing: pedestal(), operation: (load_angle_deg: 45)",
            "operation.load_angle_deg",
            "what takes the load is guided up and down",
        ),
        ("operation: (outer_speed_rpm: 100)", "operation.outer_speed_rpm", "the housing cannot turn"),
        (
            "operation: (outer_speed_profile: ramp(to: 100))",
            "operation.outer_speed_profile",
            "the housing cannot turn",
        ),
        (
            "housing: rigid(), operation: (outer_speed_profile: ramp(to: 1e6))",
            "operation.outer_speed_profile.to",
            "outside its range",
        ),
        (
            "housing: rigid(), operation: (outer_speed_profile: points([(3, 1), (2, 2)]))",
            "operation.outer_speed_profile",
            "[1]` is at 2 ms: times must ascend",
        ),
        (
            "output: (frames: (from_ms: 7, to_ms: 3))",
            "output.frames.to_ms",
            "pictures end at 3 ms, before they begin (7 ms)",
        ),
        (
            "bearing: (clearance_change_um: -200)",
            "bearing.clearance_change_um",
            "leaves a clearance of -160 µm: between -90 µm (-0.5 % of the roller's diameter) and 1800 µm (10 \
             %)",
        ),
    ] {
        let problem = only(parse(&format!("({scene})")));
        assert!(field.is_empty() || problem.field == field, "{scene}\n{problem}");
        assert!(problem.to_string().contains(words), "{scene}\n{problem}");
    }
}

/// An exciter pulls a housing that surrounds its ring against the load, too; a run only starts under a load
/// that presses.
#[test]
fn issue_a_rotating_load_beyond_the_static_one_runs_where_nothing_can_lift() {
    let scene = |housing: &str, angle_deg: f64| {
        parse(&format!(
            "(bearing: \"NU 205\", housing: {housing}, defect: None,
              operation: (load_n: 200, speed_rpm: 1500, rotating_load: (force_n: 3000, angle_deg: \
              {angle_deg})))"
        ))
    };
    for housing in ["rigid(mass_kg: 5)", "springs()", "pedestal()"] {
        assert!(scene(housing, 270.0).is_ok(), "{housing}: {:?}", scene(housing, 270.0).err());
        let problem = only(scene(housing, 90.0));
        assert_eq!(problem.field, "operation.rotating_load.angle_deg");
        assert!(problem.to_string().contains("-2800 N"), "{problem}");
    }
    let problem = only(scene("adapter", 270.0));
    assert!(problem.to_string().contains("lift the adapter"), "{problem}");
}

#[test]
fn refuses_reduced_scenes_of_what_only_the_full_model_has() {
    let problem = only(parse("(model: reduced(modes_khz: 30), film: None, solver: (start: sudden))"));
    assert!(problem.message.contains("`solver.start` is `sudden`"), "{problem}");
    assert!(parse("(model: reduced(modes_khz: 30))").is_ok(), "with oil");
    for of_both in ["", "defect: (ring: inner)", "defects: [(on: roller(1), angle_deg: 0, form: dent())]"] {
        assert!(
            parse(&format!("(model: reduced(modes_khz: 30), film: None, {of_both})")).is_ok(),
            "{of_both}"
        );
    }
}
