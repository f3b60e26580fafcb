//! Whole runs of coarse bearings: the physics they must show and the promises a run makes.

use std::ops::ControlFlow;

use crate::common::{coarse, column, fine_where_it_rolls, run_watched, small};
use stribeck_scene::scene::{
    CageScene, DampedBody, DampingFrame, PocketWalls, RollerCopies, Scene, Start, StructuralDampingScene,
};
use stribeck_simulation::bearing::assembly::{Assembly, BearingSystem, Roller};
use stribeck_store::{
    run_dir::Run,
    run_info::{RunInfo, Status},
    trace::Trace,
};
use stribeck_testing::{Scratch, assert_has, ledger, side_by_side};

fn run(scene: &Scene, threads: usize) -> (RunInfo, Run) {
    let folder = Scratch::new("runs");
    let info = run_watched(scene, threads, &folder, &mut |_| ControlFlow::Continue(()));
    let read = Run::read(folder.path()).expect("a finished run can be read");
    (info, read)
}

/// Channels and energy ledger.
fn samples(run: &Run) -> [Trace; 2] {
    [&run.trace, &run.energy].map(|file| file.read_all().expect("readable"))
}

fn assert_same_bits(one: &Run, other: &Run, case: &str) {
    assert!(samples(one) == samples(other), "{case}: other bits");
}

/// Vertical force of the rollers on the outer ring at every sample [N].
fn support_n(run: &Run) -> Vec<f64> {
    let mut sum = vec![0.0; run.trace.len()];
    for i in 1..=run.scene.written.bearing.rollers {
        for (s, f) in sum.iter_mut().zip(column(run, &format!("roller.{i}.outer_fy_n"))) {
            *s -= f;
        }
    }
    sum
}

/// Angle of a roller's centre at the end [°].
fn last_angle_deg(run: &Run, roller: usize) -> f64 {
    let last = |c: &str| column(run, &format!("roller.{roller}.{c}_m"))[run.trace.len() - 1];
    last("y").atan2(last("x")).to_degrees()
}

/// The preloaded bearing rolls: the cage turns at f_s·D_i/(D_i + D_o), the rollers carry load and weight, the
/// energy ledger closes.
/// Source: THEORY §5.1, rolling without slip.
#[test]
fn analytic_bearing_rolls_and_carries_its_load() {
    // Cage, load and ledger within 1 % each: the project's limits for the full scene too. On a 2 mm mesh the
    // cage runs 1.1 % ahead after 4 ms.
    const TOLERANCE: f64 = 0.01;
    let scene = fine_where_it_rolls(6.0);
    let (info, run) = run(&scene, 1);
    assert_eq!(info.status, Status::Complete);
    assert!(info.energy.max_relative_error < TOLERANCE, "energy: {}", info.energy.max_relative_error);

    let angle = column(&run, "cage.angle_rad");
    let end = run.trace.len() - 1;
    let cage_hz = -angle[end] / (std::f64::consts::TAU * column(&run, "time_s")[end]);
    let expected = scene.kinematics().cage_hz;
    let source = "f_s D_i/(D_i + D_o), no slip: paper, equation 24";
    ledger::compare("coarse bearing, cage", source, "Hz", cage_hz, expected, TOLERANCE);

    let carried = support_n(&run).iter().sum::<f64>() / run.trace.len() as f64;
    let source = "load and weight of adapter and outer ring";
    ledger::compare(
        "coarse bearing, force of all rollers",
        source,
        "N",
        carried,
        info.expected_support_n,
        TOLERANCE,
    );
}

/// The preload leaves equilibrium: before the first roller reaches the defect the vertical force through the
/// rollers stays near the load, while a load put on at once overshoots by its own size.
#[test]
fn behaves_preloaded_start_does_not_ring() {
    // What remains is the facet passing of a coarse polygon.
    const RIPPLE: f64 = 0.2;
    let (info, run) = run(&coarse(0.5), 1);
    for (sample, force) in support_n(&run).into_iter().enumerate() {
        let off = force / info.expected_support_n - 1.0;
        assert!(off.abs() < RIPPLE, "sample {sample}: {force} N");
    }
}

