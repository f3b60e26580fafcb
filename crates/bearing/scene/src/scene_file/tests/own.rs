//! Bearings by their own fields: completed, with a list of assumptions, or refused with the missing fields.

use super::*;
use crate::catalogue;
use crate::scene::{Assumed, PocketWalls};

/// Digits to which dimensions are written.
const TIDY: f64 = 1e-4;

fn close(ours: f64, theirs: f64) -> bool {
    (ours / theirs - 1.0).abs() < TIDY
}

/// Scenes that were refused with the paper's cage and adapter to blame, each with raceways and rollers alone.
#[test]
fn issue_cage_and_housing_follow_a_bearing_by_its_fields() {
    for [outer, inner, roller] in [[77.53, 59.5, 9.0], [500.12, 420.0, 40.0], [16.02, 10.0, 3.0]] {
        let scene = parse(&format!(
            "(bearing: (rollers: 10, roller_diameter_mm: {roller}, inner_race_diameter_mm: {inner}, \
             outer_race_diameter_mm: {outer}, outer_ring_thickness_mm: {0}, inner_ring_thickness_mm: {0}, \
             thickness_mm: {roller}))",
            0.4 * roller
        ))
        .unwrap_or_else(|why| panic!("{why}"));
        let cage = scene.cage.as_ref().expect("a cage");
        assert_eq!(cage.pocket, PocketWalls::Corners);
        assert!((inner..outer).contains(&cage.outer_diameter_mm));
        assert!(scene.adapter.width_mm < outer + 0.8 * roller);
        assert!(scene.bearing.assumed.is_empty(), "{:?}", scene.bearing.assumed);
        // As large a part of a roller as in the paper's bearing.
        assert!((scene.mesh.size_mm / roller * 18.0 / 0.5 - 1.0).abs() < 0.01);
        assert_eq!(parse(&scene.to_ron()).expect("complete"), scene);
    }
}

/// Eight rollers of 17.462 mm alone ran between the paper's raceways, and had its frequencies.
#[test]
fn issue_half_a_bearing_does_not_keep_the_papers_raceways() {
    let problem = only(parse("(bearing: (rollers: 8, roller_diameter_mm: 17.462))"));
    assert_eq!(problem.field, "bearing.roller_diameter_mm");
    assert!(problem.message.ends_with("it lacks `pitch_mm`"), "{problem}");
    let scene = parse("(bearing: (rollers: 8, roller_diameter_mm: 17.462, pitch_mm: 72.5))").expect("enough");
    let b = &scene.bearing;
    assert!(close(0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm), 72.5));
    use Assumed::{Clearance, InnerRing, Length, OuterRing};
    assert_eq!(b.assumed, [Clearance, OuterRing, InnerRing, Length]);
    let notes = catalogue::assumptions(b);
    assert!(notes.len() == 4 && notes[0].contains("ISO 5753-1"), "{notes:?}");
}

/// NU 2210 by the numbers that are asked for and its boundary.
#[test]
fn behaves_bore_outside_diameter_and_width_give_the_rest() {
    let of = |fields: &str| {
        parse(&format!("(bearing: ({fields}))")).unwrap_or_else(|why| panic!("{fields}: {why}")).bearing
    };
    let boundary = "bore_mm: 50, outside_mm: 90, width_mm: 23";
    let one = of(&format!("rollers: 17, roller_diameter_mm: 11, pitch_mm: 70.5225, {boundary}"));
    // 45 µm of clearance with a bore of 50 mm.
    assert!(close(one.inner_race_diameter_mm, 59.5) && close(one.outer_race_diameter_mm, 81.545), "{one:?}");
    assert!(close(one.inner_ring_thickness_mm, 4.75) && close(one.thickness_mm, 13.8), "{one:?}");
    assert!(close(one.outer_race_diameter_mm + 2.0 * one.outer_ring_thickness_mm, 90.0), "{one:?}");
    assert_eq!(one.assumed, [Assumed::Clearance, Assumed::Length]);
    let raceways = "inner_race_diameter_mm: 59.5, outer_race_diameter_mm: 81.545";
    let other = of(&format!("rollers: 17, roller_diameter_mm: 11, {raceways}, {boundary}"));
    assert_eq!(other.assumed, [Assumed::Length]);
    assert_eq!(other, crate::scene::BearingScene { assumed: other.assumed.clone(), ..one });
    let balls = of("balls: 8, ball_diameter_mm: 5.953, pitch_mm: 25, width_mm: 11");
    assert_eq!((balls.element, balls.thickness_mm), (crate::scene::ElementKind::Ball, 11.0));
}

