//! Defects and other deviations from round, on every surface: positions of nodes, the time step, and that
//! runs carry their load and keep their energy.

use std::ops::ControlFlow;

use crate::common::{fine_where_it_rolls, host};
use stribeck_scene::deviation::RollingSurface;
use stribeck_scene::scene::Scene;
use stribeck_simulation::bearing::assembly::Assembly;
use stribeck_simulation::simulate;
use stribeck_store::run_dir::{Run, RunDir};
use stribeck_store::run_info::Status;
use stribeck_testing::{Scratch, side_by_side};

/// Healthy raceways in elements of 1 mm with these deviations.
fn scene(defects: &str) -> Scene {
    let mut scene = running(defects, 1.0);
    scene.mesh.grading = None;
    scene
}

/// The same in larger elements away from the raceways.
fn running(defects: &str, duration_ms: f64) -> Scene {
    let mut scene = fine_where_it_rolls(duration_ms);
    (scene.defect, scene.film) = (None, None);
    scene.with_overrides(&[format!("defects=[{defects}]")]).expect("a scene that can be meshed")
}

/// One of each form.
const ALL: &str = "(on: outer, angle_deg: 93.0, form: spall(length_mm: 5.3, depth_mm: 0.1)), \
    (on: outer, form: waviness(order: 12, amplitude_um: 2.0)), \
    (on: inner, angle_deg: 40.0, form: dent(length_mm: 6.0, depth_mm: 0.05, rim_um: 8.0)), \
    (on: inner, form: roughness(rq_um: 0.5, longest_mm: 20.0, shortest_mm: 5.0)), \
    (on: roller(1), angle_deg: 100.0, \
    form: spall(length_mm: 4.0, depth_mm: 0.05, edge_mm: 1.0, edge: rounded)), \
    (on: roller(2), form: diameter(larger_um: -8.0)), \
    (on: roller(3), angle_deg: -20.0, \
    form: profile(points: [(at_mm: -2.0, depth_um: 0.0), (at_mm: 0.0, depth_um: 40.0), \
    (at_mm: 1.0, depth_um: -10.0), (at_mm: 2.0, depth_um: 0.0)]))";

/// Radii and angles of the nodes of a body's surface about its centre.
fn polar(scene: &Scene, surface: &str, centre: [f64; 2]) -> Vec<[f64; 2]> {
    let machine = Assembly::new(&scene.resolve())
        .expect("it meshes")
        .build(&scene.resolve(), 1)
        .expect("it is laid out");
    let nodes = machine.system.nodes(surface).expect("a surface of every scene");
    let polar = |n: u32| {
        let [x, y] = machine.system.position(n);
        let [x, y] = [x - centre[0], y - centre[1]];
        [x.hypot(y), y.atan2(x)]
    };
    nodes.into_iter().map(polar).collect()
}

/// Source: THEORY §6.4.
#[test]
fn analytic_nodes_lie_as_deep_as_the_scene_says() {
    // Positions of a meshed bearing are known to a few roundings of 0.1 m.
    const ROUNDING: f64 = 1e-15;
    let scene = scene(ALL);
    let g = scene.resolve();
    let centre = |i: usize| {
        let (s, c) = g.roller_angle(i).sin_cos();
        [g.path_radius() * c, g.path_radius() * s]
    };
    let mut surfaces = vec![
        ("outer raceway".to_owned(), [0.0; 2], g.outer_relief.clone(), 1.0),
        ("inner raceway".to_owned(), [0.0; 2], g.inner_relief.clone(), -1.0),
    ];
    assert_eq!(g.roller_reliefs.len(), 3);
    for (i, relief) in &g.roller_reliefs {
        surfaces.push((format!("rim of roller {}", i + 1), centre(*i), Some(relief.clone()), -1.0));
    }
    for (surface, centre, relief, outwards) in surfaces {
        let relief = relief.expect("every one of these deviates");
        let nodes = polar(&scene, &surface, centre);
        for [radius, angle] in &nodes {
            // An angle is rounded too, where the profile slopes by 0.1.
            let wanted = relief.radius + outwards * relief.depth(*angle);
            assert!((radius - wanted).abs() < 8.0 * ROUNDING, "{surface} at {angle}: {radius} for {wanted}");
        }
        for corner in relief.corners() {
            let off = |node: &[f64; 2]| (node[1] - corner).sin().abs();
            let nearest = nodes.iter().map(off).fold(1.0, f64::min);
            assert!(nearest < 1e-12, "{surface}: no node at the corner {corner}, but {nearest} away");
        }
    }
    let sound = Scene { defects: Vec::new(), ..scene };
    for [radius, _] in polar(&sound, "rim of roller 1", centre(0)) {
        assert!((radius - g.roller_radius).abs() < 8.0 * ROUNDING);
    }
}

