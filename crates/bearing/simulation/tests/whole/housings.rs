//! Housings other than the paper's adapter: their loads, the energy balance, the motion of the rings.

use std::{f64::consts::TAU, ops::ControlFlow};

use crate::common::{assert_goes_on_with_the_same_bytes, column, host};
use stribeck_scene::scene::Scene;
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_simulation::simulate;
use stribeck_store::{
    run_dir::{Run, RunDir},
    run_info::{RunInfo, Status},
};
use stribeck_testing::Scratch;
use stribeck_theory::kinematics::Kinematics;

/// A small bearing whose sides are quickly meshed.
fn scene(more: &[&str]) -> Scene {
    let base = "(name: \"housing\", bearing: \"NU 205\", film: None, defect: None, output: (frames: None),
        operation: (load_n: 5000, speed_rpm: 1500), mesh: (size_mm: 0.5, roller_facets: 48, grading: \
        (coarse_mm: 1.5)), contact: (penalty_scale: 0.3),
        solver: (duration_ms: 2))";
    let scene = Scene::parse(base, "here").expect("valid");
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/housings/pillow_block.msh");
    let more: Vec<String> = more.iter().map(|set| set.replace("FILE", folder)).collect();
    scene.with_overrides(&more.iter().map(String::as_str).collect::<Vec<_>>()).expect("valid")
}

