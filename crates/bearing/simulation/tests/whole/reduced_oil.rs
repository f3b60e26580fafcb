//! Oil in the reduced model: beside the full one from the same start, its energy, and that a run goes on to
//! the same bytes.

use std::f64::consts::TAU;

use crate::common::{assert_goes_on_with_the_same_bytes, channel, run, trace};
use stribeck_scene::scene::{ModelScene, ReducedScene, Scene};
use stribeck_store::{
    run_info::{RunInfo, Status},
    trace::Trace,
};
use stribeck_testing::Scratch;

/// The paper's bearing, coarse, with its oil.
fn coarse(duration_ms: f64) -> Scene {
    let mut scene = Scene { name: "oil".into(), ..Scene::default() };
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, ..ReducedScene::default() });
    scene.mesh.size_mm = 2.0;
    scene.mesh.roller_facets = 88;
    scene.contact.penalty_scale = 0.2;
    scene.solver.duration_ms = duration_ms;
    scene.output.frames = None;
    scene
}

fn complete(scene: &Scene, folder: &Scratch, name: &str) -> RunInfo {
    let info = run(scene, folder, name, 1);
    assert_eq!(info.status, Status::Complete, "{:?}", info.stop_reason);
    info
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A place in a vector of eight without a roller had a direction that was no number, and its film of no force
/// made the work of the drive none: every bearing in oil stopped at its first sample, but for those with
/// eight, sixteen or twenty-four rollers.
#[test]
fn issue_oil_of_rollers_that_fill_no_vector() {
    let folder = Scratch::create("oil-nine");
    for rollers in [9, 23] {
        let mut scene = coarse(0.5);
        scene.bearing.rollers = rollers;
        let name = format!("{rollers}");
        let info = complete(&scene, &folder, &name);
        assert!(info.energy.max_relative_error < 0.01, "{:?}", info.energy);
        let trace = trace(&folder, &name);
        assert!(channel(&trace, "roller.1.outer_fy_n").iter().all(|force| force.is_finite()));
    }
}

#[test]
fn invariant_a_run_with_oil_in_pieces_writes_the_same_bytes() {
    let folder = Scratch::create("oil-pieces");
    // Roller 1 goes into the defect, where films end and begin; another is not round, so that films remember
    // a place on its rim.
    let scene = coarse(3.0).with_overrides(&[
        "defects=[(on: roller(9), form: waviness(order: 8, amplitude_um: 1.0))]".to_owned(),
    ]);
    let scene = scene.expect("a scene");
    assert_goes_on_with_the_same_bytes(&scene, &folder, 161);
}

/// Energy of 12 ms, in which a roller falls into the defect, and the load on the raceway: contact and films
/// carry it together.
#[test]
fn conserves_energy_and_carries_the_load_with_oil() {
    // As of dry contact at this step (`conserves_energy_and_carries_the_load`); films add the error of an
    // implicit step of the first order, which their heat contains.
    const ENERGY: f64 = 0.005;
    // The load over a period of the rollers, 5 ms, of which 12 ms are no multiple: the error of the last part
    // of one.
    const LOAD: f64 = 0.01;
    let folder = Scratch::create("oil-energy");
    let mut scene = coarse(12.0);
    scene.model = ModelScene::Reduced(ReducedScene { modes_khz: 15.0, step_us: 1.0 });
    let info = complete(&scene, &folder, "run");
    assert!(info.energy.max_relative_error < ENERGY, "{}", info.energy.max_relative_error);
    let trace = trace(&folder, "run");
    let mut sum = 0.0;
    for i in 1..=24 {
        let force = channel(&trace, &format!("roller.{i}.outer_fy_n"));
        sum += force.iter().sum::<f64>() / force.len() as f64;
    }
    println!(
        "off by {:.3} %, {:.0} N of {:.0}",
        100.0 * info.energy.max_relative_error,
        -sum,
        info.expected_support_n
    );
    assert!((-sum / info.expected_support_n - 1.0).abs() < LOAD, "{sum} N");
}

/// Full and reduced model from one start, until a roller has left the defect.
#[test]
fn peer_films_are_those_of_the_full_model() {
    // Means over a quarter of a millisecond, over the largest: as without oil, where nodes of a coarse mesh
    // lie changes the stiffness of contacts by ±4 % (THEORY §9.6).
    const FORCES: f64 = 0.03;
    // By as much the rings approach each other more or less under the load, some 20 µm: by 0.8 µm; and an
    // inner ring without modes is out of round by a micrometre less.
    const CLEARANCE_M: f64 = 2e-6;
    // A roller brings ½ m v² of its fall across the clearance, in proportion to the way: 2 of 20 to 40 µm.
    const HEAT: f64 = 0.1;
    let folder = Scratch::create("oil-models");
    let mut scene = coarse(6.0);
    // The reduced model has none in the inner ring, which would take a tenth of what films do here.
    scene.solver.structural_damping = None;
    complete(&scene, &folder, "reduced");
    complete(&Scene { model: ModelScene::Full, ..scene.clone() }, &folder, "full");
    let traces = ["full", "reduced"].map(|name| trace(&folder, name));
    let least = scene.resolve().loaded_films().expect("a load").expect("oil").map(|film| film.least);
    let forces = |of: &Trace, i: usize, side: &str| -> Vec<f64> {
        let [x, y] = ["x", "y"].map(|c| channel(of, &format!("roller.{i}.{side}_f{c}_n")));
        x.iter().zip(y).map(|(x, y)| x.hypot(*y)).collect()
    };
    let (mut clearances, mut square, mut count, mut largest) = ([Vec::new(), Vec::new()], 0.0, 0, 0.0_f64);
    for i in 1..=24 {
        let mut idle = vec![true; channel(&traces[0], "time_s").len()];
        let mut thick: [Vec<f64>; 2] = [0, 1].map(|_| vec![0.0; idle.len()]);
        for (side, least) in ["outer", "inner"].into_iter().zip(least) {
            let both = [&traces[0], &traces[1]].map(|of| forces(of, i, side));
            let films = [&traces[0], &traces[1]].map(|of| channel(of, &format!("roller.{i}.{side}_film_m")));
            for n in 0..idle.len() {
                let force = both.each_ref().map(|forces| forces[n]);
                idle[n] &= force.iter().all(|&force| force < 50.0);
                if force.iter().all(|&force| force > 2000.0) {
                    // Solid in both.
                    assert!(films.iter().all(|film| film[n] == least), "roller {i}, sample {n}, {side}");
                }
                (0..2).for_each(|model| thick[model][n] += films[model][n]);
            }
            for (a, b) in both[0].chunks(25).zip(both[1].chunks(25)) {
                let [a, b] = [a, b].map(|part| part.iter().sum::<f64>() / part.len() as f64);
                (square, count, largest) = (square + (a - b).powi(2), count + 1, largest.max(a));
            }
        }
        for (all, thick) in clearances.iter_mut().zip(thick) {
            all.extend(thick.iter().zip(&idle).filter(|(_, idle)| **idle).map(|(thick, _)| *thick));
        }
    }
    let off = (square / f64::from(count)).sqrt() / largest;
    let [full, reduced] = clearances.map(median);
    let heat = ["full", "reduced"].map(|name| {
        let energy = Trace::read(folder.join(name).join("energy.npy")).expect("a ledger");
        *channel(&energy, "film_j").last().expect("samples")
    });
    println!(
        "forces off by {:.2} %; both films of idle rollers {:.2} and {:.2} µm; heat {:.3} and {:.3} mJ",
        100.0 * off,
        1e6 * full,
        1e6 * reduced,
        1e3 * heat[0],
        1e3 * heat[1]
    );
    assert!(off < FORCES, "{off}");
    assert!((reduced - full).abs() < CLEARANCE_M, "{full} m, {reduced} m");
    assert!((heat[1] / heat[0] - 1.0).abs() < HEAT, "{} J, {} J", heat[0], heat[1]);
}

/// Both rings turn, the outer one with a dent under the oil, and a roller is missing: what drives them makes
/// good what films do, and forces and films are those of the full model.
#[test]
fn behaves_films_between_turning_rings() {
    // As of dry arrangements (`peer_arrangements_are_felt_as_by_the_full_model`).
    const ENERGY: f64 = 0.01;
    const FORCES: f64 = 0.03;
    // A film is as thick as the gap between the circles of roller and inner ring, its least thickness and
    // the deflection of the bodies under it: 0.4 µm at most where it carries less than 20 N (THEORY §4.6).
    const LITTLE_N: f64 = 20.0;
    const GIVEN_M: f64 = 5e-7;
    let text = "(bearing: \"NU 205\", model: reduced(modes_khz: 30, step_us: 0.5), defect: None, \
        housing: rigid(mass_kg: 1), \
        defects: [(on: roller(4), form: missing), \
        (on: outer, angle_deg: 20, form: dent(length_mm: 4, depth_mm: 0.02))], \
        mesh: (size_mm: 0.7, roller_facets: 64), output: (frames: None), \
        contact: (surface: arc, penalty_scale: 1, friction: 0.05), \
        solver: (duration_ms: 2, structural_damping: None), \
        operation: (load_n: 3000, load_angle_deg: 200, speed_rpm: 1500, outer_speed_rpm: -1000))";
    let scene = Scene::parse(text, "here").expect("a valid scene");
    let folder = Scratch::create("oil-turning");
    let info = complete(&scene, &folder, "reduced");
    complete(&Scene { model: ModelScene::Full, ..scene.clone() }, &folder, "full");
    let traces = ["full", "reduced"].map(|name| trace(&folder, name));
    let (mut square, mut count, mut largest) = (0.0, 0, 0.0_f64);
    let mut clearances = [Vec::new(), Vec::new()];
    let g = scene.resolve();
    let [_, least] = g.loaded_films().expect("a load").expect("oil").map(|film| film.least);
    let mut seen = 0;
    for (i, of) in scene.rollers_in_place().flat_map(|i| traces.iter().map(move |of| (i, of))) {
        let of = |what: &str| channel(of, &format!("roller.{i}.{what}"));
        let (x, y, film) = (of("x_m"), of("y_m"), of("inner_film_m"));
        let (fx, fy) = (of("inner_fx_n"), of("inner_fy_n"));
        for n in (0..film.len()).filter(|&n| fx[n].hypot(fy[n]) < LITTLE_N && (4e-6..5e-4).contains(&film[n]))
        {
            let gap = x[n].hypot(y[n]) - g.inner_race_radius - g.roller_radius;
            let given = film[n] - least - gap;
            assert!(
                given.abs() < GIVEN_M,
                "roller {i}, sample {n}: a film of {} m in a gap of {gap} m",
                film[n]
            );
            seen += 1;
        }
    }
    assert!(seen > 1000, "{seen} samples of floating rollers");
    for i in scene.rollers_in_place() {
        for c in ["x", "y"] {
            let [a, b] = traces.each_ref().map(|of| channel(of, &format!("roller.{i}.outer_f{c}_n")));
            for (a, b) in a.chunks(25).zip(b.chunks(25)) {
                let [a, b] = [a, b].map(|part| part.iter().sum::<f64>() / part.len() as f64);
                (square, count, largest) = (square + (a - b).powi(2), count + 1, largest.max(a.abs()));
            }
        }
        let thick = traces.each_ref().map(|of| {
            let [outer, inner] = ["outer", "inner"].map(|s| channel(of, &format!("roller.{i}.{s}_film_m")));
            outer.iter().zip(inner).map(|(outer, inner)| outer + inner).collect::<Vec<f64>>()
        });
        // Where it floats in both.
        for (a, b) in thick[0].iter().zip(&thick[1]).filter(|(a, b)| a.min(**b) > 4e-6) {
            clearances[0].push(*a);
            clearances[1].push(*b);
        }
    }
    let off = (square / f64::from(count)).sqrt() / largest;
    let [full, reduced] = clearances.map(median);
    println!(
        "off by {:.3} %, forces by {:.2} % of {largest:.0} N, both films {:.2} and {:.2} µm",
        100.0 * info.energy.max_relative_error,
        100.0 * off,
        1e6 * full,
        1e6 * reduced
    );
    assert!(info.energy.max_relative_error < ENERGY, "{}", info.energy.max_relative_error);
    assert!(off < FORCES, "{off}");
}

/// With few modes the panels of the seat respond with more than all of a roller's force: films, too, give
/// way with it within the step, and no pass over the panels may change more than the next one takes back. A
/// step late, this run is off by a quarter of its peak strain energy, and by less with longer steps.
#[test]
fn conserves_energy_while_films_answer_to_a_soft_seat() {
    let text = "(bearing: \"NU 203\", model: reduced(modes_khz: 8, step_us: 0.25), defect: None, cage: \
        (pocket: corners),
        operation: (load_n: 3000, speed_rpm: 1500), contact: (penalty_scale: 1, friction: 0.05),
        mesh: (size_mm: 0.36, roller_facets: 224), output: (frames: None),
        solver: (duration_ms: 15, mass_damping_per_s: 5000, structural_damping: None))";
    let scene = Scene::parse(text, "here").expect("a valid scene");
    let info = complete(&scene, &Scratch::create("reduced-soft-seat"), "run");
    println!("off by {:.2e} of the peak strain energy", info.energy.max_relative_error);
    assert!(info.energy.max_relative_error < 1e-3, "{:?}", info.energy);
}

