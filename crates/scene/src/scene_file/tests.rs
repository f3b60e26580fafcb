//! Texts of scene files and of `--set`, and the answers to them.

mod blame;
mod deviations;
mod formats;
mod own;

use proptest::prelude::*;
use stribeck_testing::Scratch;

use super::{Place, Problem, SceneError};
use crate::housing::{HousingScene, RigidHousingScene};
use crate::scene::{
    BearingScene, ContactMethod, DampingFrame, HarmonicScene, PocketWalls, ProfileScene, RampScene,
    RollerCopies, Scene, Start,
};

/// The only problem of `result`.
fn only(result: Result<Scene, SceneError>) -> Problem {
    let error = result.expect_err("the scene must be refused");
    assert_eq!(error.problems().len(), 1, "{error}");
    error.problems()[0].clone()
}

fn parse(text: &str) -> Result<Scene, SceneError> {
    Scene::parse(text, "x.ron")
}

/// Line and column of a problem in a file, and the underlined text.
fn mark(problem: &Problem) -> (usize, usize, String) {
    match &problem.place {
        Place::File { line, column, source, width, .. } => {
            (*line, *column, source.chars().skip(column - 1).take(*width).collect())
        }
        other => panic!("not in a file: {other:?}"),
    }
}

#[test]
fn example_an_empty_group_is_the_default_scene() {
    assert_eq!(parse("()").expect("valid"), Scene::default());
}

/// Paths of the fields of `scene` that a text does not write.
fn unwritten(text: &str, scene: &Scene) -> Vec<String> {
    let paths = |text: &str| {
        let entries = super::outline::Outline::of(text).entries;
        entries.into_iter().map(|entry| entry.path).collect::<Vec<String>>()
    };
    let written = paths(text);
    paths(&scene.to_ron()).into_iter().filter(|path| !written.contains(path)).collect()
}

#[test]
fn example_oiled_steel_spells_out_the_defaults() {
    let text = include_str!("../../../../fixtures/scenes/oiled_steel.ron");
    assert_eq!(parse(text).expect("valid"), Scene::default());
    assert_eq!(unwritten(text, &Scene::default()), Vec::<String>::new());
}

/// Whoever reads the paper's scene sees every number, whatever the defaults are.
#[test]
fn example_the_scene_of_the_paper_leaves_nothing_out() {
    let text = include_str!("../../../../fixtures/scenes/singh2014.ron");
    assert_eq!(unwritten(text, &parse(text).expect("valid")), Vec::<String>::new());
}

#[test]
fn example_the_quick_scene_holds_the_exit_of_roller_1() {
    let scene = parse(include_str!("../../../../fixtures/scenes/quick.ron")).expect("valid");
    assert_eq!(scene.bearing, Scene::default().bearing);
    assert!(scene.solver.duration_ms > 5.08 + 0.5, "the exit and half a millisecond of ringing");
}

#[test]
fn roundtrip_the_resolved_scene_reads_back_equal() {
    let mut scene = Scene { defect: None, ..Scene::default() };
    scene.mesh.outer_facets = Some(1257);
    scene.bearing.thickness_mm = 0.1 + 0.2;
    scene.operation.load_n = 1.234_567_890_123_456_7e5;
    scene.contact.method = ContactMethod::Collocated;
    scene.solver.start = Start::Sudden;
    let text = scene.to_ron();
    assert_eq!(parse(&text).expect("valid"), scene);
    assert_eq!(parse(&text).expect("valid").to_ron(), text);
    assert!(text.contains("method: collocated"), "{text}");
}

#[test]
fn example_the_hash_is_fnv_1a_of_the_content() {
    let plain = parse("()").expect("valid");
    let spelled = parse("( /* same */ mesh: (size_mm: 0.5))").expect("valid");
    assert_eq!(plain.hash(), spelled.hash());
    assert_eq!(plain.hash().len(), 16);
    let other = parse("(mesh: (size_mm: 0.6))").expect("valid");
    assert_ne!(plain.hash(), other.hash());
}