/// `analyse` takes a bearing by its numbers, and a scene did not.
#[test]
fn issue_numbers_in_the_place_of_a_name_are_that_bearing() {
    let named =
        parse("(bearing: \"elements=9, element_diameter_mm=7.94, pitch_mm=39.04\")").expect("numbers");
    let fields = parse("(bearing: (balls: 9, ball_diameter_mm: 7.94, pitch_mm: 39.04))").expect("fields");
    let same = |scene: &Scene| {
        let b = &scene.bearing;
        (b.rollers, b.outer_race_diameter_mm, b.inner_ring_thickness_mm, b.thickness_mm, b.assumed.clone())
    };
    assert_eq!(same(&named), same(&fields));
    assert_eq!(named.element(), fields.element());
}

#[test]
fn behaves_the_command_line_completes_a_bearing_too() {
    let set = ["bearing.rollers=8", "bearing.roller_diameter_mm=17.462", "bearing.pitch_mm=72.5"];
    let scene = Scene::default().with_overrides(&set).expect("a bearing");
    assert_eq!(scene, parse("(bearing: (rollers: 8, roller_diameter_mm: 17.462, pitch_mm: 72.5))").unwrap());
    // What somebody gave stays.
    let kept = "(bearing: (rollers: 12, roller_diameter_mm: 11, pitch_mm: 70), operation: (load_n: 77))";
    assert_eq!(parse(kept).unwrap().operation.load_n, 77.0);
}

#[test]
fn behaves_other_numbers_of_the_papers_bearing_leave_it_the_papers() {
    let paper = Scene::default();
    for fields in
        ["rollers: 20", "thickness_mm: 100", "inner_race_diameter_mm: 163.5", "clearance_change_um: 9"]
    {
        let scene = parse(&format!("(bearing: ({fields}))")).expect("the paper's");
        assert_eq!((&scene.cage, &scene.adapter), (&paper.cage, &paper.adapter), "{fields}");
        assert_eq!(scene.operation, paper.operation, "{fields}");
    }
}

#[test]
fn refuses_bearings_that_lack_something_or_contradict_themselves() {
    for (fields, field, words) in [
        ("pitch_mm: 70", "bearing.pitch_mm", "lacks `rollers`, `roller_diameter_mm`"),
        ("bore_mm: 50, outside_mm: 90", "bearing.bore_mm", "`roller_diameter_mm`, `pitch_mm`"),
        ("rollers: 9, width_mm: 20, roller_diameter_mm: 9", "bearing.width_mm", "lacks `pitch_mm`"),
        ("roller_diameter_mm: 11, pitch_mm: 70", "bearing.pitch_mm", "lacks `rollers`"),
        (
            "rollers: 9, roller_diameter_mm: 11, pitch_mm: 75, inner_race_diameter_mm: 59.5",
            "bearing.pitch_mm",
            "not both",
        ),
        (
            "rollers: 9, pitch_mm: 70, roller_diameter_mm: 11, bore_mm: 62",
            "bearing.bore_mm",
            "leaves no ring beside its raceway of",
        ),
        (
            "rollers: 9, pitch_mm: 70, roller_diameter_mm: 11, outside_mm: 80",
            "bearing.outside_mm",
            "leaves no ring",
        ),
        (
            "rollers: 9, pitch_mm: 70, roller_diameter_mm: 11, outside_mm: 90, outer_ring_thickness_mm: 4",
            "bearing.outer_ring_thickness_mm",
            "say the same twice",
        ),
        ("rollers: 9, pitch_mm: 10, roller_diameter_mm: 11", "bearing.pitch_mm", "have no room"),
        ("rollers: 9, pitch_mm: -10, roller_diameter_mm: 11", "bearing.pitch_mm", "outside its range"),
    ] {
        let problem = only(parse(&format!("(bearing: ({fields}))")));
        assert_eq!(problem.field, field, "{problem}");
        assert!(problem.message.contains(words), "{problem}");
        assert!(!problem.allowed.is_empty(), "{problem}");
    }
    // Beside a bearing of the catalogue a pitch diameter of another one says nothing.
    let problem = only(Scene::default().with_overrides(&["bearing=NU 205", "bearing.pitch_mm=45"]));
    assert_eq!(problem.field, "bearing.pitch_mm");
}

/// A diameter with a minus sign was answered as a bearing that lacks something.
#[test]
fn issue_a_negative_roller_diameter_is_answered_with_its_field_and_range() {
    let problem = only(parse("(bearing: (rollers: 8, roller_diameter_mm: -5))"));
    assert_eq!(problem.field, "bearing.roller_diameter_mm");
    assert!(problem.message.contains("is -5, outside its range"), "{problem}");
    assert_eq!(problem.allowed, "more than 0, at most 5000 mm");
}
