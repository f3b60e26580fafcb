//! Defects and deviations that a mesh cannot follow, and the proposed values.

use super::{mark, only, parse};
use crate::deviation::{FormScene, RollingSurface};
use crate::scene::Scene;
use stribeck_testing::assert_refused;

/// A scene without oil and without the paper's spall.
fn dry(defects: &str) -> String {
    format!("(film: None, defect: None, defects: [{defects}])")
}

#[test]
fn roundtrip_defects_of_every_form_are_read_and_written_again() {
    let text = dry(
        "(on: roller(3), angle_deg: 20, form: spall(length_mm: 4)), (on: inner, form: dent(depth_mm: 0.02)), \
         (form: profile(points: [(at_mm: -1, depth_um: 0), (at_mm: 0, depth_um: 5), (at_mm: 1, depth_um: \
         0)])), (form: waviness(order: 9)), \
         (on: inner, form: roughness(seed: 4)), (on: roller(24), form: diameter(larger_um: 3))",
    );
    let scene = parse(&text).expect("six that a mesh can follow");
    assert_eq!(parse(&scene.to_ron()).expect("its own text"), scene);
    assert_eq!(scene.defects[0].on, RollingSurface::Roller(3));
    assert_eq!(scene.faults(), [RollingSurface::Outer, RollingSurface::Inner, RollingSurface::Roller(3)]);
    let set =
        scene.with_overrides(&["defects[1].form.rim_um=2.5", "defects[3].form.order=5"]).expect("fields");
    let FormScene::Dent(dent) = &set.defects[1].form else { panic!("{:?}", set.defects[1]) };
    assert_eq!(dent.rim_um, 2.5);
    let steeper = scene.with_overrides(&["defects[4].form.slope=2.6"]).expect("a field that was not written");
    let FormScene::Roughness(roughness) = &steeper.defects[4].form else {
        panic!("{:?}", steeper.defects[4])
    };
    assert_eq!(roughness.slope, 2.6);
    assert_eq!(parse(&steeper.to_ron()).expect("its own text"), steeper);
    // A spall has no slope.
    assert_refused(
        scene.with_overrides(&["defects[0].form.slope=2.6"]),
        "`spall`, which has no field `slope`",
    );
    let none = Scene::default().with_overrides(&["film=None", "defects=[(on: inner, form: dent())]"]);
    assert_eq!(none.expect("a list on the command line").defects.len(), 1);
    // The hash of a scene without them is that of scenes from before.
    let plain = Scene::default().to_ron();
    assert!(plain.contains("defects: [],"));
    assert_ne!(scene.hash(), Scene { defects: Vec::new(), ..scene.clone() }.hash());
}

#[test]
fn refuses_what_no_mesh_can_follow() {
    for (defect, field, words) in [
        (
            "form: spall(length_mm: 1)",
            "defects[0].form.length_mm",
            "facets of the outer raceway are 0.500 mm long",
        ),
        ("on: roller(25)", "defects[0].on", "outside its range"),
        (
            "on: roller(1), form: spall(length_mm: 20)",
            "defects[0].form.length_mm",
            "roller 1 measures 56.5 mm around",
        ),
        ("form: spall(depth_mm: 0.3)", "defects[0].form.depth_mm", "would slope by 31°"),
        (
            "form: spall(depth_mm: 0.05, edge_mm: 0.2)",
            "defects[0].form.edge_mm",
            "an edge takes a facet of 0.500 mm at least",
        ),
        (
            "on: roller(1), form: spall(length_mm: 1.5, edge: rectangular)",
            "defects[0].form.length_mm",
            "facets of roller 1 are 0.505 mm long",
        ),
        (
            "form: spall(edge: rectangular, edge_mm: 0.3)",
            "defects[0].form.edge_mm",
            "rectangular edges take no length",
        ),
        ("form: spall(depth_mm: 6.1, edge: rectangular)", "defects[0].form", "make room for 6 mm"),
        ("form: dent(depth_mm: 0.5)", "defects[0].form.depth_mm", "would slope"),
        ("form: waviness(order: 300)", "defects[0].form.order", "a wave would have 4.2 facets"),
        ("form: roughness(slope: -1)", "defects[0].form.slope", "outside its range"),
        ("form: roughness(shortest_mm: 1)", "defects[0].form.shortest_mm", "less than 4 facets"),
        (
            "form: roughness(shortest_mm: 5, longest_mm: 5)",
            "defects[0].form.longest_mm",
            "no whole number of waves",
        ),
        ("form: diameter(larger_um: 3)", "defects[0].on", "its diameter is a field of `bearing`"),
        ("form: missing", "defects[0].on", "it cannot be missing"),
        (
            "on: roller(2), form: missing), (on: roller(2), form: diameter(larger_um: 3)",
            "defects[1].on",
            "is `missing`, and `defects[1]` is on the same roller",
        ),
        ("form: profile(points: [])", "defects[0].form.points", "needs two"),
        (
            "form: profile(points: [(at_mm: 1, depth_um: 0), (at_mm: 0, depth_um: 2), (at_mm: 4, depth_um: \
             0)])",
            "defects[0].form.points",
            "`defects[0].form.points[1]` lies at 0 mm, not beyond the one before",
        ),
        (
            "form: profile(points: [(at_mm: -5, depth_um: 900), (at_mm: 5, depth_um: 900)])",
            "defects[0].form.points",
            "begins and ends on the circle",
        ),
        (
            "form: profile(points: [(at_mm: -0.2, depth_um: 0), (at_mm: 0.2, depth_um: 0)])",
            "defects[0].form.points",
            "as long as 4 facets of 0.500 mm",
        ),
        (
            "on: roller(1), form: profile(points: [(at_mm: 40, depth_um: 0), (at_mm: 44, depth_um: 0)])",
            "defects[0].form.points",
            "within 28.3 mm of its middle",
        ),
        ("form: spall(length_mm: NaN)", "defects[0].form.length_mm", "not a finite number"),
    ] {
        let problem = only(parse(&dry(&format!("({defect})"))));
        assert_eq!(problem.field, field, "{problem}");
        assert!(problem.message.contains(words), "{problem}");
    }
}

