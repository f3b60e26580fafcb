//! The emulator on known functions.

use crate::simulator::{self, FIELDS, OUTPUTS, columns, runs, truths};
use stribeck_infer::{Emulator, Output, Runs, Scale, sobol};

fn linear(names: &[&str]) -> Vec<Output> {
    names.iter().map(|name| Output { name: (*name).to_owned(), scale: Scale::Linear }).collect()
}

/// A linear function is its own trend.
#[test]
fn invariant_a_linear_function_is_met_exactly() {
    let f = |x: &[f64]| 3.0 + 2.0 * x[0] - 0.7 * x[1];
    let points = sobol(1, 3, 0, 24).unwrap();
    let outputs = points.iter().map(|x| vec![Some(f(x))]).collect();
    let emulator = Emulator::fit(&Runs { points, outputs, ..Runs::default() }, &linear(&["y"]), 0).unwrap();
    for x in sobol(2, 3, 0, 50).unwrap() {
        let at = emulator.predict(&x).unwrap()[0];
        // The output's standard deviation is 0.6; a noise of 1e-8 of its variance is the least that is
        // assumed.
        assert!((at.mean - f(&x)).abs() < 1e-4, "{} instead of {}", at.mean, f(&x));
        assert!(at.sd_of_mean < 1e-3 && at.scatter < 1e-3, "{at:?}");
    }
    assert!(emulator.quality()[0].r_squared > 0.999_999);
}

#[test]
fn invariant_a_constant_output_stays_constant() {
    let points = sobol(1, 2, 0, 16).unwrap();
    let outputs = points.iter().map(|_| vec![Some(7.5)]).collect();
    let emulator = Emulator::fit(&Runs { points, outputs, ..Runs::default() }, &linear(&["y"]), 0).unwrap();
    let at = emulator.predict(&[0.3, 0.9]).unwrap()[0];
    assert!((at.mean - 7.5).abs() < 1e-9 && at.sd_of_mean < 1e-9 && at.scatter < 1e-9, "{at:?}");
}

/// Scatter that grows fourfold with one field, existence that grows with another, and residuals of two
/// outputs that share 80 % of their variance.
#[test]
fn planted_scatter_existence_and_correlation_are_found() {
    let emulator = Emulator::fit(&runs(5, 200, 2), &columns(), 0).unwrap();
    let mut quiet = [0.5; FIELDS];
    quiet[1] = 0.05;
    let mut loud = quiet;
    loud[1] = 0.95;
    for output in [1, 2, 5] {
        let [a, b] = [quiet, loud].map(|x| emulator.predict(&x).unwrap()[output].scatter);
        let expected = simulator::scatter(&loud) / simulator::scatter(&quiet);
        // A standard deviation from 200 pairs that share few degrees of freedom at each end.
        assert!(
            (b / a / expected - 1.0).abs() < 0.4,
            "output {output}: {a} to {b}, expected ratio {expected}"
        );
        assert!((a / simulator::scatter(&quiet) - 1.0).abs() < 0.3, "output {output}: {a}");
    }
    let at = |x0: f64| {
        let mut x = [0.5; FIELDS];
        x[0] = x0;
        emulator.predict(&x).unwrap()[4].exists
    };
    // The standard normal distribution below 4 x₀ − 0.8: 0.27, 0.66, 0.98.
    assert!(
        (at(0.05) - 0.27).abs() < 0.15 && (at(0.3) - 0.66).abs() < 0.15 && at(0.7) > 0.9,
        "{} {}",
        at(0.05),
        at(0.3)
    );
    assert!(emulator.correlation(6, 7) > 0.6 && emulator.correlation(1, 2).abs() < 0.2);
}

/// Conformal intervals of 90 % on 1000 fresh runs. The share of a single output has a standard deviation of
/// 2.8 %, nearly all from the 128 points that the width of intervals follows from; the mean over outputs
/// less.
#[test]
fn planted_intervals_hold_the_runs_that_they_should() {
    let emulator = Emulator::fit(&runs(6, 128, 2), &columns(), 0).unwrap();
    let fresh = truths(60, 1000, 1.0);
    let share = |output: usize| {
        let mut held = [0.0; 2];
        for truth in &fresh {
            let Some(value) = truth.outputs[output] else { continue };
            let [low, high] = emulator.interval(&truth.point, output, 0.9).unwrap().unwrap();
            held[usize::from(value >= low && value <= high)] += 1.0;
        }
        held[1] / (held[0] + held[1])
    };
    let shares: Vec<f64> = (0..OUTPUTS).map(share).collect();
    assert!(shares.iter().all(|share| (0.82..=0.98).contains(share)), "{shares:?}");
    let mean = shares.iter().sum::<f64>() / OUTPUTS as f64;
    assert!((0.87..=0.93).contains(&mean), "{shares:?}");
    assert!(emulator.quality().iter().all(|said| (0.84..=0.96).contains(&said.coverage_90)));
}

/// The same runs give the same emulator, whatever the machine does meanwhile.
#[test]
fn invariant_the_same_runs_give_the_same_bits() {
    let predict = || {
        let emulator = Emulator::fit(&runs(5, 50, 2), &columns(), 0).unwrap();
        format!("{:?}", emulator.predict(&[0.2; FIELDS]).unwrap())
    };
    assert_eq!(predict(), predict());
}
