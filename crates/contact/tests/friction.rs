//! Coulomb friction: sliding to a stop, sticking on a slope, from sliding to rolling; penalty and flight.

mod common;
use common::*;
use stribeck_contact::{Contacts, Law, Method};
use stribeck_mesh::Part;
use stribeck_solver::{Behaviour, Dynamics, Force, Model, Motion};
use stribeck_testing::{assert_close, ledger};

/// Acceleration of gravity [m/s²].
const G: f64 = 9.81;

/// Penalty stiffness [Pa/m] under light bodies: they sink by less than 0.1 µm.
const STIFFNESS: f64 = 1e11;

/// Time step [s]: nothing deforms, and the bodies on their springs are a hundred times slower.
const STEP: f64 = 1e-6;

/// A rigid body on a fixed floor.
struct OnFloor {
    d: Dynamics,
    contacts: Contacts,
    model: Model,
}

impl OnFloor {
    fn new(part: &Part, surface: &str, law: Law, method: Method, gravity: [f64; 2]) -> Self {
        let mut scene = Scene::default();
        let body = scene.add("body", part, surface);
        // No node of the floor lies below the centre of a disc: inside a polygon the nearest point is on one of the two
        // sides of a corner, not the corner, and the second pass would have to choose one.
        let floor = scene.add("floor", &rectangle([-0.0205, -1e-3], 0.08, 1e-3, 80, 1), "top");
        scene.pair(body, floor, law, method);
        let mut model = scene.model();
        model.behaviour[body] = Behaviour::Rigid;
        model.motion[model.mesh.bodies[floor].nodes.clone()].fill(Motion::Held);
        model.gravity = gravity;
        let (mut d, contacts) = scene.lay_out(&model);
        d.set_time_step(STEP).expect("a positive time step");
        Self { d, contacts, model }
    }

    fn mass(&self) -> f64 {
        self.model.mesh.bodies[0].nodes.clone().map(|n| self.d.mass()[slot(&self.d, n)]).sum()
    }

    /// Runs for `span` [s].
    fn run(&mut self, span: f64) {
        for _ in 0..(span / STEP) as usize {
            self.d.step(&mut [&mut self.contacts]);
        }
    }

    fn velocity(&self) -> [f64; 2] {
        self.d.rigid[0].velocity
    }

    fn centre(&self) -> [f64; 2] {
        self.d.rigid[0].centre
    }
}

/// A block of 10 × 5 mm that already rests in the floor as deep as its weight presses it.
fn block(friction: f64, method: Method, slope: f64) -> OnFloor {
    let law = Law::penalty(STIFFNESS)
        .and_then(|l| l.with_friction(friction))
        .and_then(|l| l.with_damping(0.5, steel().density() * 5e-3))
        .expect("a possible law");
    let sunk = steel().density() * 5e-3 * G * slope.cos() / STIFFNESS;
    let part = rectangle([0.0, -sunk], 0.01, 5e-3, 10, 5);
    OnFloor::new(&part, "bottom", law, method, [G * slope.sin(), -G * slope.cos()])
}

/// Source: Coulomb's law, THEORY §4.3.
#[test]
fn analytic_block_slides_to_a_stop() {
    // It stops after v²/(2 µ g), in the time v/(µ g), its energy turned into heat.
    let (speed, friction) = (0.2, 0.2);
    for method in METHODS {
        let mut s = block(friction, method, 0.0);
        s.d.launch_rigid(0, [speed, 0.0], 0.0);
        let from = s.centre()[0];
        s.run(0.9 * speed / (friction * G));
        assert_close(s.velocity()[0], 0.1 * speed, 0.02, "speed left after nine tenths of the time");
        s.run(0.3 * speed / (friction * G));
        let stopped = s.centre()[0];
        assert_close(stopped - from, speed * speed / (2.0 * friction * G), 0.005, "way to stop");
        let energy = 0.5 * s.mass() * speed * speed;
        assert_close(s.contacts.energy().friction, energy, 0.01, "heat of friction");
        // Then it stays, but for the swing of the tangential springs.
        s.run(0.05);
        assert!((s.centre()[0] - stopped).abs() < 1e-7, "it creeps by {:e} m", s.centre()[0] - stopped);
    }
}