#[test]
fn example_a_later_field_changes_the_hash_only_where_it_is_used() {
    // The hash of the paper's scene before there was stiffness damping, with what were defaults then: a field
    // that it does not use leaves it alone.
    const FIRST: &str = "d300e82243b85717";
    let hash = |pocket: &str, film: &str, structural: &str, more: &str| {
        let scene = format!(
            "(name: \"singh2014\", mesh: (roller_copies: translated), cage: (pocket: {pocket}), film: \
             {film}, solver: (time_step_factor: 0.95, \
             mass_damping_per_s: 5000.0, structural_damping: {structural}, {more}))"
        );
        parse(&scene).expect("valid").hash()
    };
    assert_eq!(hash("corners", "None", "None", ""), FIRST);
    assert_ne!(hash("straight", "None", "None", ""), FIRST);
    assert_ne!(hash("corners", "()", "None", ""), FIRST);
    assert_ne!(hash("corners", "None", "()", ""), FIRST);
    assert_ne!(hash("corners", "None", "None", "stiffness_damping_ns: 5.0"), FIRST);
    let default = Scene::default().hash();
    let with = |set: &str| Scene::default().with_overrides(&[set]).expect("valid").hash();
    assert_eq!(with("mesh.roller_phase_deg=0"), default);
    assert_ne!(with("mesh.roller_phase_deg=1"), default);
    assert_ne!(with(&format!("cage.roller_offsets_um=[{}]", ["5.0"; 24].join(","))), default);
}

#[test]
fn refuses_structural_damping_of_nothing() {
    let scene =
        |damping: &str, more: &str| parse(&format!("(solver: (structural_damping: {damping}, {more}))"));
    assert!(scene("()", "").is_ok() && scene("(bodies: [rollers], branches: 3)", "").is_ok());
    for (damping, more, field, words) in [
        ("(from_khz: 30.0)", "", "solver.structural_damping.from_khz", "too narrow"),
        ("(bodies: [])", "", "solver.structural_damping.bodies", "nothing would be damped"),
        ("(bodies: [adapter, adapter])", "", "solver.structural_damping.bodies", "twice"),
        ("()", "stiffness_damping_ns: 5.0", "solver.stiffness_damping_ns", "exclude each other"),
        ("(branches: 4)", "", "solver.structural_damping.branches", "outside its range"),
        ("(ratio_percent: 20.0)", "", "solver.structural_damping.ratio_percent", "outside its range"),
    ] {
        let problem = only(scene(damping, more));
        assert_eq!(problem.field, field, "{problem}");
        assert!(problem.message.contains(words), "{problem}");
    }
}

#[test]
fn refuses_an_unknown_field_with_line_column_and_the_right_name() {
    let problem = only(parse("(\n  operation: (\n    load_kn: 50,\n  ),\n)"));
    assert_eq!(mark(&problem), (3, 5, "load_kn".to_owned()));
    assert_eq!(problem.field, "operation.load_kn");
    assert!(problem.suggestion.contains("did you mean `load_n`? 1 in `load_kn` is 1000"), "{problem}");

    let problem = only(parse("(operation: (load: 50))"));
    assert!(problem.suggestion.contains("`load_n`"), "{problem}");
    let problem = only(parse("(baering: (rollers: 24))"));
    assert_eq!(problem.suggestion, "did you mean `bearing`?");
    let problem = only(parse("(speed_rpm: 500)"));
    assert_eq!(problem.suggestion, "`speed_rpm` belongs in `operation: ( … )`");
    let problem = only(parse("(cage: (clearance_um: 500))"));
    assert!(problem.suggestion.contains("`pocket_clearance_um`"), "{problem}");
}

#[test]
fn refuses_with_the_line_and_a_mark() {
    let error = parse("(\n  // ü\n  bearing: (roller_diameter_mm: -18.0),\n)").expect_err("negative");
    let expected = "\
`bearing.roller_diameter_mm` is -18, outside its range
  --> x.ron:3:33
   |
 3 |   bearing: (roller_diameter_mm: -18.0),
   |                                 ^^^^^
   = allowed: more than 0, at most 5000 mm
   = try: `roller_diameter_mm: 18` (without the minus sign)
";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn refuses_all_numbers_outside_their_range() {
    let text = "(solver: (time_step_factor: 1.7, duration_ms: 0), material: (poissons_ratio: 0.5), \
                contact: (friction: NaN), operation: (load_n: inf), mesh: (roller_facets: 7))";
    let error = parse(text).expect_err("five errors");
    let fields: Vec<&str> = error.problems().iter().map(|p| p.field.as_str()).collect();
    let expected = [
        "material.poissons_ratio",
        "mesh.roller_facets",
        "operation.load_n",
        "contact.friction",
        "solver.duration_ms",
        "solver.time_step_factor",
    ];
    assert_eq!(fields, expected);
    assert!(error.to_string().contains("NaN, which is not a finite number"));
    assert!(error.to_string().contains("0 or more, less than 0.5"));
}