/// Asked of every defect: a time step within a tenth of the healthy bearing's.
#[test]
fn invariant_the_time_step_stays_within_a_tenth_where_slopes_are_steepest() {
    let step = |scene: &Scene| {
        let machine = Assembly::new(&scene.resolve())
            .expect("it meshes")
            .build(&scene.resolve(), 1)
            .expect("it is laid out");
        machine.system.critical_time_step()
    };
    let sound = step(&scene(""));
    for defects in [
        // A slope of 0.4 on one facet, which is 1 mm long on the raceways and 0.505 mm on a roller.
        "(on: outer, form: spall(length_mm: 6.4, depth_mm: 0.39))",
        "(on: inner, form: spall(length_mm: 5.7, depth_mm: 0.39))",
        "(on: roller(1), form: spall(length_mm: 3.3, depth_mm: 0.2))",
        "(on: outer, form: spall(length_mm: 4.2, depth_mm: 0.25, edge_mm: 1.0, edge: rounded))",
        "(on: outer, form: dent(length_mm: 4.0, depth_mm: 0.5, rim_um: 200.0))",
        "(on: roller(7), form: dent(length_mm: 2.1, depth_mm: 0.27, rim_um: 100.0))",
        "(on: inner, form: waviness(order: 80, amplitude_um: 400.0))",
        "(on: outer, form: roughness(rq_um: 60.0, longest_mm: 8.0, shortest_mm: 4.0))",
        "(on: roller(5), form: diameter(larger_um: -100.0))",
        "(on: outer, form: spall(length_mm: 6.0, depth_mm: 0.2, edge: rectangular)), \
         (on: outer, angle_deg: 110.0, form: spall(length_mm: 4.0, depth_mm: 0.4, edge: rectangular))",
        ALL,
    ] {
        let share = step(&scene(defects)) / sound;
        assert!(share > 0.9, "{defects}: {share}");
    }
    // Steep walls in the small cells of a roller.
    for defects in [
        "(on: roller(1), form: spall(length_mm: 3.3, depth_mm: 0.05, edge: rectangular))",
        "(on: roller(1), angle_deg: 180.0, form: spall(length_mm: 5.1, depth_mm: 0.2, edge: rectangular))",
        "(on: roller(3), angle_deg: -178.0, form: spall(length_mm: 2.2, depth_mm: 0.5, edge: rectangular)), \
         (on: roller(3), angle_deg: 30.0, form: spall(length_mm: 3.0, depth_mm: 0.3, edge: rectangular))",
        "(on: roller(2), form: spall(length_mm: 4.0, depth_mm: 1.3, edge: rectangular))",
    ] {
        let share = step(&scene(defects)) / sound;
        println!("{share:.3} {defects}");
        assert!(share > 0.85, "{defects}: {share}");
    }
}

