//! Motion against closed forms: waves, vibration, free fall, rotation; and the order of the time step.

mod common;
use std::f64::consts::{PI, TAU};

use common::*;
use stribeck_mesh::{Annulus, Disc, Mesh};
use stribeck_solver::{Behaviour, Dynamics, Model, Motion, force::NodalLoad};
use stribeck_testing::{assert_close, ledger, orders};

#[test]
fn analytic_speed_of_a_pressure_wave() {
    // Achenbach, Wave Propagation in Elastic Solids (1973), §1.3: u(x, t) = f(x − c t), c² = (λ + 2µ)/ρ, in a strip
    // whose sides are held (uniaxial strain). The pulse is 40 cells long.
    let (columns, cell) = (400, 1e-3);
    let mut model = body(&rectangle(columns as f64 * cell, cell, columns, 1));
    model.motion.fill(Motion::HeldY);
    let mut d = ready(&model, 0.9);
    let c = steel().dilatational_speed();
    let (start, width, height) = (0.1, 0.02, 1e-7);
    let pulse = |x: f64, t: f64| height * (-((x - start - c * t) / width).powi(2)).exp();
    let half = 0.5 * d.time_step();
    for n in 0..model.mesh.x.len() {
        let (x, s) = (model.mesh.x[n], slot(&d, n));
        d.state.x[s] += pulse(x, 0.0);
        // ∂u/∂t half a step earlier.
        let xi = (x - start + c * half) / width;
        d.state.vx[s] = 2.0 * c / width * xi * pulse(x, -half);
    }
    let steps = (0.2 / c / d.time_step()) as usize;
    run(&mut d, &mut [], steps);
    let (mut sum, mut moment) = (0.0, 0.0);
    for n in 0..=columns {
        let u = d.state.x[slot(&d, n)] - model.mesh.x[n];
        sum += u;
        moment += u * model.mesh.x[n];
    }
    // A wave of 40 cells runs (k h)²/24 = 0.1 % slow, less what the time step gives back.
    let source = "√((λ + 2µ)/ρ): Achenbach 1973, §1.3";
    ledger::compare(
        "speed of a pressure wave of 40 cells",
        source,
        "m/s",
        (moment / sum - start) / d.state.time,
        c,
        1e-3,
    );
    assert_close(sum * cell, height * width * PI.sqrt(), 1e-3, "area of the pulse");
}

/// Frequency [Hz] of a signal from its first and last upward zero crossing.
fn frequency(signal: &[f64], dt: f64) -> f64 {
    let crossings: Vec<f64> = signal
        .windows(2)
        .enumerate()
        .filter(|(_, w)| w[0] < 0.0 && w[1] >= 0.0)
        .map(|(i, w)| i as f64 + w[0] / (w[0] - w[1]))
        .collect();
    let [first, .., last] = crossings.as_slice() else { panic!("fewer than two periods") };
    (crossings.len() - 1) as f64 / ((last - first) * dt)
}