#[test]
fn refuses_wrong_types_with_field_and_what_belongs_there() {
    for (text, field, value, kind) in [
        ("(bearing: (rollers: 24.5))", "bearing.rollers", "24.5", "whole number"),
        ("(bearing: (rollers: -3))", "bearing.rollers", "-3", "whole number"),
        ("(bearing: (rollers: \"x\"))", "bearing.rollers", "\"x\"", "whole number"),
        ("(mesh: (size_mm: big))", "mesh.size_mm", "big", "a number"),
        ("(mesh: (size_mm: nan))", "mesh.size_mm", "nan", "a number"),
        ("(mesh: 3)", "mesh", "3", "group"),
        ("(name: quick)", "name", "quick", "text in double quotes"),
        ("(output: (sensors: 3))", "output.sensors", "3", "list"),
        ("(mesh: (outer_facets: -1))", "mesh.outer_facets", "-1", "or `None`"),
    ] {
        let problem = only(parse(text));
        assert_eq!(problem.field, field, "{problem}");
        assert_eq!(mark(&problem).2, value, "{problem}");
        assert!(problem.message.contains(kind), "{problem}");
    }
}

#[test]
fn refuses_a_wrong_word_and_corrects_it() {
    let problem = only(parse("(contact: (method: colocated))"));
    assert_eq!(problem.field, "contact.method");
    assert_eq!(problem.suggestion, "did you mean `collocated`?");
    assert_eq!(problem.allowed, "`collocated`, `integrated`");
    // What has fields wants brackets, a roller its number, and a bearing's name quotes.
    for (text, tried) in [
        ("(model: reduced)", "`model: reduced()`"),
        ("(model: \"reduced\")", "`model: reduced()`"),
        ("(model: \"full\")", "`model: full`"),
        ("(bearing: NU205)", "`bearing: \"NU 205\"`"),
        ("(defect: None, defects: [(on: roller, form: missing)])", "`on: roller(1)`"),
    ] {
        let problem = only(parse(text));
        assert!(problem.to_string().contains(&format!("try: {tried}")), "{problem}");
    }
}

#[test]
fn refuses_broken_text_and_locates_it() {
    let problem = only(parse("(bearing: (rollers: 24"));
    assert!(problem.message.contains("ends too early"), "{problem}");
    let problem = only(parse(""));
    assert!(problem.message.contains("empty"), "{problem}");
    let problem = only(parse("(bearing: (rollers: 24 thickness_mm: 20))"));
    assert_eq!(mark(&problem).0, 1);
    assert!(problem.suggestion.contains("comma"), "{problem}");
    let problem = only(parse("(name: \"a\", name: \"b\")"));
    assert!(problem.message.contains("twice"), "{problem}");
    let problem = only(parse("(output: (sensors: [(name: \"a\")]))"));
    assert!(problem.message.contains("no field `angle_deg`"), "{problem}");
    assert!(parse("() trailing").is_err());
}

#[test]
fn refuses_overlapping_bodies_with_numbers() {
    let problem = only(parse("(bearing: (\n inner_race_diameter_mm: 165.0))"));
    assert!(problem.message.contains("200 − inner raceway 165 − 2 × roller 18 = -1 mm"), "{problem}");
    assert_eq!(mark(&problem), (2, 26, "165.0".to_owned()));
    assert_eq!(problem.suggestion, "`inner_race_diameter_mm: 163.96` (a small clearance)");
    assert!(parse("(bearing: (inner_race_diameter_mm: 164.0))").is_ok(), "zero clearance is allowed");
    let problem = only(parse("(bearing: (inner_race_diameter_mm: 160.0))"));
    assert!(problem.message.contains("too wide"), "{problem}");
}

