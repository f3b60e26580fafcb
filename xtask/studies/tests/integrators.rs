//! Integrators and elements for comparisons: their orders, limits and damping; and that the plain path is the
//! kernel's.

#[path = "../../../crates/fe/solver/tests/common/mod.rs"]
mod common;

use std::f64::consts::PI;

use common::*;
use stribeck_solver::NodeMotion;
use stribeck_studies::integrators::{Scheme, Trajectory};
use stribeck_studies::reference::{Choice, Precision, Reference, Rule};
use stribeck_testing::{Noise, assert_close, ledger, orders};

const SCHEMES: [Scheme; 3] =
    [Scheme::CentralDifference, Scheme::TchamwaWielgosz { phi: 1.03 }, Scheme::NohBathe { p: 0.54 }];

/// One oscillator of unit frequency from x = 1, v = 0.
fn swing(scheme: Scheme, dt: f64, steps: usize) -> Trajectory {
    let mut accelerate = |x: &[f64], _: &[f64], a: &mut [f64]| a[0] = -x[0];
    let mut t = Trajectory::start(vec![1.0], vec![0.0], &mut accelerate);
    (0..steps).for_each(|_| scheme.step(&mut t, dt, &mut accelerate));
    t
}

/// Source: Orders of accuracy: Noh and Bathe 2013.
#[test]
fn converges_integrators_with_their_order() {
    for (scheme, expected) in SCHEMES.into_iter().zip([2.0, 1.0, 2.0]) {
        let errors =
            [40, 80, 160].map(|steps| (swing(scheme, 5.0 / steps as f64, steps).x[0] - 5_f64.cos()).abs());
        for order in orders(&errors) {
            assert!((order - expected).abs() < 0.15, "{scheme:?}: order {order}, errors {errors:?}");
        }
    }
}

/// Source: THEORY §2.4.
#[test]
fn analytic_limits_of_the_integrators() {
    // Central differences: 2. Tchamwa–Wielgosz: trace 2 − φΩ² and determinant 1 − (φ − 1)Ω² of its step give
    // Ω = 2/√(2φ − 1). Noh–Bathe with p = 1/2 is two steps of central differences: 4; an uneven split
    // shortens that a little.
    let [central, tchamwa, noh] = SCHEMES.map(|s| s.limit());
    ledger::compare(
        "limit Ω of central differences",
        "ωΔt = 2: Belytschko, Liu and Moran 2000, §6.6",
        "-",
        central,
        2.0,
        1e-6,
    );
    let exact = 2.0 / (2.0 * 1.03 - 1.0_f64).sqrt();
    ledger::compare(
        "limit Ω of Tchamwa–Wielgosz, φ = 1.03",
        "2/√(2φ − 1), from trace and determinant",
        "-",
        tchamwa,
        exact,
        1e-6,
    );
    assert_close(Scheme::NohBathe { p: 0.5 }.limit(), 4.0, 1e-6, "Noh–Bathe, even split");
    assert!(noh > 3.5 && noh < 4.0, "Noh–Bathe: {noh}");
}

/// Source: Noh and Bathe 2013.
#[test]
fn analytic_damping_of_high_and_low_frequencies() {
    // Energy left after a hundred steps near the limit, and after a hundred steps of a twentieth of a radian.
    let left = |scheme: Scheme, omega: f64| {
        let t = swing(scheme, omega, 100);
        0.5 * (t.x[0] * t.x[0] + t.v[0] * t.v[0])
    };
    for scheme in &SCHEMES[1..] {
        assert!(left(*scheme, 0.9 * scheme.limit()) < 1e-3, "{scheme:?} keeps what it should damp");
        assert!(left(*scheme, 0.05) > 0.48, "{scheme:?} damps what it should keep");
    }
    assert!(left(Scheme::CentralDifference, 1.8) > 0.1);
}

/// The plain path moves nodes as the kernel does, to rounding.
#[test]
fn patch_the_plain_path_is_the_kernel() {
    let mut part = rectangle(8e-3, 4e-3, 8, 4);
    distort(&mut part, 8, 4, 0.2e-3);
    for part in [part.clone(), split(part)] {
        let model = body(&part);
        let mut d = ready(&model, 0.9);
        let dt = d.time_step();
        let mut plain = Reference::new(&model, Choice::default()).expect("a model of elastic bodies");
        let mut noise = Noise::new(5);
        let v: Vec<f64> = plain.rest().iter().map(|_| noise.uniform()).collect();
        let mut t =
            Trajectory::start(plain.rest().to_vec(), v.clone(), &mut |x, v, a| plain.accelerate(x, v, a));
        for n in 0..model.mesh.x.len() {
            let s = slot(&d, n);
            // The kernel's velocities belong to half a step earlier; at rest nothing accelerates.
            (d.state.vx[s], d.state.vy[s]) = (v[2 * n], v[2 * n + 1]);
        }
        for _ in 0..200 {
            Scheme::CentralDifference.step(&mut t, dt, &mut |x, v, a| plain.accelerate(x, v, a));
            d.step(&mut []);
        }
        for n in 0..model.mesh.x.len() {
            let s = slot(&d, n);
            let off = (d.state.x[s] - t.x[2 * n]).hypot(d.state.y[s] - t.x[2 * n + 1]);
            // 200 steps of 1e-7 s at 1 m/s move nodes by some 20 µm.
            assert!(off < 1e-14, "node {n} is off by {off:e} m");
        }
        assert_eq!(plain.evaluations(), 201 * (model.mesh.quads.len() + model.mesh.triangles.len()) as u64);
    }
}

