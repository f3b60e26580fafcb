//! Bad input, and the answers that it gets.

use stribeck_infer::{
    Calibration, Curves, Emulator, Output, Posterior, PosteriorOptions, Prior, Runs, Scale, Target, sobol,
};
use stribeck_testing::refuses;

fn columns() -> Vec<Output> {
    vec![
        Output { name: "a".to_owned(), scale: Scale::Linear },
        Output { name: "b".to_owned(), scale: Scale::Logarithmic },
    ]
}

fn runs() -> Runs {
    let points = sobol(1, 2, 0, 12).unwrap();
    let outputs = points.iter().map(|x| vec![Some(x[0]), Some(1.0 + x[1])]).collect();
    Runs { points, outputs, ..Runs::default() }
}

#[test]
fn refuses_priors_that_are_no_distributions() {
    let cases: [(Prior, &[&str]); 6] = [
        (Prior::Uniform { from: 2.0, to: 1.0 }, &["to = 1", "above `from`"]),
        (Prior::Uniform { from: f64::NAN, to: 1.0 }, &["from = NaN", "finite"]),
        (Prior::LogUniform { from: 0.0, to: 1.0 }, &["from = 0", "above 0", "`Uniform`"]),
        (Prior::Normal { mean: 0.0, sd: 0.0, from: -1.0, to: 1.0 }, &["sd = 0", "above 0"]),
        (Prior::Normal { mean: 50.0, sd: 1.0, from: -1.0, to: 1.0 }, &["mean = 50", "too far"]),
        (Prior::Choices(0), &["choices = 0", "1 at least"]),
    ];
    for (prior, words) in cases {
        refuses(prior.check(), words);
    }
}

#[test]
fn refuses_runs_that_do_not_fit_together() {
    let fit = |change: fn(&mut Runs)| {
        let mut runs = runs();
        change(&mut runs);
        Emulator::fit(&runs, &columns(), 0)
    };
    refuses(fit(|runs| runs.points[3] = vec![0.1]), &["point 3 has 1 numbers, expected 2"]);
    refuses(fit(|runs| runs.points[3][1] = 1.5), &["coordinate 1 of row 3 = 1.5", "0 to 1"]);
    refuses(fit(|runs| runs.points[3][1] = f64::NAN), &["coordinate 1 of row 3 = NaN"]);
    refuses(
        fit(|runs| runs.outputs[5][1] = Some(-2.0)),
        &["output `b`", "row 5 = -2", "positive", "`Linear`"],
    );
    refuses(fit(|runs| runs.outputs[5][0] = Some(f64::INFINITY)), &["output `a`", "row 5 = inf", "finite"]);
    refuses(fit(|runs| runs.outputs[5] = vec![None]), &["row of outputs 5 has 1 numbers, expected 2"]);
    refuses(fit(|runs| runs.outputs.truncate(4)), &["table 0 has 4 numbers, expected 12"]);
    refuses(fit(|runs| runs.simulations = vec![0; 5]), &["list of simulations 0 has 5 numbers, expected 12"]);
    let few = |runs: &mut Runs| {
        runs.points = vec![vec![0.5, 0.5]; 12];
    };
    refuses(fit(few), &["1 different points in 2 dimensions", "at least 4"]);
    refuses(fit(|runs| *runs = Runs::default()), &["0 different points"]);
}

#[test]
fn refuses_targets_that_cannot_be_asked_for() {
    let emulator = Emulator::fit(&runs(), &columns(), 0).unwrap();
    let ask = |output, value, tolerance| {
        emulator.log_likelihood(&[0.5, 0.5], &[Target { output, value, tolerance }])
    };
    assert!(ask(1, Some(1.5), 0.0).unwrap().is_finite());
    refuses(ask(7, Some(1.0), 0.0), &["target 0", "`7`", "outputs 0 to 1"]);
    refuses(ask(1, Some(-1.0), 0.0), &["target 0", "`b`", "value = -1", "positive"]);
    refuses(ask(0, Some(f64::NAN), 0.0), &["`a`", "value = NaN"]);
    refuses(ask(0, Some(1.0), -0.1), &["`a`", "tolerance = -0.1"]);
    refuses(emulator.log_likelihood(&[0.5], &[]), &["point 0 has 1 numbers, expected 2"]);
}

#[test]
fn refuses_options_out_of_range() {
    let emulator = Emulator::fit(&runs(), &columns(), 0).unwrap();
    let priors = [Prior::Uniform { from: 0.0, to: 1.0 }; 2];
    let draws = |draws| Posterior::of(&emulator, &priors, &[], PosteriorOptions { draws, seed: 1 });
    refuses(draws(3), &["draws = 3", "50 to 16384"]);
    let one = Posterior::of(&emulator, &priors[..1], &[], PosteriorOptions::default());
    refuses(one, &["list of priors", "1 numbers, expected 2"]);
    refuses(emulator.interval(&[0.5, 0.5], 0, 1.0), &["share = 1", "below 1"]);
    let none = Calibration::of(&emulator, &priors, &[], &[], PosteriorOptions::default());
    refuses(none, &["truths = 0", "1 at least"]);
    refuses(Curves::fit(&[vec![1.0]], 0.9, 5), &["curves = 1", "2 at least"]);
    refuses(Curves::fit(&[vec![1.0], vec![1.0, 2.0]], 0.9, 5), &["curve 1 has 2 numbers, expected 1"]);
}

/// Outputs that no run, or only a few, yield are not emulated, and say so instead of inventing a number.
#[test]
fn survives_outputs_that_hardly_exist() {
    let mut runs = runs();
    for (row, values) in runs.outputs.iter_mut().enumerate() {
        values[0] = values[0].filter(|_| row < 2);
        values[1] = None;
    }
    let emulator = Emulator::fit(&runs, &columns(), 0).unwrap();
    let at = emulator.predict(&[0.5, 0.5]).unwrap();
    assert!(at.iter().all(|one| one.mean.is_nan()) && at[0].exists > at[1].exists && at[1].exists < 0.1);
    assert_eq!(emulator.interval(&[0.5, 0.5], 0, 0.9).unwrap(), None);
    let asked = [Target { output: 1, value: Some(1.0), tolerance: 0.1 }];
    assert!(emulator.log_likelihood(&[0.5, 0.5], &asked).unwrap().is_finite());
}
