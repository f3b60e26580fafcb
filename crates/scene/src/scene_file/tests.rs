//! Texts of scene files and of `--set`, and the answers to them.

mod blame;
mod deviations;
mod formats;
mod named;
mod operation;
mod own;
mod written;

use proptest::prelude::*;
use stribeck_testing::{Scratch, assert_refused};

use super::{Place, Problem, SceneError, read_as};
use crate::housing::{HousingScene, PedestalScene, RigidHousingScene};
use crate::reading::sources::SCENE;
use crate::scene::{
    BearingScene, ContactMethod, DampingFrame, HarmonicScene, ModelScene, PocketWalls, ProfileScene,
    RampScene, ReducedScene, RollerCopies, Scene, Start,
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
    assert!(problem.suggestion.contains("did you mean `operation.load_n` [N]?"), "{problem}");

    let problem = only(parse("(operation: (load: 50))"));
    assert!(problem.suggestion.contains("`operation.load_n`"), "{problem}");
    let problem = only(parse("(baering: (rollers: 24))"));
    assert_eq!(problem.suggestion, "did you mean `bearing`?");
    let problem = only(parse("(speed_rpm: 500)"));
    assert_eq!(problem.suggestion, "did you mean `operation.speed_rpm` [rpm]?");
    let problem = only(parse("(cage: (clearance_um: 500))"));
    assert!(problem.suggestion.contains("`cage.pocket_clearance_um`"), "{problem}");
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
    // Sections need brackets, a roller its number, and a bearing's name quotes.
    for (text, tried) in [
        ("(model: reduced)", "`reduced()`"),
        ("(model: \"reduced\")", "`reduced()`"),
        ("(model: \"full\")", "`full`"),
        ("(bearing: NU205)", "`\"NU 205\"`"),
        ("(defect: None, defects: [(on: roller, form: missing)])", "`roller(1)`"),
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
    let problem = only(parse("() trailing"));
    assert!(problem.message.contains("the end of the text is expected here"), "{problem}");
}

#[test]
fn refuses_overlapping_bodies_with_numbers() {
    let bearing = |inner: &str, roller: &str| {
        format!(
            "(bearing: (rollers: 24, outer_race_diameter_mm: 200, roller_diameter_mm: {roller},\n \
             inner_race_diameter_mm: {inner}))"
        )
    };
    let problem = only(parse(&bearing("165.0", "18")));
    assert!(problem.message.contains("200 − inner raceway 165 − 2 × roller 18 = -1 mm"), "{problem}");
    assert_eq!(problem.allowed, "16.667 to 17.5 mm");
    assert!(parse("(bearing: (inner_race_diameter_mm: 164.0))").is_ok(), "zero clearance is allowed");
    let problem = only(parse("(bearing: (inner_race_diameter_mm: 160.0))"));
    assert!(problem.message.contains("it lacks `rollers`, `roller_diameter_mm`, `pitch_mm`"), "{problem}");
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
        assert!(!problem.allowed.is_empty(), "{problem}");
    }
}

