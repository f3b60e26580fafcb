//! Bodies that hit each other: momentum, energy, the bar impact.

mod common;
use common::*;
use stribeck_contact::{Contacts, Law, Method, Smoothing};
use stribeck_solver::{Behaviour, Dynamics, Force, Motion};
use stribeck_testing::{assert_close, ledger};

/// Rounding of ten thousand sums of forces, relative to the momentum that is exchanged.
const MOMENTUM_ROUNDING: f64 = 1e-11;

fn penalty(size: f64) -> Law {
    // As stiff as an element of that size.
    Law::penalty(steel().plane_strain_modulus() / size).expect("a positive stiffness")
}

/// Largest change of a wheel's energy under central differences at a tenth of the critical step: where within a step the
/// points of contact set in is chance.
const LEAPFROG: f64 = 1e-3;

struct BarImpact {
    /// Contact time [s].
    time: f64,
    /// Force in the middle third of the contact [N].
    force: f64,
    /// Mean velocities of both bars after it [m/s].
    after: [f64; 2],
}

/// Two bars of `length` [m] meet at ±`speed` [m/s]; sides held, so that the strain is uniaxial.
fn bars(length: f64, cells: usize, speed: f64, method: Method) -> BarImpact {
    let size = length / cells as f64;
    let mut scene = Scene::default();
    let left = rectangle([-length, 0.0], length, 2.0 * size, cells, 2);
    let a = scene.add("left bar", &left, "right");
    let b = scene.add("right bar", &rectangle([1e-9, 0.0], length, 2.0 * size, cells, 2), "left");
    scene.pair(a, b, penalty(size), method);
    let mut model = scene.model();
    model.motion.fill(Motion::HeldY);
    let (mut d, mut contacts) = scene.lay_out(&model);
    // A contact sets in within a step; the energy that this gives or takes falls with the square of the step.
    set_step(&mut d, &contacts, 0.4);
    let bodies = [a, b].map(|body| of_body(&d, &model, body));
    launch(&mut d, &bodies[0], [speed, 0.0]);
    launch(&mut d, &bodies[1], [-speed, 0.0]);
    let mut history = Vec::new();
    let steps = (3.0 * length / steel().dilatational_speed() / d.time_step()) as usize;
    for _ in 0..steps {
        d.step(&mut [&mut contacts]);
        history.push(contacts.resultants().next().expect("one pair").force[0]);
    }
    let touched: Vec<usize> = (0..steps).filter(|&i| history[i] != 0.0).collect();
    let (first, last) = (touched[0], touched[touched.len() - 1]);
    let third = (last - first) / 3;
    let middle = &history[first + third..first + 2 * third];
    BarImpact {
        time: (last - first) as f64 * d.time_step(),
        force: -middle.iter().sum::<f64>() / third as f64 / (2.0 * size * THICKNESS),
        after: bodies.map(|body| d.rigid_motion(&body).velocity[0]),
    }
}

#[test]
fn analytic_two_equal_bars() {
    // Johnson, Contact Mechanics (1985), §11.1; Goldsmith, Impact (1960), §3.3: two bars that approach at 2 v stay in
    // contact for 2L/c under the stress ρ c v and exchange their velocities.
    let (length, speed) = (0.05, 1.0);
    let c = steel().dilatational_speed();
    for method in METHODS {
        let impact = bars(length, 200, speed, method);
        // The penalty spring and the dispersion of the front add about the time across two cells.
        let how = if method == Method::Collocated { "collocated" } else { "integrated" };
        let source = "2L/c: Johnson 1985, §11.1";
        ledger::compare(
            &format!("two equal bars, contact time, {how}"),
            source,
            "s",
            impact.time,
            2.0 * length / c,
            0.015,
        );
        // The force rings by some per cent about its plateau; a third of the contact averages most of it.
        let stress = steel().density() * c * speed;
        let source = "ρ c v: Goldsmith 1960, §3.3";
        ledger::compare(
            &format!("two equal bars, interface stress, {how}"),
            source,
            "Pa",
            impact.force,
            stress,
            0.01,
        );
        // A hundredth of the energy stays behind as ringing of cells.
        assert_close(impact.after[0], -speed, 0.01, "velocity of the left bar");
        assert_close(impact.after[1], speed, 0.01, "velocity of the right bar");
    }
}

