//! A shaft that is moved in a housing that stands still (THEORY §9.7), beside the bearing whose housing takes
//! the load, and beside balances that hold exactly.

use std::f64::consts::TAU;

use stribeck_reduced::{
    error::Error,
    motion::Energies,
    shaft::{BearingOnShaft, OnShaft, SavedOnShaft, ShaftPoint},
};
use stribeck_scene::scene::Scene;
use stribeck_simulation::reduced::{on_shaft, prepared};
use stribeck_simulation::reduction::dense;
use stribeck_testing::{Scratch, ledger::compare};

const LOAD_N: f64 = 3000.0;
const RIGID: &str = "housing: rigid(mass_kg: 1)";
const SPRINGS: &str = "housing: springs(stiffness_n_um: 200, damping_n_s_m: 3000, mass_kg: 20)";

/// A healthy NU 205 on a coarse mesh, dry, frictionless and without weight, under a load down to the left.
fn sound(more: &str) -> Scene {
    loaded(240, more)
}

/// The same under a load from elsewhere [°].
fn loaded(angle_deg: i32, more: &str) -> Scene {
    let text = format!(
        "(bearing: \"NU 205, elements=13\", model: reduced(modes_khz: 30, step_us: 0.5), film: None,
          defect: None, mesh: (size_mm: 0.7, roller_facets: 64), output: (frames: None),
          contact: (surface: arc, penalty_scale: 1, friction: 0),
          operation: (load_n: {LOAD_N}, load_angle_deg: {angle_deg}, speed_rpm: 600, gravity_m_s2: 0),
          solver: (duration_ms: 2, mass_damping_per_s: 0, structural_damping: None), {more})"
    );
    Scene::parse(&text, "here").expect("a valid scene")
}

fn parts(scene: &Scene, folder: &Scratch) -> OnShaft {
    on_shaft(&scene.resolve(), Some(folder.path())).expect("it can be reduced")
}

fn start(parts: &OnShaft, at: ShaftPoint) -> BearingOnShaft {
    BearingOnShaft::start(parts.clone(), at, &dense::solve).expect("an equilibrium")
}

fn at(displacement: [f64; 2]) -> ShaftPoint {
    ShaftPoint { displacement, velocity: [0.0; 2] }
}

/// Displacement of ring and housing as one piece when the housing takes the load [m].
fn under_load(scene: &Scene, parts: &OnShaft, folder: &Scratch) -> [f64; 2] {
    let prepared = prepared(&scene.resolve(), Some(folder.path())).expect("it can be reduced");
    let (r, shapes) = (prepared.bearing.reduction.padded, &prepared.bearing.reduction.shapes);
    let free = (0..prepared.bearing.reduction.modes).filter(|k| prepared.bearing.reduction.squares[*k] < 1e3);
    free.fold(parts.centre, |[x, y], k| {
        let q = prepared.start.q[k];
        [x + q * shapes[k], y + q * shapes[r + k]]
    })
}

/// A shaft that is displaced by as much as the load displaces the housing, the other way, has the load.
/// Source: the same bearing under that load, at the equilibrium that its runs start from (THEORY §9.5).
#[test]
fn analytic_a_displaced_shaft_has_the_load_of_its_displacement() {
    // On springs the ring takes its share of the mass, a four-hundredth, of the force that holds both.
    const TOLERANCE: f64 = 2e-3;
    for (name, housing) in [("rigid", RIGID), ("springs", SPRINGS)] {
        let folder = Scratch::create(&format!("shaft-static-{name}"));
        let scene = sound(housing);
        let parts = parts(&scene, &folder);
        let [x, y] = under_load(&scene, &parts, &folder);
        let mut bearing = start(&parts, at([-x, -y]));
        bearing.advance(2.0 * parts.time_step, at([-x, -y])).expect("it moves");
        let force = bearing.force().last;
        println!("{name}: shaft at {:.3} {:.3} µm, force {force:?} N", -1e6 * x, -1e6 * y);
        let (s, c) = 240.0_f64.to_radians().sin_cos();
        for (axis, got, along) in [("x", force[0], c), ("y", force[1], s)] {
            let what = format!("force along {axis} on a shaft displaced in a housing, {name}");
            compare(&what, "the same bearing under the load", "N", got, LOAD_N * along, TOLERANCE);
        }
    }
}

/// Mass of a rotor [kg] and the length of its steps [s].
const MASS: f64 = 10.0;
const STEP: f64 = 20e-6;

