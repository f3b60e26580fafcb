//! Fields in which scenes differ.

use stribeck_analysis::comparison::differences;
use stribeck_scene::scene::Scene;

#[test]
fn behaves_two_scenes_and_a_record() {
    let scene = |set: &[&str]| Scene::default().with_overrides(set).expect("a scene");
    let first = scene(&["operation.load_n=3000", "defect.length_mm=4"]);
    let mut other = scene(&["operation.load_n=5000", "defect=None"]);
    other.name = "other".to_owned();
    let found = differences(&[Some(&first), None, Some(&other)]);
    let fields: Vec<&str> = found.iter().map(|d| d.field.as_str()).collect();
    assert_eq!(fields, ["defect", "operation.load_n"]);
    assert_eq!(found[1].values, [Some("3000".to_owned()), None, Some("5000".to_owned())]);
    let defect = found[0].values[0].as_deref().expect("of a scene");
    assert!(defect.starts_with('(') && defect.contains("length_mm: 4"), "{defect}");
    assert_eq!(found[0].values[2].as_deref(), Some("None"));
    assert!(differences(&[Some(&first), Some(&Scene { name: "x".to_owned(), ..first.clone() })]).is_empty());
    assert!(differences(&[Some(&first), None]).is_empty());
}