#[test]
fn refuses_more_rollers_than_fit_the_pitch_circle() {
    // 2 asin(18 / 181.98) = 11.355°, so 31 rollers touch nowhere and 32 do. A pocket of radius 9.9 mm cuts
    // ±5.85° out of the cage, more than half of 360° / 31.
    assert!(parse("(cage: None, bearing: (rollers: 31))").is_ok());
    let problem = only(parse("(cage: None, bearing: (rollers: 32))"));
    assert_eq!(problem.allowed, "at most 31 rollers");
    let problem = only(parse("(bearing: (rollers: 31), cage: (pocket_clearance_um: 900))"));
    assert!(problem.message.contains("31 pockets leave nothing of the cage"), "{problem}");
}

#[test]
fn refuses_impossible_cage_adapter_defect_mesh_and_sampling() {
    for (text, field, words) in [
        ("(cage: (outer_diameter_mm: 200))", "cage.outer_diameter_mm", "between the raceways"),
        ("(cage: (thickness_mm: 17))", "cage.thickness_mm", "between the raceways"),
        ("(cage: (outer_diameter_mm: 199.9, thickness_mm: 0.01))", "", ""),
        ("(adapter: (width_mm: 220))", "adapter.width_mm", "as wide as the outer ring (220 mm)"),
        ("(defect: (length_mm: 700))", "defect.length_mm", "longer than the whole raceway"),
        ("(defect: (length_mm: 400))", "defect.length_mm", "longer than any load zone"),
        ("(defect: (depth_mm: 7))", "defect.depth_mm", "too deep"),
        ("(mesh: (size_mm: 11))", "mesh.size_mm", "more than"),
        ("(mesh: (size_mm: 1e-6))", "mesh.size_mm", "elements"),
        ("(mesh: (roller_facets: 99999))", "mesh.roller_facets", "1.9e10 elements"),
        ("(mesh: (outer_facets: 1000000, size_mm: 0.2))", "mesh.outer_facets", "5.0e7 elements"),
        ("(bearing: (inner_ring_thickness_mm: 82))", "bearing.inner_ring_thickness_mm", "no bore"),
        ("(solver: (duration_ms: 0.015))", "solver.duration_ms", "fewer than two samples"),
        ("(solver: (duration_ms: 6e4), output: (interval_us: 0.01))", "output.interval_us", "6.0e9 samples"),
        ("(output: (sensors: []))", "output.sensors", "0 entries"),
        (
            "(output: (sensors: [(name: \"a\", angle_deg: 0), (name: \"a\", angle_deg: 1)]))",
            "output.sensors[1].name",
            "both called `a`",
        ),
        ("(output: (sensors: [(name: \"a b\", angle_deg: 0)]))", "output.sensors[0].name", "cannot name"),
        ("(name: \"../x\")", "name", "cannot name"),
        ("(cage: (roller_offsets_um: [1, 2]))", "cage.roller_offsets_um", "2 numbers for 24 rollers"),
        (
            "(bearing: (rollers: 3), cage: (roller_offsets_um: [99, -101, 0]))",
            "cage.roller_offsets_um[1]",
            "roller 2 would start in the wall of its pocket, which leaves it 100 µm",
        ),
        ("(mesh: (roller_phase_deg: 400))", "mesh.roller_phase_deg", "outside its range"),
    ] {
        if words.is_empty() {
            assert!(parse(text).is_ok(), "{text}");
            continue;
        }
        let problem = only(parse(text));
        assert_eq!(problem.field, field, "{problem}");
        assert!(problem.message.contains(words), "{problem}");
        assert!(!problem.allowed.is_empty() && !problem.suggestion.is_empty(), "{problem}");
    }
}

