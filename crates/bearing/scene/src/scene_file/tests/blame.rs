//! Inconsistent fields: which one is blamed, and with which values allowed.

use super::*;
use crate::fields::paths;

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
                assert!(!problem.allowed.is_empty(), "{problem}");
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

/// On a 6205 a load of 0 and one of \"2 kN\" were answered with the 50 kN of the paper's bearing, six times what a
/// 6205 carries.
#[test]
fn issue_no_default_of_another_scene_is_proposed() {
    let folder = Scratch::create("defaults");
    let path = folder.join("x.ron");
    std::fs::write(&path, "(bearing: \"6205\", operation: (load_n: 500))").expect("writable");
    for (value, words) in [("0", "outside its range"), ("\"2 kN\"", "not a number"), ("2kN", "not a number")]
    {
        let problem = only(Scene::read_with(&path, &[format!("operation.load_n={value}")]));
        assert!(problem.message.contains(words), "{problem}");
        assert!(problem.allowed.ends_with("more than 0, at most 1e9 N"), "{problem}");
        assert_eq!(problem.suggestion, "");
    }
    // A value that always helps is proposed.
    let dry = only(parse("(defect: (edge_slope_deg: 20, depth_mm: 0.1))"));
    assert!(dry.message.contains("oil needs edges"), "{dry}");
    assert_eq!(dry.suggestion, "`film: None` (dry)");
    let problem = only(Scene::default().with_overrides(&["bearing.roller_profile=logarithmic"]));
    assert_eq!(problem.suggestion, "`straight`");
    let ragged = "defects: [(form: spall(edge: EDGE, ragged_um: 5))], defect: None, film: None";
    for (edge, model, words) in
        [("rectangular", "full", "full model"), ("sloped", "reduced()", "only rectangular")]
    {
        let problem = only(parse(&format!("(model: {model}, {})", ragged.replace("EDGE", edge))));
        assert!(problem.message.contains("ragged_um") && problem.message.contains(words), "{problem}");
    }
}

#[test]
fn issue_no_number_in_a_message_is_longer_than_a_word() {
    let longest =
        |text: &str| text.split([' ', '`', ',']).map(|word| word.chars().count()).max().unwrap_or(0);
    for value in ["1e308", "-1e308", "5e-324", "1e-310", "123456789.123456789", "NaN", "inf", "-inf", "0"] {
        for path in paths() {
            let Err(error) = Scene::default().with_overrides(&[format!("{path}={value}")]) else { continue };
            for problem in error.problems() {
                for text in [&problem.message, &problem.allowed, &problem.suggestion] {
                    assert!(longest(text) <= 60, "{text}");
                }
            }
        }
    }
}
