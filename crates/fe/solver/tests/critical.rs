//! The critical time step: a closed form, an independent eigenvalue, and the edge itself.
//!
//! Belytschko, Liu and Moran, *Nonlinear Finite Elements for Continua and Structures* (2000), §6.6: leapfrog
//! is stable up to Δt = 2/ω_max.

mod common;
use common::*;
use stribeck_mesh::{Annulus, Part};
use stribeck_solver::{
    Behaviour, Dynamics, Force, NodeMotion,
    force::NodalLoad,
    state::{Moment, NodeForces},
};
use stribeck_testing::{Noise, assert_close, ledger};

/// The bound stops when it is at most this far above the largest ω² (critical.rs).
const BOUND: f64 = 2e-3;

/// Positions to displace when stiffnesses are taken by differences [m].
const PROBE: f64 = 1e-9;

/// Largest ω² of M⁻½ K M⁻½ by power iteration on the dense matrix, whose columns are differences of forces.
fn largest_eigenvalue(d: &Dynamics, extra: &[f64]) -> f64 {
    let free = massive(d);
    let n = 2 * free.len();
    let pushed = |i: usize, h: f64| {
        let (mut x, mut y) = (d.state.x.clone(), d.state.y.clone());
        if i.is_multiple_of(2) {
            x[free[i / 2]] += h
        } else {
            y[free[i / 2]] += h
        }
        let (mut fx, mut fy) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        d.elastic_forces(&x, &y, &mut fx, &mut fy);
        (fx, fy)
    };
    let mut matrix = vec![0.0; n * n];
    for i in 0..n {
        let (plus, minus) = (pushed(i, PROBE), pushed(i, -PROBE));
        for j in 0..n {
            let s = free[j / 2];
            let k = if j % 2 == 0 { minus.0[s] - plus.0[s] } else { minus.1[s] - plus.1[s] };
            let spring = if i == j { extra[s] } else { 0.0 };
            matrix[i * n + j] = (k / (2.0 * PROBE) + spring) / (d.mass()[free[i / 2]] * d.mass()[s]).sqrt();
        }
    }
    let mut noise = Noise::new(2);
    let mut v: Vec<f64> = (0..n).map(|_| noise.uniform()).collect();
    let mut value = 0.0;
    for _ in 0..20_000 {
        let w: Vec<f64> =
            (0..n).map(|i| matrix[i * n..(i + 1) * n].iter().zip(&v).map(|(a, b)| a * b).sum()).collect();
        value = w.iter().map(|a| a * a).sum::<f64>().sqrt();
        v = w.iter().map(|a| a / value).collect();
    }
    value
}

