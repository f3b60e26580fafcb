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
    assert!(problem.message.contains("where the rollers run"), "{problem}");
    assert!(problem.suggestion.contains("`pitch_mm`"), "{problem}");
    let scene = parse("(bearing: (rollers: 8, roller_diameter_mm: 17.462, pitch_mm: 72.5))").expect("enough");
    let b = &scene.bearing;
    assert!(close(0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm), 72.5));
    use Assumed::{Clearance, InnerRing, Length, OuterRing};
    assert_eq!(b.assumed, [Clearance, OuterRing, InnerRing, Length]);
    let notes = catalogue::assumptions(b);
    assert!(notes.len() == 4 && notes[0].contains("ISO 5753-1"), "{notes:?}");
}

/// NU 2210 by its boundary dimensions, its inner raceway and its rollers, whichever way they are given.
#[test]
fn behaves_dimensions_of_one_bearing_in_any_form() {
    let of = |fields: &str| {
        parse(&format!("(bearing: ({fields}))")).unwrap_or_else(|why| panic!("{fields}: {why}")).bearing
    };
    let boundary = "bore_mm: 50, outside_mm: 90, width_mm: 23";
    let one = of(&format!("rollers: 17, roller_diameter_mm: 11, inner_race_diameter_mm: 59.5, {boundary}"));
    assert!(close(one.inner_ring_thickness_mm, 4.75) && close(one.thickness_mm, 13.8), "{one:?}");
    // 45 µm of clearance with a bore of 50 mm.
    assert!(close(one.outer_race_diameter_mm, 81.545), "{one:?}");
    assert!(close(one.outer_race_diameter_mm + 2.0 * one.outer_ring_thickness_mm, 90.0), "{one:?}");
    for fields in [
        "rollers: 17, pitch_mm: 70.5, roller_diameter_mm: 11",
        "rollers: 17, pitch_mm: 70.5, inner_race_diameter_mm: 59.5",
        "rollers: 17, inner_race_diameter_mm: 59.5, outer_race_diameter_mm: 81.545",
        "rollers: 17, outer_race_diameter_mm: 81.545, roller_diameter_mm: 11",
    ] {
        let other = of(&format!("{fields}, {boundary}"));
        for (a, b) in [
            (other.outer_race_diameter_mm, one.outer_race_diameter_mm),
            (other.inner_race_diameter_mm, one.inner_race_diameter_mm),
            (other.roller_diameter_mm, one.roller_diameter_mm),
        ] {
            // The clearance at most, which is taken from rollers or raceways.
            assert!((a - b).abs() < 0.046, "{fields}: {a} {b}");
        }
    }
    let pitch = of("rollers: 17, roller_diameter_mm: 11, bore_mm: 50, outside_mm: 90");
    assert!(pitch.assumed.contains(&Assumed::Pitch), "{pitch:?}");
    assert!(close(0.5 * (pitch.outer_race_diameter_mm + pitch.inner_race_diameter_mm), 70.0));
}

#[test]
fn behaves_the_command_line_completes_a_bearing_too() {
    let set = ["bearing.rollers=8", "bearing.roller_diameter_mm=17.462", "bearing.pitch_mm=72.5"];
    let scene = Scene::default().with_overrides(&set).expect("a bearing");
    assert_eq!(scene, parse("(bearing: (rollers: 8, roller_diameter_mm: 17.462, pitch_mm: 72.5))").unwrap());
    // What somebody gave stays.
    let kept = parse("(bearing: (roller_diameter_mm: 11, pitch_mm: 70), operation: (load_n: 77))").unwrap();
    assert_eq!(kept.operation.load_n, 77.0);
    assert!(kept.bearing.assumed.contains(&Assumed::Rollers));
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
        ("pitch_mm: 70", "bearing.pitch_mm", "lacks the size of the rollers"),
        ("bore_mm: 50, outside_mm: 90", "bearing.bore_mm", "lacks the size of the rollers"),
        ("width_mm: 20, roller_diameter_mm: 9", "bearing.roller_diameter_mm", "where the rollers run"),
        (
            "pitch_mm: 75, inner_race_diameter_mm: 59.5, outer_race_diameter_mm: 81.54",
            "bearing.pitch_mm",
            "make a pitch diameter of 70.52 mm",
        ),
        ("pitch_mm: 70, roller_diameter_mm: 11, bore_mm: 62", "bearing.bore_mm", "leaves the inner ring"),
        (
            "pitch_mm: 70, roller_diameter_mm: 11, outside_mm: 80",
            "bearing.outside_mm",
            "leaves the outer ring",
        ),
        ("pitch_mm: 10, roller_diameter_mm: 11", "bearing.pitch_mm", "make no bearing"),
        ("pitch_mm: -10, roller_diameter_mm: 11", "bearing.pitch_mm", "outside its range"),
    ] {
        let problem = only(parse(&format!("(bearing: ({fields}))")));
        assert_eq!(problem.field, field, "{problem}");
        assert!(problem.message.contains(words), "{problem}");
        assert!(!problem.suggestion.is_empty(), "{problem}");
    }
    // Beside a bearing of the catalogue a pitch diameter of another one says nothing.
    let problem = only(Scene::default().with_overrides(&["bearing=NU 205", "bearing.pitch_mm=45"]));
    assert_eq!(problem.field, "bearing.pitch_mm");
}

/// A diameter with a minus sign was answered with "no single value repairs this", which was false: the other
/// dimensions would follow the right one.
#[test]
fn issue_a_negative_roller_diameter_is_answered_with_its_field_and_range() {
    let problem = only(parse("(bearing: (rollers: 8, roller_diameter_mm: -5))"));
    assert_eq!(problem.field, "bearing.roller_diameter_mm");
    assert!(problem.message.contains("is -5, outside its range"), "{problem}");
    assert_eq!(problem.allowed, "more than 0, at most 5000 mm");
    assert!(problem.suggestion.contains("roller_diameter_mm"), "{problem}");
}