/// Cosine of half a wave along a strip with held sides, after 1.3 periods of the continuum.
fn standing_wave(columns: usize, choice: Choice, scheme: Scheme, factor: f64) -> f64 {
    let length = 0.01;
    let mut model = body(&rectangle(length, length / columns as f64, columns, 1));
    model.motion.fill(NodeMotion::HeldY);
    let mut plain = Reference::new(&model, choice).expect("a model of elastic bodies");
    let critical = lay_out(&model).critical_time_step(&[], 0.0).time_step;
    let time = 1.3 * 2.0 * length / steel().dilatational_speed();
    let steps = (time / (factor * critical * 0.5 * scheme.limit())).ceil();
    let dt = time / steps;
    let amplitude = 1e-7;
    let shape = |x: f64| amplitude * (PI * x / length).cos();
    let rest = plain.rest().to_vec();
    let x = rest.chunks(2).flat_map(|p| [p[0] + shape(p[0]), p[1]]).collect();
    let mut t = Trajectory::start(x, vec![0.0; rest.len()], &mut |x, v, a| plain.accelerate(x, v, a));
    (0..steps as usize).for_each(|_| scheme.step(&mut t, dt, &mut |x, v, a| plain.accelerate(x, v, a)));
    let exact = (1.3 * 2.0 * PI).cos();
    let nodes = rest.len() / 2;
    let square: f64 =
        (0..nodes).map(|n| (t.x[2 * n] - rest[2 * n] - exact * shape(rest[2 * n])).powi(2)).sum();
    (square / nodes as f64).sqrt() / amplitude
}

/// Source: Bilinear elements: Hughes 2000, chapter 4.
#[test]
fn converges_displacements_with_second_order_in_space() {
    for rule in [Rule::OnePoint, Rule::Full] {
        let choice = Choice { rule, ..Choice::default() };
        let errors = [8, 16, 32].map(|n| standing_wave(n, choice, Scheme::CentralDifference, 0.5));
        for order in orders(&errors) {
            assert!((1.9..2.2).contains(&order), "{rule:?}: order {order}, errors {errors:?}");
        }
        assert!(errors[2] < 0.01, "{rule:?}: {errors:?}");
    }
}

#[test]
fn by_hand_mixed_precision_and_viscosity_change_what_they_should() {
    let double = standing_wave(32, Choice::default(), Scheme::CentralDifference, 0.5);
    // Strains of 3e-5 in numbers of seven digits: a per mille or so, and never more than a hundredth.
    let mixed = Choice { precision: Precision::Mixed, ..Choice::default() };
    let single = standing_wave(32, mixed, Scheme::CentralDifference, 0.5);
    assert!((single - double).abs() < 0.01 && single != double, "{single} against {double}");
    // The rate of decay of a wave of 64 cells is b (h/2) k²c… : its amplitude loses b π²/32 · 1.3 in 1.3
    // periods.
    let viscous = Choice { bulk_viscosity: 0.06, ..Choice::default() };
    let damped = standing_wave(32, viscous, Scheme::CentralDifference, 0.5);
    let lost = 0.06 * PI * PI * 1.3 / 32.0 * (1.3 * 2.0 * PI).cos().abs() / 2_f64.sqrt();
    assert!(damped > 0.3 * lost && damped < 3.0 * lost, "{damped}, expected about {lost}");
}

#[test]
fn invariant_full_integration_is_rotation_invariant_and_has_no_soft_mode() {
    let model = body(&rectangle(1e-3, 1e-3, 1, 1));
    let force = |rule, change: &dyn Fn([f64; 2], usize) -> [f64; 2]| {
        let mut plain = Reference::new(&model, Choice { rule, ..Choice::default() }).expect("one square");
        let x: Vec<f64> =
            plain.rest().chunks(2).enumerate().flat_map(|(n, p)| change([p[0], p[1]], n)).collect();
        let mut a = vec![0.0; x.len()];
        plain.accelerate(&x, &vec![0.0; x.len()], &mut a);
        a.iter().fold(0.0_f64, |m, a| m.max(a.abs()))
    };
    let turn = |p: [f64; 2], _: usize| [0.6 * p[0] - 0.8 * p[1], 0.8 * p[0] + 0.6 * p[1]];
    let stretch = |p: [f64; 2], _: usize| [1.001 * p[0], p[1]];
    let hourglass = |p: [f64; 2], n: usize| [p[0] + if n == 0 || n == 3 { 1e-6 } else { -1e-6 }, p[1]];
    let scale = force(Rule::Full, &stretch);
    assert!(force(Rule::Full, &turn) < 1e-9 * scale);
    assert_close(force(Rule::OnePoint, &stretch), scale, 1e-9, "a uniform stretch is the same for both");
    let [one, full] = [Rule::OnePoint, Rule::Full].map(|rule| force(rule, &hourglass));
    // Exact bending against bilinear shear: 1.49 for ν = 0.3.
    assert!(one > 0.0 && full > 1.2 * one && full < 3.0 * one, "{one:e} and {full:e}");
}
