//! Measured signals and exported runs, as users meet them.

use std::path::Path;
use std::process::{Command, Output};

use stribeck_formats::{Channel, Recording, mat5};
use stribeck_testing::{Noise, Scratch};

fn stribeck(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_stribeck")).current_dir(folder).args(words).output().expect("it starts")
}

fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Knocks of an outer raceway of a 6205 at 1200 rpm.
fn knocks(rate_hz: f64) -> Vec<f64> {
    let mut noise = Noise::new(5);
    (0..100_000)
        .map(|n| {
            let since = (f64::from(n) / rate_hz).rem_euclid(1.0 / 71.5);
            noise.uniform() + 3.0 * (-since / 1e-3).exp() * (std::f64::consts::TAU * 3_000.0 * since).sin()
        })
        .collect()
}

#[test]
fn example_a_record_gives_a_verdict_findings_and_a_page() {
    let desk = Scratch::create("measured");
    let channel = Channel::held("housing", knocks(12_800.0)).at_rate(Some(12_800.0));
    mat5::write(&desk.join("a.mat"), &[channel, Channel::held("shaft_rpm", vec![1200.0])], &[]).unwrap();
    let output = stribeck(
        desk.path(),
        &["analyse", "a.mat", "--rate-hz", "12800", "--bearing", "6205", "--channel", "housing"],
    );
    let text = said(&output);
    assert!(output.status.success(), "{text}");
    assert!(text.contains("a defect of the outer raceway (BPFO at 71.50 Hz"), "{text}");
    assert!(text.contains("the speed of 1200 rpm is that of `shaft_rpm`"), "{text}");
    let findings = std::fs::read_to_string(desk.join("a-analysis/findings.json")).unwrap();
    let findings: serde_json::Value = serde_json::from_str(&findings).unwrap();
    assert_eq!(findings["families"][0]["name"], "BPFO");
    assert_eq!(findings["families"][0]["claimed"], true);
    assert!(findings["spall_mm"].is_null() && findings["notes"].as_array().is_some_and(|n| !n.is_empty()));
    for key in ["rate_hz", "speed_rpm", "resolution_hz", "verdict"] {
        assert!(!findings[key].is_null(), "{key}");
    }
    for key in ["expected_hz", "measured_hz", "harmonics", "level_db", "p_value"] {
        assert!(findings["families"][0][key].is_number(), "{key}");
    }
    let page = std::fs::read_to_string(desk.join("a-analysis/report.html")).unwrap();
    assert!(page.contains("Squared envelope spectrum about BPFO"));
}

#[test]
fn refuses_a_record_with_what_to_give() {
    let desk = Scratch::create("measured-refused");
    let table: String = (0..2000).map(|n| format!("{},{}\n", f64::from(n).sin(), n % 7)).collect();
    std::fs::write(desk.join("a.csv"), format!("x,y\n{table}")).unwrap();
    std::fs::write(desk.join("b.csv"), "x,y\n1,2\n3,oops\n").unwrap();
    for (words, says) in [
        (vec!["analyse", "a.csv"], "give `--rate-hz`"),
        (vec!["analyse", "a.csv", "--channel", "z"], "it has `x` (2000 samples), `y` (2000 samples)"),
        (vec!["analyse", "a.csv", "--rate-hz", "100", "--bearing", "6999"], "no bearing `6999` is known"),
        (vec!["analyse", "a.csv", "--rate-hz", "0"], "give one above 0"),
        (vec!["analyse", "b.csv", "--rate-hz", "100", "--channel", "y"], "1024 are the least"),
        (vec!["analyse", "c.csv"], "`c.csv` cannot be read"),
    ] {
        let output = stribeck(desk.path(), &words);
        assert!(!output.status.success() && said(&output).contains(says), "{words:?}: {}", said(&output));
    }
}

#[test]
fn example_a_run_is_exported_and_read_back() {
    let desk = Scratch::create("exported");
    std::fs::copy(
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scenes/quick.ron"),
        desk.join("quick.ron"),
    )
    .unwrap();
    let coarse = [
        "simulate",
        "quick.ron",
        "--set=mesh.size_mm=4.0",
        "--set=mesh.roller_facets=40",
        "--set=solver.start=sudden",
        "--threads=1",
        "--no-report",
        "--set=output.frames=(from_ms: 0.1, to_ms: 0.2, every_us: 50.0, half_width_mm: 12.0)",
        "--set=solver.duration_ms=0.5",
    ];
    let output = stribeck(desk.path(), &coarse);
    assert!(output.status.success(), "{}", said(&output));
    let trace = Recording::open(desk.join("runs/quick/trace.npy")).unwrap();
    let name = trace.channels.iter().map(|c| c.name.clone()).find(|n| n.ends_with("ay_m_s2")).unwrap();
    for format in ["csv", "npz", "mat", "uff", "wav"] {
        let output = stribeck(desk.path(), &["export", "quick", "--to", format, "--channel", &name]);
        assert!(output.status.success(), "{format}: {}", said(&output));
        let path = desk.join(format!("runs/quick/trace.{format}"));
        let found = Recording::open(&path).unwrap();
        let read = found
            .channels
            .iter()
            .find(|c| c.len == trace.channel(&name).unwrap().len && !c.name.starts_with("time"))
            .unwrap();
        let (ours, theirs) = (read.read().unwrap(), trace.channel(&name).unwrap().read().unwrap());
        // A universal file has thirteen digits.
        assert!(ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() <= 5e-13 * b.abs()), "{format}");
    }
    let output = stribeck(desk.path(), &["export", "quick", "--to", "pvd"]);
    assert!(output.status.success(), "{}", said(&output));
    let index = std::fs::read_to_string(desk.join("runs/quick/paraview/frames.pvd")).unwrap();
    assert_eq!(index.matches("<DataSet").count(), 3, "{index}");
    let grid = std::fs::read(desk.join("runs/quick/paraview/frame-00000.vtu")).unwrap();
    assert!(String::from_utf8_lossy(&grid[..4000.min(grid.len())]).contains("von_mises_pa"));
    let output = stribeck(
        desk.path(),
        &[
            "export",
            "quick",
            "--to",
            "npz",
            "--out",
            "s.npz",
            "--sensor",
            "rate_hz=50000, bits=16, range=5000",
        ],
    );
    assert!(output.status.success(), "{}", said(&output));
    assert_eq!(Recording::open(desk.join("s.npz")).unwrap().channels[0].rate_hz, Some(50_000.0));
    let output = stribeck(desk.path(), &["export", "quick", "--to", "csv", "--channel", "nothing"]);
    assert!(said(&output).contains("no channel contains `nothing`"), "{}", said(&output));
}
