//! Runs whose speed changes, from the scene to the report: the defect's family follows the shaft.

use std::{f64::consts::TAU, path::Path};

use crate::common::{command, complete};
use stribeck_analysis::{
    duty::{self, ShockOrder},
    enveloping,
    record::Record,
    summary::Summary,
    tones,
};
use stribeck_diagnosis::Defect;
use stribeck_report as report;
use stribeck_scene::{
    deviation::{DeviationScene, FormScene, RollingSurface, SpallScene},
    scene::{DefectRing, Scene},
};
use stribeck_store::run_dir::Run;
use stribeck_testing::{Scratch, assert_has, said, side_by_side};
use stribeck_theory::kinematics::Kinematics;

fn scene(file: &str, set: &[&str]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../fixtures/scenes").join(file);
    Scene::read_with(path, set).expect("a valid scene")
}

fn run(scene: &Scene, folder: &Path) -> Summary {
    complete(scene, folder);
    report::write(folder).expect("a report")
}

/// Findings of a run over the angle of its shaft.
struct OverAngle {
    resolution: f64,
    orders: Vec<f64>,
    /// Of the envelope of the leading sensor.
    power: Vec<f64>,
    /// How often the cage takes rollers past a place of the raceway in a turn.
    moved: f64,
}

fn over_angle(folder: &Path, shocks: ShockOrder) -> OverAngle {
    let run = Run::read(folder).expect("a run");
    let record = Record::whole(&run).expect("a record");
    let turns = duty::turns(&record).expect("a tacho");
    let signal = record.channel("sensor.side.ay_m_s2").expect("a sensor");
    let (spectrum, finding) = duty::over_angle(signal, record.sample_rate_hz(), &turns, shocks, None)
        .expect("numbers")
        .expect("turns enough");
    let swept = |angle: &[f64]| (angle[angle.len() - 1] - angle[0]).abs();
    let cage = swept(record.channel("cage.angle_rad").expect("a cage")) / TAU;
    OverAngle {
        resolution: finding.resolution,
        orders: spectrum.frequencies_hz().to_vec(),
        power: spectrum.values().to_vec(),
        moved: run.scene.written.bearing.rollers as f64 * cage / swept(&turns),
    }
}

/// The run-up of `fixtures/scenes/ramp.ron`: over the angle of the shaft BPFO stands within one resolution of
/// kinematics, and its multiples do in the mean of some starts; in time, at the mean speed, nothing stands
/// there.
/// Source: THEORY §5.1, rolling without slip; the cage runs some half per cent behind.
#[test]
fn analytic_bpfo_and_its_multiples_follow_the_tacho_of_a_ramp() {
    let folder = Scratch::create("ramp");
    let scene = scene("ramp.ron", &[]);
    let summary = run(&scene, &folder.join("run"));
    let duty = summary.duty.as_ref().expect("a speed that changes");
    assert_eq!((duty.speed_rpm, duty.load_n), ((300.0, 1200.0), (50_000.0, 50_000.0)));
    let orders = duty.envelope.as_ref().expect("turns enough");
    // The project's limit for every ledger; the reduced model's error goes with the square of its step.
    assert!(summary.energy.max_relative_error < 0.01, "{:?}", summary.energy);
    let order = Kinematics::new(&scene.bearing, 60.0).bpfo_hz;
    let found = orders.lines[0].measured.expect("a line");
    assert!((found - order).abs() < orders.resolution, "{found} instead of {order} ± {}", orders.resolution);
    let read = Run::read(folder.join("run")).expect("a run");
    let side: Vec<f64> = read.trace.channel("sensor.side.ay_m_s2").expect("readable").expect("a sensor");
    let mean_hz = order * summary.kinematics.shaft_hz;
    let family = tones::harmonics(&[("BPFO".into(), mean_hz)], 4, 1e9);
    let (_, smeared) = enveloping::analyse(&side, 5e4, &family).expect("numbers").expect("periods enough");
    assert!(smeared.lines.iter().all(|line| line.measured_hz.is_none()), "{:?}", smeared.lines);

    // Each passage begins and ends when the shaft has come so far, and the defect is as long at any speed.
    assert!(summary.events.len() > 60, "{} events", summary.events.len());
    let lengths: Vec<f64> = summary.events.iter().skip(2).filter_map(|event| event.spall_mm).collect();
    assert!(lengths.len() > 55, "{} of {}", lengths.len(), summary.events.len());
    let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
    assert!((mean / 10.0 - 1.0).abs() < 0.05, "{mean} mm");
    let page = std::fs::read_to_string(folder.join("run").join("report.html")).expect("a page");
    assert_has(
        &page,
        &["at 300 to 1200 rpm", "Speed and load", "Envelope line over the angle", "The speed changes"],
    );
    assert!(!page.contains("Family of facet lines") && summary.notch.is_none());
    multiples_stand_in_the_mean_of_some_starts(&folder.join("run"));
}