/// Source: 2L/c: Johnson 1985, §11.1.
#[test]
fn converges_contact_time_of_bars() {
    let exact = 0.1 / steel().dilatational_speed();
    let errors =
        [50, 100, 200, 400].map(|cells| bars(0.05, cells, 1.0, Method::Collocated).time / exact - 1.0);
    // The front spreads with the third root of the distance in cells (order two thirds), the spring with the cell. The
    // instant of release rings, hence the rate over all three halvings.
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!((0.4..1.2).contains(&order), "order {order}, errors {errors:?}");
    assert!(errors[3] < 0.01, "{errors:?}");
}

/// Two free blocks that meet off centre at an angle: a flat side of one, a corner region of the other.
fn oblique(law: Law, method: Method) -> (Dynamics, Contacts, [Vec<u32>; 2]) {
    let mut scene = Scene::default();
    let lower = rectangle([-0.01, -0.01], 0.02, 0.01, 10, 5);
    let upper = rectangle([-0.004, 0.2e-3], 0.01, 0.01, 6, 6).rotated(0.004);
    let a = scene.add("lower", &lower, "top");
    let b = scene.add("upper", &upper, "bottom");
    scene.pair(a, b, law, method);
    let model = scene.model();
    let (mut d, contacts) = scene.lay_out(&model);
    set_step(&mut d, &contacts, 0.5);
    let bodies = [a, b].map(|body| of_body(&d, &model, body));
    launch(&mut d, &bodies[0], [0.0, 1.0]);
    launch(&mut d, &bodies[1], [0.5, -3.0]);
    (d, contacts, bodies)
}

#[test]
fn conserves_momentum_in_a_collision() {
    for method in METHODS {
        let (mut d, mut contacts, bodies) = oblique(penalty(2e-3), method);
        let (before, exchanged) = (momentum(&d), momentum_of(&d, &bodies[1])[1].abs());
        let mut hardest = 0.0_f64;
        for _ in 0..3000 {
            d.step(&mut [&mut contacts]);
            hardest = hardest.max(contacts.resultants().next().expect("one pair").force[1].abs());
        }
        assert!(hardest > 1e3, "they have met: {hardest} N");
        assert!(momentum_of(&d, &bodies[1])[1] > 0.0, "the upper block has bounced");
        let after = momentum(&d);
        for i in 0..2 {
            let drift = (after[i] - before[i]).abs() / exchanged;
            assert!(drift < MOMENTUM_ROUNDING, "{method:?}, component {i}: {drift:e}");
        }
        // Forces of penalty lie on one line: angular momentum is kept too (lever 1 cm).
        let drift = (after[2] - before[2]).abs() / (0.01 * exchanged);
        assert!(drift < MOMENTUM_ROUNDING, "{method:?}, angular: {drift:e}");
    }
}

fn momentum_of(d: &Dynamics, slots: &[u32]) -> [f64; 2] {
    let body = d.rigid_motion(slots);
    body.velocity.map(|v| body.mass * v)
}

#[test]
fn conserves_momentum_with_friction_and_damping() {
    for method in METHODS {
        let law =
            penalty(2e-3).with_friction(0.3).and_then(|l| l.with_damping(0.2, 7800.0 * 1e-3)).expect("a law");
        let (mut d, mut contacts, bodies) = oblique(law, method);
        let (before, exchanged) = (momentum(&d), momentum_of(&d, &bodies[1])[1].abs());
        for _ in 0..3000 {
            d.step(&mut [&mut contacts]);
        }
        assert!(contacts.energy().friction > 0.0 && contacts.energy().damping > 0.0);
        let after = momentum(&d);
        for i in 0..2 {
            let drift = (after[i] - before[i]).abs() / exchanged;
            assert!(drift < MOMENTUM_ROUNDING, "{method:?}, component {i}: {drift:e}");
        }
    }
}

