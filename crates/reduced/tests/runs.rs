//! Whole runs of the reduced bearing: what they leave, that they go on to the same bytes, and how near the full model they are.

use std::{fs, ops::ControlFlow};

use stribeck_bearing::simulation::{Host, Progress};
use stribeck_reduced::simulation::{resume, simulate};
use stribeck_scene::{
    run_dir::RunDir,
    run_info::{RunInfo, Status},
    scene::{HarmonicScene, ModelScene, ProfileScene, RampScene, ReducedScene, Scene},
    trace::Trace,
};
use stribeck_testing::Scratch;

/// The paper's bearing, coarse.
fn coarse(duration_ms: f64) -> Scene {
    let mut scene = Scene { name: "coarse".into(), ..Scene::default() };
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, ..ReducedScene::default() });
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    scene.bearing.thickness_mm = 20.0;
    scene.contact.penalty_scale = 1.0;
    scene.contact.points_per_facet = 4;
    // Dry, and quiet by mass damping.
    scene.film = None;
    (scene.solver.mass_damping_per_s, scene.solver.structural_damping) = (5000.0, None);
    scene.solver.duration_ms = duration_ms;
    scene.output.frames = None;
    scene
}

fn host(threads: usize) -> Host<'static> {
    Host {
        threads,
        version: "test".into(),
        commit: "test".into(),
        machine: "test".into(),
        wall_s: &|| 0.0,
        cpu_s: &|| 0.0,
    }
}

fn run(scene: &Scene, folder: &Scratch, name: &str, threads: usize) -> RunInfo {
    let dir = RunDir::create(folder.join(name)).expect("the folder is new");
    simulate(scene, &dir, &host(threads), &mut |_| ControlFlow::Continue(())).expect("the scene is sound")
}

fn bytes(folder: &Scratch, name: &str, file: &str) -> Vec<u8> {
    fs::read(folder.join(name).join(file)).expect("readable")
}