/// Source: Coulomb's law, THEORY §4.3.
#[test]
fn analytic_block_sticks_below_the_angle_of_friction() {
    // µ = 0.2 holds up to 11.3°.
    for method in METHODS {
        let mut s = block(0.2, method, 10_f64.to_radians());
        s.run(0.05);
        let (early, [vx, _]) = (s.centre()[0], s.velocity());
        // The weight comes on suddenly: the springs swing to twice their static stretch before it settles.
        let stretch = steel().density() * 5e-3 * G / (0.8 * STIFFNESS);
        assert!(early - 5e-3 < 10.0 * stretch, "{method:?}: it has slid {:e} m", early - 5e-3);
        s.run(0.1);
        // A tenth of a second of sliding under a hundredth of the weight would be half a millimetre.
        assert!(
            (s.centre()[0] - early).abs() < 2.0 * stretch,
            "{method:?}: creep {:e} m",
            s.centre()[0] - early
        );
        assert!(vx.abs() < 1e-3);
    }
}

/// Source: Coulomb's law, THEORY §4.3.
#[test]
fn analytic_block_slides_above_the_angle_of_friction() {
    // a = g (sin α − µ cos α).
    let slope = 16_f64.to_radians();
    let (expected, span) = (G * (slope.sin() - 0.2 * slope.cos()), 0.05);
    for method in METHODS {
        let mut s = block(0.2, method, slope);
        s.run(0.01);
        let (v, t) = (s.velocity()[0], s.d.state.time);
        s.run(span);
        let found = (s.velocity()[0] - v) / (s.d.state.time - t);
        let how = if method == Method::Collocated { "collocated" } else { "integrated" };
        let source = "g (sin α − µ cos α)";
        ledger::compare(
            &format!("block on a slope, acceleration, {how}"),
            source,
            "m/s²",
            found,
            expected,
            0.005,
        );
    }
}

/// Source: Kleppner and Kolenkow, *An Introduction to Mechanics* (2014), chapter 7.
#[test]
fn analytic_from_sliding_to_rolling() {
    // A disc set down at v₀ without spin: friction passes through the contact, about which the angular momentum
    // m v r + I ω is kept, so that it ends rolling at v₀ r²/(r² + I/m), 2/3 v₀ for a full disc, whatever µ is.
    let (radius, speed, friction) = (0.02, 0.15, 0.3);
    let law = Law::penalty(1e13)
        .and_then(|l| l.with_friction(friction))
        .and_then(|l| l.with_damping(0.3, 10.0))
        .expect("a possible law");
    // A polygon rolls over its corners; with 256 of them they lift it by 1.5 µm, 0.2 % of its energy.
    let part = disc(radius, 256, 1.5e-3).translated(0.0, radius);
    let mut s = OnFloor::new(&part, "rim", law, Method::Integrated { points: 4 }, [0.0, -G]);
    let mass = s.mass();
    let body = s.d.rigid_motion(&of_body(&s.d, &s.model, 0));
    s.d.launch_rigid(0, [speed, 0.0], 0.0);
    // While it slides it slows down by µ g.
    s.run(0.01);
    assert_close(s.velocity()[0], speed - friction * G * 0.01, 0.02, "speed while it slides");
    s.run(0.02);
    let expected = speed * radius * radius / (radius * radius + body.inertia / mass);
    assert_close(expected, 2.0 / 3.0 * speed, 0.01, "this polygon against a disc");
    // Mean over ten milliseconds: the corners make it rock.
    let (from, angle) = (s.centre()[0], s.d.rigid[0].angle);
    s.run(0.01);
    let (way, turn) = (s.centre()[0] - from, s.d.rigid[0].angle - angle);
    ledger::compare("from sliding to rolling, speed", "v₀ r²/(r² + I/m)", "m/s", way / 0.01, expected, 0.01);
    assert_close(-turn * radius, way, 0.01, "it rolls without slip, clockwise to the right");
}