/// The power over the orders of four starts of the run-up, the first in `folder`: the first four multiples of
/// BPFO stand within one resolution of what the cage does. One start shows the first alone: others are 3 to
/// 15 dB high from starts 0.01° apart. Source: THEORY §5.1; the limit that of noise: a mean of four has a χ²
/// distribution of eight degrees of freedom, which exceeds 3.56 times its median once in a thousand, as often
/// as a single power exceeds ten times its own. Further starts take steps of twice the length, in half
/// the time: the comment in `ramp.ron` has what that costs.
fn multiples_stand_in_the_mean_of_some_starts(folder: &Path) {
    const STARTS: usize = 4;
    const STANDS: f64 = 3.56;
    let further = scene("ramp.ron", &["model.step_us=0.5"]);
    let order = Kinematics::new(&further.bearing, 60.0).bpfo_hz;
    let more = Scratch::create("ramps");
    let starts: Vec<usize> = (0..STARTS).collect();
    let starts = side_by_side(&starts, |&start| {
        let mut folder = folder.to_owned();
        if start > 0 {
            let mut scene = further.clone();
            scene.bearing.first_roller_deg += 360.0 / 24.0 * start as f64 / STARTS as f64;
            folder = more.join(format!("{start}"));
            complete(&scene, &folder);
        }
        over_angle(&folder, ShockOrder { defect: Defect::Bpfo, order })
    });
    let OverAngle { resolution, orders, .. } = &starts[0];
    let mean: Vec<f64> = (0..orders.len()).map(|n| starts.iter().map(|start| start.power[n]).sum()).collect();
    let moved = starts.iter().map(|start| start.moved).sum::<f64>() / STARTS as f64;
    assert!((moved / order - 1.0).abs() < 0.01, "{moved} of {order}");
    let within =
        |from: f64, to: f64| orders.iter().zip(&mean).filter(move |(at, _)| (from..=to).contains(*at));
    for multiple in 1..=4 {
        let line = moved * f64::from(multiple);
        let (at, height) = within(line - 2.0 * resolution, line + 2.0 * resolution)
            .max_by(|a, b| a.1.total_cmp(b.1))
            .expect("orders enough");
        let mut beside: Vec<f64> =
            within(line - 0.5 * order, line + 0.5 * order).map(|(_, power)| *power).collect();
        beside.sort_by(f64::total_cmp);
        let times = height / beside[beside.len() / 2];
        println!("multiple {multiple}: {at} for {line}, {times} times the median");
        assert!((at - line).abs() < *resolution && times > STANDS, "{at} for {line} ± {resolution}, {times}");
    }
}