#[test]
fn behaves_overrides_reach_every_kind_of_field() {
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
fn refuses_overrides_and_points_at_the_command_line() {
    let refuse = |argument: &str| only(Scene::default().with_overrides(&[argument]));
    for (argument, words) in [
        ("mesh.size=1", "did you mean `mesh.size_mm` [mm]?"),
        ("mesh.siz_mm=1", "did you mean `mesh.size_mm` [mm]?"),
        ("load_kn=50", "did you mean `operation.load_n` [N]?"),
        ("size_mm=1", "did you mean `mesh.size_mm` [mm]?"),
        ("solver.size_mm=1", "did you mean `mesh.size_mm` [mm]?"),
        ("operation.load_kn=50", "did you mean `operation.load_n` [N]?"),
        ("load=2000", "did you mean `operation.load_n` [N]?"),
        ("output.rate_hz=51200", "`output.interval_us=19.53125` (1e6 over the rate in Hz)"),
        ("cage=none", "`None` (with a capital letter)"),
        ("mesh.size_mm=-1", "more than 0, at most 1000 mm"),
        ("mesh.size_mm=big", "which is not a number"),
        ("mesh.size_mm=1, roller_facets: 3", "not one complete value"),
        ("mesh.size_mm=", "is given no value"),
        ("mesh.size_mm", "has no `=`"),
        ("contact.method=smooth", "not one of its words"),
        ("output.sensors[9].angle_deg=1", "has 4 items"),
        ("cage=(thicknes_mm: 3)", "did you mean `cage.thickness_mm` [mm]?"),
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
fn behaves_an_override_may_repair_a_file_or_break_it() {
    let folder = Scratch::create("scene");
    let path = folder.join("x.ron");
    std::fs::write(&path, "(mesh: (size_mm: -1.0))").expect("writable");
    let problem = only(Scene::read(&path));
    assert!(matches!(problem.place, Place::File { .. }), "{problem}");
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
    assert!(
        only(Scene::read(folder.join("missing.ron")))
            .to_string()
            .contains("missing.ron`: there is no such file")
    );
    assert!(only(Scene::read(folder.path())).to_string().contains("is a folder"));
    std::fs::write(folder.join("bom.ron"), "\u{feff}()").expect("writable");
    assert!(Scene::read(folder.join("bom.ron")).is_ok());
}

#[test]
fn refuses_deep_nesting() {
    assert_refused(parse(&"(".repeat(100_000)), "too many brackets in each other");
    assert_refused(parse(&format!("(bearing: {}", "[".repeat(100_000))), "too many brackets in each other");
    let deep = Scene::default().with_overrides(&[format!("bearing={}", "(a:".repeat(50_000))]);
    assert_refused(deep, "which is not one complete value");
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

#[test]
fn refuses_numbers_outside_their_range_behind_the_name_of_a_group() {
    for text in ["(mesh: (size_mm: -1.0))", "Scene(mesh: MeshScene(size_mm: -1.0))"] {
        let why = read_as::<Scene>(text, "x.ron", &SCENE).expect_err("no size");
        assert_eq!(why.problems()[0].field, "mesh.size_mm", "{text}: {why}");
    }
}

/// Each problem holds its line: all of these would take gigabytes.
#[test]
fn survives_a_line_of_many_mistakes() {
    let many = |item: &str| format!("(cage: (roller_offsets_um: [{}]))", item.repeat(100_000 / item.len()));
    for text in [many("x,"), many("99999,"), format!("({})", "a:1,".repeat(25_000))] {
        let why = parse(&text).expect_err("mistakes");
        assert_eq!(why.problems().len(), crate::reading::problem::MOST_TOLD);
    }
}

#[test]
fn refuses_a_foreign_word_in_some_with_a_mark_between_its_letters() {
    let why = Scene::default().with_overrides(&["contact.method=Some(ééé)"]).expect_err("no method");
    assert!(why.to_string().contains("`contact.method` is `ééé`, which is not one of its words"), "{why}");
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
    fn roundtrip_every_number_of_a_scene(load in 1e-3_f64..5e6, angle in -360.0_f64..360.0) {
        let mut scene = Scene::default();
        scene.operation.load_n = load;
        scene.bearing.first_roller_deg = angle;
        prop_assert_eq!(parse(&scene.to_ron()).expect("in range"), scene);
    }
}

#[test]
fn refuses_unknown_fields_of_meshes_without_naming_the_one_that_runs_write() {
    for text in ["(housing: mesh(fil: \"x.msh\"))", "(outer_ring_mesh: (fil: \"x.msh\"))"] {
        let why = Scene::parse(text, "mine").unwrap_err().to_string();
        assert!(why.contains("`file`") && !why.contains("`text`"), "{why}");
    }
}