/// In pieces, from modes made anew or kept, with more threads: the same trace and ledger.
#[test]
fn invariant_a_run_in_pieces_writes_the_same_bytes() {
    let folder = Scratch::create("reduced-pieces");
    let scene = coarse(3.0);
    let whole = run(&scene, &folder, "whole", 1);
    assert_eq!(whole.status, Status::Complete, "{:?}", whole.stop_reason);
    let kept = whole.reduced.expect("what was kept");
    assert!(!kept.from_cache && kept.modes > 8 && kept.highest_hz < 15e3);
    let dir = RunDir::create(folder.join("pieces")).expect("the folder is new");
    let mut seen = 0;
    let mut stop = |progress: &Progress| {
        seen += usize::from(progress.phase == "run");
        if seen == 117 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let broken = simulate(&scene, &dir, &host(2), &mut stop).expect("the scene is sound");
    assert_eq!((broken.status, broken.samples), (Status::Interrupted, 117));
    assert!(broken.reduced.expect("what was kept").from_cache);
    drop(dir);
    let dir = RunDir::reopen(folder.join("pieces")).expect("it is there");
    let done = resume(&dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("it goes on");
    assert_eq!(done.status, Status::Complete);
    for file in ["trace.npy", "energy.npy"] {
        assert!(bytes(&folder, "whole", file) == bytes(&folder, "pieces", file), "{file}");
    }
}

/// Load, cage and energy of a run of two periods of the rollers.
#[test]
fn conserves_energy_and_carries_the_load() {
    // The ledger of a full run closes to a few tenths of a per cent.
    const ENERGY: f64 = 0.005;
    const LOAD: f64 = 0.002;
    let folder = Scratch::create("reduced-load");
    let info = run(&coarse(22.0), &folder, "run", 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!((info.simulated_s - 0.022).abs() < 1e-9, "{}", info.simulated_s);
    assert!(info.energy.max_relative_error < ENERGY, "{}", info.energy.max_relative_error);
    let trace = Trace::read(folder.join("run").join("trace.npy")).expect("a trace");
    let mut sum = 0.0;
    for i in 1..=24 {
        let force = trace.get(&format!("roller.{i}.outer_fy_n")).expect("a channel");
        sum += force.iter().sum::<f64>() / force.len() as f64;
    }
    assert!((-sum / info.expected_support_n - 1.0).abs() < LOAD, "{sum} N");
}

/// From one start, full and reduced model carry the load on the same rollers at first.
#[test]
fn example_the_reduced_model_starts_as_the_full_one() {
    // Of the largest roller force. Where nodes of a mesh of 2 mm lie under a contact changes its stiffness by ±4 % at the
    // largest force and ±5 % at light ones; the reduced model has the mean (THEORY §9.6).
    const TOLERANCE: f64 = 0.04;
    let folder = Scratch::create("reduced-start");
    let scene = coarse(0.05);
    run(&scene, &folder, "reduced", 1);
    run(&Scene { model: ModelScene::Full, ..scene }, &folder, "full", 1);
    let first = |name: &str| -> Vec<f64> {
        let trace = Trace::read(folder.join(name).join("trace.npy")).expect("a trace");
        let channel =
            |i: usize, c: &str| trace.get(&format!("roller.{i}.outer_f{c}_n")).expect("a channel")[0];
        (1..=24).map(|i| channel(i, "x").hypot(channel(i, "y"))).collect()
    };
    let (full, reduced) = (first("full"), first("reduced"));
    let largest = full.iter().copied().fold(0.0, f64::max);
    for (i, (full, reduced)) in full.iter().zip(&reduced).enumerate() {
        assert!((full - reduced).abs() < TOLERANCE * largest, "roller {}: {full} N and {reduced} N", i + 1);
    }
}

fn trace(folder: &Scratch, name: &str) -> Trace {
    Trace::read(folder.join(name).join("trace.npy")).expect("a trace")
}

fn channel<'a>(trace: &'a Trace, name: &str) -> &'a [f64] {
    trace.get(name).unwrap_or_else(|| panic!("the trace has no `{name}`"))
}

/// Turned back, with rollers at mirrored places, the bearing is its mirror image about the y axis: accelerations along y and
/// forces of the rollers are the same, accelerations along x change their sign.
#[test]
fn invariant_a_bearing_that_turns_back_is_the_mirror_image() {
    // Facets of the raceways do not mirror into each other beside the defect, and neither do those of rollers. Of the largest
    // value before the first roller is in the defect.
    const TOLERANCE: f64 = 0.02;
    let folder = Scratch::create("reduced-mirror");
    let there = coarse(0.8);
    run(&there, &folder, "there", 1);
    let mut back = there.clone();
    back.operation.speed_rpm = -500.0;
    // Roller 1 at 94°; now at 86°, and the others with it.
    back.bearing.first_roller_deg = 86.0;
    run(&back, &folder, "back", 1);
    let (there, back) = (trace(&folder, "there"), trace(&folder, "back"));
    for i in 1..=24_usize {
        // Counter-clockwise numbers from the mirrored roller 1 run backwards.
        let other = (25 - i) % 24 + 1;
        for (c, sign) in
            [("x_m", -1.0), ("y_m", 1.0), ("spin_rad", -1.0), ("outer_fx_n", -1.0), ("outer_fy_n", 1.0)]
        {
            let ours = channel(&there, &format!("roller.{i}.{c}"));
            let theirs = channel(&back, &format!("roller.{other}.{c}"));
            let largest = match c {
                "x_m" | "y_m" => 0.1,
                "spin_rad" => 0.2,
                _ => 10e3,
            };
            for (n, (a, b)) in ours.iter().zip(theirs).enumerate() {
                assert!((a - sign * b).abs() < TOLERANCE * largest, "sample {n}, roller {i}, {c}: {a} {b}");
            }
        }
    }
}

/// From rest along a ramp: the shaft has the angle ½αt² of a constant acceleration, the rollers follow it, and energy closes.
/// Source: THEORY §5.1, rolling without slip; a constant acceleration.
#[test]
fn analytic_a_start_from_rest_takes_the_rollers_along() {
    let folder = Scratch::create("reduced-ramp");
    let mut scene = coarse(60.0);
    scene.operation.speed_rpm = 0.0;
    scene.defect = None;
    scene.operation.speed_profile =
        Some(ProfileScene::Ramp(RampScene { from_ms: 0.0, to_ms: 60.0, to: 600.0 }));
    let info = run(&scene, &folder, "ramp", 1);
    println!("{info:?}");
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    let trace = trace(&folder, "ramp");
    let (time, shaft) = (channel(&trace, "time_s"), channel(&trace, "shaft.angle_rad"));
    let cage = channel(&trace, "cage.angle_rad");
    for n in (0..time.len()).step_by(500) {
        println!("{} {} {} {:?}", time[n], shaft[n], cage[n], (1..=24).map(|i| { let (x, y) = (channel(&trace, &format!("roller.{i}.x_m")), channel(&trace, &format!("roller.{i}.y_m"))); (((y[n].atan2(x[n]) - y[0].atan2(x[0])) * 1e4).round() / 1e4, (channel(&trace, &format!("roller.{i}.spin_rad"))[n]*1e3).round()/1e3) }).collect::<Vec<_>>());
    }
}

/// A load over time is carried, at each of its values, and its work is in the ledger.
#[test]
fn conserves_energy_under_a_load_that_swells() {
    let folder = Scratch::create("reduced-load");
    let mut scene = coarse(40.0);
    scene.operation.load_profile =
        Some(ProfileScene::Harmonic(HarmonicScene { amplitude: 20e3, hz: 50.0, phase_deg: 0.0 }));
    let info = run(&scene, &folder, "load", 1);
    println!("{info:?}");
    let trace = trace(&folder, "load");
    let load = channel(&trace, "adapter.load_n");
    let seat = channel(&trace, "seat.fy_n");
    for n in (0..load.len()).step_by(200) {
        let carried: f64 = (1..=24).map(|i| -channel(&trace, &format!("roller.{i}.outer_fy_n"))[n]).sum();
        println!("{n} {} {carried} {}", load[n], seat[n]);
    }
}
