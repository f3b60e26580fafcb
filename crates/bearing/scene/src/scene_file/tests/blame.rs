//! Inconsistent fields: which one is blamed, and whether the proposed value works.

use super::*;
use crate::fields::{Shape, counts, paths, spot};

/// Each relation, broken by one field alone: that field is blamed, from a file and from the command line.
const BROKEN_BY_ONE: [&str; 30] = [
    "bearing.roller_diameter_mm=19",
    "bearing.roller_diameter_mm=15",
    "bearing.inner_race_diameter_mm=165",
    "bearing.inner_race_diameter_mm=150",
    "bearing.inner_race_diameter_mm=250",
    "bearing.outer_race_diameter_mm=199",
    "bearing.outer_race_diameter_mm=500",
    "bearing.inner_ring_thickness_mm=82",
    "bearing.rollers=32",
    "bearing.rollers=400",
    "cage.outer_diameter_mm=201",
    "cage.outer_diameter_mm=165",
    "cage.thickness_mm=17",
    "cage.pocket_clearance_um=5000",
    "adapter.width_mm=220",
    "adapter.height_mm=0.1",
    "defect.length_mm=700",
    "defect.length_mm=400",
    "defect.depth_mm=7",
    "bearing.outer_ring_thickness_mm=0.2",
    "mesh.size_mm=11",
    "mesh.size_mm=1e-6",
    "mesh.roller_facets=99999",
    "mesh.grading=(coarse_mm: 0.1)",
    "solver.duration_ms=0.0001",
    "solver.duration_ms=0.015",
    "solver.duration_ms=1e-300",
    "output.interval_us=5e5",
    "output.interval_us=0.01",
    "adapter.height_mm=50000",
];

/// `a.b=1` as a scene file.
fn as_file(argument: &str) -> String {
    let (path, value) = argument.split_once('=').expect("an assignment");
    path.rsplit('.').fold(value.to_owned(), |inner, name| format!("({name}: {inner})"))
}

/// The problems of a refused scene whose other fields are defaults.
fn problems(result: Result<Scene, SceneError>) -> Vec<Problem> {
    result.err().map(|error| error.problems().to_vec()).unwrap_or_default()
}

#[test]
fn issue_the_field_that_the_user_gave_is_blamed() {
    for argument in BROKEN_BY_ONE {
        let path = argument.split_once('=').expect("an assignment").0;
        for (how, result) in [
            ("file", parse(&as_file(argument))),
            ("command line", Scene::default().with_overrides(&[argument])),
        ] {
            let found = problems(result);
            // At this interval the longest run is refused, not the default one.
            assert_eq!(found.is_empty(), argument == "output.interval_us=0.01", "{argument}");
            for problem in found {
                assert!(problem.field.starts_with(path), "{argument} ({how})\n{problem}");
                assert!(!problem.allowed.is_empty() && !problem.suggestion.is_empty(), "{problem}");
                let repair = problem.repair.as_deref().unwrap_or_else(|| panic!("no value\n{problem}"));
                assert!(repair.starts_with(path), "{argument} ({how})\n{problem}");
                let repaired = Scene::default().with_overrides(&[argument, repair]);
                assert!(repaired.is_ok(), "{argument}, then {repair}\n{}", repaired.expect_err("refused"));
            }
        }
    }
}

#[test]
fn issue_a_short_run_is_not_blamed_on_the_sampling_interval() {
    let problem = only(Scene::default().with_overrides(&["solver.duration_ms=0.0001"]));
    let expected = "\
0.0001 ms sampled every 10 µs are fewer than two samples
  --> command line
   |
   | --set solver.duration_ms=0.0001
   |                          ^^^^^^
   = allowed: at least 0.02 ms, two samples
   = try: --set solver.duration_ms=1 (a hundred samples)
";
    assert_eq!(problem.to_string(), expected);
    // The command line was written after the file.
    let folder = Scratch::create("blame");
    let path = folder.join("x.ron");
    std::fs::write(&path, Scene::default().to_ron()).expect("writable");
    for set in ["solver.duration_ms=0.0001", "output.interval_us=50000", "output=(interval_us: 50000)"] {
        let problem = only(Scene::read_with(&path, &[set]));
        let field = if set.starts_with("solver") { "solver.duration_ms" } else { "output.interval_us" };
        assert_eq!(problem.field, field, "{problem}");
        assert!(matches!(problem.place, Place::CommandLine { .. }), "{problem}");
    }
}

#[test]
fn behaves_another_field_is_proposed_where_the_blamed_one_cannot_help() {
    // Half the bearing with rollers of the same size: the number of rollers must change, no diameter can.
    let problem = only(parse(
        "(bearing: (outer_race_diameter_mm: 120, inner_race_diameter_mm: 83.96), cage: None, adapter: \
         (width_mm: 90))",
    ));
    assert_eq!(problem.field, "bearing.outer_race_diameter_mm");
    assert_eq!(problem.repair.as_deref(), Some("bearing.rollers=17"), "{problem}");
    assert_eq!(problem.suggestion, "`bearing.rollers: 17`");
}

