//! `stribeck stiffness`, and a rotor that ROSS runs on it.

use std::f64::consts::TAU;
use std::fs;
use std::process::Command;

use crate::common::Desk;
use stribeck_formats::Recording;
use stribeck_testing::{peer::python_with, said};

/// A healthy NU 205 in a rigid housing without gravity, whose contact is as stiff as steel rather than as
/// quick: half of ROSS's rotor moves with the ring.
const SOUND: &str = "(
    name: \"sound\",
    bearing: \"NU 205, elements=13\",
    housing: rigid(mass_kg: 5.0),
    defect: None,
    film: None,
    model: reduced(),
    operation: (load_n: 3000, speed_rpm: 300, gravity_m_s2: 0),
    contact: (surface: arc, penalty_scale: 1),
    solver: (duration_ms: 500, mass_damping_per_s: 2000, structural_damping: None),
    output: (interval_us: 50, frames: None),
)";

fn desk(name: &str) -> Desk {
    let desk = Desk::new(name);
    fs::write(desk.join("sound.ron"), SOUND).expect("a scene");
    desk
}

#[test]
fn behaves_stiffness_as_table_json_and_for_ross() {
    let desk = desk("stiffness");
    let words = ["stiffness", "sound.ron", "--loads-n", "1000,3000", "--speeds-rpm", "300,600,1200"];
    desk.succeeds(&words);
    let found = desk.json("sound-stiffness/stiffness.json");
    let points = found["points"].as_array().expect("points");
    assert_eq!(points.len(), 6);
    let table = desk.text("sound-stiffness/stiffness.csv");
    assert_eq!(table.lines().count(), 1 + 6 * 64);
    // The mean of a column of the table is that of the file.
    let rows =
        table.lines().skip(1).take(64).map(|row| row.split(',').nth(5).and_then(|k| k.parse::<f64>().ok()));
    let mean = rows.map(|k| k.expect("a number")).sum::<f64>() / 64.0;
    let said = points[0]["stiffness_n_m"]["yy"]["mean"].as_f64().expect("a number");
    assert!((mean / said - 1.0).abs() < 1e-8, "{mean} {said}");
    let ross = desk.json("sound-stiffness/ross_3000n.json");
    let element = ross.as_object().and_then(|all| all.values().next()).expect("an element");
    assert_eq!(element["frequency"].as_array().map(Vec::len), Some(3));
    assert_eq!(element["kyy"][0], points[3]["stiffness_n_m"]["yy"]["mean"]);
    // The same command overwrites its own files.
    desk.succeeds(&words);
}

#[test]
fn refuses_stiffness_that_cannot_be() {
    let desk = desk("stiffness-refused");
    for (words, told) in [
        (vec!["--loads-n", "0"], ["loads are above 0 N", "no stiffness"]),
        (vec!["--loads-n", "3 kN"], ["3 kN", "invalid"]),
        (vec!["--angles", "2"], ["`--angles` is 2", "between 3 and 4096"]),
        (vec!["--damping-us", "-1"], ["between 0 and 1000", "2.5 to 25"]),
        (vec!["--loads-n", "1e12"], ["no static load distribution", "load_n"]),
        (vec!["--contact", "oil"], ["line", "palmgren"]),
        (vec!["--set", "operation.speed_rpm=0"], ["do not turn", "--speeds-rpm"]),
    ] {
        desk.refuses(&[&["stiffness", "sound.ron"][..], &words].concat(), &told);
    }
}

/// Amplitude of a channel at a frequency [Hz] over whole periods of it, by Hann's window.
fn line(samples: &[f64], interval_s: f64, hz: f64) -> f64 {
    let periods = (samples.len() as f64 * interval_s * hz).floor();
    let count = (periods / hz / interval_s) as usize;
    let (mut re, mut im, mut sum) = (0.0, 0.0, 0.0);
    for (n, x) in samples[..count].iter().enumerate() {
        let w = 0.5 - 0.5 * (TAU * n as f64 / count as f64).cos();
        let (s, c) = (TAU * hz * n as f64 * interval_s).sin_cos();
        (re, im, sum) = (re + w * x * c, im - w * x * s, sum + w);
    }
    2.0 * re.hypot(im) / sum
}

/// ROSS 2.3.0 loads our bearing and runs a rotor on two of them: unbalance against m e ω²/|2k − M ω²|, and
/// the line that the turning cage drives at BPFO beside our own simulation of the healthy bearing.
#[test]
fn peer_ross_runs_a_rotor_on_our_stiffness() {
    /// The shaft of ROSS's rotor bends, by 1 and 4 % of the bearings' shift.
    const SHAFT: f64 = 0.05;
    /// The simulation has its own law of contact (penalty and local compliance), the stiffness Johnson's.
    const OTHER_LAW: f64 = 0.25;
    let Some(python) = python_with(&["ross"]) else { return };
    let desk = desk("rotor");
    desk.succeeds("stiffness sound.ron --loads-n=3000 --speeds-rpm=300");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/peers/ross_rotor.py");
    let folder = desk.join("sound-stiffness");
    let answer = Command::new(python)
        .arg(script)
        .args(["ross_3000n.json", "stiffness.json", "answer.json"])
        .current_dir(&folder)
        .output()
        .expect("it starts");
    assert!(answer.status.success(), "{}", said(&answer));
    let answer = desk.json("sound-stiffness/answer.json");
    let number = |key: &str| answer[key].as_f64().expect("a number");
    let point = &desk.json("sound-stiffness/stiffness.json")["points"][0];
    for (axis, key) in [("xx", "kxx"), ("yy", "kyy")] {
        let ours = point["stiffness_n_m"][axis]["mean"].as_f64().expect("a number");
        assert!((number(key) / ours - 1.0).abs() < 1e-9, "{key}: {} {ours}", number(key));
    }
    let square = number("speed_rad_s").powi(2);
    for (at, key) in [(0, "kxx"), (1, "kyy")] {
        let rigid = number("unbalance_kg_m") * square / (2.0 * number(key) - number("mass_kg") * square);
        let theirs = answer["unbalance_m"][at].as_f64().expect("a number");
        assert!(theirs > rigid * 0.999 && theirs < rigid * (1.0 + SHAFT), "{key}: {theirs:e} {rigid:e}");
    }
    desk.succeeds("simulate sound.ron --out=run --no-report --threads=1");
    let trace = Recording::open(desk.join("run/trace.npy")).expect("a trace");
    let samples = trace.channel("sensor.side.ax_m_s2").and_then(|c| c.read()).expect("a channel");
    let bpfo_hz = point["bpfo_hz"].as_f64().expect("a number");
    // A cage between raceways with play slips a little.
    let hz = (0..=40).map(|n| bpfo_hz * (0.98 + 1e-3 * f64::from(n)));
    let ours = hz.map(|hz| line(&samples[2000..], 50e-6, hz) / (TAU * hz).powi(2)).fold(0.0, f64::max);
    let theirs = answer["at_bpfo_m"][0].as_f64().expect("a number");
    println!("at BPFO, across the load: simulated {:.0} nm, ROSS {:.0} nm", 1e9 * ours, 1e9 * theirs);
    assert!((ours / theirs - 1.0).abs() < OTHER_LAW, "{ours:e} {theirs:e}");
}
