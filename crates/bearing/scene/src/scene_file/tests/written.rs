//! Complete scenes as they are written: defaults, hash, and reading them back.

use super::*;

#[test]
fn behaves_an_empty_group_is_the_default_scene() {
    assert_eq!(parse("()").expect("valid"), Scene::default());
}

/// Paths of the fields of `scene` that a text does not write.
fn unwritten(text: &str, scene: &Scene) -> Vec<String> {
    let paths = |text: &str| super::super::paths_in(&crate::fields::tree::parse(text).expect("sound"));
    let written = paths(text);
    paths(&scene.to_ron()).into_iter().filter(|path| !written.contains(path)).collect()
}

#[test]
fn behaves_oiled_steel_spells_out_the_defaults() {
    let text = include_str!("../../../../../../fixtures/scenes/oiled_steel.ron");
    assert_eq!(parse(text).expect("valid"), Scene::default());
    assert_eq!(unwritten(text, &Scene::default()), Vec::<String>::new());
}

/// The file of the paper's scene holds every number, whatever the defaults are.
#[test]
fn behaves_the_scene_of_the_paper_leaves_nothing_out() {
    let text = include_str!("../../../../../../fixtures/scenes/singh2014.ron");
    assert_eq!(unwritten(text, &parse(text).expect("valid")), Vec::<String>::new());
}

#[test]
fn behaves_the_quick_scene_holds_the_exit_of_roller_1() {
    let scene = parse(include_str!("../../../../../../fixtures/scenes/quick.ron")).expect("valid");
    assert_eq!(scene.bearing, Scene::default().bearing);
    assert!(scene.solver.duration_ms > 5.08 + 0.5, "the exit and half a millisecond of ringing");
}

#[test]
fn roundtrip_the_resolved_scene_reads_back_equal() {
    let mut scene = Scene { defect: None, ..Scene::default() };
    scene.mesh.outer_facets = Some(1257);
    scene.bearing.thickness_mm = 30.1 + 0.2;
    scene.operation.load_n = 1.234_567_890_123_456_7e5;
    scene.contact.method = ContactMethod::Collocated;
    scene.solver.start = Start::Sudden;
    let text = scene.to_ron();
    assert_eq!(parse(&text).expect("valid"), scene);
    assert_eq!(parse(&text).expect("valid").to_ron(), text);
    assert!(text.contains("method: collocated"), "{text}");
}

#[test]
fn behaves_the_hash_is_fnv_1a_of_the_content() {
    let plain = parse("()").expect("valid");
    let spelled = parse("( /* same */ mesh: (size_mm: 0.5))").expect("valid");
    assert_eq!(plain.hash(), spelled.hash());
    assert_eq!(plain.hash().len(), 16);
    let other = parse("(mesh: (size_mm: 0.6))").expect("valid");
    assert_ne!(plain.hash(), other.hash());
}

#[test]
fn behaves_a_later_field_changes_the_hash_only_where_it_is_used() {
    // The hash of the paper's scene before there was stiffness damping, with what were defaults then: a field
    // that it does not use leaves it alone.
    const FIRST: &str = "d300e82243b85717";
    let hash = |pocket: &str, film: &str, structural: &str, more: &str| {
        let scene = format!(
            "(name: \"singh2014\", mesh: (roller_copies: translated), cage: (pocket: {pocket}), film: \
             {film}, solver: (time_step_factor: 0.95, \
             mass_damping_per_s: 5000.0, structural_damping: {structural}, {more}), \
             guards: (energy_warning_percent: 0.5))"
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
