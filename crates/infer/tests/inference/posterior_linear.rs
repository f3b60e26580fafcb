//! Two outputs, linear in two of three fields, known with normal errors: the posterior is normal with the
//! covariance (Aᵀ S⁻¹ A)⁻¹ as long as the cube's faces are far away (Gelman and others, *Bayesian Data
//! Analysis*, 2013, §14.3).
//!
//! ```text
//! y₀ = x₀ + x₁          ± 0.05, observed 1.0        A = ⎡1  1⎤    det A = −3
//! y₁ = x₀ − 2 x₁        ± 0.08, observed −0.5           ⎣1 −2⎦
//! ```

use stribeck_infer::{
    Emulator, Output, Posterior, PosteriorOptions, Prior, Runs, Scale, Target, pulls, sobol,
};

const ERRORS: [f64; 2] = [0.05, 0.08];
const OBSERVED: [f64; 2] = [1.0, -0.5];
const PRIORS: [Prior; 3] = [Prior::Uniform { from: 0.0, to: 1.0 }; 3];

/// Standard deviations that a Monte Carlo estimate may lie off.
const OFF: f64 = 4.0;

fn emulator() -> Emulator {
    let points = sobol(1, 3, 0, 32).unwrap();
    let outputs = points.iter().map(|x| vec![Some(x[0] + x[1]), Some(x[0] - 2.0 * x[1])]).collect();
    let columns = ["y0", "y1"].map(|name| Output { name: name.to_owned(), scale: Scale::Linear });
    Emulator::fit(&Runs { points, outputs, ..Runs::default() }, &columns, 0).unwrap()
}

fn targets() -> [Target; 2] {
    [0, 1].map(|i| Target { output: i, value: Some(OBSERVED[i]), tolerance: ERRORS[i] })
}

#[test]
fn analytic_mean_deviation_and_evidence_of_a_linear_problem() {
    let options = PosteriorOptions { draws: 4000, seed: 3 };
    let posterior = Posterior::of(&emulator(), &PRIORS, &targets(), options).unwrap();
    // x₀ = (2 y₀ + y₁)/3, x₁ = (y₀ − y₁)/3.
    let means = [0.5, 0.5];
    let deviations = [
        (4.0 * ERRORS[0].powi(2) + ERRORS[1].powi(2)).sqrt() / 3.0,
        (ERRORS[0].powi(2) + ERRORS[1].powi(2)).sqrt() / 3.0,
    ];
    let n = posterior.effective_sample_size;
    assert!(n > 2000.0, "{n}");
    for i in 0..2 {
        let [mean, sd] = posterior.moments(i);
        assert!((mean - means[i]).abs() < OFF * deviations[i] / n.sqrt(), "x{i}: mean {mean}");
        assert!(
            (sd / deviations[i] - 1.0).abs() < OFF / (2.0 * n).sqrt(),
            "x{i}: {sd}, not {}",
            deviations[i]
        );
    }
    // The third field has no say: it keeps its prior.
    let [mean, sd] = posterior.moments(2);
    assert!((mean - 0.5).abs() < OFF * (1.0 / 12.0 / n).sqrt(), "{mean}");
    assert!((sd - (1.0_f64 / 12.0).sqrt()).abs() < 0.01, "{sd}");
    // ∫ N(y; A x, S) dx = 1/|det A|.
    assert!((posterior.log_evidence + 3_f64.ln()).abs() < 0.15, "{}", posterior.log_evidence);
}

#[test]
fn analytic_without_a_target_a_field_widens_along_the_other() {
    let (emulator, targets, options) = (emulator(), targets(), PosteriorOptions { draws: 2000, seed: 4 });
    let posterior = Posterior::of(&emulator, &PRIORS, &targets, options).unwrap();
    let pulls = pulls(&emulator, &PRIORS, &targets, &posterior, options).unwrap();
    assert_eq!(pulls.len(), 6);
    // Without y₀, points with x₀ − 2 x₁ = −0.5 remain: x₁ is even between 0.25 and 0.75, x₀ = 2 x₁ − 0.5 is
    // even in the unit interval; variances 1/48 and 1/12.
    let pull = pulls.iter().find(|pull| pull.target == 0 && pull.field == 0).unwrap();
    let with = (4.0 * ERRORS[0].powi(2) + ERRORS[1].powi(2)) / 9.0;
    assert!((pull.variance_ratio * (1.0 / 12.0) / with - 1.0).abs() < 0.15, "{pull:?}");
    let idle = pulls.iter().filter(|pull| pull.field == 2);
    for pull in idle {
        assert!(pull.shift.abs() < 0.15 && (pull.variance_ratio - 1.0).abs() < 0.15, "{pull:?}");
    }
}

#[test]
fn invariant_the_same_seed_gives_the_same_draws() {
    let emulator = emulator();
    let draws = |seed| {
        let options = PosteriorOptions { draws: 100, seed };
        Posterior::of(&emulator, &PRIORS, &targets(), options).unwrap().draws
    };
    assert_eq!(draws(1), draws(1));
    assert_ne!(draws(1), draws(2));
}