/// Places of a rotor under a load [N], with damping [N s/m], by leapfrog [m].
fn rotor(parts: &OnShaft, from: [f64; 2], load: [f64; 2], damping: f64, steps: usize) -> Vec<[f64; 2]> {
    let (mut u, mut v) = (from, [0.0; 2]);
    let mut bearing = start(parts, at(u));
    bearing.advance(STEP, at(u)).expect("it moves");
    let mut force = bearing.force().last;
    let mut places = Vec::new();
    for _ in 0..steps {
        for k in 0..2 {
            v[k] += STEP * (force[k] + load[k] - damping * v[k]) / MASS;
            u[k] += STEP * v[k];
        }
        bearing.advance(STEP, ShaftPoint { displacement: u, velocity: v }).expect("it moves");
        force = bearing.force().last;
        places.push(u);
    }
    places
}

/// The bearing at rest, because the place of a rotor varies by a micrometre as the cage turns on, with
/// friction that holds the rollers, which eccentric rings squeeze out of the load zone otherwise; the place
/// of a shaft under the opposite of the load on the housing, and that force.
fn at_rest(folder: &Scratch) -> (OnShaft, [f64; 2], [f64; 2]) {
    let mut scene = sound(RIGID);
    scene.operation.speed_rpm = 0.0;
    scene.contact.friction = 0.1;
    let parts = parts(&scene, folder);
    let [x, y] = under_load(&scene, &parts, folder);
    let (s, c) = 240.0_f64.to_radians().sin_cos();
    (parts, [-x, -y], [-LOAD_N * c, -LOAD_N * s])
}

/// A rotor on the bearing, damped, comes to rest where the load displaces the housing the other way. Source:
/// the same bearing under that load, at the equilibrium that its runs start from (THEORY §9.5).
#[test]
fn analytic_a_rotor_settles_where_the_load_displaces_the_housing() {
    const TOLERANCE: f64 = 1e-3;
    let folder = Scratch::create("shaft-rotor");
    let (parts, there, load) = at_rest(&folder);
    // A third of the critical damping of 10⁸ N/m.
    let places = rotor(&parts, there.map(|u| 0.75 * u), load, 2e4, 1500);
    let place = places[places.len() - 1];
    println!("shaft at {:?} µm", place.map(|u| 1e6 * u));
    for (got, want) in place.into_iter().zip(there) {
        assert!((got / want - 1.0).abs() < TOLERANCE, "{got:e} {want:e}");
    }
}

/// A rotor without damping does not swing farther and farther: a force that is late by a step of half a
/// microsecond would drive it by a half more in these 30 ms.
#[test]
fn invariant_the_force_on_the_shaft_is_not_late() {
    // Rounds of friction and the meeting of other rollers change single swings.
    const MORE: f64 = 1.1;
    let folder = Scratch::create("shaft-late");
    let (parts, there, load) = at_rest(&folder);
    let places = rotor(&parts, there.map(|u| 0.98 * u), load, 0.0, 1500);
    let away = |[x, y]: &[f64; 2]| (x - there[0]).hypot(y - there[1]);
    let most = |places: &[[f64; 2]]| places.iter().map(away).fold(0.0, f64::max);
    let (first, last) = (most(&places[..300]), most(&places[1200..]));
    println!("swings by {:.1} nm, then {:.1} nm", 1e9 * first, 1e9 * last);
    assert!(last < MORE * first, "{first:e} {last:e}");
}

/// Rollers with play that touch nothing stay where they are in space, however the shaft is accelerated.
#[test]
fn invariant_a_roller_that_touches_nothing_stays_where_it_is() {
    // Positions of centimetres are rounded to 10⁻¹⁸ m, some hundred steps add up.
    const ROUNDING: f64 = 1e-14;
    let folder = Scratch::create("shaft-free");
    let mut scene = sound(RIGID);
    scene.bearing.clearance_change_um = 400.0;
    scene.operation.speed_rpm = 0.0;
    scene.cage = None;
    let parts = parts(&scene, &folder);
    let mut bearing = start(&parts, at([0.0; 2]));
    let before: Vec<[f64; 2]> = bearing.motion().centres().collect();
    let (length, hz, far) = (13.7 * parts.time_step, 3000.0, 20e-6);
    let place = |t: f64| {
        let angle = TAU * hz * t;
        ShaftPoint {
            displacement: [far * (1.0 - angle.cos()), 0.5 * far * (1.0 - angle.cos())],
            velocity: [far * TAU * hz * angle.sin(), 0.5 * far * TAU * hz * angle.sin()],
        }
    };
    for n in 1..=40 {
        bearing.advance(length, place(f64::from(n) * length)).expect("it moves");
        assert_eq!(bearing.force().mean, [0.0; 2], "nothing is touched");
    }
    // The bearing is behind the last communication point by part of a step.
    let behind = 40.0 * length - bearing.motion().time();
    assert!((0.0..parts.time_step).contains(&behind), "{behind}");
    let last = place(40.0 * length);
    let moved = |c: usize| last.displacement[c] - behind * last.velocity[c];
    let curved = 0.5 * behind * behind * far * (TAU * hz).powi(2);
    for (old, new) in before.iter().zip(bearing.motion().centres()) {
        for c in 0..2 {
            let in_space = new[c] + moved(c) - old[c];
            assert!(in_space.abs() < ROUNDING + 2.0 * curved, "{in_space:e}");
        }
    }
}