/// The shaft speeds up against an outer ring that turns the other way and has a spall: families have orders
/// of the shaft against the ring, over that angle BPFO stands within a resolution of kinematics, and rollers
/// pass the spall when the rings have come so far. The housing is damped: otherwise it would
/// ring on from impact to impact. Source: THEORY §5.1, rolling
/// without slip.
#[test]
fn analytic_bpfo_follows_the_difference_of_two_speeds() {
    /// Travel of a roller in its pocket, by which a cage falls behind [rad of the cage on the ring].
    const PLAY: f64 = 0.05;
    let text =
        "(bearing: \"NU 205\", model: reduced(modes_khz: 30.0, step_us: 0.5), film: None, defect: None,
        defects: [(on: outer, angle_deg: 40, form: spall(length_mm: 2, depth_mm: 0.06))], housing: \
        rigid(mass_kg: 1, damping_per_s: 2000),
        operation: (load_n: 3000, speed_rpm: 300, speed_profile: ramp(to_ms: 600, to: 1500), \
        outer_speed_rpm: -600),
        cage: (outer_diameter_mm: 44.85, thickness_mm: 1.65, pocket: corners), mesh: (roller_facets: 56),
        contact: (surface: arc, friction: 0.05), output: (frames: None),
        solver: (duration_ms: 600, mass_damping_per_s: 5000, structural_damping: None))";
    let scene = Scene::parse(text, "here").expect("a valid scene");
    let folder = Scratch::create("two-rings");
    let summary = run(&scene, &folder.join("run"));
    let duty = summary.duty.as_ref().expect("a speed that changes");
    assert_eq!((duty.speed_rpm, duty.outer_speed_rpm), ((300.0, 1500.0), (-600.0, -600.0)));
    assert_eq!(duty.relative_speed_rpm, (900.0, 2100.0));
    assert!((duty.turns - 0.6 * 1500.0 / 60.0).abs() < 0.01, "{} turns", duty.turns);
    let orders = duty.envelope.as_ref().expect("turns enough");
    let order = Kinematics::new(&scene.bearing, 60.0).bpfo_hz;
    let line = &orders.lines[0];
    assert!((line.predicted - order).abs() < 1e-9, "{line:?}");
    let found = line.measured.expect("a line");
    assert!((found - order).abs() < orders.resolution, "{found} instead of {order} ± {}", orders.resolution);
    // The cage on the ring, by the recorded motion, at the mean speeds of 900 and −600 rpm.
    let k = Kinematics::between(&scene.bearing, 900.0, -600.0);
    let [cage, expected] = summary.kinematics.cage_on_outer_hz.map(|hz| hz.expect("a cage"));
    println!("cage on the ring {cage} Hz, without slip {expected}");
    assert!((expected / k.cage_on_outer_hz - 1.0).abs() < 1e-4, "{expected}");
    assert!((cage / expected - 1.0).abs() < 0.01, "{cage} Hz of {expected} Hz");
    let passed: Vec<f64> = summary
        .events
        .iter()
        .filter_map(|event| Some(event.path_entry_ms? - event.expected_entry_ms))
        .map(|late_ms| 1e-3 * late_ms * TAU * 1.4 * k.cage_on_outer_hz)
        .collect();
    println!("{} of {} events, late by {:.4?} rad", passed.len(), summary.events.len(), passed);
    // The spall comes through the load zone six times.
    assert!(summary.events.len() > 20 && 10 * passed.len() > 9 * summary.events.len());
    assert!(passed.iter().all(|late| late.abs() < PLAY), "{passed:?}");
    let page = std::fs::read_to_string(folder.join("run").join("report.html")).expect("a page");
    assert_has(
        &page,
        &[
            "300 to 1500 rpm of the inner and 600 rpm counter-clockwise of the outer ring",
            "Turns of the shaft against the outer ring",
            "have no order while the ratio of the speeds changes",
            "FTF against the outer ring",
        ],
    );
    let analysed = command(&folder, &["analyse", "run"]).output().expect("it starts");
    let words = " % over the record, by the recorded angle of the shaft against the outer ring";
    assert!(said(&analysed).contains(words), "{}", said(&analysed));
    // A stretch has speeds of its own.
    let part = report::write_between(&folder.join("run"), 0.3..0.4).expect("a report");
    let duty = part.duty.expect("a speed that changes");
    let [least, most] = [duty.speed_rpm.0 - 900.0, duty.speed_rpm.1 - 1100.0];
    assert!(least.abs() < 0.1 && most.abs() < 0.1, "{:?}", duty.speed_rpm);
    assert!((part.run.simulated_ms - 100.0).abs() < 0.05, "{} ms", part.run.simulated_ms);
}