#[test]
fn conserves_the_ledger_of_a_collision() {
    let lossy =
        penalty(2e-3).with_friction(0.3).and_then(|l| l.with_damping(0.2, 7800.0 * 1e-3)).expect("a law");
    for (name, law) in [("frictionless", penalty(2e-3)), ("friction and damping", lossy)] {
        for method in METHODS {
            let (mut d, mut contacts, _) = oblique(law, method);
            let start = step_and_balance(&mut d, &mut contacts).mechanical;
            let mut worst = 0.0_f64;
            let mut heat = [0.0; 2];
            for _ in 0..3000 {
                let now = step_and_balance(&mut d, &mut contacts);
                heat = now.heat;
                worst = worst.max((now.mechanical + heat[0] + heat[1] - start).abs());
            }
            // A spring that sets in within a step is not integrated exactly: part of a per mille.
            assert!(worst < 2e-3 * start, "{name}, {method:?}: {:e} of the energy is missing", worst / start);
            if law.friction > 0.0 {
                assert!(
                    heat[0] > 5e-3 * start && heat[1] > 5e-3 * start,
                    "{name}: heat {heat:?} J of {start} J"
                );
            } else {
                assert_eq!(heat, [0.0; 2]);
            }
        }
    }
}

/// Source: THEORY §2.5: the trapezoidal rule is of second order.
#[test]
fn converges_the_ledger_of_a_collision() {
    // What is missing falls with the square of the step: every term is counted over the same span as the others.
    let lossy =
        penalty(2e-3).with_friction(0.3).and_then(|l| l.with_damping(0.2, 7800.0 * 1e-3)).expect("a law");
    for (name, law) in [("frictionless", penalty(2e-3)), ("friction and damping", lossy)] {
        for method in METHODS {
            let missing = |refined: usize| {
                let (mut d, mut contacts, _) = oblique(law, method);
                d.set_time_step(d.time_step() / refined as f64).expect("a positive time step");
                let start = step_and_balance(&mut d, &mut contacts).mechanical;
                let mut worst = 0.0_f64;
                for _ in 0..3000 * refined {
                    let now = step_and_balance(&mut d, &mut contacts);
                    worst = worst.max((now.mechanical + now.heat[0] + now.heat[1] - start).abs());
                }
                worst / start
            };
            let (coarse, fine) = (missing(1), missing(8));
            // Where within a step a point sets in is chance, so the order scatters about two.
            let order = (coarse / fine).log2() / 3.0;
            assert!(order > 1.4, "{name}, {method:?}: order {order}, {coarse:e} to {fine:e}");
            assert!(fine < 4e-5, "{name}, {method:?}: {fine:e}");
        }
    }
}

