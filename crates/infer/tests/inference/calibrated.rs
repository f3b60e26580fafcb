//! Simulation-based calibration of the whole chain on a simulator whose truths are known: runs, emulator,
//! posterior.

use std::sync::OnceLock;

use crate::simulator::{FIELDS, IDLE, OUTPUTS, PRIORS, columns, only, readings, runs, truths};
use stribeck_infer::{Calibration, Emulator, Output, PosteriorOptions, Runs, Truth};

const TRUTHS: usize = 200;

/// What the truths of a scatter of `times` that of the runs say of one emulator, by so many draws for each.
fn calibration(times: f64, draws: usize) -> Calibration {
    static FITTED: OnceLock<Emulator> = OnceLock::new();
    let emulator = FITTED.get_or_init(|| Emulator::fit(&runs(8, 192, 2), &columns(), 0).unwrap());
    let all: Vec<(usize, f64)> = (0..OUTPUTS).map(|output| (output, 0.0)).collect();
    Calibration::of(emulator, &PRIORS, &truths(80, TRUTHS, times), &all, PosteriorOptions { draws, seed: 9 })
        .unwrap()
}

/// 90 % intervals hold 85 to 95 % of the truths of every field, ranks are even, and the field without
/// influence keeps its prior while the others are learned.
#[test]
fn planted_intervals_hold_the_truths_that_they_should() {
    let calibration = calibration(1.0, 300);
    for (number, field) in calibration.fields.iter().enumerate() {
        assert!((0.85..=0.95).contains(&field.coverage_90.share), "field {number}: {field:?}");
        assert!((0.40..=0.60).contains(&field.coverage_50.share), "field {number}: {field:?}");
        assert!(field.p_value > 0.001, "field {number}: {field:?}");
    }
    let width = |field: usize| calibration.fields[field].width;
    assert!((width(IDLE) - 1.0).abs() < 0.05, "{}", width(IDLE));
    assert!((0..FIELDS).all(|field| field == IDLE || width(field) < 0.7));
}

/// Readings of one run err together: told so, the emulator finds the scatter of starts, and its intervals
/// hold fresh runs; taken for runs of their own, they predict one another, and it is too sure.
#[test]
fn issue_readings_of_one_run_counted_as_runs() {
    const KEPT: [usize; 2] = [1, 5];
    let together = only(readings(8, 64, 3), &KEPT);
    let apart = Runs { simulations: Vec::new(), ..together.clone() };
    let names: Vec<Output> = KEPT.iter().map(|&output| columns()[output].clone()).collect();
    let [told, sure] = [together, apart].map(|runs| Emulator::fit(&runs, &names, 0).unwrap());
    let fresh = truths(80, TRUTHS, 1.0);
    let held = |emulator: &Emulator, output: usize| {
        let within = |truth: &&Truth| {
            let [low, high] = emulator.interval(&truth.point, output, 0.9).unwrap().unwrap();
            truth.outputs[KEPT[output]].is_some_and(|value| low <= value && value <= high)
        };
        fresh.iter().filter(within).count() as f64 / TRUTHS as f64
    };
    // Mean square of 0.05 + 0.15 x.
    let scatter = 0.0175_f64.sqrt();
    for output in 0..KEPT.len() {
        let [known, unknown] = [&told, &sure].map(|emulator| emulator.quality()[output].scatter / scatter);
        assert!((0.7..1.4).contains(&known) && unknown < 0.5, "{known} {unknown}");
        let [good, bad] = [&told, &sure].map(|emulator| held(emulator, output));
        assert!((0.82..=0.97).contains(&good) && bad < 0.75, "{good} {bad}");
    }
}

/// The same check finds an emulator whose scatter is half of the truths'.
#[test]
fn planted_half_the_scatter_is_found_out() {
    let calibration = calibration(2.0, 150);
    let worst = calibration.fields.iter().map(|field| field.coverage_90.share).fold(1.0, f64::min);
    assert!(worst < 0.8, "{worst}");
    let failing = calibration.fields.iter().filter(|field| field.p_value < 0.001).count();
    assert!(failing >= 2, "{calibration:?}");
    let idle = &calibration.fields[IDLE];
    assert!(
        (0.85..=0.95).contains(&idle.coverage_90.share),
        "a field without influence stays calibrated: {idle:?}"
    );
}