fn run(scene: &Scene, folder: &Scratch) -> RunInfo {
    let dir = RunDir::create(folder.path()).expect("the folder is new");
    simulate(scene, &dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("the scene runs")
}

/// Mean of a channel over the second half.
fn mean(run: &Run, name: &str) -> f64 {
    let channel = run.trace.channel(name).expect("readable").unwrap_or_else(|| panic!("no channel {name}"));
    let late = &channel[channel.len() / 2..];
    late.iter().sum::<f64>() / late.len() as f64
}

const PEDESTAL: &str = "housing=pedestal(width_mm: 90, base_mm: 45, top_mm: 38)";
const MESH: &str = "housing=mesh(file: \"FILE\", unit_mm: 1)";
const SPRINGS: &str = "housing=springs(stiffness_n_um: 500, damping_n_s_m: 3000, mass_kg: 2)";
const RIGID: &str = "housing=rigid(mass_kg: 2)";
const MACHINE: &str = "housing=machine(mass_kg: 200)";

/// Source: the sum of the rollers' forces along the load is the load and the weight along it, in any
/// direction that the housing takes; THEORY §4.
#[test]
fn analytic_every_housing_hands_its_load_to_the_rollers() {
    for (housing, angle) in [(PEDESTAL, 90.0), (MESH, 270.0), (SPRINGS, 200.0), (RIGID, 35.0)] {
        let scene = scene(&[housing, &format!("operation.load_angle_deg={angle}")]);
        let folder = Scratch::new("housing");
        let info = run(&scene, &folder);
        assert_eq!(
            (info.status, info.warnings.len()),
            (Status::Complete, 0),
            "{housing} {:?}",
            info.warnings
        );
        assert!(info.energy.max_relative_error < 2e-3, "{housing}: {}", info.energy.max_relative_error);
        let run = Run::read(folder.path()).expect("readable");
        let [x, y] = scene.load_direction();
        let along = |i: usize| {
            x * mean(&run, &format!("roller.{i}.outer_fx_n"))
                + y * mean(&run, &format!("roller.{i}.outer_fy_n"))
        };
        let carried: f64 = (1..=scene.bearing.rollers).map(along).sum();
        assert!((carried / info.expected_support_n - 1.0).abs() < 0.02, "{housing} {angle}: {carried}");
        let sits = scene.housing.has_seat();
        assert_eq!(run.trace.names().iter().any(|name| name == "seat.fx_n"), sits, "{housing}");
    }
}

/// A machine stands on its foundation: 1962 N of its housing change nothing of what the rollers carry, in neither
/// model. Source: the sum of all forces on the ring vanishes at rest.
#[test]
fn analytic_the_weight_of_a_machine_is_not_the_bearings() {
    const RING_KG: f64 = 0.1;
    for model in ["full", "reduced()"] {
        let model = format!("model={model}");
        let scene = scene(&[MACHINE, &model, "contact.surface=arc", "solver.mass_damping_per_s=5000"]);
        let folder = Scratch::new("housing-foundation");
        assert_eq!(run(&scene, &folder).status, Status::Complete, "{model}");
        let run = Run::read(folder.path()).expect("readable");
        let on = |i: usize| -mean(&run, &format!("roller.{i}.outer_fy_n"));
        let carried: f64 = (1..=scene.bearing.rollers).map(on).sum();
        assert!((carried - 5000.0).abs() < 0.02 * 5000.0, "{model}: {carried}");
        assert!((run.info.expected_support_n - 5000.0).abs() < 9.81 * RING_KG, "{model}: {:?}", run.info);
    }
}

/// A sensor of a rigid ring shows along each axis the force of the rollers on it, over its mass.
/// Source: Newton (1687), the second law; load and weight are constant.
#[test]
fn analytic_a_rigid_ring_is_moved_by_its_rollers_along_each_axis() {
    // Of sums over the steps of an interval, which are equal but for rounding.
    const ROUNDING: f64 = 1e-9;
    let scene = scene(&[RIGID, "operation.load_angle_deg=35"]);
    let folder = Scratch::new("housing-axes");
    assert_eq!(run(&scene, &folder).status, Status::Complete);
    let run = Run::read(folder.path()).expect("a finished run can be read");
    let less_its_mean = |channel: Vec<f64>| {
        let mean = channel.iter().sum::<f64>() / channel.len() as f64;
        channel.into_iter().map(|x| x - mean).collect::<Vec<f64>>()
    };
    for axis in ["x", "y"] {
        let shown = less_its_mean(column(&run, &format!("sensor.side.a{axis}_m_s2")));
        // Recorded are the forces of the raceway on the rollers.
        let mut force = vec![0.0; shown.len()];
        for i in 1..=scene.bearing.rollers {
            let on_roller = column(&run, &format!("roller.{i}.outer_f{axis}_n"));
            force.iter_mut().zip(on_roller).for_each(|(sum, f)| *sum -= f);
        }
        let force = less_its_mean(force);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let correlation = dot(&force, &shown) / (dot(&force, &force) * dot(&shown, &shown)).sqrt();
        assert!((correlation - 1.0).abs() < ROUNDING, "{axis}: {correlation}");
    }
}

#[test]
fn behaves_a_missing_roller_leaves_its_pocket_empty_and_its_load_to_others() {
    let folder = Scratch::new("missing");
    let whole = scene(&[]);
    let scene = scene(&["defects=[(on: roller(1), form: missing)]"]);
    let info = run(&scene, &folder);
    assert_eq!((info.status, info.warnings.len()), (Status::Complete, 0), "{:?}", info.warnings);
    assert!(info.energy.max_relative_error < 2e-3, "{}", info.energy.max_relative_error);
    let run = Run::read(folder.path()).expect("readable");
    assert!(!run.trace.names().iter().any(|name| name.starts_with("roller.1.")));
    let rollers: Vec<usize> = scene.rollers_in_place().collect();
    assert_eq!(rollers.len(), scene.bearing.rollers - 1);
    let on = |i: &usize| -mean(&run, &format!("roller.{i}.outer_fy_n"));
    let carried: f64 = rollers.iter().map(on).sum();
    assert!((carried / info.expected_support_n - 1.0).abs() < 0.02, "{carried}");
    let outer_hz = scene.kinematics().bpfo_hz;
    assert!(outer_hz == whole.kinematics().bpfo_hz, "{outer_hz} Hz");
    let [most, before] = [&scene, &whole].map(|s| s.resolve().static_load().expect("rests").max_roller_n());
    let found = rollers.iter().map(on).fold(0.0, f64::max);
    println!("largest force {found:.0} N, between rigid rings {most:.0}, of all rollers {before:.0}");
    assert!(found > 1.1 * before, "{found} N and {before} N with all rollers");
}

/// Source: rolling without slip between two rings that turn: the cage at (ω_i D_i + ω_o D_o)/(D_i + D_o),
/// THEORY §5.1.
#[test]
fn analytic_rollers_between_turning_rings() {
    for (inner, outer) in [(0.0, 1500.0), (1500.0, -800.0), (600.0, 600.0)] {
        let scene = scene(&[
            RIGID,
            &format!("operation.speed_rpm={inner}"),
            &format!("operation.outer_speed_rpm={outer}"),
            "contact.friction=0.1",
        ]);
        let folder = Scratch::new("turning");
        let info = run(&scene, &folder);
        assert_eq!(info.status, Status::Complete, "{:?}", info.warnings);
        assert!(info.energy.max_relative_error < 2e-3, "{inner} {outer}: {}", info.energy.max_relative_error);
        let run = Run::read(folder.path()).expect("readable");
        let k = scene.kinematics();
        let trace = run.trace.read_all().expect("readable");
        let angle = trace.get("cage.angle_rad").expect("a cage");
        let time = trace.get("time_s").expect("a time");
        let last = angle.len() - 1;
        let rate = (angle[last] - angle[0]) / (time[last] - time[0]);
        let fastest = k.shaft_rad_s.abs().max(k.outer_rad_s.abs());
        assert!((rate - k.cage_rad_s).abs() < 5e-3 * fastest, "{inner} {outer}: {rate} and {}", k.cage_rad_s);
        let spin = trace.get("roller.3.spin_rad").expect("a roller");
        let rate = (spin[last] - spin[0]) / (time[last] - time[0]);
        assert!(
            (rate - k.roller_rad_s).abs() < 0.05 * fastest,
            "{inner} {outer}: {rate} and {}",
            k.roller_rad_s
        );
    }
}

/// The shaft speeds up, beside an outer ring that turns at one speed or through rest: both follow their
/// angles, and a roller under load goes by the weighted mean of both.
/// Source: as above; the angle of a ramp is θ = ω₀t + ½αt², THEORY §6.3.
#[test]
fn analytic_rollers_between_rings_whose_speeds_change() {
    // Of the way of the shaft against the outer ring: creep under the load, and what facets add on so short a
    // way.
    const ROLLING: f64 = 0.01;
    for outer in ["outer_speed_rpm=-800", "outer_speed_profile=ramp(to_ms: 2, to: 900)"] {
        let scene = scene(&[
            RIGID,
            "operation.speed_rpm=600",
            "operation.speed_profile=ramp(to_ms: 2, to: 1800)",
            &format!("operation.{outer}"),
            "contact.friction=0.1",
        ]);
        let folder = Scratch::new("speeding");
        let info = run(&scene, &folder);
        assert_eq!(info.status, Status::Complete, "{:?}", info.warnings);
        assert!(info.energy.max_relative_error < 2e-3, "{outer}: {}", info.energy.max_relative_error);
        let trace = Run::read(folder.path()).expect("readable").trace.read_all().expect("readable");
        let of = |name: &str| trace.get(name).unwrap_or_else(|| panic!("no `{name}`"));
        let (time, shaft, ring) = (of("time_s"), of("shaft.angle_rad"), of("outer_ring.angle_rad"));
        let per_rpm = -TAU / 60.0;
        let share = Kinematics::new(&scene.bearing, 60.0).cage_hz;
        let last = time.len() - 1;
        for (n, &t) in time.iter().enumerate() {
            let inner = per_rpm * (600.0 * t + 0.5 * 600e3 * t * t);
            let swept = if outer.contains("ramp") { 0.5 * 450e3 * t * t } else { -800.0 * t };
            assert!((shaft[n] - inner).abs() < 1e-12 && (ring[n] - per_rpm * swept).abs() < 1e-12, "{t} s");
        }
        let turned = |angle: &[f64]| angle[last] - angle[0];
        let against = turned(shaft) - turned(ring);
        let without_slip = turned(ring) + share * against;
        // Roller 1 is near the top, in the load zone.
        let [x, y] = ["x_m", "y_m"].map(|c| of(&format!("roller.1.{c}")));
        let rolled = turned(&x.iter().zip(y).map(|(x, y)| y.atan2(*x)).collect::<Vec<_>>());
        println!(
            "{outer}: {rolled:.5} rad, without slip {without_slip:.5}, ledger off by {:.1e}",
            info.energy.max_relative_error
        );
        assert!(((rolled - without_slip) / against).abs() < ROLLING, "{outer}: {rolled} and {without_slip}");
    }
}

#[test]
fn refuses_a_mesh_that_is_no_housing_of_the_bearing() {
    for (set, words) in [
        ("housing.bore=boar", "no set of nodes `boar`, which `housing.bore` names; sets: `bore`, `loaded`"),
        ("housing.bore=loaded", "is no closed bore"),
        ("housing.unit_mm=1000", "the outer ring: a node lies 26000.000"),
    ] {
        let said = Assembly::new(&scene(&[MESH, set]).resolve()).expect_err(set).to_string();
        assert!(said.contains(words) && said.contains("pillow_block.msh"), "{set}: {said}");
    }
}

#[test]
fn invariant_a_run_on_springs_goes_on_with_the_same_bytes() {
    let turning = "operation.rotating_load=(force_n: 500, angle_deg: 0)";
    let scene = scene(&[SPRINGS, "solver.duration_ms=1", turning]);
    assert_goes_on_with_the_same_bytes(&scene, &Scratch::create("springs"), 50);
}
