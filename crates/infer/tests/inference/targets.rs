//! Targets that are missing, out of reach, or exclude one another; runs at the posterior, and the gain from
//! more of them.

use stribeck_infer::{
    Conflict, Emulator, NextOptions, Output, Posterior, PosteriorOptions, Predictive, Prior, Runs, Scale,
    Target, expected_gain, next, sobol,
};

const PRIORS: [Prior; 3] = [Prior::Uniform { from: 0.0, to: 1.0 }; 3];
const OPTIONS: PosteriorOptions = PosteriorOptions { draws: 1000, seed: 1 };

/// y₀ = x₀; y₁ = 1 − x₀² + small ripple along x₂; y₂ = x₁, missing where x₂ < 0.5.
fn emulator(runs: usize) -> Emulator {
    let points = sobol(1, 3, 0, runs).unwrap();
    let one = |x: &Vec<f64>| {
        let ripple = 0.05 * (12.0 * x[2]).sin() * (9.0 * x[1]).cos();
        vec![Some(x[0]), Some(1.0 - x[0] * x[0] + ripple), (x[2] >= 0.5).then_some(x[1])]
    };
    let outputs = points.iter().map(one).collect();
    let columns = ["y0", "y1", "y2"].map(|name| Output { name: name.to_owned(), scale: Scale::Linear });
    Emulator::fit(&Runs { points, outputs, ..Runs::default() }, &columns, 0).unwrap()
}

fn target(output: usize, value: impl Into<Option<f64>>, tolerance: f64) -> Target {
    Target { output, value: value.into(), tolerance }
}

#[test]
fn planted_a_missing_output_tells_where_it_is_missing() {
    let emulator = emulator(128);
    for (value, lower) in [(None, true), (Some(0.4), false)] {
        let posterior = Posterior::of(&emulator, &PRIORS, &[target(2, value, 0.05)], OPTIONS).unwrap();
        let below = posterior.column(2).iter().filter(|&&x| x < 0.5).count() as f64 / 1000.0;
        assert!(if lower { below > 0.85 } else { below < 0.15 }, "{value:?}: {below} of draws below 0.5");
    }
}

#[test]
fn planted_conflicts_are_named() {
    let emulator = emulator(128);
    // y₀ = 0.9 makes y₁ = 0.19; both are within reach alone. y₂ = 1.6 is not.
    let targets = [target(0, 0.9, 0.02), target(1, 0.75, 0.05), target(2, 1.6, 0.05)];
    let conflict = Conflict::of(&emulator, &PRIORS, &targets, None, 1).unwrap();
    let outside: Vec<usize> = conflict.out_of_reach().map(|reach| reach.target).collect();
    assert_eq!(outside, [2]);
    assert!(conflict.reaches[2].deviations > 5.0 && (conflict.reaches[2].prediction - 1.0).abs() < 0.1);
    let pairs: Vec<[usize; 2]> = conflict.exclusions.iter().map(|pair| pair.targets).collect();
    assert_eq!(pairs, [[0, 1]]);

    let targets = [target(0, 0.6, 0.02), target(1, 0.64, 0.05), target(2, 0.3, 0.05)];
    let conflict = Conflict::of(&emulator, &PRIORS, &targets, None, 1).unwrap();
    assert!(conflict.out_of_reach().next().is_none() && conflict.exclusions.is_empty(), "{conflict:?}");
    assert!(conflict.reaches.iter().all(|reach| reach.deviations_together.abs() < 1.5), "{conflict:?}");
}

#[test]
fn planted_runs_at_the_posterior_lie_about_their_targets() {
    let emulator = emulator(128);
    let targets = [target(0, 0.6, 0.02), target(1, 0.64, 0.05)];
    let posterior = Posterior::of(&emulator, &PRIORS, &targets, OPTIONS).unwrap();
    let predictive = Predictive::of(&emulator, &posterior, &targets, 1).unwrap();
    for (one, target) in predictive.iter().zip(&targets) {
        let below = one.below_target.unwrap();
        assert!((0.1..0.9).contains(&below), "{below}");
        assert!((one.quantiles[2] - target.value.unwrap()).abs() < 0.03, "{:?}", one.quantiles);
    }
    assert!(predictive[2].below_target.is_none() && (0.3..0.7).contains(&predictive[2].exists));
}

/// Few runs do not resolve the ripple; runs at the requested points narrow the posterior no less than was
/// expected of any, and the expectation lies between the present posterior and the limit.
#[test]
fn planted_further_runs_narrow_the_posterior() {
    let emulator = emulator(24);
    let targets = [target(1, 0.64, 0.01)];
    let posterior = Posterior::of(&emulator, &PRIORS, &targets, OPTIONS).unwrap();
    let options = NextOptions { count: 20, filling: 0.2, filled: 0, seed: 1 };
    let points = next(&emulator, &PRIORS, &targets, &posterior, options).unwrap();
    assert_eq!(points.len(), 20);
    let mean = posterior.moments(0)[0];
    let off = |point: &Vec<f64>| (point[0] - mean).abs();
    let [sought, filling] =
        [&points[..16], &points[16..]].map(|some| some.iter().map(off).sum::<f64>() / some.len() as f64);
    assert!(sought < 0.15 && filling > 0.15, "{sought} {filling}");
    let gain = expected_gain(&emulator, &PRIORS, &targets, &posterior, &points).unwrap()[0];
    assert!(gain.limit < 0.95 * gain.deviation, "{gain:?}");
    assert!(gain.after < gain.deviation && gain.after > 0.95 * gain.limit, "{gain:?}");
}
