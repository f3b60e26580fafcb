//! Stiffness damping: rates of decay, the edge of stability, its heat, and undamped motions.
//!
//! Problems with a closed form have a file each.

#[path = "../common/mod.rs"]
mod common;

mod bar_modes;
mod disc_that_spins;

use common::*;
use stribeck_solver::{Dynamics, critical::damped_time_step};
use stribeck_testing::{assert_close, assert_refused};

/// Sets the damping [s] and `factor` of the critical time step under it.
fn damp(d: &mut Dynamics, beta: f64, factor: f64) {
    d.set_stiffness_damping(beta).expect("a possible damping");
    let guess = damped_time_step(d.critical_time_step(&[], 0.0).time_step, beta);
    let critical = d.critical_time_step(&[], guess).time_step;
    d.set_time_step(factor * critical).expect("a positive time step");
}

#[test]
fn invariant_the_edge_of_stability_is_where_it_is_predicted() {
    // Ω² + 2βω²Δt = 4: just below nothing grows, just above a disturbance of the highest mode does.
    let part = rectangle(4e-3, 3e-3, 4, 3);
    let model = body(&part);
    let undamped = lay_out(&model).critical_time_step(&[], 0.0).time_step;
    for beta in [0.02 * undamped, 0.3 * undamped, 3.0 * undamped] {
        let largest = |factor: f64| {
            let mut d = lay_out(&model);
            d.set_stiffness_damping(beta).expect("a possible damping");
            d.set_time_step(factor * damped_time_step(undamped, beta)).expect("a positive time step");
            shake(&mut d, 1e-3);
            run(&mut d, &mut [], 4000);
            let speeds = massive(&d).into_iter().map(|n| d.state.vx[n].abs());
            // An amplitude that has overflowed is infinite.
            speeds.map(|v| if v.is_nan() { f64::INFINITY } else { v }).fold(0.0, f64::max)
        };
        // The eigenvalue is bounded within 0.2 %, the step within 0.1 %.
        let (below, above) = (largest(0.999), largest(1.004));
        assert!(below < 3e-3, "β = {beta:e} s: {below:e} m/s below the limit");
        assert!(above > 1.0, "β = {beta:e} s: {above:e} m/s above the limit");
    }
}

#[test]
fn invariant_the_critical_step_of_elements_is_the_closed_form() {
    // Without other forces K(1 + 2β/Δt) at Δt itself gives Δt² + 2βΔt = (2/ω)².
    let mut d = lay_out(&body(&rectangle(4e-3, 3e-3, 4, 3)));
    let undamped = d.critical_time_step(&[], 0.0).time_step;
    for share in [0.0, 0.1, 1.0, 10.0] {
        let beta = share * undamped;
        d.set_stiffness_damping(beta).expect("a possible damping");
        let damped = damped_time_step(undamped, beta);
        assert_close(damped * damped + 2.0 * beta * damped, undamped * undamped, 1e-12, "Δt² + 2βΔt");
        assert_close(d.critical_time_step(&[], damped).time_step, damped, 2e-3, "critical step");
    }
    for beta in [-1e-9, f64::NAN] {
        assert_refused(d.set_stiffness_damping(beta), "zero or positive");
    }
}

#[test]
fn conserves_the_ledger_of_stiffness_damping() {
    let mut d = lay_out(&workshop());
    damp(&mut d, 5e-9, 0.9);
    shake(&mut d, 1e-3);
    // The first steps turn half of the energy from motion into strain, too fast for counting every fourth
    // step.
    run(&mut d, &mut [], 16);
    let balance = |d: &mut Dynamics| {
        let now = step_and_balance(d, &mut []);
        [now.mechanical() - now.drive, d.heat.at_last_positions()]
    };
    let [start, none] = balance(&mut d);
    let (mut heat, mut worst) = (none, 0.0_f64);
    for _ in 0..3000 {
        let [rest, so_far] = balance(&mut d);
        heat = so_far;
        worst = worst.max((rest + heat - start - none).abs());
    }
    println!("heat {:.3e} of {start:.3e} J, missing {:.2e} of it", heat - none, worst / (heat - none));
    assert!(heat - none > 0.0);
    assert!(worst < 5e-3 * (heat - none), "{:e} of the heat is missing", worst / (heat - none));
}

#[test]
fn invariant_threads_and_interruptions_change_no_bit() {
    let model = workshop();
    let made = |threads: usize| {
        let mut d = Dynamics::new(&model, &vec![true; model.mesh.x.len()], threads).expect("a model");
        damp(&mut d, 1e-8, 0.9);
        d
    };
    assert_threads_and_interruptions_change_no_bit(made);
}

#[test]
fn invariant_none_is_as_if_it_were_never_set() {
    let model = workshop();
    let run_with = |set: bool| {
        let mut d = ready(&model, 0.9);
        if set {
            d.set_stiffness_damping(1e-8).expect("a possible damping");
            d.set_stiffness_damping(0.0).expect("none");
        }
        shake(&mut d, 0.1);
        run(&mut d, &mut [], 50);
        d.snapshot()
    };
    assert!(run_with(false) == run_with(true));
}