/// Counter-clockwise the same report comes of the mirror image, but for the words.
#[test]
fn invariant_a_mirrored_run_has_the_same_report() {
    let folder = Scratch::create("mirror");
    let set = ["operation.speed_profile=None", "solver.duration_ms=60", "operation.speed_rpm=500"];
    let there = scene("ramp.ron", &set);
    let mut back = there.clone();
    back.operation.speed_rpm = -500.0;
    back.bearing.first_roller_deg = 86.0;
    let (there, back) = (run(&there, &folder.join("there")), run(&back, &folder.join("back")));
    assert!(there.events.len() > 4 && there.events.len() == back.events.len());
    let mut edges = 0;
    for (a, b) in there.events.iter().zip(&back.events) {
        assert_eq!((25 - a.roller) % 24 + 1, b.roller);
        assert!((a.expected_entry_ms - b.expected_entry_ms).abs() < 1e-9);
        // A roller that is in the defect at the end has no exit.
        for (a, b) in
            [(a.entry_ms, b.entry_ms), (a.exit_ms, b.exit_ms)].into_iter().filter_map(|(a, b)| a.zip(b))
        {
            // Idle rollers rattle differently once rounding has grown: as two starts of one scene on so
            // coarse a mesh.
            assert!((a - b).abs() < 0.2, "{a} ms and {b} ms");
            edges += 1;
        }
    }
    assert!(edges >= 2 * there.events.len() - 2, "{edges} edges of {} events", there.events.len());
    let hz =
        |s: &Summary| [s.kinematics.shaft_hz, s.kinematics.expected_cage_hz, s.kinematics.expected_bpfo_hz];
    assert_eq!(hz(&there), hz(&back));
    let [a, b] = [&there, &back].map(|s| s.kinematics.cage_hz.expect("a cage"));
    // The cage floats in its pockets by more than a milliradian of 1.4 rad.
    assert!((a / b - 1.0).abs() < 5e-3, "{a} Hz and {b} Hz");
    assert!(there.duty.is_none() && back.duty.is_none());
    let page = std::fs::read_to_string(folder.join("back").join("report.html")).expect("a page");
    assert!(page.contains("500 rpm counter-clockwise"));
}

/// A spall that turns with the shaft and one that stands: the centres of loaded rollers pass their edges when
/// rolling without slip says, and the lengths that the forces give are those of the scene.
/// Source: THEORY §5.1 and §7.5.
#[test]
fn analytic_spalls_of_both_raceways_have_events_and_lengths() {
    /// Time of a roller's travel in its pocket, 0.2 mm at 2.4 m/s [ms].
    const POCKET_MS: f64 = 0.1;
    let folder = Scratch::create("both");
    let mut set = vec!["model=reduced(modes_khz: 30.0)", "film=None", "solver.duration_ms=60"];
    set.extend(["defect.ring=inner", "defect.angle_deg=120"]);
    let mut scene = scene("quick.ron", &set);
    let sloped = SpallScene { length_mm: 8.0, depth_mm: 0.1, ..SpallScene::default() };
    let form = FormScene::Spall(sloped);
    scene.defects.push(DeviationScene { on: RollingSurface::Outer, angle_deg: 75.0, form });
    let summary = run(&scene, &folder.join("run"));
    // Walls are upright, or fall over a facet.
    let expected = [(DefectRing::Inner, 2, 10.0, 0.5), (DefectRing::Outer, 24, 8.0, scene.mesh.size_mm)];
    for (spall, (ring, roller, length_mm, off_mm)) in (1..).zip(expected) {
        let mut of_spall = summary.events.iter().filter(|event| event.spall == spall);
        let event = of_spall.find(|event| event.roller == roller).expect("a passage");
        assert_eq!(event.ring, ring);
        for (path, expected) in
            [(event.path_entry_ms, event.expected_entry_ms), (event.path_exit_ms, event.expected_exit_ms)]
        {
            let path = path.expect("a path");
            assert!(
                (path - expected).abs() < POCKET_MS,
                "spall {spall}: {path} ms, {expected} ms without slip"
            );
        }
        // A roller that is pressed together comes free behind the first edge and is caught before the second.
        let (entry, exit) = (event.entry_ms.expect("an entry"), event.exit_ms.expect("an exit"));
        assert!(event.expected_entry_ms < entry && exit < event.expected_exit_ms, "{event:?}");
        let found = event.spall_mm.expect("a length");
        assert!((found - length_mm).abs() < off_mm, "spall {spall}: {found} mm");
    }
    // Rollers that pass it on the other side of the bearing carry nothing.
    assert!(summary.notes.iter().any(|note| note.contains("outside the load zone")), "{:?}", summary.notes);
}