/// Bearings whose rollers lie loosely while the preload is sought: the rings of the paper's mesh are thin, or
/// nothing but their weight moves the rollers that carry nothing. Those must stay in their clearance.
#[test]
fn behaves_thin_and_slow_bearings_find_their_equilibrium() {
    let lean = ("lean.ron", include_str!("../../../../../fixtures/scenes/lean.ron"));
    let quick = ("quick.ron", include_str!("../../../../../fixtures/scenes/quick.ron"));
    for ((name, text), thickness_mm, speed_rpm) in
        [(lean, 5.0, 500.0), (lean, 30.0, 50.0), (quick, 30.0, 1.0), (quick, 30.0, 50.0)]
    {
        let mut scene = Scene::parse(text, name).expect("a valid scene");
        scene.bearing.thickness_mm = thickness_mm;
        scene.operation.speed_rpm = speed_rpm;
        scene.solver.duration_ms = 0.02;
        let (info, _) = run(&scene, 1);
        let case = format!("{name}, {thickness_mm} mm, {speed_rpm} rpm");
        assert_eq!(info.status, Status::Complete, "{case}: {:?}", info.stop_reason);
        assert!(!info.warnings.iter().any(|w| w.contains("unbalanced")), "{case}: {:?}", info.warnings);
    }
}

/// Same scene, same bits, for any number of threads.
#[test]
fn invariant_same_bits_with_1_2_and_3_threads() {
    let scene = coarse(0.3);
    let (_, one) = run(&scene, 1);
    for threads in [2, 3] {
        let (_, other) = run(&scene, threads);
        assert_same_bits(&one, &other, &format!("{threads} threads"));
    }
}

/// Stiffness damping shortens the step, its heat closes the ledger, and threads change no bit.
#[test]
fn behaves_stiffness_damping_is_paid_and_counted() {
    /// Share of the peak strain energy that the ledger may lack before a bearing gets a warning.
    const LEDGER: f64 = 5e-3;
    let mut plain = coarse(0.3);
    // Its heat alone is seen. Loaded bodies that turn drive themselves a little with it (THEORY §2.7): it may
    // be negative.
    (plain.solver.mass_damping_per_s, plain.solver.structural_damping) = (0.0, None);
    let mut scene = plain.clone();
    scene.solver.stiffness_damping_ns = 100.0;
    let ((undamped, without), (info, one)) = (run(&plain, 1), run(&scene, 1));
    assert!(info.critical_time_step_s < 0.9 * undamped.critical_time_step_s, "{info:?}");
    assert!(info.energy.max_relative_error < LEDGER, "{:?}", info.energy);
    let heat = |run: &Run| {
        run.energy.channel("damping_j").expect("readable").and_then(|h| h.last().copied()).expect("a column")
    };
    assert!(
        heat(&without) == 0.0 && heat(&one) != 0.0,
        "{} J without, {} J with",
        heat(&without),
        heat(&one)
    );
    let (_, two) = run(&scene, 2);
    assert_same_bits(&one, &two, "two threads");
}

/// Structural damping shortens the step by a few per cent, its loss closes the ledger, and threads change no
/// bit.
#[test]
fn behaves_structural_damping_is_paid_and_counted() {
    /// Share of the peak strain energy that the ledger may lack before a bearing gets a warning.
    const LEDGER: f64 = 5e-3;
    let mut plain = coarse(0.3);
    (plain.solver.mass_damping_per_s, plain.solver.structural_damping) = (0.0, None);
    let mut scene = plain.clone();
    scene.solver.structural_damping = Some(StructuralDampingScene::default());
    let ((undamped, _), (info, one)) = (run(&plain, 1), run(&scene, 1));
    // √(1 + Σ g) with Σ g = 0.146, where a damped body sets the step; rollers do here, and the step is an
    // estimate.
    const ESTIMATE: f64 = 1e-4;
    let shorter = info.critical_time_step_s / undamped.critical_time_step_s;
    assert!((0.93..=1.0 + ESTIMATE).contains(&shorter), "{shorter} of the undamped step");
    assert!(info.energy.max_relative_error < LEDGER, "{:?}", info.energy);
    let loss =
        one.energy.channel("damping_j").expect("readable").and_then(|h| h.last().copied()).expect("a column");
    assert!(loss > 0.0, "{loss} J");
    let (_, two) = run(&scene, 2);
    assert_same_bits(&one, &two, "two threads");
    let mut adapter_alone = scene;
    adapter_alone.solver.structural_damping =
        Some(StructuralDampingScene { bodies: vec![DampedBody::Adapter], ..Default::default() });
    let (_, less) = run(&adapter_alone, 1);
    assert!(samples(&less) != samples(&one), "the rings are not damped");
}

