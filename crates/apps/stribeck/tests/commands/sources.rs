//! `stribeck analyse` with components and zones: a record of known parts, and the likely mistakes.

use std::f64::consts::TAU;
use std::fs;

use crate::common::Desk;
use stribeck_testing::Noise;

/// Two and a half seconds of a gear with 23 teeth at 25 Hz and of a 6205 on its shaft whose outer raceway
/// impacts, in m/s².
fn desk(name: &str) -> Desk {
    const RATE_HZ: f64 = 12_800.0;
    let desk = Desk::of(name, &["analyse", "record.csv"]);
    let mut noise = Noise::new(7);
    let mut text = "time_s,a_m_s2\n".to_owned();
    for n in 0..32_768 {
        let t = n as f64 / RATE_HZ;
        let mesh = (1.0 + 0.3 * (TAU * 25.0 * t).cos()) * (TAU * 575.0 * t).cos();
        let since = t.rem_euclid(1.0 / (0.995 * 3.585 * 25.0));
        let impact = 6.0 * (-since / 1e-3).exp() * (TAU * 3_000.0 * since).sin();
        text += &format!("{t:.9},{:.6}\n", mesh + impact + noise.uniform());
    }
    fs::write(desk.join("record.csv"), text).expect("a record");
    desk
}

#[test]
fn planted_components_of_a_record_are_distinguished() {
    let desk = desk("components");
    desk.says(
        "--speed-rpm=1500 --unit=g --iso-group=2 --foundation=rigid --component bearing=6205 \
         '--component=bearing=NU 205, elements=13, ratio=2.5' --component gear=23",
        &[
            "6205 at 1 times the shaft: The record shows a defect of the outer raceway",
            "velocity: zone",
            "NU 205 at 2.5 times the shaft: The record cannot tell whether a raceway is damaged",
        ],
    );
    let found = desk.json("record-analysis/findings.json");
    assert_eq!(found["bearings"].as_array().map(Vec::len), Some(2));
    assert_eq!(found["bearings"][0]["findings"]["zone"]["group"], "medium");
    assert!(desk.join("record-analysis/1-6205/report.html").exists());
}

#[test]
fn refuses_components_and_zones_that_cannot_be() {
    let desk = desk("components-refused");
    for (line, told) in [
        ("--component 6205", ["no component", "gear=23"]),
        ("--component gear=23 --speed-rpm 1500", ["none of the components is a bearing", "6205"]),
        ("--component bearing=6205", ["no speed is known", "--tacho"]),
        ("--component bearing=6205 --bearing 6205", ["--bearing", "cannot be used"]),
        ("--component 'bearing=6205, ratio=-1'", ["above 0", "ratio"]),
        ("--iso-group 2", ["--foundation", "required"]),
        ("--iso-group 3 --foundation rigid", ["3", "1..=2"]),
        ("--iso-group 1 --foundation soft", ["soft", "flexible"]),
    ] {
        desk.refuses(line, &told);
    }
}
