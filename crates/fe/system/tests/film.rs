//! Oil between a roller and a wall: what films do to bodies in motion.

use stribeck_contact::{Law, Oil};
use stribeck_mesh::{Disc, Rectangle};
use stribeck_solver::{Elastic, NodeMotion};
use stribeck_system::{Film, Pair, Plan, Preload, System};

/// The roller [m] and the out-of-plane thickness [m].
const RADIUS: f64 = 9e-3;
const LENGTH: f64 = 30e-3;
const FACETS: usize = 56;

/// Penalty stiffness of contact [Pa/m].
const STIFFNESS: f64 = 2e14;

/// Thinnest film [m]: so thin that it plays no part.
const LEAST: f64 = 1e-9;

fn steel() -> Elastic {
    Elastic::new(208e9, 0.3, 7800.0).expect("steel is a possible material")
}

/// A roller `gap` above a wall whose bottom is held or free, at `x` along it, with oil between them.
fn above_wall(x: f64, gap: f64, viscosity: f64, held: bool) -> Plan {
    let mut plan = dry(x, gap, held);
    pour(&mut plan, Oil { viscosity, least: LEAST }, 0.0);
    plan
}

/// Puts oil under the roller of a plan.
fn pour(plan: &mut Plan, oil: Oil, speed: f64) {
    let centre = plan.nodes("roller.centre").expect("a mark")[0];
    let (round, track) = ("roller.rim".to_owned(), "wall.top".to_owned());
    plan.film(Film { round, centre, track, oil, stiffness: STIFFNESS, length: LENGTH, speed })
        .expect("two surfaces");
}

/// The same without oil.
fn dry(x: f64, gap: f64, held: bool) -> Plan {
    let mut plan = Plan::new(LENGTH);
    let wall = Rectangle { x0: -0.02, y0: -0.006, width: 0.04, height: 0.006, columns: 40, rows: 6 };
    plan.add("wall", &wall.part().expect("a rectangle"), steel()).expect("a new name");
    let disc = Disc { radius: RADIUS, facets: FACETS, size: 1e-3, rotation: -0.25 * std::f64::consts::TAU };
    let disc = disc.part().expect("a disc").translated(x, RADIUS + gap);
    plan.add("roller", &disc, steel()).expect("a new name");
    if held {
        plan.constrain("wall.bottom", NodeMotion::Held).expect("a surface");
    }
    plan.contact(Pair::new("roller.rim", "wall.top", Law::penalty(STIFFNESS).expect("a law")))
        .expect("two surfaces");
    plan
}

fn thickness(system: &System) -> f64 {
    system.films().next().expect("a film").thickness
}

/// Under a constant load W the film of pure squeeze has W = −12π η L (R/2h)^{3/2} dh/dt, so h^{-1/2} grows by
/// W/(24π η L) (2/R)^{3/2} a second. A. Cameron, The Principles of Lubrication, Longmans 1966, chapter 7.
#[test]
fn analytic_a_roller_sinks_through_oil() {
    const TOLERANCE: f64 = 0.02;
    let (viscosity, load) = (5.0, 2000.0);
    let mut plan = above_wall(0.0, 40e-6, viscosity, true);
    let mass = std::f64::consts::PI * RADIUS * RADIUS * LENGTH * 7800.0;
    plan.model.gravity = [0.0, -load / mass];
    let mut system = plan.build(1).expect("a valid plan");
    system.set_time_step_factor(0.9).expect("elements are stiff");
    let mass: f64 = system.nodes("roller").expect("a body").iter().map(|&n| system.mass(n)).sum();
    let load = load / (std::f64::consts::PI * RADIUS * RADIUS * LENGTH * 7800.0) * mass;
    // Inertia: mass over film damping is a few microseconds.
    system.run_until(50e-6).expect("a time step is set");
    let (start, first) = (system.time(), thickness(&system));
    let rate = load / (24.0 * std::f64::consts::PI * viscosity * LENGTH) * (2.0 / RADIUS).powf(1.5);
    let mut worst = 0.0_f64;
    while thickness(&system) > 4e-6 {
        system.run_until(system.time() + 10e-6).expect("a time step is set");
        let expected = (first.powf(-0.5) + rate * (system.time() - start)).powi(-2);
        worst = worst.max((thickness(&system) / expected - 1.0).abs());
    }
    println!(
        "sank from {:.1} to {:.1} µm, {:.2} % off at worst",
        1e6 * first,
        1e6 * thickness(&system),
        100.0 * worst
    );
    assert!(worst < TOLERANCE, "{worst}");
}