#[test]
fn issue_a_bearing_that_lacks_a_number_is_named_beside_other_problems() {
    let set = ["bearing.outer_race_diameter_mm=201.25", "cage.outer_diameter_mm=1"];
    let found = problems(Scene::default().with_overrides(&set));
    let fields: Vec<&str> = found.iter().map(|problem| &*problem.field).collect();
    assert_eq!(fields, ["cage.outer_diameter_mm", "bearing.outer_race_diameter_mm"], "{found:?}");
}

#[test]
fn behaves_a_second_sensor_of_one_name_gets_a_free_one() {
    let sensor = |name: &str| format!("(name: \"{name}\", angle_deg: 0)");
    let text = format!("(output: (sensors: [{}, {}, {}]))", sensor("a"), sensor("a_2"), sensor("a"));
    let problem = only(parse(&text));
    assert_eq!(problem.repair.as_deref(), Some("output.sensors[2].name=\"a_3\""), "{problem}");
    let long = "a".repeat(64);
    let problem = only(parse(&format!("(output: (sensors: [{}, {}]))", sensor(&long), sensor(&long))));
    assert!(problem.repair.is_some_and(|repair| repair.contains("_2")));
}

#[test]
fn issue_no_number_in_a_message_is_longer_than_a_word() {
    let longest =
        |text: &str| text.split([' ', '`', ',']).map(|word| word.chars().count()).max().unwrap_or(0);
    for value in ["1e308", "-1e308", "5e-324", "1e-310", "123456789.123456789", "NaN", "inf", "-inf", "0"] {
        for path in crate::fields::paths() {
            let Err(error) = Scene::default().with_overrides(&[format!("{path}={value}")]) else { continue };
            for problem in error.problems() {
                for text in [&problem.message, &problem.allowed, &problem.suggestion] {
                    assert!(longest(text) <= 60, "{text}");
                }
            }
        }
    }
}

/// Whatever is proposed for overrides of the default scene leaves fewer problems, and not the same.
fn repairs_work(arguments: &[String]) {
    let before = problems(Scene::default().with_overrides(arguments));
    for problem in before.iter().filter(|problem| problem.repair.is_some()) {
        let mut repaired = arguments.to_vec();
        repaired.extend(problem.repair.clone());
        let after = problems(Scene::default().with_overrides(&repaired));
        assert!(after.len() < before.len(), "{arguments:?}, then {:?}\n{problem}", problem.repair);
        assert!(after.iter().all(|left| left.message != problem.message), "{arguments:?}\n{problem}");
    }
}

/// A raceway out of range beside the bore of another bearing: the paper's raceway was proposed, and refused
/// when it was taken.
#[test]
fn issue_beside_dimensions_of_another_bearing_the_papers_are_no_remedy() {
    for diameter in ["outer_race_diameter_mm", "inner_race_diameter_mm", "roller_diameter_mm"] {
        for (value, other) in [("1.5e8", 142.4), ("-18", 5.0), ("0", 300.0)] {
            for field in ["pitch_mm", "bore_mm", "outside_mm", "width_mm"] {
                let arguments = [format!("bearing.{diameter}={value}"), format!("bearing.{field}={other}")];
                let found = problems(Scene::default().with_overrides(&arguments));
                assert_eq!(found.len(), 1, "{arguments:?}");
                assert!(found[0].message.contains("outside its range"), "{}", found[0]);
                repairs_work(&arguments);
            }
        }
    }
    let named = only(parse("(bearing: (designation: \"6205\", roller_diameter_mm: -2.0))"));
    assert!(named.message.contains("outside its range") && !named.suggestion.contains("18"), "{named}");
    // An outer raceway beyond all ranges follows from these two.
    repairs_work(
        &["bearing.roller_diameter_mm=1e4", "bearing.inner_race_diameter_mm=1e-3"].map(str::to_owned),
    );
}

/// Values of any size, more often near the sensible ones.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        (-9.0_f64..9.0).prop_map(|power| 10_f64.powf(power)),
        0.0_f64..300.0,
        (0.0_f64..300.0).prop_map(f64::round),
        Just(-18.0),
        Just(1e308),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(600) })]
    #[test]
    fn invariant_what_is_proposed_removes_the_problem_and_makes_no_new_one(
        first in 0_usize..60, x in number(), second in 0_usize..60, y in number(), as_is in any::<bool>(),
    ) {
        let number = |path: &&String| {
            spot(path, None).is_some_and(|spot| matches!(spot.shape.there(), Shape::Number | Shape::Count))
        };
        let fields: Vec<&String> = paths().iter().filter(number).collect();
        let set = |field: usize, value: f64| {
            let path = fields[field % fields.len()];
            let value = if counts(path) { value.abs().round().min(1e9) } else { value };
            format!("{path}={value}")
        };
        let mut arguments = vec![set(first, x)];
        if !as_is {
            arguments.push(set(second, y));
        }
        repairs_work(&arguments);
    }
}