/// Source: Kleppner and Kolenkow, *An Introduction to Mechanics* (2014), chapter 5.
#[test]
fn analytic_bouncing_disc() {
    // Dropped from h it comes back to h; the flight between two contacts lasts 2 √(2h/g).
    let (radius, height) = (5e-3, 0.1e-3);
    let part = disc(radius, 64, 0.5e-3).translated(0.0, radius + height);
    let law = Law::penalty(1e12).expect("a positive stiffness");
    let mut s = OnFloor::new(&part, "rim", law, Method::Collocated, [0.0, -G]);
    let (mut lifts, mut lands, mut highest, mut touching) = (Vec::new(), Vec::new(), 0.0_f64, false);
    while lands.len() < 4 {
        s.run(STEP);
        let touches = s.contacts.resultants().any(|r| r.force[1] > 0.0);
        if touches && !touching {
            lands.push(s.d.state.time);
        } else if touching && !touches {
            lifts.push(s.d.state.time);
        }
        touching = touches;
        if !lifts.is_empty() {
            highest = highest.max(s.centre()[1] - radius);
        }
        assert!(s.d.state.time < 0.1, "it stopped bouncing: {lands:?}");
    }
    // Time is counted in steps, and each contact sets in within one.
    ledger::compare("bouncing disc, first fall", "√(2h/g)", "s", lands[0], (2.0 * height / G).sqrt(), 1e-3);
    for (lift, land) in lifts.iter().zip(&lands[1..]) {
        assert_close(land - lift, 2.0 * (2.0 * height / G).sqrt(), 2e-3, "flight");
    }
    ledger::compare("bouncing disc, height of the rebound", "energy", "m", highest, height, 2e-3);
    // It bounces on a corner, an unstable place: rounding grows a thousandfold in each bounce, but to nothing yet.
    assert!(s.d.rigid[0].spin.abs() < 1e-3, "{:?}", s.d.rigid[0]);
}

#[test]
fn example_penetration_is_pressure_over_stiffness() {
    // A column on a floor, in equilibrium: it sinks by ρ g H/k, and the resultant is its weight.
    let (height, width) = (0.01, 0.02);
    for (method, tolerance) in [
        // The floor's nodes stand 0.3 mm off the column's, so that it leans a little.
        (Method::Collocated, 1e-3),
        // Corners have a point of their own: half a share at each end, beside 20 cells of 3.
        (Method::Integrated { points: 3 }, 1.0 / 60.0 + 1e-3),
    ] {
        let mut scene = Scene::default();
        let column = scene.add("column", &rectangle([0.0, 0.0], width, height, 20, 10), "bottom");
        // No contact point of the floor lies below an edge of the column: whether it projects onto the column would hang
        // on rounding.
        let floor = scene.add("floor", &rectangle([-0.0103, -1e-3], 0.04, 1e-3, 40, 1), "top");
        scene.pair(column, floor, Law::penalty(STIFFNESS).expect("a positive stiffness"), method);
        let mut model = scene.model();
        model.gravity = [0.0, -G];
        // No sideways motion: the pressure is then the same everywhere.
        model.motion[model.mesh.bodies[column].nodes.clone()].fill(Motion::HeldX);
        model.motion[model.mesh.bodies[floor].nodes.clone()].fill(Motion::Held);
        let (mut d, mut contacts) = scene.lay_out(&model);
        let bodies = vec![("column".to_owned(), of_body(&d, &model, column))];
        let mut no_load = stribeck_solver::force::NodalLoad::default();
        preload(&mut d, &mut contacts, &mut no_load, bodies, &[1e-8, 1e-9, 0.0], 1e-7);
        let found = contacts.resultants().next().expect("one pair");
        let pressure = steel().density() * G * height;
        assert_close(found.penetration, pressure / STIFFNESS, tolerance, "penetration");
        assert_close(found.force[1], pressure * width * THICKNESS, 1e-4, "resultant, up on the first");
        assert!(found.force[0].abs() < 1e-9);
    }
}