/// Rolling at the entrainment speed u carries W = 4.9 η u R L/h. H. M. Martin, Engineering 102 (1916) 119.
#[test]
fn analytic_a_rolling_roller_floats() {
    const TOLERANCE: f64 = 0.02;
    let (viscosity, speed) = (0.05, 2.0);
    for load in [5.0, 20.0] {
        let mut plan = above_wall(-6e-3, 30e-6, viscosity, true);
        let mass = std::f64::consts::PI * RADIUS * RADIUS * LENGTH * 7800.0;
        plan.model.gravity = [0.0, -load / mass];
        let mut system = plan.build(1).expect("a valid plan");
        system.set_time_step_factor(0.9).expect("elements are stiff");
        let roller = system.body("roller").expect("a body");
        let load = load / mass * system.motion_of(roller).mass;
        system.launch(roller, [speed, 0.0], -speed / RADIUS);
        system.run_until(5e-3).expect("a time step is set");
        let (mut mean, mut samples) = (0.0, 0.0);
        while system.time() < 6e-3 {
            system.step().expect("a time step is set");
            (mean, samples) = (mean + thickness(&system), samples + 1.0);
        }
        let expected = 4.895 * viscosity * speed * RADIUS * LENGTH / load;
        let found = mean / samples;
        println!("{load:.2} N: {:.3} µm, expected {:.3} µm", 1e6 * found, 1e6 * expected);
        assert!((found / expected - 1.0).abs() < TOLERANCE, "{found} instead of {expected}");
    }
}

/// A roller that is thrown at a free wall through oil.
#[test]
fn conserves_momentum_and_energy_through_oil() {
    /// Of sums over a thousand nodes and twelve thousand steps.
    const ROUNDING: f64 = 1e-11;
    let mut system = above_wall(1.3e-3, 20e-6, 0.05, false).build(1).expect("a valid plan");
    system.set_time_step_factor(0.5).expect("elements are stiff");
    let [roller, wall] = ["roller", "wall"].map(|name| system.body(name).expect("a body"));
    system.launch(roller, [0.4, -0.5], 30.0);
    let momentum = |system: &System| {
        let mut sum = [0.0; 3];
        for node in [wall, roller].into_iter().flat_map(|body| system.nodes_of(body)) {
            let (m, [x, y], [vx, vy]) = (system.mass(node), system.position(node), system.velocity(node));
            sum[0] += m * vx;
            sum[1] += m * vy;
            sum[2] += m * (x * vy - y * vx);
        }
        sum
    };
    system.step().expect("a time step is set");
    let before = momentum(&system);
    let mut pushed = 0.0_f64;
    let mut worst = 0.0_f64;
    system
        .run(12_000, 20, |system, ledger| {
            let film = system.films().next().expect("a film");
            pushed = pushed.max(film.force[1]);
            assert!(film.force[1] >= 0.0, "it pulls: {film:?}");
            worst = worst.max(ledger.relative_error);
        })
        .expect("a time step is set");
    let after = momentum(&system);
    println!("{before:?} {after:?} {pushed} N, {worst}, {:?}", system.last_ledger());
    assert!(pushed > 100.0, "{pushed} N");
    for k in 0..2 {
        assert!((after[k] - before[k]).abs() < ROUNDING * before[1].abs(), "{k}: {before:?} {after:?}");
    }
    // Where they are placed the two forces have no moment; until they are updated, after sixteen steps, their
    // points of action slide apart.
    let impulse = 2.0 * before[1].abs();
    let lever = 16.0 * system.time_step() * (0.4 + 30.0 * RADIUS);
    assert!((after[2] - before[2]).abs() < impulse * lever, "{before:?} {after:?}");
    assert!(worst < 1e-3, "{worst}");
}

