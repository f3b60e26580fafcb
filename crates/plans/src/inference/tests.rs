//! Inference files: the unknowns and targets that they define, and the errors that they get.

use serde_json::json;

use super::*;

const UNKNOWN: &str = "(field: \"operation.load_n\", from: 5000, to: 50000, log: true)";
const TARGET: &str = "(name: \"exits\", of: \"levels.impulse_g\", value: 180, tolerance: 18, log: true)";

fn text(unknowns: &str, targets: &str, more: &str) -> String {
    format!("(name: \"x\", unknowns: [{unknowns}], targets: [{targets}]{more})")
}

fn parse(text: &str) -> Result<Inference, String> {
    Inference::parse(text, "a.ron", Path::new("")).map_err(|why| why.to_string())
}

#[test]
fn behaves_values_of_unknowns_make_a_scene() {
    let unknowns = format!(
        "{UNKNOWN}, (field: \"mesh.roller_copies\", values: [rotated, translated]),
         (name: \"damping\", sets: [[\"solver.mass_damping_per_s=5000\", \"solver.structural_damping=None\"], []])"
    );
    let inference = parse(&text(&unknowns, TARGET, ", set: [\"film=None\"]")).unwrap();
    let scene = inference.scene(&[12345.678, 1.0, 0.0]).unwrap();
    assert_eq!((scene.operation.load_n, scene.film), (12345.68, None));
    assert_eq!((scene.solver.mass_damping_per_s, scene.solver.structural_damping), (5000.0, None));
    assert_eq!(inference.unknowns[1].written(1.0), "translated");
    assert_eq!(inference.scene(&[1e4, 0.0, 1.0]).unwrap().solver.mass_damping_per_s, 0.0);
}

#[test]
fn refuses_what_cannot_be_inferred_with_its_line() {
    let refused = [
        (text("", TARGET, ""), "`unknowns` has 0 items"),
        (text(UNKNOWN, "", ""), "`targets` has 0 items"),
        (text("(field: \"operation.lod_n\", from: 1, to: 2)", TARGET, ""), "operation.load_n"),
        (text("(field: \"operation.load_n\", from: 5, to: 2)", TARGET, ""), "goes from 5 to 2"),
        (text("(field: \"operation.load_n\", from: -5, to: 20)", TARGET, ""), "allowed"),
        (text("(field: \"operation.load_n\", values: [1])", TARGET, ""), "one choice"),
        (text(UNKNOWN, "(of: \"sum(levels.impulse_g)\", value: 1)", ""), "it is one of count"),
        (text(UNKNOWN, "(of: \"max(levels.impulse_g > 5)\", value: 1)", ""), "has a bound"),
        (text(UNKNOWN, "(of: \"levels.impulse_g > x\", value: 1)", ""), "the bound `x`"),
        (text(UNKNOWN, "(of: \"levels..impulse_g\", value: 1)", ""), "no path of summary.json"),
        (text(UNKNOWN, "(of: \"levels.sensors[sensor={s}].gap_g\", value: 1)", ""), "asks for `{s}`"),
        (text(UNKNOWN, "(of: \"levels.impulse_g\")", ""), "takes one of `value`"),
        (text(UNKNOWN, "(of: \"levels.impulse_g\", value: 1, tolerance: -1)", ""), "0 or more"),
        (text(UNKNOWN, TARGET, ", budget: (runs: 3)"), "1 unknowns take 4 scenes at least"),
        (text(UNKNOWN, TARGET, ", bugdet: (runs: 3)"), "did you mean `budget`?"),
        (text(UNKNOWN, TARGET, ", set: [\"film=5\"]"), "film"),
    ];
    for (text, word) in refused {
        let why = parse(&text).unwrap_err();
        assert!(why.contains(word) && why.contains("a.ron:1:"), "`{word}` with its line is not in\n{why}");
    }
}

#[test]
fn behaves_quantities_name_numbers_of_a_summary() {
    let summary = json!({
        "levels": { "impulse_g": 180.0, "gap_g": null },
        "tones": [
            { "name": "cage", "harmonic": 1, "hz": 3.0 },
            { "name": "roller", "harmonic": 1, "hz": 4671.0 },
            { "name": "roller", "harmonic": 5, "hz": null },
        ],
        "events": [{ "floor_n": 270.0 }, { "floor_n": null }, { "floor_n": 190.0 }],
        "curve": [1.0, 2.0, 3.0],
    });
    let number = |path: &str| Quantity::parse(path).unwrap().number(&summary);
    let expected = [
        ("levels.impulse_g", Some(180.0)),
        ("levels.gap_g", None),
        ("levels.lost_g", None),
        ("tones[name=roller,harmonic=1].hz", Some(4671.0)),
        ("tones[name=roller, harmonic=5].hz", None),
        ("tones[0].hz", Some(3.0)),
        ("tones.hz", None),
        ("count(events.floor_n)", Some(2.0)),
        ("share(events.floor_n)", Some(2.0 / 3.0)),
        ("count(events.floor_n > 200)", Some(1.0)),
        ("share(events.floor_n < 200)", Some(1.0 / 3.0)),
        ("levels.impulse_g > 200", Some(0.0)),
        ("levels.impulse_g < 200", Some(1.0)),
        ("levels.gap_g < 200", None),
        ("mean(events.floor_n)", Some(230.0)),
        ("median(events.floor_n)", Some(230.0)),
        ("min(events.floor_n)", Some(190.0)),
        ("max(events.floor_n)", Some(270.0)),
        ("first(events.floor_n)", Some(270.0)),
        ("count(tones[name=nobody].hz)", Some(0.0)),
    ];
    for (path, value) in expected {
        assert_eq!(number(path), value, "{path}");
    }
    let gap = Quantity::parse("tones[name={tone},harmonic=1].hz").unwrap();
    assert_eq!((gap.placeholders(), gap.with("tone", "cage").number(&summary)), (vec!["tone"], Some(3.0)));
    assert_eq!(Quantity::parse("curve").unwrap().curve(&summary), Some(vec![1.0, 2.0, 3.0]));
    assert_eq!(Quantity::parse("tones[name={tone}, harmonic=1].hz").unwrap().path(), "tones.hz");
}

#[test]
fn behaves_the_file_of_the_guide_is_one() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/infer/quick.ron");
    let inference = Inference::read(&path).unwrap();
    assert_eq!((inference.unknowns.len(), inference.targets.len(), inference.budget.first), (2, 3, 12));
}