#[test]
fn refuses_a_defect_beside_a_groove_and_in_oil() {
    let beside = only(parse("(film: None, defects: [(form: dent())])"));
    assert!(
        beside.message.contains("lies 0 mm from `defect`") || beside.message.contains("lies 0.00 mm"),
        "{beside}"
    );
    assert!(parse("(film: None, defects: [(angle_deg: 120, form: dent())])").is_ok());
    assert!(parse("(film: None, defects: [(on: inner, form: dent())])").is_ok());
    let oil =
        only(parse("(defect: None, defects: [(on: roller(2), form: dent(length_mm: 4, depth_mm: 0.02))])"));
    assert!(oil.message.contains("oil needs round rollers"), "{oil}");
    assert!(oil.suggestion.contains("`film: None` (dry)"), "{oil}");
}

/// The advice for a spall with sloped edges in oil was to go without oil, though upright walls go with it.
#[test]
fn issue_a_spall_in_oil_is_advised_to_have_walls_at_right_angles() {
    let spall = |on: &str, form: &str| format!("(defect: None, defects: [(on: {on}, form: spall({form}))])");
    let told = |text: String| only(parse(&text)).message.contains("`edge: rectangular`");
    assert!(told(spall("outer", "length_mm: 6.0, depth_mm: 0.2, edge_mm: 1.0")));
    assert!(parse(&spall("outer", "length_mm: 6.0, depth_mm: 0.2, edge: rectangular")).is_ok());
    // On a roller no wall helps.
    assert!(!told(spall("roller(1)", "length_mm: 4.0, depth_mm: 0.05, edge_mm: 1.0")));
}

#[test]
fn refuses_too_many_missing_rollers() {
    let missing =
        |count: usize| (1..=count).map(|i| format!("(on: roller({i}), form: missing), ")).collect::<String>();
    assert!(parse(&format!("(defects: [{}])", missing(1))).is_ok(), "in oil as well");
    assert!(parse(&dry(&missing(10))).is_ok());
    for (count, words) in [
        (11, "the 13 rollers that are left leave 180° without one"),
        (23, "the 1 rollers that are left leave 360° without one"),
    ] {
        assert_refused(parse(&dry(&missing(count))), words);
    }
}

#[test]
fn refuses_spalls_of_one_surface_that_meet() {
    let spalls = |apart: f64| {
        dry(&format!("(angle_deg: 90, form: spall()), (angle_deg: {}, form: spall())", 90.0 + apart))
    };
    // 5 mm and two facets of 0.5 mm are 3.44° of a raceway of 100 mm.
    for apart in [0.0, 0.1, -3.4] {
        let problem = only(parse(&spalls(apart)));
        assert!(problem.message.contains("needs 6.00 mm: lengths and 2 facets"), "{problem}");
    }
    assert!(parse(&spalls(3.5)).is_ok());
    assert!(parse(&dry("(on: outer, form: spall()), (on: inner, form: spall())")).is_ok());
}

#[test]
fn behaves_several_spalls_with_steep_walls() {
    let grooves = |apart: f64| {
        let spall = "form: spall(length_mm: 4, depth_mm: 0.2, edge: rectangular)";
        dry(&format!(
            "(angle_deg: 80, {spall}), (angle_deg: {}, {spall}), (on: inner, {spall})",
            80.0 + apart
        ))
    };
    let scene = parse(&grooves(10.0)).expect("three grooves");
    assert_eq!(parse(&scene.to_ron()).expect("its own text"), scene);
    let (cut, all) = (scene.grooves(), scene.spalls());
    assert_eq!(cut, all);
    assert_eq!(cut.iter().map(|groove| groove.angle_deg).collect::<Vec<_>>(), [80.0, 90.0, 90.0]);
    assert!(cut.iter().all(|groove| groove.edge_slope_deg == 90.0));
    // 4 mm and twenty facets of 0.5 mm are 8.02° of a raceway of 100 mm.
    assert!(parse(&grooves(8.1)).is_ok());
    let near = only(parse(&grooves(8.0)));
    assert!(near.message.contains("needs 14.00 mm: lengths and 20 facets"), "{near}");
    let in_oil = parse(&grooves(10.0).replace("film: None, ", ""));
    assert!(in_oil.is_ok(), "{in_oil:?}");
}

#[test]
fn refuses_an_unknown_field_of_a_form_where_it_stands() {
    let problem = only(parse(&dry("(form: dent(lenght_mm: 3))")));
    assert!(problem.to_string().contains("length_mm"), "{problem}");
    let (line, _, underlined) = mark(&problem);
    assert_eq!((line, underlined.as_str()), (1, "lenght_mm"));
    let problem = only(parse(&dry("(on: cage)")));
    assert!(problem.to_string().contains("roller"), "{problem}");
}