fn stored(e: &Energies) -> f64 {
    e.kinetic + e.strain + e.contact + e.friction + e.damping + e.contact_damping + e.film
        - e.external
        - e.drive
}

/// Shaken by some micrometres at 400 Hz, the bearing gains what shaft, inertia and drive put in: the ledger
/// of the moving frame closes.
#[test]
fn conserves_energy_on_a_shaken_shaft() {
    // Share of the work that goes in and out: the error of steps of half a microsecond.
    const OFF: f64 = 2e-4;
    for (name, housing) in [("rigid", RIGID), ("springs", SPRINGS)] {
        let folder = Scratch::create(&format!("shaft-energy-{name}"));
        let mut scene = sound(housing);
        scene.contact.friction = 0.05;
        scene.solver.mass_damping_per_s = 2000.0;
        let parts = parts(&scene, &folder);
        let [x, y] = under_load(&scene, &parts, &folder);
        let place = |t: f64| {
            let angle = TAU * 400.0 * t;
            let (far, speed) = (4e-6 * (1.0 - angle.cos()), 4e-6 * TAU * 400.0 * angle.sin());
            ShaftPoint { displacement: [far - x, -0.7 * far - y], velocity: [speed, -0.7 * speed] }
        };
        let length = 20e-6;
        let mut bearing = start(&parts, place(0.0));
        let mut first = None;
        let (mut most, mut off) = (0.0_f64, 0.0_f64);
        for n in 1..=500 {
            let energies = bearing.advance(length, place(f64::from(n) * length)).expect("it moves");
            let first: &(f64, f64) = first.get_or_insert((stored(&energies), energies.external));
            most = most.max((energies.external - first.1).abs());
            off = off.max((stored(&energies) - first.0).abs());
        }
        println!("{name}: {:.3} mJ go in and out, off by {:.5} mJ", 1e3 * most, 1e3 * off);
        assert!(off < OFF * most, "{name}: {off:e} of {most:e} J");
    }
}

/// A state that is saved, put into bytes and back goes on with the same bits.
#[test]
fn roundtrip_a_saved_state_goes_on_with_the_same_bits() {
    let folder = Scratch::create("shaft-saved");
    let scene = sound(RIGID);
    let parts = parts(&scene, &folder);
    let [x, y] = under_load(&scene, &parts, &folder);
    let mut bearing = start(&parts, at([-x, -y]));
    let go = |bearing: &mut BearingOnShaft, n: i32| {
        let to = at([-x + 1e-8 * f64::from(n), -y]);
        bearing.advance(10.3e-6, to).expect("it moves");
        bearing.force()
    };
    (0..20).for_each(|n| {
        go(&mut bearing, n);
    });
    let bytes = postcard::to_stdvec(&bearing.saved()).expect("bytes");
    let ahead: Vec<_> = (20..40).map(|n| go(&mut bearing, n)).collect();
    let saved: SavedOnShaft = postcard::from_bytes(&bytes).expect("a state");
    bearing.go_on(saved).expect("its own state");
    let again: Vec<_> = (20..40).map(|n| go(&mut bearing, n)).collect();
    assert_eq!(ahead, again);
}

#[test]
fn refuses_what_cannot_be_moved() {
    let folder = Scratch::create("shaft-refused");
    let said = |result: Result<BearingOnShaft, Error>, words: &[&str]| {
        let told = result.map(|_| ()).expect_err("it is refused").to_string();
        assert!(words.iter().all(|word| told.contains(word)), "{told}");
    };
    let begin =
        |scene: &Scene, at: ShaftPoint| BearingOnShaft::start(parts(scene, &folder), at, &dense::solve);
    let guided = loaded(270, "housing: pedestal(width_mm: 70, base_mm: 35, top_mm: 35)");
    said(begin(&guided, at([0.0; 2])), &["guided", "housing: rigid()", "springs"]);
    let mut turning = sound(RIGID);
    turning.operation.outer_speed_rpm = 100.0;
    said(begin(&turning, at([0.0; 2])), &["outer ring turns", "outer_speed_rpm: 0"]);
    said(begin(&sound(RIGID), at([1.0, 0.0])), &["1000000.0 µm", "metres"]);
    said(begin(&sound(RIGID), at([f64::NAN, 0.0])), &["NaN µm"]);
    let mut bearing = begin(&sound(RIGID), at([0.0; 2])).expect("it starts");
    let told = bearing.advance(0.4e-6, at([0.0; 2])).expect_err("too short").to_string();
    assert!(told.contains("0.400 µs") && told.contains("two steps"), "{told}");
}