/// Pockets push rollers along their track: walls that touch them at their flanks have no other direction,
/// corners do.
#[test]
fn behaves_straight_pockets_push_along_the_track() {
    let across = |pocket: PocketWalls| {
        let mut scene = coarse(1.5);
        // Without play the cage carries idle rollers from the beginning.
        scene.cage = Some(CageScene { pocket, pocket_clearance_um: 0.0, ..CageScene::default() });
        let (_, run) = run(&scene, 1);
        let (mut radial, mut all) = (0.0, 0.0);
        for roller in 1..=scene.bearing.rollers {
            let get = |channel: &str| column(&run, &format!("roller.{roller}.{channel}"));
            let [x, y, fx, fy] = ["x_m", "y_m", "cage_fx_n", "cage_fy_n"].map(get);
            for n in 0..x.len() {
                radial += (fx[n] * x[n] + fy[n] * y[n]) / x[n].hypot(y[n]);
                all += fx[n].hypot(fy[n]);
            }
        }
        println!("{pocket:?}: {radial:.1} N outwards of {all:.1} N");
        assert!(all > 0.0, "the cage touches no roller");
        radial / all
    };
    // Corners 3 mm above the centres of rollers of 9 mm push inwards with a third of their force.
    assert!(across(PocketWalls::Corners) < -0.25);
    // Friction gives 0.005, the facets of a roller some per cent of either sign.
    assert!(across(PocketWalls::Straight).abs() < 0.02);
}

/// Without a cage a roller with µ = 0.005 loses traction in the spall, rebounds from the exit edge and stays
/// inside; the cage pushes it out. Seen on the first prototype of this bearing.
#[test]
fn issue_roller_is_trapped_in_the_spall_without_a_cage() {
    const TRAILING_EDGE_DEG: f64 = 90.0 - 2.8648;
    // On facets of 2 mm the polygon rolls over the first time.
    let mut scene = fine_where_it_rolls(6.5);
    // As it was seen: damping across the track takes the rebound from the roller, which then climbs out by
    // itself.
    scene.solver.damping_frame = DampingFrame::RigidMotion;
    scene.solver.mass_damping_per_s = 150.0;
    // And on a stiff contact: on a soft one a roller sinks far enough into the edge to climb out.
    (scene.contact.penalty_scale, scene.contact.points_per_facet) = (1.0, 4);
    let without = Scene { cage: None, ..scene.clone() };
    let runs = side_by_side(&[scene, without], |scene| run(scene, 1).1);
    let (caged, free) = (&runs[0], &runs[1]);
    let angle = last_angle_deg(caged, 1);
    assert!(
        angle < TRAILING_EDGE_DEG,
        "with its cage roller 1 should be out of the spall, it is at {angle}°"
    );
    let angle = last_angle_deg(free, 1);
    assert!(angle > TRAILING_EDGE_DEG, "without a cage roller 1 should stay in the spall, it is at {angle}°");
    assert!(
        free.trace.names().iter().all(|name| name != "cage.angle_rad"),
        "a scene without a cage records none"
    );
}

/// A step above the critical one creates energy: the run stops by itself, says where and what to try, and
/// its files stay readable.
#[test]
fn survives_a_run_that_diverges() {
    let mut scene = coarse(2.0);
    scene.solver.time_step_factor = 1.3;
    let (info, run) = run(&scene, 1);
    assert_eq!(info.status, Status::Diverged);
    let reason = info.stop_reason.expect("a diverged run says why");
    assert_has(&reason, &["step", "ms", "x =", "time_step_factor"]);
    assert_eq!(run.trace.len(), info.samples);
    assert_eq!(run.info.status, Status::Diverged);
}