#[test]
fn example_overrides_reach_every_kind_of_field() {
    let set = |arguments: &[&str]| Scene::default().with_overrides(arguments).expect("valid");
    assert_eq!(set(&["mesh.size_mm=1"]).mesh.size_mm, 1.0);
    assert_eq!(set(&["mesh.roller_facets=56"]).mesh.roller_facets, 56);
    assert_eq!(set(&["mesh.outer_facets=700"]).mesh.outer_facets, Some(700));
    assert_eq!(set(&["cage=None"]).cage, None);
    assert_eq!(set(&["cage=None", "cage.thickness_mm=3.5"]).cage.map(|c| c.thickness_mm), Some(3.5));
    assert_eq!(set(&["defect=(length_mm: 5.0)"]).defect.map(|d| d.length_mm), Some(5.0));
    assert_eq!(set(&["contact.method=collocated"]).contact.method, ContactMethod::Collocated);
    assert_eq!(set(&["mesh.roller_copies=rotated"]).mesh.roller_copies, RollerCopies::Rotated);
    assert_eq!(set(&["solver.damping_frame=absolute"]).solver.damping_frame, DampingFrame::Absolute);
    assert_eq!(set(&["solver.duration_ms = 2"]).solver.duration_ms, 2.0);
    assert_eq!(set(&["name=quick"]).name, "quick");
    assert_eq!(set(&["name=\"quick\""]).name, "quick");
    assert_eq!(set(&["output.sensors[1].angle_deg=-22.5"]).output.sensors[1].angle_deg, -22.5);
    assert_eq!(set(&["output.sensors=[(name: \"a\", angle_deg: 1)]"]).output.sensors.len(), 1);
    assert_eq!(set(&["mesh.size_mm=2", "mesh.size_mm=1"]).mesh.size_mm, 1.0);
}

#[test]
fn example_profiles_are_written_in_files_and_behind_set() {
    let set = |arguments: &[&str]| Scene::default().with_overrides(arguments).expect("valid").operation;
    let ramp = RampScene { from_ms: 5.0, to_ms: 25.0, to: 1500.0 };
    let in_file =
        parse("(operation: (speed_profile: ramp(from_ms: 5, to_ms: 25, to: 1500)))").expect("valid");
    assert_eq!(in_file.operation.speed_profile, Some(ProfileScene::Ramp(ramp.clone())));
    // Beside what the section says already, whole or field by field, of the same kind or of another.
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
fn example_housings_are_written_in_files_and_behind_set() {
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
    assert_eq!(set(&["housing.mass_kg=3"]).housing, HousingScene::Rigid(RigidHousingScene { mass_kg: 3.0 }));
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
    // What is not said is not written: hashes of older scenes stay.
    let text = Scene::default().to_ron();
    assert!(
        !text.contains("housing") && !text.contains("load_angle") && !text.contains("outer_speed"),
        "{text}"
    );
}

#[test]
fn refuses_what_a_ring_from_a_file_leaves_to_the_file() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/rings/notched_outer.msh");
    for (more, field, words) in [
        // The paper's spall, which nobody has written: what is at fault is what was.
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
    let said = parse(&inner).expect_err("a clearance").to_string();
    assert!(said.contains("let the file have it"), "{said}");
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

#[test]
fn refuses_overrides_and_points_at_the_command_line() {
    let refuse = |argument: &str| only(Scene::default().with_overrides(&[argument]));
    for (argument, words) in [
        ("mesh.size=1", "did you mean `mesh.size_mm`?"),
        ("mesh.siz_mm=1", "did you mean `mesh.size_mm`?"),
        ("load_kn=50", "did you mean `operation.load_n`?"),
        ("size_mm=1", "did you mean `mesh.size_mm`?"),
        ("solver.size_mm=1", "did you mean `mesh.size_mm`?"),
        ("operation.load_kn=50", "1 in `load_kn` is 1000 in `operation.load_n`"),
        ("cage=none", "--set cage=None (with a capital letter)"),
        ("mesh.size_mm=-1", "without the minus sign"),
        ("mesh.size_mm=big", "which is not a number"),
        ("mesh.size_mm=1, roller_facets: 3", "not one complete value"),
        ("mesh.size_mm=", "is given no value"),
        ("mesh.size_mm", "has no `=`"),
        ("contact.method=smooth", "not one of its words"),
        ("output.sensors[9].angle_deg=1", "has 4 items"),
        ("cage=(thicknes_mm: 3)", "did you mean `thickness_mm`?"),
        ("=3", "name of a field is missing"),
        ("cage.roller_offsets_um[0]=1", "has 0 items"),
        ("cage.roller_offsets_um=[a]", "cage.roller_offsets_um"),
    ] {
        let problem = refuse(argument);
        let shown = problem.to_string();
        assert!(shown.contains(words), "{argument}\n{shown}");
        assert!(matches!(problem.place, Place::CommandLine { .. }), "{argument}\n{shown}");
        assert!(shown.contains(&format!("--set {argument}")), "{shown}");
    }
}

#[test]
fn example_an_override_may_repair_a_file_or_break_it() {
    let folder = Scratch::create("scene");
    let path = folder.join("x.ron");
    std::fs::write(&path, "(mesh: (size_mm: -1.0))").expect("writable");
    assert!(Scene::read(&path).is_err());
    assert_eq!(Scene::read_with(&path, &["mesh.size_mm=2.0"]).expect("repaired").mesh.size_mm, 2.0);
    let problem = only(Scene::read_with(&path, &["mesh=(size_mm: -2.0)"]));
    assert!(matches!(problem.place, Place::CommandLine { .. }), "{problem}");
}

#[test]
fn refuses_files_that_are_no_scene() {
    let folder = Scratch::create("files");
    let refuse = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).expect("writable");
        only(Scene::read(&path)).to_string()
    };
    assert!(refuse("nul", b"(\0)").contains("not a text file: byte 1 is 0x00"));
    assert!(refuse("huge", &vec![b' '; (8 << 20) + 1]).contains("larger than 8388608 bytes"));
    assert!(refuse("empty", b"").contains("the scene is empty"));
    assert!(refuse("cut", b"(bearing: (rollers: 2").contains("ends too early"));
    assert!(only(Scene::read(folder.join("missing.ron"))).to_string().contains("cannot read scene"));
    assert!(only(Scene::read(folder.path())).to_string().contains("is a folder"));
    std::fs::write(folder.join("bom.ron"), "\u{feff}()").expect("writable");
    assert!(Scene::read(folder.join("bom.ron")).is_ok());
}

