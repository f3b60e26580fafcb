//! Two equal bars meet end to end.
//!
//! Johnson, *Contact Mechanics* (1985), §11.1; Goldsmith, *Impact* (1960), §3.3.
//!
//! # Goal
//!
//! Contact time, stress between the bars and velocities after an impact that waves govern; the order in which
//! the contact time converges.
//!
//! # Mesh
//!
//! ```text
//!        ▽  ▽  ▽  ▽  ▽  ▽   ▽  ▽  ▽  ▽  ▽  ▽
//!       ┌──┬──┬── … ──┬──┐ ┌──┬──┬── … ──┬──┐
//!  v →  ├──┼──┼── … ──┼──┤ ├──┼──┼── … ──┼──┤  ← v      two rows of squares
//!       └──┴──┴── … ──┴──┘ └──┴──┴── … ──┴──┘
//!        △  △  △  △  △  △   △  △  △  △  △  △
//!       x = −L            0                 L
//! ```
//!
//! 200 squares along each bar; 50 to 400 for the order.
//!
//! # Boundary conditions
//!
//! All nodes are held in y (uniaxial strain). The bars start 1 nm apart, each with the velocity v of its own.
//!
//! # Parameters
//!
//! L = 50 mm, v = 1 m/s, E = 208 GPa, ν = 0.3, ρ = 7800 kg/m³; the penalty is as stiff as an element; 0.4 of
//! the critical time step, because a contact sets in within a step, and the energy that this gives or takes
//! falls with the square of the step.
//!
//! # Expected
//!
//! The bars touch for 2L/c, c² = (λ + 2µ)/ρ, under the stress ρ c v, and exchange their velocities.

use stribeck_contact::Method;
use stribeck_solver::NodeMotion;
use stribeck_testing::{assert_close, ledger};

use crate::common::*;
use crate::penalty;

/// The penalty spring and the dispersion of the front add about the time across two cells, of 400.
const TIME: f64 = 0.015;

/// The stress rings by some per cent about its plateau; the mean over a third of the contact takes most of
/// that out.
const STRESS: f64 = 0.01;

/// A hundredth of the energy stays behind as ringing of cells.
const VELOCITY: f64 = 0.01;

/// The front spreads with the third root of the distance in cells (order two thirds), the spring with the
/// cell (order one).
const ORDER: std::ops::Range<f64> = 0.4..1.2;

/// With 400 cells: [`TIME`], which is that of 200, over 2^(2/3), the slower of both orders.
const FINEST: f64 = 0.01;

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
    model.motion.fill(NodeMotion::HeldY);
    let (mut d, mut contacts) = scene.lay_out(&model);
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
    let (length, speed) = (0.05, 1.0);
    let c = steel().dilatational_speed();
    for method in METHODS {
        let impact = bars(length, 200, speed, method);
        let how = if method == Method::Collocated { "collocated" } else { "integrated" };
        let source = "2L/c: Johnson 1985, §11.1";
        let quantity = format!("two equal bars, contact time, {how}");
        ledger::compare(&quantity, source, "s", impact.time, 2.0 * length / c, TIME);
        let stress = steel().density() * c * speed;
        let source = "ρ c v: Goldsmith 1960, §3.3";
        let quantity = format!("two equal bars, interface stress, {how}");
        ledger::compare(&quantity, source, "Pa", impact.force, stress, STRESS);
        assert_close(impact.after[0], -speed, VELOCITY, "velocity of the left bar");
        assert_close(impact.after[1], speed, VELOCITY, "velocity of the right bar");
    }
}

/// Source: 2L/c: Johnson 1985, §11.1.
#[test]
fn converges_contact_time_of_bars() {
    let exact = 0.1 / steel().dilatational_speed();
    let errors =
        [50, 100, 200, 400].map(|cells| bars(0.05, cells, 1.0, Method::Collocated).time / exact - 1.0);
    // The instant of release rings, hence the rate over all three halvings.
    let order = (errors[0] / errors[3]).log2() / 3.0;
    assert!(ORDER.contains(&order), "order {order}, errors {errors:?}");
    assert!(errors[3] < FINEST, "{errors:?}");
}