#[test]
fn analytic_bending_modes_of_a_free_ring() {
    // Love, A Treatise on the Mathematical Theory of Elasticity (1927), §293, inextensional bending in its plane:
    // f = n (n² − 1)/(2π R²) √(E' I/(ρ A (n² + 1))), with E' for plane strain; the benchmark of Code_Aster
    // V2.03.109. Shear and rotary inertia, left out, lower it by about n² (h/R)²/3.
    // Square cells: their hourglass stiffness is exact in bending.
    let (inner, outer, facets, layers) = (0.098, 0.102, 314, 2);
    let ring = Annulus {
        inner_radius: inner,
        outer_radius: outer,
        facets,
        layers,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let model = body(&ring.part().expect("a ring"));
    for n in [2, 3] {
        let mut d = ready(&model, 0.95);
        let k = n as f64;
        // Velocities of the mode: radial cos nθ, hoop −sin(nθ)/n, so small that strains stay below 1e-5.
        for node in 0..model.mesh.x.len() {
            let (x, y, s) = (model.mesh.x[node], model.mesh.y[node], slot(&d, node));
            let (angle, r) = (y.atan2(x), x.hypot(y) / 0.1);
            let (radial, hoop) =
                (0.01 * (k * angle).cos(), -0.01 / k * (k * angle).sin() * (1.0 + (1.0 - k * k) * (1.0 - r)));
            d.state.vx[s] = radial * angle.cos() - hoop * angle.sin();
            d.state.vy[s] = radial * angle.sin() + hoop * angle.cos();
        }
        let thickness = outer - inner;
        let stiffness = steel().plane_strain_modulus() * thickness * thickness / (12.0 * steel().density());
        let expected = k * (k * k - 1.0) / (TAU * 0.01) * (stiffness / (k * k + 1.0)).sqrt();
        let every = 20;
        let samples = (3.3 / expected / d.time_step()) as usize / every;
        let rim = slot(&d, 0);
        let signal: Vec<f64> = (0..samples)
            .map(|_| {
                run(&mut d, &mut [], every);
                d.state.x[rim].hypot(d.state.y[rim]) - inner
            })
            .collect();
        let found = frequency(&signal, every as f64 * d.time_step());
        let source = "Love 1927, §293; Code_Aster V2.03.109";
        ledger::compare(&format!("ring, bending mode {n}"), source, "Hz", found, expected, 0.01);
    }
}

#[test]
fn example_free_fall() {
    // Leapfrog sums the fall exactly: from rest half a step before the start, y = g Δt² n (n + 1)/2.
    let mut mesh = Mesh::new();
    let disc = Disc { radius: 0.01, facets: 24, size: 3e-3, rotation: 0.0 }.part().expect("a disc");
    for i in 0..3 {
        mesh.add(format!("disc {i}"), &disc.translated(0.05 * i as f64, 0.0));
    }
    mesh.add("block", &rectangle(0.02, 0.01, 4, 2).translated(0.0, 0.1));
    let rigid = mesh.add("rigid block", &rectangle(0.02, 0.01, 4, 2).translated(0.1, 0.1));
    let mut model = Model::new(mesh, steel(), THICKNESS).expect("a positive thickness");
    model.behaviour[rigid.body] = Behaviour::Rigid;
    model.gravity = [2.0, -9.81];
    let mut d = ready(&model, 0.9);
    let n = 20_000;
    run(&mut d, &mut [], n);
    let fall = 0.5 * d.time_step().powi(2) * n as f64 * (n + 1) as f64;
    assert_close(d.state.time, n as f64 * d.time_step(), 1e-14, "time");
    for node in 0..model.mesh.x.len() {
        let s = slot(&d, node);
        // Positions of 0.1 m round to 1e-17 m in each of 20 000 steps.
        assert!((d.state.x[s] - model.mesh.x[node] - 2.0 * fall).abs() < 1e-12, "node {node}");
        assert!((d.state.y[s] - model.mesh.y[node] + 9.81 * fall).abs() < 1e-12, "node {node}");
    }
    assert!(d.elastic_energy().strain < 1e-12 * d.gravity_work().abs(), "nothing is strained");
}

/// Source: Lumped masses as in THEORY §1.
#[test]
fn analytic_rigid_block_under_a_couple() {
    // θ = M t²/(2 I) with the moment of inertia of masses lumped to a grid of m × n cells:
    // I = M/12 [a² (1 + 2/m²) + b² (1 + 2/n²)].
    let (a, b, columns, rows) = (0.04, 0.02, 4, 2);
    let mut model = body(&rectangle(a, b, columns, rows));
    model.behaviour[0] = Behaviour::Rigid;
    let mut d = lay_out(&model);
    d.set_time_step(1e-6).expect("a positive time step");
    // Equal and opposite forces at the middles of the short sides; the angle stays below 0.01 rad.
    let (left, right) = (slot(&d, 5) as u32, slot(&d, 9) as u32);
    let force = 1.0;
    let mut couple = NodalLoad::new(vec![(left, 0.0, -force), (right, 0.0, force)]);
    let steps = 2000;
    run(&mut d, &mut [&mut couple], steps);
    let mass = steel().density() * THICKNESS * a * b;
    let share = |cells: usize| 1.0 + 2.0 / (cells * cells) as f64;
    let inertia = mass / 12.0 * (a * a * share(columns) + b * b * share(rows));
    let t2 = d.time_step().powi(2) * steps as f64 * (steps + 1) as f64;
    let angle = 0.5 * force * a / inertia * t2;
    assert!(angle > 1e-3 && angle < 0.02, "{angle} rad");
    // The lever shortens as cos θ.
    let source = "θ = M t²/(2 I), lumped masses";
    ledger::compare(
        "rigid block under a couple, angle",
        source,
        "rad",
        d.rigid[0].angle,
        angle,
        angle * angle,
    );
    assert!((d.rigid[0].centre[0] - 0.5 * a).abs() < 1e-15 && (d.rigid[0].centre[1] - 0.5 * b).abs() < 1e-15);
    // Work = kinetic energy.
    assert_close(couple_work(&mut d, &mut couple), 1.0, 1e-9, "work / energy");
}

/// Source: THEORY §6.5: the angle is Ω t, and the drive supplies −M Ω a second.
#[test]
fn analytic_block_that_turns_at_a_prescribed_rate() {
    let mut model = body(&rectangle(0.04, 0.02, 4, 2));
    let rate = 50.0;
    model.behaviour[0] = Behaviour::Turning { rate };
    let mut d = lay_out(&model);
    d.set_time_step(1e-6).expect("a positive time step");
    let (left, right) = (slot(&d, 5) as u32, slot(&d, 9) as u32);
    // A couple that acts along y, and a force that moves the centre.
    let (couple, push) = (3.0, 2.0);
    let mut load = NodalLoad::new(vec![(left, 0.0, -couple), (right, push, couple)]);
    let steps = 4000;
    run(&mut d, &mut [&mut load], steps);
    let time = d.state.time;
    assert_close(d.rigid[0].angle, rate * time, 1e-12, "angle");
    assert_eq!(d.rigid[0].spin, rate);
    let mass = steel().density() * THICKNESS * 0.04 * 0.02;
    let path = 0.5 * push / mass * d.time_step().powi(2) * (steps * (steps + 1)) as f64;
    assert_close(d.rigid[0].centre[0] - 0.02, path, 1e-9, "path");
    // ∫ Ω M dt with the couple's lever cos θ and the push's own torque about the centre, which is −push · ½ a sin θ.
    let angle = rate * time;
    let of_couple = couple * 0.04 * angle.sin();
    let of_push = push * 0.02 * (angle.cos() - 1.0);
    assert_close(d.drive.at_last_positions(), -(of_couple + of_push), 1e-3, "work of the drive");
    // Nothing else turns it.
    d.launch_rigid(0, [0.0; 2], 7.0);
    assert_eq!(d.rigid[0].spin, rate);
}

/// Source: THEORY §6.3 and §6.5: given the mean rate of each step the angle is ½αt² from rest, and what drives the body against a
/// couple M leaves ½Iω² in it and supplies −∫Mω dt on top.
#[test]
fn analytic_a_block_whose_prescribed_rate_changes() {
    // The couple's lever is taken at the ends of steps of 50 µrad.
    const STEPS: f64 = 1e-3;
    let mut model = body(&rectangle(0.04, 0.02, 4, 2));
    model.behaviour[0] = Behaviour::Turning { rate: 0.0 };
    let mut d = lay_out(&model);
    d.set_time_step(1e-6).expect("a positive time step");
    let (left, right) = (slot(&d, 5) as u32, slot(&d, 9) as u32);
    let (couple, acceleration) = (3.0, 5e4);
    let mut load = NodalLoad::new(vec![(left, 0.0, -couple), (right, 0.0, couple)]);
    for _ in 0..4000 {
        d.set_turning_rate(acceleration * (d.state.time + 0.5 * d.time_step())).expect("a possible rate");
        let now = step_and_balance(&mut d, &mut [&mut load]);
        assert!(now.kinetic >= 0.0);
    }
    let angle = 0.5 * acceleration * d.state.time.powi(2);
    assert_close(d.rigid[0].angle, angle, 1e-12, "angle");
    let mass = steel().density() * THICKNESS * 0.04 * 0.02;
    // Lumped to nodes: a quarter of each of the eight elements' masses at its corners.
    let (cells_x, cells_y) = (4.0_f64, 2.0_f64);
    let lumped = |length: f64, cells: f64| mass * length * length / 12.0 * (1.0 + 2.0 / (cells * cells));
    let inertia = lumped(0.04, cells_x) + lumped(0.02, cells_y);
    let kinetic = 0.5 * inertia * (acceleration * d.state.time).powi(2);
    let by_couple = couple * 0.04 * angle.sin();
    assert!(kinetic > 0.1 * by_couple.abs(), "{kinetic} J beside {by_couple} J");
    assert_close(d.drive.at_last_positions(), kinetic - by_couple, STEPS, "work of the drive");
    assert!(d.set_turning_rate(f64::NAN).is_err() && d.set_turning_rate(4e6).is_err());
}

/// Work supplied by a load over kinetic energy, at the same instant.
fn couple_work(d: &mut Dynamics, load: &mut NodalLoad) -> f64 {
    use stribeck_solver::Force;
    let now = step_and_balance(d, &mut [load]);
    load.energy().supplied / now.kinetic
}

/// Source: THEORY §2.3: central differences are of second order.
#[test]
fn converges_time_step_second_order() {
    // The same bar set off at 1 cm/s, its end after three quarters of a period; the error against a step sixteen
    // times smaller falls fourfold with each halving.
    let (columns, length) = (16, 0.016);
    let mut model = body(&rectangle(length, 1e-3, columns, 1));
    model.motion.fill(Motion::HeldY);
    let critical = lay_out(&model).critical_time_step(&[], 0.0).time_step;
    let steps = (1.5 * length / steel().dilatational_speed() / (0.8 * critical)).ceil() as usize;
    let end = |refined: usize| {
        let mut d = lay_out(&model);
        d.set_time_step(0.8 * critical / refined as f64).expect("a positive time step");
        for s in massive(&d) {
            // The acceleration at the start is zero, so this is the velocity half a step earlier too.
            d.state.vx[s] = 0.01 * (PI * d.state.x[s] / length).cos();
        }
        run(&mut d, &mut [], steps * refined);
        d.state.x[slot(&d, columns)] - length
    };
    let exact = end(32);
    let errors = [1, 2, 4].map(|refined| (end(refined) - exact).abs());
    for order in orders(&errors) {
        assert!((1.9..2.2).contains(&order), "order {order}, errors {errors:?} m of {exact:e} m");
    }
}

/// Source: THEORY §2.5.
#[test]
fn analytic_driven_ring_turns_as_one() {
    // A ring launched at the speed of its driven bore stays in rigid rotation: kinetic energy ½ I ω², no drive work.
    let (facets, layers, rate) = (60, 4, -80.0);
    let ring = Annulus {
        inner_radius: 0.05,
        outer_radius: 0.07,
        facets,
        layers,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    let centre = [0.02, -0.01];
    let mut model = body(&ring.part().expect("a ring").translated(centre[0], centre[1]));
    for n in 0..facets {
        model.motion[n] = Motion::Rotating { centre, rate };
    }
    let mut d = ready(&model, 0.9);
    let mut inertia = 0.0;
    for n in massive(&d) {
        let (x, y) = (d.state.x[n] - centre[0], d.state.y[n] - centre[1]);
        inertia += d.mass()[n] * (x * x + y * y);
        let (s, c) = (-0.5 * rate * d.time_step()).sin_cos();
        (d.state.vx[n], d.state.vy[n]) = (-rate * (s * x + c * y), rate * (c * x - s * y));
    }
    run(&mut d, &mut [], 5000);
    let now = step_and_balance(&mut d, &mut []);
    // Centrifugal stretch of 1e-8 and its ringing are all that differs.
    let expected = 0.5 * inertia * rate * rate;
    ledger::compare("driven ring, kinetic energy", "½ I ω²", "J", now.kinetic, expected, 1e-6);
    assert!(now.drive.abs() < 1e-6 * now.kinetic, "drive work {:e} J", now.drive);
}
