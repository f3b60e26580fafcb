//! The FMU of a healthy bearing, run by FMPy.

use std::f64::consts::TAU;
use std::path::Path;
use std::process::Command;

use crate::common::Desk;
use serde_json::Value;
use stribeck_formats::Recording;
use stribeck_scene::scene::Scene;
use stribeck_simulation::reduced::{on_shaft, prepared};
use stribeck_testing::{
    peer::{absent, python_with},
    said,
};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/scenes/rotor.ron");

/// The FMU of that scene, which `STRIBECK_FMU` names: `cargo xtask fmu fixtures/scenes/rotor.ron` packs it.
fn fmu() -> Option<String> {
    std::env::var("STRIBECK_FMU")
        .ok()
        .filter(|fmu| Path::new(fmu).is_file())
        .or_else(|| absent("STRIBECK_FMU", "there is no FMU of rotor.ron"))
}

/// Amplitude of a channel near a frequency [Hz], the largest within 2 %, by Hann's window over whole periods.
fn line(samples: &[f64], interval_s: f64, hz: f64) -> f64 {
    let at = |hz: f64| {
        let count = ((samples.len() as f64 * interval_s * hz).floor() / hz / interval_s) as usize;
        let (mut re, mut im, mut sum) = (0.0, 0.0, 0.0);
        for (n, x) in samples[..count].iter().enumerate() {
            let w = 0.5 - 0.5 * (TAU * n as f64 / count as f64).cos();
            let (s, c) = (TAU * hz * n as f64 * interval_s).sin_cos();
            (re, im, sum) = (re + w * x * c, im - w * x * s, sum + w);
        }
        2.0 * f64::hypot(re, im) / sum
    };
    (0..=40).map(|n| at(hz * (0.98 + 1e-3 * f64::from(n)))).fold(0.0, f64::max)
}

/// FMPy 0.3.32 finds no fault with the archive; a rotor of 10 kg that it steps in Python settles where the
/// same load displaces the housing of a run the other way, answers an unbalance by the stiffness that
/// `stribeck stiffness` computes, and has the line at BPFO of the run.
#[test]
fn peer_fmpy_runs_a_rotor_on_our_fmu() {
    /// The mean over a second, in which the cage turns on; a run starts at one angle of it.
    const PLACE: f64 = 0.02;
    /// The rotor has come to rest but for the line.
    const FORCE: f64 = 1e-3;
    /// The simulation has its own law of contact (penalty and local compliance), the stiffness Johnson's.
    const UNBALANCE: f64 = 0.25;
    /// Housing and rotor have other masses, and friction other histories.
    const LINE: f64 = 0.1;
    const MASS_KG: f64 = 10.0;
    const UNBALANCE_KG_M: f64 = 0.1;
    let (Some(fmu), Some(python)) = (fmu(), python_with(&["fmpy"])) else { return };
    let desk = Desk::new("fmu");
    let scene = Scene::read(SCENE).expect("a valid scene");
    let load = scene.operation.load_n;
    let turns = scene.kinematics();
    let (bpfo, shaft) = (turns.bpfo_hz.abs(), turns.shaft_hz.abs());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/fmpy_rotor.py");
    let answer = desk.join("answer.json");
    let numbers = [load, 90.0, MASS_KG, UNBALANCE_KG_M, 1.3, bpfo, shaft].map(|number| number.to_string());
    let mut command = Command::new(python);
    let output = command.args([script, &fmu]).arg(&answer).args(numbers).output().expect("it starts");
    assert!(output.status.success(), "{}", said(&output));
    let json = |path: &Path| -> Value {
        serde_json::from_str(&std::fs::read_to_string(path).expect("a file")).expect("JSON")
    };
    let answer = json(&answer);
    assert_eq!(answer["problems"], Value::Array(Vec::new()));
    let pair = |key: &str| [0, 1].map(|axis| answer[key][axis].as_f64().expect("a number"));

    let ([x, y], [fx, fy]) = (pair("place_m"), pair("force_n"));
    println!("rotor at {:.3} {:.3} µm, force {fx:.2} {fy:.2} N", 1e6 * x, 1e6 * y);
    assert!((fy / -load - 1.0).abs() < FORCE && fx.abs() < FORCE * load, "{fx} {fy}");
    // The rotor is pushed up, the housing of the run down.
    let run = prepared(&scene.resolve(), Some(desk.path())).expect("it can be reduced");
    let centre = on_shaft(&scene.resolve(), Some(desk.path())).expect("it can be reduced").centre;
    let reduction = &run.bearing.reduction;
    let moved = centre[1] + run.start.q[1] * reduction.shapes[reduction.padded + 1];
    assert!((y / -moved - 1.0).abs() < PLACE, "{y:e} {moved:e}");

    let stribeck = |words: &[&str]| {
        desk.succeeds(words);
    };
    stribeck(&["stiffness", SCENE, &format!("--loads-n={load}"), "--speeds-rpm=300", "--out=k"]);
    let stiffness = &json(&desk.join("k/stiffness.json"))["points"][0]["stiffness_n_m"]["yy"]["mean"];
    let square = (TAU * shaft).powi(2);
    let rigid = UNBALANCE_KG_M * square / (stiffness.as_f64().expect("a number") - MASS_KG * square);
    let turned = pair("unbalance_m")[1];
    println!("unbalance, along the load: FMU {:.1} nm, by the stiffness {:.1} nm", 1e9 * turned, 1e9 * rigid);
    assert!((turned / rigid - 1.0).abs() < UNBALANCE, "{turned:e} {rigid:e}");

    stribeck(&["simulate", SCENE, "--out=run", "--no-report", "--threads=1"]);
    let trace = Recording::open(desk.join("run/trace.npy")).expect("a trace");
    let samples = trace.channel("sensor.side.ax_m_s2").and_then(|c| c.read()).expect("a channel");
    let ours = line(&samples[2000..], 50e-6, bpfo) / (TAU * bpfo).powi(2);
    let theirs = pair("at_bpfo_m")[0];
    println!(
        "at BPFO, across the load: simulated {:.0} nm, rotor on the FMU {:.0} nm",
        1e9 * ours,
        1e9 * theirs
    );
    assert!((theirs / ours - 1.0).abs() < LINE, "{theirs:e} {ours:e}");
}
