//! `--path`: the force of a run at a sensor, and back, and the likely mistakes.

use crate::common::stribeck;
use stribeck_formats::Recording;
use stribeck_testing::{Scratch, said, says};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

#[test]
fn behaves_a_path_leads_the_force_to_a_sensor_and_back() {
    let desk = Scratch::create("path");
    let scene = format!("{ROOT}/fixtures/scenes/first_look.ron");
    let output =
        stribeck(&desk, &["simulate", &scene, "--set", "solver.duration_ms=100", "--out", "run", "--quiet"]);
    assert!(output.status.success(), "{}", said(&output));
    let mode = "mass=12, stiffness=2e8, damping=0.02";
    let uff = format!("{ROOT}/fixtures/signals/responses.uff");
    let first = format!("{uff}#1");
    for (path, file) in [(mode, "mode.csv"), (&first, "lines.csv")] {
        let output = stribeck(&desk, &["export", "run", "--to", "csv", "--path", path, "--out", file]);
        assert!(output.status.success(), "{}", said(&output));
        let made = Recording::open(desk.join(file)).expect("a record");
        let names: Vec<&str> = made.channels.iter().map(|channel| channel.name.as_str()).collect();
        assert_eq!(names, ["time_s", "path.ax_m_s2", "path.ay_m_s2"]);
    }
    let back = ["analyse", "mode.csv", "--channel", "path.ay", "--bearing", "NU 205", "--speed-rpm", "1500"];
    let output = stribeck(&desk, &[&back[..], &["--path", mode]].concat());
    assert!(output.status.success(), "{}", said(&output));
    says(&output, &["was divided out", "the force at the bearing"]);
    says(&stribeck(&desk, &["analyse", "run", "--path", mode]), &["went through the path"]);
    for (path, told) in [
        (uff.as_str(), ["has several", "#5 `uneven`"]),
        ("nowhere.uff", ["no such file", "mass="]),
        ("mass=-12, stiffness=2e8, damping=0.02", ["mass = -12", "greater than 0"]),
        (&format!("{ROOT}/fixtures/signals/make.py"), ["no dataset", "UFF 58"]),
    ] {
        let output = stribeck(&desk, &["export", "run", "--to", "csv", "--path", path]);
        assert!(!output.status.success(), "{path}: {}", said(&output));
        says(&output, &told);
    }
    says(&stribeck(&desk, &["export", "run", "--to", "k", "--path", mode]), &["`--path` makes signals"]);
}