#[test]
fn refuses_deep_nesting() {
    assert!(parse(&"(".repeat(100_000)).is_err());
    assert!(parse(&format!("(bearing: {}", "[".repeat(100_000))).is_err());
    assert!(Scene::default().with_overrides(&[format!("bearing={}", "(a:".repeat(50_000))]).is_err());
}

#[test]
fn refuses_a_scene_cut_anywhere() {
    let text = Scene::default().to_ron();
    let end = text.trim_end().len();
    for cut in (0..end).filter(|cut| text.is_char_boundary(*cut)) {
        let error = parse(&text[..cut]).expect_err("a part of a scene is no scene");
        assert!(!error.to_string().is_empty());
    }
}

proptest! {
    #[test]
    fn survives_any_scene_text_with_an_answer(text in "[(){}\\[\\]:,\"a-z_0-9. \\n\\-é]{0,60}") {
        let shown = parse(&text).map_or_else(|e| e.to_string(), |scene| scene.to_ron());
        prop_assert!(!shown.is_empty());
    }

    #[test]
    fn survives_any_override_with_an_answer(text in "[a-z_.=(){}\\[\\]0-9\"é ]{0,40}") {
        let shown = Scene::default().with_overrides(&[text]).map_or_else(|e| e.to_string(), |s| s.to_ron());
        prop_assert!(!shown.is_empty());
    }

    #[test]
    fn survives_a_damaged_scene_with_an_answer(at in 0_usize..1500, with in "[(){}:,\"0-9a-z. ]{1}") {
        let mut text = Scene::default().to_ron();
        let at = at.min(text.len() - 1);
        text.replace_range(at..=at, &with);
        let shown = parse(&text).map_or_else(|e| e.to_string(), |scene| scene.to_ron());
        prop_assert!(!shown.is_empty());
    }

    #[test]
    fn roundtrip_every_number_of_a_scene(load in 1e-3_f64..1e9, angle in -360.0_f64..360.0) {
        let mut scene = Scene::default();
        scene.operation.load_n = load;
        scene.bearing.first_roller_deg = angle;
        prop_assert_eq!(parse(&scene.to_ron()).expect("in range"), scene);
    }
}

