//! Summaries of several runs as one.

use serde_json::Value;
use serde_json::json;
use stribeck_analysis::ensemble::Merged;

#[test]
fn by_hand_three_summaries_as_one() {
    let all = [
        json!({"status": "complete", "found": true, "level_g": 10.0,
               "events": [{"roller": 1, "floor_n": 100.0}, {"roller": 2, "floor_n": null}]}),
        json!({"status": "complete", "found": false, "level_g": 14.0, "events": [{"roller": 2, "floor_n": 50.0}]}),
        json!({"status": "diverged", "found": true, "level_g": null, "events": []}),
    ];
    let merged = Merged::of(all.iter()).expect("plain values");
    let level = merged.number("level_g").expect("in two");
    assert_eq!((level.mean, level.count, level.of), (12.0, 2, 3));
    assert_eq!(merged.get("status"), Some(&Merged::Nothing));
    let Some(Merged::Share(found)) = merged.get("found") else { panic!("no share") };
    assert_eq!((found.count, found.of), (2, 3));
    // The second roller is found by its name, not by its place.
    let floor = merged.number("events[1].floor_n").expect("in one");
    assert_eq!((floor.mean, floor.count, floor.of), (50.0, 1, 3));
    assert_eq!(merged.get("events[1].roller"), Some(&Merged::Same(json!(2))));
    assert_eq!(merged.items("events").len(), 2);
    assert_eq!(merged.number("events[7].floor_n"), None);
    let text = serde_json::to_value(&merged).expect("writable");
    assert_eq!(text["events"][0]["floor_n"]["mean"], json!(100.0));
    assert_eq!(text["status"], Value::Null);
    assert!(text["level_g"]["low"].as_f64().expect("a number") < 12.0);
}

#[test]
fn behaves_no_summary_has_no_numbers() {
    let none: [Value; 0] = [];
    assert_eq!(Merged::of(none.iter()).expect("nothing to write"), Merged::Nothing);
}