/// An interrupted run keeps every sample up to the interruption.
#[test]
fn survives_an_interruption_with_its_samples() {
    let folder = Scratch::new("runs");
    let mut samples = 0;
    let info = run_watched(&coarse(2.0), 1, &folder, &mut |p| {
        samples += usize::from(p.time_s > 0.0);
        if samples == 10 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!(info.status, Status::Interrupted);
    assert_eq!(Run::read(folder.path()).expect("readable").trace.len(), 10);
}

/// First parts of a millisecond of three bearings against our own blessed history (`fixtures/golden/*.csv`): a
/// change of the physics shows here, a change of rounding does not. `fixtures/golden/digest` is the checksum of
/// these files, by which a page of results knows whether an older program made it. `STRIBECK_BLESS=1 cargo
/// test …` writes them anew.
#[test]
fn golden_traces() {
    // Sums over wide and narrow vectors round differently on another machine, far below this; the preload,
    // whose factorisation does too, is left out of the full model. A change of the physics shows in the first
    // digits.
    const TOLERANCE: f64 = 1e-6;
    const CHANNELS: [&str; 6] = [
        "sensor.side.ay_m_s2",
        "sensor.bottom.ax_m_s2",
        "roller.1.outer_fy_n",
        "roller.1.inner_fy_n",
        "cage.angle_rad",
        "roller.1.y_m",
    ];
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/golden/");
    let bless = std::env::var_os("STRIBECK_BLESS").is_some();
    let mut full = coarse(0.3);
    full.solver.start = Start::Sudden;
    // Dry, with mass damping, and pockets with corners.
    full.film = None;
    (full.solver.mass_damping_per_s, full.solver.structural_damping) = (5000.0, None);
    full.cage = Some(CageScene { pocket: PocketWalls::Corners, ..CageScene::default() });
    let mut reduced = small("");
    reduced.solver.duration_ms = 0.5;
    let balls = "(bearing: \"6203\", model: reduced(), housing: pedestal(), output: (frames: None), \
                 solver: (duration_ms: 0.5))";
    let balls = Scene::parse(balls, "here").expect("a valid scene");
    let mut digest = crc32fast::Hasher::new();
    for (name, scene) in [("full", full), ("reduced", reduced), ("balls", balls)] {
        let path = format!("{folder}{name}.csv");
        let (_, run) = run(&scene, 1);
        if bless {
            let mut text = CHANNELS.join(",") + "\n";
            for sample in 0..run.trace.len() {
                let row = CHANNELS.map(|c| format!("{:.12e}", column(&run, c)[sample]));
                text += &(row.join(",") + "\n");
            }
            std::fs::write(&path, text).expect("the golden file can be written");
        }
        let text = std::fs::read_to_string(&path).expect("the golden file is in the repository");
        digest.update(text.as_bytes());
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some(CHANNELS.join(",").as_str()));
        let rows: Vec<Vec<f64>> =
            lines.map(|l| l.split(',').map(|v| v.parse().expect("a number")).collect()).collect();
        assert_eq!(rows.len(), run.trace.len());
        for (c, channel) in CHANNELS.into_iter().enumerate() {
            let largest = rows.iter().map(|r| r[c].abs()).fold(0.0, f64::max);
            assert!(largest > 0.0, "{name}: {channel} is silent");
            for (sample, (row, now)) in rows.iter().zip(column(&run, channel)).enumerate() {
                let off = (row[c] - now).abs() / largest;
                assert!(
                    off < TOLERANCE,
                    "{name}, {channel}, sample {sample}: {now}, blessed {} ({off:.1e} off)",
                    row[c]
                );
            }
        }
    }
    let digest = format!("{:08x}\n", digest.finalize());
    if bless {
        std::fs::write(format!("{folder}digest"), &digest).expect("the digest can be written");
    }
    let kept = std::fs::read_to_string(format!("{folder}digest")).expect("the digest is in the repository");
    assert_eq!(kept, digest, "STRIBECK_BLESS=1 writes it");
}

/// Centres stand where angle and place in the pocket say, and meshes are turned by their phase; the cage
/// stays.
#[test]
fn by_hand_rollers_start_where_the_scene_puts_them() {
    // Sums and products of numbers of the size of one metre.
    const ROUNDING: f64 = 1e-14;
    let plain = coarse(1.0);
    let mut moved = plain.clone();
    moved.mesh.roller_phase_deg = 1.5;
    moved
        .cage
        .iter_mut()
        .for_each(|c| c.roller_offsets_um = (0..24).map(|i| 90.0 - 7.5 * f64::from(i)).collect());
    for copies in [RollerCopies::Rotated, RollerCopies::Translated] {
        let [before, after] = [&plain, &moved].map(|scene| {
            let mut scene = scene.clone();
            scene.mesh.roller_copies = copies;
            let assembly = Assembly::new(&scene.resolve()).expect("sound");
            assembly.build(&scene.resolve(), 1).expect("sound")
        });
        for (i, (a, b)) in before.rollers.iter().zip(&after.rollers).enumerate() {
            let [[ax, ay], [bx, by]] = [before.system.position(a.centre), after.system.position(b.centre)];
            let turned = (ax * by - ay * bx).atan2(ax * bx + ay * by);
            let along = 1e-6 * (90.0 - 7.5 * i as f64) / 91e-3;
            assert!((turned - along).abs() < ROUNDING / 91e-3, "{i}: {turned} instead of {along}");
            assert!((bx.hypot(by) - 91e-3).abs() < ROUNDING);
            let rim = |machine: &BearingSystem, roller: &Roller| {
                let [[cx, cy], [x, y]] = [roller.centre, roller.rim].map(|n| machine.system.position(n));
                (y - cy).atan2(x - cx)
            };
            let spun = (rim(&after, b) - rim(&before, a)).rem_euclid(std::f64::consts::TAU);
            let with_place = if copies == RollerCopies::Rotated { along } else { 0.0 };
            let expected = (1.5_f64.to_radians() + with_place).rem_euclid(std::f64::consts::TAU);
            assert!((spun - expected).abs() < ROUNDING / 9e-3, "{i}: {spun} instead of {expected}");
        }
        let cage = after.cage.expect("there is one");
        for (a, b) in before.system.nodes_of(cage).zip(after.system.nodes_of(cage)) {
            assert_eq!(before.system.position(a), after.system.position(b));
        }
    }
}
