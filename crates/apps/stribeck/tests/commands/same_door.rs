//! A simulated record through a sensor, a file and the program that the file belongs to: the verdict of the
//! run's own report.

use std::path::Path;
use std::process::Command;

use crate::common::Desk;
use serde_json::Value;
use stribeck_testing::{peer::python_with, said};

/// An outer raceway of a NU 205 with a spall, long enough for forty passages.
const SCENE: &str = r#"(
    name: "spalled",
    model: reduced(modes_khz: 30.0, step_us: 1.0),
    bearing: "NU 205",
    defect: None,
    defects: [(on: outer, angle_deg: 90.0, form: spall(length_mm: 4.0, depth_mm: 0.06))],
    cage: (outer_diameter_mm: 44.85, thickness_mm: 1.65, pocket: corners),
    mesh: (size_mm: 1.0, roller_facets: 56),
    contact: (surface: arc, penalty_scale: 0.1, friction: 0.05),
    film: None,
    operation: (speed_rpm: 1500.0),
    solver: (duration_ms: 300.0, mass_damping_per_s: 5000.0, structural_damping: None),
    output: (frames: None),
)"#;

/// Noise and resolution of a good sensor on a common recorder.
const SENSOR: &str =
    "rate_hz=50000, resonance_hz=40000, quality=30, noise_density=0.01, range=5000, bits=24, seed=3";

/// Formats with the module of Python that reads and writes them.
const FORMATS: [(&str, &str); 6] = [
    ("csv", "pandas"),
    ("npz", "numpy"),
    ("mat", "scipy.io"),
    ("uff", "pyuff"),
    ("parquet", "pyarrow.parquet"),
    ("wav", "soundfile"),
];

fn read(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("it was written")).expect("JSON")
}

/// Names of the families that are claimed, with their frequencies [Hz].
fn claimed(families: &Value) -> Vec<(String, f64)> {
    let families = families.as_array().expect("families");
    let claimed = families.iter().filter(|f| f["claimed"] == true);
    claimed.map(|f| (f["name"].as_str().unwrap().to_owned(), f["measured_hz"].as_f64().unwrap())).collect()
}

#[test]
fn peer_a_simulated_record_gives_the_verdict_of_its_run_through_every_format() {
    // pandas 3.1.1, numpy 2.4.6, scipy.io 1.17.1, pyuff 2.5.8, pyarrow 26.0.1 and soundfile 0.14.0, where the
    // interpreter in STRIBECK_PYTHON (or python3) has them.
    let desk = Desk::new("same-door");
    std::fs::write(desk.join("spalled.ron"), SCENE).unwrap();
    desk.succeeds("simulate spalled.ron");
    let diagnosis = &read(&desk.join("runs/spalled/summary.json"))["diagnosis"];
    let reported = claimed(&diagnosis["families"]);
    assert!(reported.iter().map(|f| f.0.as_str()).eq(["BPFO"]), "{diagnosis}");
    let resolution_hz = diagnosis["resolution_hz"].as_f64().unwrap();
    let channel = diagnosis["channel"].as_str().unwrap();

    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/pass_on.py");
    for (format, module) in FORMATS {
        let file = format!("trace.{format}");
        desk.succeeds(&[
            "export",
            "spalled",
            "--to",
            format,
            "--channel",
            channel,
            "--sensor",
            SENSOR,
            "--out",
            &file,
        ]);
        let mut files = vec![file.clone()];
        if let Some(python) = python_with(&[module]) {
            let copy = format!("theirs.{format}");
            let run = Command::new(&python)
                .arg(script)
                .args([&file, &copy])
                .current_dir(desk.path())
                .output()
                .unwrap();
            assert!(run.status.success(), "{format}: {}", said(&run));
            files.push(copy);
        }
        for file in files {
            let out = format!("{file}-analysis");
            let words = [
                "analyse",
                &file,
                "--rate-hz=50000",
                "--bearing=NU 205, elements=13",
                "--speed-rpm=1500",
                "--out",
                &out,
            ];
            desk.succeeds(&words);
            let findings = read(&desk.join(&out).join("findings.json"));
            let found = claimed(&findings["families"]);
            assert_eq!(found.len(), reported.len(), "{file}: {findings}");
            for ((name, hz), (own, own_hz)) in found.iter().zip(&reported) {
                assert!(
                    name == own && (hz - own_hz).abs() <= resolution_hz,
                    "{file}: {found:?} {reported:?}"
                );
            }
        }
    }
}