/// A lightly loaded cylindrical roller bearing at high speed skids where oil resists: its cage loses a fifth of
/// its speed in 0.1 s and more, one that is loaded well less than two per cent, and one without resistance
/// nothing. Measured: Y. Guo, J. Keller, Tribology International 148 (2020) 106347, up to 60 %.
#[test]
fn issue_a_lightly_loaded_bearing_at_high_speed_skids() {
    let folder = Scratch::create("oil-skid");
    let slip = |name: &str, load_n: f64, resistance: &str| {
        let text = format!(
            "(bearing: \"NU 205\", model: reduced(), housing: machine(), defect: None, \
             operation: (load_n: {load_n}, speed_rpm: 15000), \
             film: (viscosity_pa_s: 0.01, resistance: {resistance}), \
             solver: (duration_ms: 100, mass_damping_per_s: 5000, structural_damping: None), \
             output: (interval_us: 20, frames: None))"
        );
        let scene = Scene::parse(&text, "skid").expect("a scene");
        let info = complete(&scene, &folder, name);
        assert!(info.energy.share_of_heat().is_some_and(|share| share < 0.005), "{name}: {:?}", info.energy);
        let angle = channel(&trace(&folder, name), "cage.angle_rad").to_vec();
        let late = angle.len() * 3 / 4;
        let turned = (angle[angle.len() - 1] - angle[late]).abs();
        let time = (angle.len() - 1 - late) as f64 * 20e-6;
        1.0 - turned / time / (TAU * scene.kinematics().cage_hz)
    };
    let [light, loaded, plain] = [("light", 130.0, "()"), ("loaded", 1100.0, "()"), ("plain", 130.0, "None")]
        .map(|(n, l, r)| slip(n, l, r));
    assert!((0.2..0.6).contains(&light), "{light}");
    assert!((0.0..0.02).contains(&loaded), "{loaded}");
    assert!(plain.abs() < 0.003, "{plain}");
}