/// A spall with steep walls is the same mesh as `defect`, whatever else is on other surfaces.
#[test]
fn invariant_rectangular_spalls_are_cut_as_the_defect_is() {
    let nodes = |scene: &Scene| {
        let mesh = Assembly::new(&scene.resolve()).expect("it meshes").model.mesh;
        (mesh.x, mesh.y)
    };
    let spall = "(on: outer, angle_deg: 93.0, form: spall(length_mm: 5.0, depth_mm: 0.2, edge: rectangular))";
    let listed = scene(spall);
    let mut single = scene("");
    single.defect = listed.spalls().pop();
    assert_eq!(nodes(&listed), nodes(&single));
    // Three of them carry their load.
    let others = "(on: outer, angle_deg: 78.0, \
        form: spall(length_mm: 5.0, depth_mm: 0.1, edge: rectangular)), \
        (on: inner, angle_deg: 90.0, form: spall(length_mm: 6.0, depth_mm: 0.2, edge: rectangular))";
    let scene = running(&format!("{spall}, {others}"), 1.0);
    let folder = Scratch::new("defects-grooves");
    let dir = RunDir::create(folder.path()).expect("the folder is new");
    let info = simulate(&scene, &dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("it runs");
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!(info.energy.max_relative_error < 0.01, "{}", info.energy.max_relative_error);
}

#[test]
fn conserves_energy_and_carries_the_load_over_every_form() {
    let scene = running(ALL, 2.5);
    // Roller 2, too small by 8 µm, carries less than a healthy one in its place would.
    let mut round = scene.clone();
    round.defects.retain(|deviation| deviation.on != RollingSurface::Roller(2));
    let one = |scene: &Scene| {
        let folder = Scratch::new("defects");
        let dir = RunDir::create(folder.path()).expect("the folder is new");
        let info = simulate(scene, &dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("it runs");
        (info, Run::read(folder.path()).expect("a finished run can be read"))
    };
    let runs = side_by_side(&[&scene, &round], |scene| one(scene));
    let [(info, run), (_, other)] = &runs[..] else { unreachable!("two scenes were run") };
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!(info.energy.max_relative_error < 0.01, "{}", info.energy.max_relative_error);
    let up = |i: usize| {
        run.trace
            .channel(&format!("roller.{i}.outer_fy_n"))
            .expect("readable")
            .expect("every roller is recorded")
    };
    let samples = run.trace.len();
    let carried: f64 = (1..=scene.bearing.rollers).map(|i| -up(i).iter().sum::<f64>() / samples as f64).sum();
    // Over two and a half milliseconds the adapter still swings a little on the bearing.
    assert!((carried / info.expected_support_n - 1.0).abs() < 0.05, "{carried}");
    let mean = |run: &Run| {
        let [x, y] = ["x", "y"].map(|c| {
            run.trace.channel(&format!("roller.2.outer_f{c}_n")).expect("readable").expect("recorded")
        });
        x.iter().zip(&y).map(|(x, y)| x.hypot(*y)).sum::<f64>() / samples as f64
    };
    assert!(mean(run) < 0.9 * mean(other), "{} {}", mean(run), mean(other));
}

/// Oil over the defects that a scene allows under it: a gentle dent, a rounded spall, waves and a small
/// roller.
#[test]
fn conserves_energy_in_oil() {
    let mut scene = fine_where_it_rolls(2.5);
    scene.defect = None;
    let defects = "(on: outer, angle_deg: 93.0, \
        form: spall(length_mm: 6.0, depth_mm: 0.1, edge_mm: 2.0, edge: rounded)), \
        (on: inner, angle_deg: 88.0, form: dent(length_mm: 6.0, depth_mm: 0.05, rim_um: 8.0)), \
        (on: outer, form: roughness(rq_um: 0.5, longest_mm: 20.0, shortest_mm: 5.0)), \
        (on: roller(2), form: diameter(larger_um: -8.0))";
    let scene = scene.with_overrides(&[format!("defects=[{defects}]")]).expect("oil goes with these");
    assert!(scene.film.is_some());
    let folder = Scratch::new("defects-oil");
    let dir = RunDir::create(folder.path()).expect("the folder is new");
    let info = simulate(&scene, &dir, &host(1), &mut |_| ControlFlow::Continue(())).expect("it runs");
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    assert!(info.energy.max_relative_error < 0.01, "{}", info.energy.max_relative_error);
    let kinked = scene.with_overrides(&["defects=[(on: outer, form: spall())]"]);
    assert!(kinked.expect_err("a kink").to_string().contains("oil needs round rollers"));
}
