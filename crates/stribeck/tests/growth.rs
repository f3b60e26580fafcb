//! `stribeck grow` and `--path`: their files, continued commands, and the likely mistakes.

use std::fs;
use std::process::{Command, Output, Stdio};

use stribeck_formats::Recording;
use stribeck_testing::{Scratch, said, says};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

fn stribeck(desk: &Scratch, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stribeck"));
    command.current_dir(desk.path()).args(words).stdin(Stdio::null()).output().expect("it starts")
}

/// Three units in few, short records on a coarse mesh.
fn growth(from: &str, to: &str) -> String {
    let text = fs::read_to_string(format!("{ROOT}/fixtures/growth/quick.ron")).expect("the fixture");
    let text = text
        .replace("../scenes/first_look.ron", &format!("{ROOT}/fixtures/scenes/first_look.ron"))
        .replace("duration_ms=300\"", "duration_ms=60\", \"mesh.size_mm=1.0\", \"mesh.roller_facets=40\"")
        .replace("units: 5", "units: 3")
        .replace("every_revolutions: 2e6", "every_revolutions: 3e6");
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}

#[test]
fn behaves_spalls_grow_and_a_second_command_runs_nothing() {
    let desk = Scratch::create("grow");
    fs::write(desk.join("g.ron"), growth("", "")).expect("written");
    let output = stribeck(&desk, &["grow", "g.ron", "--out", "out"]);
    assert!(output.status.success(), "{}", said(&output));
    says(&output, &["3 units", "growth.html"]);
    let read = |name: &str| fs::read(desk.join(name)).expect(name);
    let found: serde_json::Value = serde_json::from_slice(&read("out/growth.json")).expect("JSON");
    let units = found["units"].as_array().expect("units");
    assert_eq!(units.len(), 3);
    for unit in units {
        let records = unit["records"].as_array().expect("records");
        let lengths: Vec<f64> = records.iter().filter_map(|r| r["length_mm"].as_f64()).collect();
        assert!(lengths.is_sorted() && lengths.iter().all(|mm| (1.0..=4.0).contains(mm)), "{lengths:?}");
        let last = records.last().expect("a record");
        assert!(last["revolutions"].as_f64() < unit["end"].as_f64());
        let begun = |r: &&serde_json::Value| r["length_mm"].is_number();
        let onset = unit["onset"].as_f64().expect("an onset");
        assert!(records.iter().filter(begun).all(|r| r["revolutions"].as_f64() >= Some(onset)));
    }
    let table = Recording::open(desk.join("out/growth.parquet")).expect("a table");
    assert_eq!(table.channel("length_mm").expect("lengths").len, table.channel("run").expect("runs").len);
    let before = (read("out/growth.json"), read("out/growth.parquet"));
    let again = stribeck(&desk, &["grow", "g.ron", "--out", "out"]);
    says(&again, &["0 of them to be run here"]);
    assert!(before == (read("out/growth.json"), read("out/growth.parquet")), "the same bytes");
    fs::write(desk.join("g.ron"), growth("seed: 1", "seed: 2")).expect("written");
    let other = stribeck(&desk, &["grow", "g.ron", "--out", "out"]);
    assert!(!other.status.success(), "{}", said(&other));
    says(&other, &["another growth", "--out"]);
}

#[test]
fn refuses_growths_that_cannot_be() {
    let desk = Scratch::create("grow-refused");
    for (from, to, told) in [
        ("units: 3", "units: 0", ["`units` is 0", "allowed: 1 to 10000"]),
        ("from: 1.0, to: 4.0", "from: 4.0, to: 1.0", ["goes from 4 to 1", "grows"]),
        (
            "life: (revolutions: 4e6",
            "life: (revolutions: -4e6",
            ["`life.revolutions` is -4000000", "allowed: 1 to 1e13"],
        ),
        ("on: outer", "on: cage", ["cage", "outer"]),
        ("most_depth_mm", "most_deep_mm", ["did you mean `most_depth_mm`", "g.ron:"]),
        ("defect=None", "defects=None", ["defects", ""]),
    ] {
        fs::write(desk.join("g.ron"), growth(from, to)).expect("written");
        let output = stribeck(&desk, &["grow", "g.ron", "--out", "out"]);
        assert!(!output.status.success(), "{from}: {}", said(&output));
        says(&output, &told);
    }
    says(&stribeck(&desk, &["grow", "nowhere.ron"]), &["nowhere.ron", "fixtures/growth/quick.ron"]);
}

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