#[test]
fn example_a_bearing_by_its_name_starts_from_rest_or_turns_back() {
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
fn example_a_bearing_by_its_name() {
    let scene = Scene::parse("(bearing: \"NU 205\", operation: (speed_rpm: 1500))", "mine").unwrap();
    let b = &scene.bearing;
    assert_eq!((scene.name.as_str(), b.designation.as_str(), b.rollers), ("nu-205", "NU 205", 13));
    assert_eq!((b.inner_race_diameter_mm, b.outer_race_diameter_mm), (31.5, 46.5));
    // Bore 25 and outside diameter 52.
    assert_eq!((b.inner_ring_thickness_mm, b.outer_ring_thickness_mm), (3.25, 2.75));
    assert_eq!(scene.operation.speed_rpm, 1500.0);
    // Facets of the paper's number.
    assert!((scene.mesh.size_mm / b.roller_diameter_mm - 0.5 / 18.0).abs() < 2e-4);
    // What the file or the command line says stays; the complete scene reads back to itself.
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

#[test]
fn example_every_bearing_of_the_catalogue_makes_a_scene_or_says_why_not() {
    let mut refused = Vec::new();
    for bearing in crate::catalogue::all() {
        let text = format!("(bearing: \"{}\")", bearing.name);
        match Scene::parse(&text, "mine") {
            Ok(scene) if bearing.name == crate::catalogue::PAPER => assert_eq!(scene, Scene::default()),
            Ok(scene) => assert_eq!(scene.bearing.designation, bearing.name),
            Err(why) => {
                let why = why.to_string();
                assert!(why.contains("contact angle") || why.contains("rings of"), "{text}: {why}");
                refused.push(bearing.name);
            }
        }
    }
    assert_eq!(refused, ["ZA-2115", "NICE"]);
    let fewer = Scene::parse("(bearing: \"paper, elements=20\")", "mine").unwrap();
    assert_eq!(fewer.bearing, BearingScene { rollers: 20, ..BearingScene::default() });
    let other = Scene::parse("(bearing: \"paper, diameter_mm=17\")", "mine").unwrap_err();
    assert!(other.to_string().contains("as fields of `bearing`"), "{other}");
}

#[test]
fn invariant_balls_are_cylinders_of_their_own_stiffness() {
    use crate::{line_contact::LineContacts, point_contact};
    let scene = Scene::parse("(bearing: \"6205\", operation: (load_n: 2000))", "mine").unwrap();
    let g = scene.resolve();
    let load = 4.37 * 2000.0 / 9.0;
    let modulus = g.material.youngs_modulus / (1.0 - g.material.poissons_ratio.powi(2));
    let ball = |race| point_contact::approach(g.roller_radius, race, 1.04 * g.roller_radius, load, modulus);
    let ratio = LineContacts::of(&g).approach(load / g.thickness).0
        / (ball(g.inner_race_radius) + ball(-g.outer_race_radius));
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
}

#[test]
fn refuses_unknown_fields_of_meshes_without_naming_the_one_that_runs_write() {
    for text in ["(housing: mesh(fil: \"x.msh\"))", "(outer_ring_mesh: (fil: \"x.msh\"))"] {
        let why = Scene::parse(text, "mine").unwrap_err().to_string();
        assert!(why.contains("`file`") && !why.contains("`text`"), "{why}");
    }
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
    let why = Scene::parse("(bearing: \"NU 205\", mesh: (sise_mm: 1))", "mine").unwrap_err().to_string();
    assert!(why.contains("(bearing: \"NU 205\", mesh: (sise_mm: 1))"), "{why}");
}

#[test]
fn example_defects_on_either_ring_with_sloped_edges() {
    let scene = parse("(defect: (ring: inner, edge_slope_deg: 30))").unwrap();
    let defect = scene.resolve().grooves[0];
    assert_eq!(defect.ring, crate::scene::DefectRing::Inner);
    assert!((defect.edge_slope.to_degrees() - 30.0).abs() < 1e-12);
    for (text, field) in [
        ("(defect: (edge_slope_deg: 120))", "defect.edge_slope_deg"),
        ("(film: None, defect: (edge_slope_deg: 6))", "defect.edge_slope_deg"),
        // A roller would feel a film across the edge.
        ("(defect: (edge_slope_deg: 20))", "defect.edge_slope_deg"),
        ("(defect: (ring: middle))", "defect.ring"),
        ("(defect: (ring: inner, depth_mm: 7))", "defect.depth_mm"),
    ] {
        assert_eq!(only(parse(text)).field, field, "{text}");
    }
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
