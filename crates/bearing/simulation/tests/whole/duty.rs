//! Speed and load over time in whole runs: the other sense of rotation, starts from rest, runs in pieces.

use std::f64::consts::TAU;

use crate::common::{assert_goes_on_with_the_same_bytes, coarse, column, run};
use stribeck_scene::scene::{HarmonicScene, PocketWalls, ProfileScene, RampScene};
use stribeck_store::{run_dir::Run, run_info::Status};
use stribeck_testing::Scratch;
use stribeck_theory::kinematics::Kinematics;

/// Turned back, with rollers at mirrored places, the bearing is its mirror image about the y axis.
#[test]
fn invariant_a_bearing_that_turns_back_is_the_mirror_image() {
    // Meshes of rings and rollers mirror into themselves, but for the triangles within rollers and the
    // tolerance of the preload. Of 0.1 m and 10 kN, before roller 1 comes near the defect, where cells
    // differ.
    const TOLERANCE: f64 = 2e-3;
    let folder = Scratch::create("mirror");
    let there = coarse(0.6);
    let mut back = there.clone();
    back.operation.speed_rpm = -500.0;
    // Roller 1 at 94°; now at 86°, and the others with it.
    back.bearing.first_roller_deg = 86.0;
    let [there, back] = [(&there, "there"), (&back, "back")].map(|(scene, name)| {
        assert_eq!(run(scene, &folder, name, 2).status, Status::Complete);
        Run::read(folder.join(name)).expect("a finished run can be read")
    });
    for i in 1..=24_usize {
        let other = (25 - i) % 24 + 1;
        let channels =
            [("x_m", -1.0, 0.1), ("y_m", 1.0, 0.1), ("outer_fx_n", -1.0, 10e3), ("outer_fy_n", 1.0, 10e3)];
        for (c, sign, scale) in channels {
            let ours = column(&there, &format!("roller.{i}.{c}"));
            let theirs = column(&back, &format!("roller.{other}.{c}"));
            for (n, (a, b)) in ours.iter().zip(theirs).enumerate() {
                let off = (a - sign * b).abs() / scale;
                assert!(off < TOLERANCE, "sample {n}, roller {i}, {c}: {a} {b}");
            }
        }
    }
    let turned = column(&back, "cage.angle_rad");
    assert!(turned[turned.len() - 1] > 0.0);
}

/// From rest along a ramp, under a load that swells: rollers roll on a shaft of constant acceleration, the
/// load is carried, energy closes, and it goes on with the same bytes.
#[test]
fn conserves_energy_from_rest_under_a_load_that_swells() {
    const ENERGY: f64 = 0.001;
    // Creep under the load and what facets add on so short a way.
    const ROLLING: f64 = 0.01;
    // Share of the ring's lowest modes, of the load.
    const SWING: f64 = 0.2;
    let folder = Scratch::create("rest");
    let mut scene = coarse(2.0);
    scene.defect = None;
    scene.film = None;
    // Coarse rollers at rest would settle on their flats under a friction of 0.005.
    scene.contact.friction = 0.1;
    scene.cage.iter_mut().for_each(|cage| cage.pocket = PocketWalls::Corners);
    scene.operation.speed_rpm = 0.0;
    let ramp = RampScene { from_ms: 0.0, to_ms: 4.0, to: -100.0 };
    scene.operation.speed_profile = Some(ProfileScene::Ramp(ramp));
    let sine = HarmonicScene { amplitude: 10e3, hz: 250.0, phase_deg: 90.0 };
    scene.operation.load_profile = Some(ProfileScene::Harmonic(sine));
    let [info, _] = assert_goes_on_with_the_same_bytes(&scene, &folder, 77);
    let read = Run::read(folder.join("whole")).expect("a finished run can be read");
    assert!(info.energy.max_relative_error < ENERGY, "{}", info.energy.max_relative_error);
    let (time, shaft) = (column(&read, "time_s"), column(&read, "shaft.angle_rad"));
    let load = column(&read, "adapter.load_n");
    let acceleration = 100.0 / 60.0 * TAU / 4e-3;
    for n in 0..time.len() {
        let wanted = 0.5 * acceleration * time[n] * time[n];
        assert!((shaft[n] - wanted).abs() < 1e-12, "{} rad at {} s", shaft[n], time[n]);
        let carried: f64 = (1..=24).map(|i| -column(&read, &format!("roller.{i}.outer_fy_n"))[n]).sum();
        assert!((carried / load[n] - 1.0).abs() < SWING, "{carried} N of {} N", load[n]);
    }
    // Roller 1 stands at the top and rolls.
    let [x, y] = ["roller.1.x_m", "roller.1.y_m"].map(|c| column(&read, c));
    let last = time.len() - 1;
    let share = Kinematics::new(&scene.bearing, 60.0).cage_hz;
    let rolled = (y[last].atan2(x[last]) - y[0].atan2(x[0])) / (shaft[last] - shaft[0]);
    assert!((rolled / share - 1.0).abs() < ROLLING, "{rolled}");
}