/// An irregular body of a few elements, quadrilaterals or triangles.
fn bodies() -> [(&'static str, Part); 3] {
    let mut quads = rectangle(4e-3, 3e-3, 4, 3);
    distort(&mut quads, 4, 3, 0.3e-3);
    [("squares", rectangle(4e-3, 3e-3, 4, 3)), ("quadrilaterals", quads.clone()), ("triangles", split(quads))]
}

#[test]
fn analytic_one_free_square() {
    // Uniform dilatation u = ε (x, y) of one square of side a, lumped mass: strain energy ½ (λ + µ)(2ε)² V,
    // kinetic energy ½ ρ V ε̇² a²/2, so ω² = 8 (λ + µ)/(ρ a²); shear and hourglass modes are slower.
    let a = 1e-3;
    let d = lay_out(&body(&rectangle(a, a, 1, 1)));
    let s = steel();
    let exact = (8.0 * (s.lame() + s.shear()) / s.density()).sqrt() / a;
    let found = d.critical_time_step(&[], 0.0);
    assert!(found.frequency >= exact * (1.0 - 1e-6), "{} below {exact}", found.frequency);
    let source = "ω² = 8 (λ + µ)/(ρ a²), uniform dilatation";
    ledger::compare("largest frequency of one square", source, "rad/s", found.frequency, exact, BOUND);
    assert_close(found.time_step, 2.0 / found.frequency, 1e-12, "time step");
}

#[test]
fn invariant_lanczos_bound_is_above_the_dense_eigenvalue_and_close() {
    for (name, part) in bodies() {
        let d = lay_out(&body(&part));
        let exact = largest_eigenvalue(&d, &vec![0.0; d.state.x.len()]);
        let ratio = d.critical_time_step(&[], 0.0).frequency.powi(2) / exact;
        // The dense matrix holds the rounding of its differences.
        assert!(
            ratio > 1.0 - 1e-5 && ratio < 1.0 + 2.0 * BOUND,
            "{name}: bound / eigenvalue of ω² = {ratio}"
        );
    }
}

/// A spring to the ground at every node, with the bound that contact would announce.
struct Ground {
    stiffness: f64,
    place: Vec<[f64; 2]>,
}

impl Force for Ground {
    fn accumulate(&mut self, at: Moment<'_>, force: &mut NodeForces) {
        for (n, place) in self.place.iter().enumerate() {
            force.fx[n] -= self.stiffness * (at.x[n] - place[0]);
            force.fy[n] -= self.stiffness * (at.y[n] - place[1]);
        }
    }

    fn stiffness_bound(&self, _dt: f64, bound: &mut [f64]) {
        bound.iter_mut().for_each(|b| *b += self.stiffness);
    }
}

#[test]
fn invariant_forces_enter_the_same_eigenvalue() {
    // Springs that alone would allow the same step as the elements: together they ask for 1/√2 of it, and the
    // smaller of two separate steps would be unstable.
    let part = rectangle(4e-3, 3e-3, 4, 3);
    let d = lay_out(&body(&part));
    let alone = d.critical_time_step(&[], 0.0).time_step;
    let lightest = massive(&d).iter().map(|&n| d.mass()[n]).fold(f64::INFINITY, f64::min);
    let ground = Ground {
        stiffness: lightest * (2.0 / alone).powi(2),
        place: d.state.x.iter().zip(&d.state.y).map(|(x, y)| [*x, *y]).collect(),
    };
    let found = d.critical_time_step(&[&ground], 0.0);
    let exact = largest_eigenvalue(&d, &vec![ground.stiffness; d.state.x.len()]);
    assert_close(found.frequency.powi(2), exact, 2.0 * BOUND, "ω² of elements and springs");
    assert!(found.time_step < 0.9 * alone, "{:e} s against {alone:e} s alone", found.time_step);
    // A force that is not stiff leaves the step alone.
    let load = NodalLoad::default();
    assert_eq!(d.critical_time_step(&[&load], 0.0), d.critical_time_step(&[], 0.0));
}

/// Largest displacement [m] within `steps` steps of `dt`, from a disturbance of 1 nm.
fn excursion(part: &Part, dt: f64, steps: usize) -> f64 {
    let model = body(part);
    let mut d = lay_out(&model);
    d.set_time_step(dt).expect("a positive time step");
    let mut noise = Noise::new(9);
    for n in massive(&d) {
        d.state.x[n] += 1e-9 * noise.uniform();
        d.state.y[n] += 1e-9 * noise.uniform();
    }
    let mut largest = 0.0_f64;
    for _ in 0..steps {
        d.step(&mut []);
        for node in 0..model.mesh.x.len() {
            let s = slot(&d, node);
            let moved = (d.state.x[s] - model.mesh.x[node]).hypot(d.state.y[s] - model.mesh.y[node]);
            largest = largest.max(moved);
        }
        if largest > 1e-6 {
            break;
        }
    }
    largest
}

#[test]
fn invariant_the_limit_is_sharp() {
    for (name, part) in bodies() {
        let d = lay_out(&body(&part));
        let critical = d.critical_time_step(&[], 0.0).time_step;
        let exact = 2.0 / largest_eigenvalue(&d, &vec![0.0; d.state.x.len()]).sqrt();
        // Near the limit a mode may swing 1/√(1 − 0.99²) = 7 times as far, and rigid motion drifts not at
        // all.
        let below = excursion(&part, 0.99 * critical, 20_000);
        assert!(below < 3e-8, "{name}: {below:e} m at 0.99 of the critical step");
        // Growth by exp(2 arcosh 1.01) = 1.33 a step: a thousandfold within 25.
        let above = excursion(&part, 1.01 * exact, 300);
        assert!(above > 1e-6, "{name}: only {above:e} m at 1.01 of the limit");
    }
}

#[test]
fn by_hand_rigid_bodies_on_springs_limit_the_step() {
    // A rigid block on a spring at each corner: ω² = 4 k/M for translation; the bound adds the rotation.
    let mut model = body(&rectangle(0.02, 0.01, 1, 1));
    model.behaviour[0] = Behaviour::Rigid;
    let mut d = lay_out(&model);
    assert_eq!(d.critical_time_step(&[], 0.0).time_step, f64::INFINITY, "nothing has stiffness");
    let mut ground =
        Ground { stiffness: 1e9, place: d.state.x.iter().zip(&d.state.y).map(|(x, y)| [*x, *y]).collect() };
    let mass: f64 = d.mass().iter().sum();
    let bound = d.critical_time_step(&[&ground], 0.0);
    let translation = (4.0 * ground.stiffness / mass).sqrt();
    assert!(bound.frequency >= translation && bound.frequency <= 1.5 * translation);
    d.set_time_step(0.99 * bound.time_step).expect("a positive time step");
    d.launch_rigid(0, [1.0, -1.0], 300.0);
    run(&mut d, &mut [&mut ground], 10_000);
    // Amplitude of a free oscillation v/ω, doubled for the step near its limit.
    assert!((d.rigid[0].centre[0] - 0.01).abs() < 2.0 / translation, "{:?}", d.rigid[0]);
}

/// A body all of whose nodes are held vibrates at no frequency.
#[test]
fn behaves_held_bodies_have_no_limit() {
    let mut model = body(&rectangle(0.02, 0.01, 2, 1));
    model.motion.fill(NodeMotion::Held);
    let d = lay_out(&model);
    assert_eq!(d.critical_time_step(&[], 0.0).time_step, f64::INFINITY);
    assert_eq!(d.present_critical_time_step(&[]).time_step, f64::INFINITY);
}

#[test]
fn invariant_a_ring_has_the_step_of_its_shortest_cells() {
    // Halving the cells halves the step.
    let step = |facets, layers| {
        let ring = Annulus {
            inner_radius: 0.05,
            outer_radius: 0.06,
            facets,
            layers,
            start_angle: 0.0,
            grooves: Vec::new(),
        };
        lay_out(&body(&ring.part().expect("a ring"))).critical_time_step(&[], 0.0).time_step
    };
    assert_close(step(60, 2), 2.0 * step(120, 4), 0.05, "step of the coarser ring");
}
