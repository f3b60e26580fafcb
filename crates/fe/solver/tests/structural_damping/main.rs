//! Structural damping: the ratio over a band, its effect on a ring, a bar and a spin, its edge of stability
//! and its ledger.
//!
//! Problems with a closed form have a file each.

#[path = "../common/mod.rs"]
mod common;

mod bar_modes;
mod ring_bending_modes;

mod edge_of_stability;
mod one_element_on_its_spring;

use std::f64::consts::{PI, TAU};

use common::*;
use stribeck_mesh::Disc;
use stribeck_solver::{
    Dynamics,
    structural_damping::{Branch, StructuralDamping},
};
use stribeck_testing::assert_refused;

/// Damps body 0 and sets the time step to `factor` of the critical one.
fn damp(d: &mut Dynamics, branch: Branch, bodies: Vec<usize>, factor: f64) {
    let damping = StructuralDamping::new(branch, bodies).expect("a possible branch");
    d.set_structural_damping(Some(&damping)).expect("elastic bodies");
    let critical = d.critical_time_step(&[], 0.0).time_step;
    d.set_time_step(factor * critical).expect("a positive time step");
}

/// Mechanical energy and heat of damping [J] at the positions before a step, which it takes.
fn step_and_count(d: &mut Dynamics) -> [f64; 2] {
    d.measure_elastic_energy();
    let now = step_and_balance(d, &mut []);
    [now.mechanical() - now.drive, d.structural_loss()]
}

/// Decay rate [1/s] and angular frequency [rad/s] of a vibration with the stiffness ω₀² (1 + g sτ/(1 +
/// sτ)): the root of s² + ω₀² (…) = 0 near iω₀, by Newton's method on complex numbers.
fn root(branch: Branch, omega: f64) -> [f64; 2] {
    type C = [f64; 2];
    let mul = |a: C, b: C| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
    let div = |a: C, b: C| {
        let n = b[0] * b[0] + b[1] * b[1];
        let p = mul(a, [b[0], -b[1]]);
        [p[0] / n, p[1] / n]
    };
    let f = |s: C| {
        let st = s.map(|part| part * branch.relaxation_time);
        let part = div(st, [1.0 + st[0], st[1]]);
        let sum = [1.0 + branch.stiffness * part[0], branch.stiffness * part[1]];
        let square = mul(s, s);
        [square[0] + omega * omega * sum[0], square[1] + omega * omega * sum[1]]
    };
    let mut s = [0.0, omega];
    for _ in 0..50 {
        let h = 1e-6 * omega;
        let (a, b) = (f([s[0] + h, s[1]]), f([s[0] - h, s[1]]));
        let slope = [(a[0] - b[0]) / (2.0 * h), (a[1] - b[1]) / (2.0 * h)];
        let step = div(f(s), slope);
        s = [s[0] - step[0], s[1] - step[1]];
    }
    [-s[0], s[1]]
}

/// Amplitude of `shape` in the velocities, by mass.
fn amplitude(d: &Dynamics, shape: &[[f64; 2]]) -> f64 {
    let (mut part, mut whole) = (0.0, 0.0);
    for s in massive(d) {
        part += d.mass()[s] * (shape[s][0] * d.state.vx[s] + shape[s][1] * d.state.vy[s]);
        whole += d.mass()[s] * (shape[s][0].powi(2) + shape[s][1].powi(2));
    }
    part / whole
}

/// Angular frequency [rad/s] and damping ratio of a mode whose velocity starts with `shape` [m/s], from the
/// zeros and the extremes of its amplitude over `cycles`.
fn ring_down(d: &mut Dynamics, shape: &[[f64; 2]], guess: f64, cycles: f64) -> [f64; 2] {
    for s in massive(d) {
        [d.state.vx[s], d.state.vy[s]] = shape[s];
    }
    let steps = (cycles * TAU / guess / d.time_step()) as usize;
    let (mut zeros, mut peaks) = (Vec::new(), Vec::new());
    let (mut before, mut last) = (amplitude(d, shape), amplitude(d, shape));
    for n in 0..steps {
        d.step(&mut []);
        let now = amplitude(d, shape);
        if last * now < 0.0 {
            zeros.push(n as f64 + last / (last - now));
        }
        if last.abs() > before.abs() && last.abs() >= now.abs() {
            // A parabola through three values.
            let (a, b) = (0.5 * (before + now) - last, 0.5 * (now - before));
            peaks.push([n as f64 - 0.5 * b / a, (last - 0.25 * b * b / a).abs()]);
        }
        (before, last) = (last, now);
    }
    let dt = d.time_step();
    let omega = PI * (zeros.len() - 1) as f64 / (dt * (zeros[zeros.len() - 1] - zeros[0]));
    let ([t0, a0], [t1, a1]) = (peaks[0], peaks[peaks.len() - 1]);
    [omega, (a0 / a1).ln() / (dt * (t1 - t0)) / omega]
}

/// The ring and all discs; the block is not damped.
const DAMPED: [usize; 4] = [0, 1, 2, 3];

/// A branch that damps the motion of a small model in a few thousand steps.
const BRANCH: Branch = Branch { stiffness: 0.06, relaxation_time: 5e-6 };