/// Half the time step halves the error of a film that is squeezed: its thickness is stepped by implicit
/// Euler, E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, Springer 1993,
/// II.3.
#[test]
fn converges_with_the_time_step() {
    /// Fitted over three halvings; the pattern of looks is not the same for all.
    const ORDERS: std::ops::RangeInclusive<f64> = 0.8..=2.3;
    let thickness_after = |factor: f64| {
        let mut system = above_wall(0.0, 6e-6, 0.05, true).build(1).expect("a valid plan");
        let step = system.set_time_step_factor(0.9).expect("elements are stiff") * factor;
        system.set_time_step(step, None).expect("a positive one");
        let roller = system.body("roller").expect("a body");
        system.launch(roller, [0.0, -0.2], 0.0);
        let steps = (40e-6 / step).round();
        system.set_time_step(40e-6 / steps, None).expect("a positive one");
        (0..steps as u64).for_each(|_| system.step().expect("a time step is set"));
        thickness(&system)
    };
    let found = [1.0, 0.5, 0.25, 0.03125].map(thickness_after);
    let errors = [0, 1, 2].map(|n| (found[n] - found[3]).abs());
    let order = 0.5 * (errors[0] / errors[2]).log2();
    println!("{found:?} {errors:?}, order {order:.2}");
    assert!(ORDERS.contains(&order), "{order}: {errors:?}");
    assert!(errors[0] < 2e-3 * found[3], "{errors:?} of {}", found[3]);
}

/// A contact that carries more than its film can lift is as stiff as a dry one, in the preload and in motion.
#[test]
fn invariant_a_loaded_contact_is_as_dry() {
    /// What preloads of either leave unbalanced, 3·10⁻⁶ N, over contact of 10⁸ N/m [m] and its motion
    /// thereafter.
    const TOLERANCE: f64 = 1e-13;
    let least = 1e-6;
    let [mut oiled, mut dry] = [true, false].map(|oil| {
        let mut plan = dry(0.0, 0.0, true);
        if oil {
            // At most 70 N of 3 kN.
            pour(&mut plan, Oil { viscosity: 0.05, least }, 1.0);
        }
        plan.model.gravity = [0.0, -5e4];
        let mut system = plan.build(1).expect("a valid plan");
        let strict = Preload { load: Some(30.0), ..Preload::default() };
        system.settle(&strict).expect("the wall holds it");
        system.set_time_step(5e-8, None).expect("a positive one");
        let roller = system.body("roller").expect("a body");
        system.launch(roller, [0.0, -1e-3], 0.0);
        system
    });
    let apart = |oiled: &System, dry: &System| {
        let of = |n| {
            let ([ax, ay], [bx, by]) = (oiled.position(n), dry.position(n));
            (ax - bx).hypot(ay - by)
        };
        (0..dry.node_count() as u32).map(of).fold(0.0, f64::max)
    };
    println!("settled {:e} m apart", apart(&oiled, &dry));
    for _ in 0..500 {
        oiled.step().expect("a time step is set");
        dry.step().expect("a time step is set");
        let film = oiled.films().next().expect("a film");
        assert!(film.force == [0.0; 2] && film.thickness == least, "{film:?}");
    }
    let apart = apart(&oiled, &dry);
    println!("{apart:e} m apart");
    assert!(apart < TOLERANCE, "{apart}");
}
