//! Inferences as their users meet them: found, killed, split over machines, asked for missing targets.

use std::fs;
use std::path::Path;
use std::process::Stdio;

use crate::common::Desk;
use serde_json::Value;
use stribeck_formats::Recording;
use stribeck_testing::{Noise, assert_has, said, says};

/// A small reduced bearing: its load and the length of its defect from three numbers of a run.
const QUICK: &str = include_str!("../../../../fixtures/infer/quick.ron");

fn desk(name: &str, text: &str) -> Desk {
    let desk = Desk::of(name, &["infer", "targets.ron"]);
    fs::write(desk.join("targets.ron"), text).expect("the file of an inference");
    desk
}

fn answer(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("inference.json")).expect("inference.json")).expect("JSON")
}

fn draws(folder: &Path) -> Vec<u8> {
    fs::read(folder.join("posterior.parquet")).expect("posterior.parquet")
}

/// The same inference with targets that a run of `length_mm` and `load_n` has, and more or fewer runs.
fn with_targets(length_mm: f64, load_n: f64, budget: &str) -> String {
    let desk = Desk::new("infer-truth");
    let set = QUICK.lines().filter_map(|line| line.trim().strip_prefix('"')?.strip_suffix("\","));
    let set: Vec<String> =
        set.filter(|line| line.contains('=')).map(|line| line.replace("\\\"", "\"")).collect();
    let mut command = desk.command(&["simulate", "--out=truth"]);
    for field in &set {
        command.args(["--set", field]);
    }
    command.args([format!("--set=defect.length_mm={length_mm}"), format!("--set=operation.load_n={load_n}")]);
    let done = command.output().expect("it starts");
    assert!(done.status.success(), "{}", said(&done));
    let summary = desk.json("truth/summary.json");
    let number = |path: &str| {
        let quantity = stribeck_plans::inference::Quantity::parse(path).expect("a path");
        quantity.number(&summary).unwrap_or_else(|| panic!("{path} has no number"))
    };
    let (exits, before, length) =
        (number("levels.impulse_g"), number("median(events.level_n)"), number("median(events.spall_mm)"));
    let head = &QUICK[..QUICK.find("    targets: [").expect("targets")];
    format!(
        "{head}    targets: [
        (name: \"exits\", of: \"levels.impulse_g\", value: {exits}, tolerance: {}, log: true),
        (name: \"force before the defect\", of: \"median(events.level_n)\", value: {before}, tolerance: 5.0),
        (name: \"length\", of: \"median(events.spall_mm)\", value: {length}, tolerance: 0.1),
    ],
    budget: ({budget}),\n)\n",
        0.1 * exits
    )
}

#[test]
fn planted_load_and_length_are_found_from_a_run_with_both() {
    let desk = desk("infer-found", &with_targets(4.1, 700.0, "runs: 60, first: 12, round: 9, check: 4"));
    desk.says("--out=A --calibrate=40", &["defect.length_mm", "operation.load_n", "report: A/report.html"]);
    let answer = answer(&desk.join("A"));
    for (field, truth, most) in [("defect.length_mm", 4.1, 0.6), ("operation.load_n", 700.0, 0.8)] {
        let found =
            answer["fields"].as_array().expect("a list").iter().find(|f| f["name"] == field).expect(field);
        let interval: Vec<f64> = serde_json::from_value(found["interval_90"].clone()).expect("an interval");
        // Twice as wide as the 90 % interval, so that a sound inference misses it once in a thousand.
        let (middle, half) = (0.5 * (interval[0] + interval[1]), interval[1] - interval[0]);
        assert!((truth - middle).abs() < half, "{field}: {interval:?}");
        let width = found["width_of_prior"].as_f64().expect("a number");
        assert!(width < most, "{field}: {width} of the prior");
    }
    // Outputs of runs at draws of the posterior lie about the targets.
    for target in answer["targets"].as_array().expect("a list") {
        let (value, median) = (target["value"].as_f64().expect("a value"), target["run_median"].as_f64());
        let ratio = median.expect("runs") / value;
        assert!((0.5..2.0).contains(&ratio), "{}: {ratio}", target["name"]);
    }
    let calibrated = answer["calibration"].as_array().expect("a calibration");
    for field in calibrated {
        let held = field["held_90"][0].as_f64().expect("a share");
        // 36 of 40 are expected; 29 or fewer come by chance once in a thousand.
        assert!(held >= 0.725, "{}: {held}", field["name"]);
    }
    let draws = stribeck_formats::parquet::open(&desk.join("A/posterior.parquet")).expect("a table");
    let Recording { .. } = draws;
    let page = desk.text("A/report.html");
    assert_has(&page, &["What each unknown can have been", "What no scene makes", "Calibration"]);
}

#[test]
fn survives_kills_and_any_split_with_the_draws_of_an_unbroken_inference() {
    let desk =
        desk("infer-kills", &QUICK.replace("runs: 48, first: 12, round: 6", "runs: 28, first: 9, round: 5"));
    desk.succeeds("--out=A --jobs=2 --threads=2");
    let mut noise = Noise::new(5);
    for _ in 0..5 {
        desk.kill("--out=B --jobs=2", 200.0 + 800.0 * noise.uniform().abs());
    }
    desk.succeeds("--out=B --jobs=1");
    assert_eq!(draws(&desk.join("A")), draws(&desk.join("B")));
    // Two parts at once, in a folder that is not there yet.
    let parts: Vec<_> = ["--shard=1/2", "--shard=2/2"]
        .map(|part| {
            desk.command(&["--out=C", part, "--jobs=1"]).stdout(Stdio::null()).stderr(Stdio::null()).spawn()
        })
        .into_iter()
        .map(|child| child.expect("it starts"))
        .collect();
    for mut part in parts {
        assert!(part.wait().expect("it ends").success());
    }
    assert_eq!(draws(&desk.join("A")), draws(&desk.join("C")));
}

#[test]
fn refuses_what_no_run_has_and_another_folder() {
    let lost = QUICK.replace("levels.impulse_g", "levels.impuls_g");
    let desk = desk("infer-lost", &lost);
    let done = desk.run("--out=A");
    assert!(!done.status.success());
    says(
        &done,
        &[
            "target `exits`",
            "`levels.impuls_g` is no number of summary.json",
            "nearest is `levels.impulse_g`",
        ],
    );
    assert!(!desk.join("A/runs").exists(), "runs were made before the target was looked for");
    fs::write(desk.join("targets.ron"), QUICK).expect("it can be written");
    desk.refuses("--out=A", &["holds another inference", "--out"]);
    let script = desk.run("--emit=slurm --shards=4");
    says(&script, &["#SBATCH --array=1-4", " infer ", "--shard $SLURM_ARRAY_TASK_ID/4"]);
}
