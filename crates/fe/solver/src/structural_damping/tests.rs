//! A branch fitted to a band, and one vibration that it damps. Rates: THEORY §2.8, (2.37).

use super::*;

/// Growth [1/s] of one mode of `omega` [rad/s] without the branch over this number of evaluations, in steps
/// of `dt` [s].
fn growth(damping: &StructuralDamping, omega: f64, dt: f64, evaluations: usize) -> f64 {
    let Branch { stiffness, relaxation_time } = damping.branch();
    let stiffer = damping.stiffening(f64::INFINITY);
    let (mut x, mut v, mut path) = (1.0, 0.0, 1.0);
    let (mut step, mut total) = (0, 0.0);
    let mut steps = 1;
    let (mut first, mut logarithm) = (0, 0.0_f64);
    // The first tenth is left out: fast parts of the start die away in it.
    for evaluation in 0..evaluations {
        let passed = steps as f64 * dt;
        let keep = (-passed / relaxation_time).exp();
        path = keep * path + (1.0 - keep) * x;
        let back = 0.5 * (dt / relaxation_time).exp_m1();
        let held = stiffness * ((1.0 + back) * path - back * x);
        steps = damping.steps_until_next(dt, step);
        for _ in 0..steps {
            v += dt * omega * (held - stiffer * x);
            x += dt * omega * v;
        }
        step += steps;
        let size: f64 = (path * path + x * x + v * v).sqrt();
        total += size.ln();
        x /= size;
        v /= size;
        path /= size;
        if evaluation == evaluations / 10 {
            (first, logarithm) = (step, total);
        }
    }
    (total - logarithm) / ((step - first) as f64 * dt)
}

/// (2.37) is of first order in the loss, which is 5 % at most.
const IN_THE_BAND: f64 = 0.05;

#[test]
fn analytic_vibrations_in_the_band_decay_by_their_ratio() {
    let dt = 70e-9;
    let damping = StructuralDamping::over_band(0.02, [2e3, 4e4], vec![0]).expect("a band");
    for frequency in [5e3, 1e4, 2e4, 4e4] {
        // That of the mode without the branch is lower, because the branch makes it stiffer.
        let omega = TAU * frequency / damping.stiffening(frequency).sqrt();
        let expected = TAU * frequency * damping.ratio(frequency);
        let off = growth(&damping, omega, dt, 50_000) / -expected - 1.0;
        assert!(off.abs() < IN_THE_BAND, "{frequency} Hz: {off}");
    }
}

#[test]
fn analytic_no_vibration_grows_that_is_sampled_at_uneven_times() {
    let dt = 70e-9;
    let damping = StructuralDamping::over_band(0.02, [2e3, 4e4], vec![0]).expect("a band");
    let Branch { stiffness, relaxation_time } = damping.branch();
    let stiffer = damping.stiffening(f64::INFINITY);
    // Far above the band a vibration decays by g/2τ over its stiffening.
    let expected = 0.5 * stiffness / relaxation_time / stiffer;
    let highest = 2.0 / (dt * stiffer.sqrt());
    let modes = (12..=400).map(|n| 0.0025 * 0.98 * f64::from(n) * highest);
    let mut all: Vec<f64> = modes.map(|omega| growth(&damping, omega, dt, 4000)).collect();
    all.sort_by(f64::total_cmp);
    let (median, worst) = (all[all.len() / 2], all[all.len() - 1]);
    assert!(worst < -0.6 * expected, "{worst:e} of {expected:e}");
    assert!((median / -expected - 1.0).abs() < 0.15, "{median:e}");
}

/// The largest ratio, lower and higher bands, and a step that is seven times shorter.
#[test]
fn invariant_no_vibration_grows_in_any_band_or_step() {
    for (dt, ratio, band) in [
        (70e-9, 0.02, [200.0, 4e3]),
        (70e-9, 0.1, [200.0, 4e3]),
        (70e-9, 0.1, [2e3, 4e4]),
        (70e-9, 0.1, [5e3, 1e5]),
        (10e-9, 0.1, [2e3, 4e4]),
    ] {
        let damping = StructuralDamping::over_band(ratio, band, vec![0]).expect("a band");
        let highest = 2.0 / (dt * damping.stiffening(f64::INFINITY).sqrt());
        for n in (12..=400).step_by(4) {
            let rate = growth(&damping, 0.0025 * 0.98 * f64::from(n) * highest, dt, 4000);
            assert!(rate < 0.0, "{ratio} over {band:?}, mode {n}: {rate:e}");
        }
    }
}

#[test]
fn refuses_impossible_branches_and_bands() {
    let branch = |stiffness, relaxation_time| Branch { stiffness, relaxation_time };
    assert!(StructuralDamping::new(branch(0.1, 1e-5), vec![]).is_ok());
    for (bad, words) in [
        (branch(0.0, 1e-5), "stiffness of a branch"),
        (branch(0.1, f64::NAN), "relaxation time of a branch"),
        (branch(-0.1, 1e-5), "stiffness of a branch"),
    ] {
        stribeck_testing::assert_refused(StructuralDamping::new(bad, vec![]), words);
    }
    let band = |ratio, band| StructuralDamping::over_band(ratio, band, vec![]);
    assert!(band(0.02, [2e3, 4e4]).is_ok());
    for (ratio, ends, words) in [
        (0.0, [2e3, 4e4], "ratio"),
        (0.2, [2e3, 4e4], "ratio"),
        (0.02, [0.0, 4e4], "lower end of the damped band"),
        (0.02, [4e4, 2e3], "above the lower end"),
        (0.02, [2e3, f64::INFINITY], "above the lower end"),
        (0.1, [1.0, 1e9], "closer to the lower end"),
    ] {
        stribeck_testing::assert_refused(band(ratio, ends), words);
    }
}
