//! `--path`: the force of a run at a sensor, and back, and the likely mistakes.

use crate::common::Desk;
use stribeck_formats::Recording;
use stribeck_testing::{said, says};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../..");

#[test]
fn behaves_a_path_leads_the_force_to_a_sensor_and_back() {
    let desk = Desk::new("path");
    let scene = format!("{ROOT}/fixtures/scenes/first_look.ron");
    let output =
        desk.run(&["simulate", &scene, "--set", "solver.duration_ms=100", "--out", "run", "--quiet"]);
    assert!(output.status.success(), "{}", said(&output));
    let mode = "mass=12, stiffness=2e8, damping=0.02";
    desk.succeeds(&["export", "run", "--to", "csv", "--path", mode, "--out", "mode.csv"]);
    let made = Recording::open(desk.join("mode.csv")).expect("a record");
    let names: Vec<&str> = made.channels.iter().map(|channel| channel.name.as_str()).collect();
    assert_eq!(names, ["time_s", "path.ax_m_s2", "path.ay_m_s2"]);
    let back = ["analyse", "mode.csv", "--channel", "path.ay", "--bearing", "NU 205", "--speed-rpm", "1500"];
    let output = desk.succeeds(&[&back[..], &["--path", mode]].concat());
    says(&output, &["was divided out", "the force at the bearing"]);
    says(&desk.run(&["analyse", "run", "--path", mode]), &["went through the path"]);
    for (path, told) in [
        ("hammer_test.uff", ["tables of frequency responses are not read", "mass="]),
        ("mass=-12, stiffness=2e8, damping=0.02", ["mass = -12", "greater than 0"]),
    ] {
        desk.refuses(&["export", "run", "--to", "csv", "--path", path], &told);
    }
    says(&desk.run(&["export", "run", "--to", "inp", "--path", mode]), &["`--path` makes signals"]);
}
