//! The data set of a campaign: ground truth, events, and a page that describes
//! them.

use std::fs;
use std::path::Path;
use stribeck_testing::assert_has;

use crate::common::Desk;
use serde_json::Value;
use stribeck_formats::Recording;

/// Four bearings of the reduced model: a spall, a dent beside a missing roller, waves, and none of these.
const CAMPAIGN: &str = "(
    name: \"defects\",
    scene: \"reduced.ron\",
    set: [\"mesh.size_mm=2.0\", \"defect=None\", \"solver.duration_ms=40\",
        \"output.interval_us=20\"],
    keep: KEEP,
    variants: grid([(field: \"defects\", values: [
        [(on: outer, angle_deg: 85.0, form: spall(length_mm: 8.0, depth_mm: 0.2))],
        [(on: roller(3), angle_deg: 30.0, form: dent(length_mm: 3.0, depth_mm: 0.02)), (on: roller(5), form: \
        missing)],
        [(on: inner, form: waviness(order: 9, amplitude_um: 1.0))],
        [],
    ])]),
)";

fn run(desk: &Desk, keep: &str, words: &[&str]) {
    fs::write(desk.join("campaign.ron"), CAMPAIGN.replace("KEEP", keep)).expect("a campaign");
    desk.succeeds(&[&["campaign", "campaign.ron"], words].concat());
}

fn numbers(table: &Path, column: &str) -> Vec<f64> {
    let table = Recording::open(table).expect("a table");
    table.channel(column).expect("a column").read().expect("numbers")
}

/// Events of the runs in their order, from their folders.
fn summaries(campaign: &Path) -> Vec<(f64, Value)> {
    // By the hash of its scene; which run that is follows from how many defects it has.
    let folders = fs::read_dir(campaign.join("runs")).expect("runs").flatten();
    // Beside them lie the modes that they share.
    let folders = folders.filter(|folder| folder.path().join("scene.ron").exists());
    let mut found: Vec<(f64, Value)> = folders
        .map(|folder| {
            let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a run");
            let scene = read("scene.ron");
            let number = ["form: spall", "form: dent", "form: waviness", ""];
            let number = number.iter().position(|form| scene.contains(form)).expect("the last fits all") + 1;
            (number as f64, serde_json::from_str(&read("summary.json")).expect("a summary"))
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

#[test]
fn behaves_the_tables_hold_the_truth_and_every_event() {
    let desk = Desk::new("data-set");
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/reduced.ron");
    fs::copy(scenes, desk.join("reduced.ron")).expect("a scene");
    run(&desk, "numbers", &["--out=A"]);
    let runs = desk.join("A/runs.parquet");
    assert_eq!(numbers(&runs, "fault_count"), [1.0, 2.0, 0.0, 0.0]);
    // A dent is as long as its hollow and half as much of a rim on either side.
    for (column, of_spall, of_dent) in
        [("fault_size_mm", 8.0, 6.0), ("fault_depth_mm", 0.2, 0.02), ("fault_angle_deg", 85.0, 30.0)]
    {
        let found = numbers(&runs, column);
        assert_eq!(found[..2], [of_spall, of_dent], "{column}");
        assert!(found[2..].iter().all(|n| n.is_nan()), "{column}: {found:?}");
    }

    let events = desk.join("A/events.parquet");
    let (of_run, of_roller) = (numbers(&events, "run"), numbers(&events, "roller"));
    let columns = ["expected_entry_ms", "entry_ms", "path_exit_ms", "level_n", "floor_n", "spall_mm"];
    let found = columns.map(|column| numbers(&events, column));
    let mut row = 0;
    for (number, summary) in summaries(&desk.join("A")) {
        for event in summary["events"].as_array().expect("a list") {
            assert_eq!((of_run[row], of_roller[row]), (number, event["roller"].as_f64().expect("a number")));
            for (column, found) in columns.iter().zip(&found) {
                let expected = event[column].as_f64().unwrap_or(f64::NAN);
                assert_eq!(found[row].to_bits(), expected.to_bits(), "{column} of event {row}");
            }
            row += 1;
        }
    }
    assert_eq!(row, of_run.len());
    // 85 Hz for 40 ms over the only spall that is on a raceway.
    assert!(row >= 2 && of_run.iter().all(|run| *run == 1.0), "{of_run:?}");

    // In parts, to the same bytes.
    run(&desk, "numbers", &["--out=B", "--shard=2/2"]);
    run(&desk, "numbers", &["--out=B", "--shard=1/2"]);
    for name in ["runs.parquet", "events.parquet", "DATASHEET.md"] {
        assert_eq!(
            fs::read(desk.join("A").join(name)).ok(),
            fs::read(desk.join("B").join(name)).ok(),
            "{name}"
        );
    }

    let sheet = desk.text("A/DATASHEET.md");
    assert_has(
        &sheet,
        &[
            "| model | reduced: 4 |",
            "healthy: 2; outer_race (spall): 1; rolling_element+missing_rolling_element (dent+missing): 1",
            "| other deviations | none: 3; waviness: 1 |",
            "| bearing | without a designation: 4 |",
            "modes up to 30 kHz",
            "missing leaves its pocket empty",
            "| `fault_depth_mm` | mm |",
            "| `level_n` | N |",
            "| `floor_by` |",
            "| sampling rate | 50000 Hz |",
        ],
    );
    for line in sheet.lines().filter(|line| line.starts_with("| `")) {
        assert!(!line.ends_with("|  |"), "a column without its meaning: {line}");
    }
    // Nothing of what this campaign does not hold.
    for words in ["Full model", "signals.parquet", "## Columns of `signals"] {
        assert!(!sheet.contains(words), "`{words}` is in\n{sheet}");
    }
}
