//! A machine around the bearing: its record in the folder of a run, the machine that is fitted to such records,
//! and the smallest spall that is found.

use crate::common::Desk;
use stribeck_testing::says;

/// A path and a background that nobody would guess.
const PLANTED: &str = "(gains: [(hz: 60, gain: 0.004), (hz: 800, gain: 0.02), (hz: 3000, gain: 0.3), (hz: 5000, \
    gain: 0.1)], background: [(hz: 60, rms_m_s2: 0.002), (hz: 5000, rms_m_s2: 0.01)], sensor: (rate_hz: 12500, \
    resonance_hz: 1e6, noise_density: 0))";

/// A 6205 with a spall, behind the planted path.
fn desk(name: &str) -> Desk {
    let desk = Desk::new(name);
    desk.succeeds("new mine.ron --yes --bearing=6205 --load-n=200 --speed-rpm=1797");
    std::fs::write(desk.join("planted.ron"), PLANTED).expect("room");
    desk
}

const BEHIND: [&str; 3] = [
    "--set=housing=machine(file: \"planted.ron\")",
    "--set=output.interval_us=20",
    "--set=output.frames=None",
];

/// The path behind which two runs were recorded is found again from their records, by other simulations of the same
/// bearing, to 3 dB (median) where it passes the spall's impacts; the record is judged as a measured one.
#[test]
fn planted_the_machine_of_two_runs_is_found_again() {
    let desk = desk("machine");
    for (name, defect) in [("sound", "--set=defect=None"), ("spalled", "--set=defect.length_mm=0.8")] {
        let out = format!("--out={name}");
        let words = ["simulate", "mine.ron", "--threads=1", "--no-report", "-q", &out, defect];
        desk.succeeds(&[&words[..], &BEHIND, &["--set=solver.duration_ms=1100"]].concat());
        let csv = format!("--out={name}.csv");
        desk.succeeds(&["export", name, "--machine", "--to=csv", &csv]);
    }
    let judged = desk.succeeds("analyse spalled");
    says(&judged, &["BPFO"]);
    desk.succeeds("machine sound.csv spalled.csv --defect=none --defect=outer:0.8 --bearing=6205 --speed-rpm=1797 --load-n=200 --unit=m/s^2 --channel=machine --out=found.ron");
    let machine =
        |name: &str| stribeck_scene::machine::MachineScene::read(&desk.join(name)).expect("a machine").gains;
    let (planted, found) = (machine("planted.ron"), machine("found.ron"));
    let mut off: Vec<f64> = found
        .iter()
        .filter(|gain| (800.0..5000.0).contains(&gain.hz))
        .map(|gain| {
            let pair = planted.windows(2).find(|pair| gain.hz <= pair[1].hz).expect("within");
            let share = (gain.hz / pair[0].hz).ln() / (pair[1].hz / pair[0].hz).ln();
            let there = pair[0].gain * (pair[1].gain / pair[0].gain).powf(share);
            (20.0 * (gain.gain / there).log10()).abs()
        })
        .collect();
    off.sort_by(f64::total_cmp);
    assert!(off[off.len() / 2] < 3.0, "{off:?}");
}

/// The share of found records rises with the length, and the same seed finds the same.
#[test]
fn invariant_detect_is_that_of_its_seed() {
    let desk = desk("detect");
    let asked = |out: &str| {
        let words =
            ["detect", "mine.ron", "--machine=planted.ron", "--lengths=0.2..2", "--points=2", "--records=5"];
        let out = format!("--out={out}");
        let quick = ["--set=solver.duration_ms=250", "--set=output.interval_us=20", "-q", &out];
        desk.succeeds(&[&words[..], &quick].concat());
    };
    asked("a");
    asked("b");
    assert_eq!(desk.text("a/detect.json"), desk.text("b/detect.json"));
    let found = desk.json("a/detect.json");
    assert_eq!(found["version"], 1);
    let curve: Vec<f64> = found["lengths"]
        .as_array()
        .expect("lengths")
        .iter()
        .filter_map(|one| one["by_curve"].as_f64())
        .collect();
    assert!(curve.len() == 2 && curve[0] <= curve[1], "{found}");
    assert!(desk.text("a/report.html").contains("the smallest spall that is found"));
}

#[test]
fn refuses_what_has_no_machine() {
    let desk = desk("no-machine");
    let rigid = "--set=housing=rigid(mass_kg: 10)";
    desk.refuses(&["detect", "mine.ron", rigid], &["has no machine", "--machine FILE"]);
    desk.refuses("machine a.csv --defect=none --bearing=6205", &["healthy bearings", "--defect outer:0.53"]);
    desk.refuses("machine a.csv b.csv --defect=none --bearing=6205", &["2 records and 1 states"]);
}