#[test]
fn conserves_the_ledger_of_structural_damping() {
    // The ring turns with its bore, everything vibrates, the discs have a stroke each.
    let model = workshop();
    let mut d = lay_out(&model);
    damp(&mut d, BRANCH, DAMPED.to_vec(), 0.9);
    shake(&mut d, 0.1);
    for n in slots(&d, model.mesh.bodies[0].nodes.clone()) {
        let n = n as usize;
        let (x, y) = (d.state.x[n], d.state.y[n]);
        d.state.vx[n] += 0.3 * (20.0 * y).cos() - 50.0 * y;
        d.state.vy[n] += 50.0 * x;
    }
    for body in 1..4 {
        for n in slots(&d, model.mesh.bodies[body].nodes.clone()) {
            d.state.vx[n as usize] += 3.0 * (300.0 * d.state.y[n as usize]).cos();
        }
    }
    let [start, none] = step_and_count(&mut d);
    let (mut loss, mut worst) = (none, 0.0_f64);
    for _ in 0..6000 {
        let [rest, so_far] = step_and_count(&mut d);
        loss = so_far;
        worst = worst.max((rest + loss - start - none).abs());
    }
    println!("{:e} of the loss is missing", worst / (loss - none));
    assert!(worst < 3e-3 * (loss - none), "{:e} of the loss is missing", worst / (loss - none));
}

/// A disc that flies and spins while it vibrates keeps its momentum and its angular momentum, and the springs
/// of its damping do not stretch it.
#[test]
fn conserves_momentum_and_the_size_of_a_spinning_disc() {
    let part = Disc { radius: 0.01, facets: 24, size: 3e-3, rotation: 0.0 }.part().expect("a disc");
    let model = body(&part.translated(0.05, -0.02));
    let (spin, speed) = (300.0, [2.0, -1.0]);
    let moved = |damped: bool, shaken: f64| {
        let mut d = lay_out(&model);
        damp(&mut d, BRANCH, vec![0], 0.9);
        if !damped {
            d.set_structural_damping(None).expect("none");
        }
        shake(&mut d, shaken);
        for n in massive(&d) {
            d.state.vx[n] += speed[0] - spin * (d.state.y[n] + 0.02);
            d.state.vy[n] += speed[1] + spin * (d.state.x[n] - 0.05);
        }
        let before = momentum(&d);
        run(&mut d, &mut [], 20_000);
        let all: Vec<u32> = massive(&d).into_iter().map(|n| n as u32).collect();
        (before, momentum(&d), d.rigid_motion(&all))
    };
    // Rounding in 20 000 steps; without the measured spin of the body the springs would take 1.7 Nm s of
    // every 100 000.
    const ROUNDING: f64 = 1e-10;
    for shaken in [0.0, 0.1] {
        let (before, after, body) = moved(true, shaken);
        for i in 0..2 {
            assert!((after[i] - before[i]).abs() < ROUNDING * before[0].abs(), "{after:?} from {before:?}");
        }
        let lost = (before[2] - after[2]) / (body.inertia * spin);
        println!("vibration of {shaken} m/s: lost {lost:.2e} of its spin");
        let (_, _, free) = moved(false, shaken);
        // The lag of the springs would change it by 6e-6. A disc that is shaken and not damped is larger and
        // smaller by as much at one moment or another.
        let grown = body.inertia / free.inertia - 1.0;
        assert!(shaken > 0.0 || grown.abs() < 1e-6, "inertia off by {grown:e}");
        assert!(lost.abs() < 1e-8, "{lost:e} of the spin");
    }
}

#[test]
fn invariant_threads_and_interruptions_change_no_bit() {
    let model = workshop();
    let made = |threads: usize| {
        let mut d = Dynamics::new(&model, &vec![true; model.mesh.x.len()], threads).expect("a model");
        damp(&mut d, BRANCH, DAMPED.to_vec(), 0.9);
        d
    };
    let start = assert_threads_and_interruptions_change_no_bit(made);
    let mut undamped = lay_out(&model);
    assert_refused(undamped.restore(start), "must be those of the structural damping");
}

#[test]
fn invariant_a_body_that_is_not_damped_moves_as_if_there_were_none() {
    let model = workshop();
    let run_with = |bodies: Option<Vec<usize>>| {
        let mut d = ready(&model, 0.8);
        let step = d.time_step();
        if let Some(bodies) = bodies {
            let damping = StructuralDamping::new(BRANCH, bodies).expect("a possible branch");
            d.set_structural_damping(Some(&damping)).expect("elastic bodies");
            d.set_time_step(step).expect("a positive step");
        }
        shake(&mut d, 0.1);
        run(&mut d, &mut [], 50);
        let slots = slots(&d, model.mesh.bodies[4].nodes.clone());
        slots.into_iter().map(|s| d.state.x[s as usize]).collect::<Vec<_>>()
    };
    assert!(run_with(None) == run_with(Some(DAMPED.to_vec())));
    assert!(run_with(None) != run_with(Some(vec![4])));
}

#[test]
fn refuses_bodies_that_cannot_be_damped() {
    let mut d = lay_out(&workshop());
    let damping = |bodies| StructuralDamping::new(BRANCH, bodies).expect("a possible branch");
    for (bodies, word) in [(vec![9], "deforms"), (vec![1, 2], "shape")] {
        let error = d.set_structural_damping(Some(&damping(bodies))).expect_err("impossible bodies");
        assert!(error.to_string().contains(word), "{error}");
    }
    assert!(d.structural_damping().is_none());
}