#[test]
fn conserves_energy_over_a_hundred_bounces() {
    // A disc shuttles between two fixed plates; without damping and friction nothing is lost.
    let (radius, gap) = (5e-3, 20e-6);
    let mut scene = Scene::default();
    let disc_body = scene.add("disc", &disc(radius, 32, 1e-3), "rim");
    let floor = rectangle([-0.01, -radius - gap - 2e-3], 0.02, 2e-3, 20, 2);
    let ceiling = rectangle([-0.01, radius + gap], 0.02, 2e-3, 20, 2);
    let plates = [scene.add("floor", &floor, "top"), scene.add("ceiling", &ceiling, "bottom")];
    for plate in plates {
        scene.pair(disc_body, plate, penalty(1e-3), Method::Integrated { points: 4 });
    }
    let mut model = scene.model();
    for plate in plates {
        model.motion[model.mesh.bodies[plate].nodes.clone()].fill(Motion::Held);
    }
    let (mut d, mut contacts) = scene.lay_out(&model);
    set_step(&mut d, &contacts, 0.5);
    let body = of_body(&d, &model, disc_body);
    launch(&mut d, &body, [0.0, -0.5]);
    let start = step_and_balance(&mut d, &mut contacts).mechanical;
    let (mut bounces, mut touching, mut worst) = (0, false, 0.0_f64);
    while bounces < 100 {
        let now = step_and_balance(&mut d, &mut contacts);
        worst = worst.max((now.mechanical - start).abs() / start);
        let touches = contacts.resultants().any(|r| r.force[1] != 0.0);
        bounces += usize::from(touches && !touching);
        touching = touches;
        assert!(d.state.time < 0.1, "only {bounces} bounces");
    }
    // Each set-in and release of a contact point errs at random by parts of a per mille.
    assert!(worst < 5e-3, "the energy is off by {worst:e}");
}

#[test]
fn conserves_energy_over_a_thousand_bounces_on_curves() {
    // A rigid wheel, its rim an arc that moves as a spline, shuttles between two plates. Its forces are the gradient of a
    // potential and have no memory: its energy does not drift, and after its velocity has been turned round it runs all the
    // way back, to rounding.
    let (radius, gap) = (5e-3, 0.5e-6);
    let mut scene = Scene::default();
    let wheel = scene.add("wheel", &disc(radius, 32, 1e-3), "rim");
    let floor = rectangle([-2e-3, -radius - gap - 1e-3], 4e-3, 1e-3, 4, 1);
    let ceiling = rectangle([-2e-3, radius + gap], 4e-3, 1e-3, 4, 1);
    let plates = [scene.add("floor", &floor, "top"), scene.add("ceiling", &ceiling, "bottom")];
    let law = Law::penalty(1e14).and_then(|law| law.with_onset(0.2e-6)).expect("a possible law");
    for plate in plates {
        scene.pair(wheel, plate, law, Method::Integrated { points: 12 });
    }
    let mut model = scene.model();
    model.behaviour[wheel] = Behaviour::Rigid;
    for plate in plates {
        model.motion[model.mesh.bodies[plate].nodes.clone()].fill(Motion::Held);
    }
    let arc = Smoothing::Arc { centre: [0.0; 2] };
    let curves = [(arc, true), (Smoothing::Facet, false), (Smoothing::Facet, false)];
    let (mut d, mut contacts) = scene.lay_out_smooth(&model, &curves);
    set_step(&mut d, &contacts, 0.1);
    let speed = 0.5;
    d.launch_rigid(0, [0.0, -speed], 0.0);
    let start = d.rigid[0].centre;
    let (mut bounces, mut touching, mut worst) = (0, false, 0.0_f64);
    // It ends in flight, where a half step of force makes no difference.
    while bounces < 1000 || touching {
        d.step(&mut [&mut contacts]);
        let touches = contacts.resultants().any(|r| r.force != [0.0; 2]);
        if touches && !touching {
            bounces += 1;
        }
        if !touches {
            let v = d.rigid[0].velocity;
            worst = worst.max(((v[0] * v[0] + v[1] * v[1]) / (speed * speed) - 1.0).abs());
        }
        touching = touches;
        assert!(d.state.step < 3_000_000, "only {bounces} bounces");
    }
    let steps = d.state.step;
    assert!(worst < LEAPFROG, "the energy is off by {worst:e}");
    let [vx, vy] = d.rigid[0].velocity;
    let spin = d.rigid[0].spin;
    d.launch_rigid(0, [-vx, -vy], -spin);
    for _ in 0..steps {
        d.step(&mut [&mut contacts]);
    }
    let end = d.rigid[0].centre;
    let off = (end[0] - start[0]).hypot(end[1] - start[1]);
    assert!(off < 1e-12, "back at {end:?}, {off:e} m from the start");
}
