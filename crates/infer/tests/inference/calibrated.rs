//! Simulation-based calibration of the whole chain on a simulator whose truths are known: runs, emulator,
//! posterior.

use crate::simulator::{FIELDS, IDLE, OUTPUTS, PRIORS, columns, readings, runs, truths};
use stribeck_infer::{Calibration, Emulator, PosteriorOptions, Runs};

const TRUTHS: usize = 200;
const OPTIONS: PosteriorOptions = PosteriorOptions { draws: 300, seed: 9 };

fn calibration(times: f64) -> Calibration {
    calibration_by(&runs(8, 192, 2), times)
}

fn calibration_by(runs: &Runs, times: f64) -> Calibration {
    let emulator = Emulator::fit(runs, &columns(), 0).unwrap();
    let all: Vec<(usize, f64)> = (0..OUTPUTS).map(|output| (output, 0.0)).collect();
    Calibration::of(&emulator, &PRIORS, &truths(80, TRUTHS, times), &all, OPTIONS).unwrap()
}

/// 90 % intervals hold 85 to 95 % of the truths of every field, ranks are even, and the field without
/// influence keeps its prior while the others are learned.
#[test]
fn example_intervals_hold_the_truths_that_they_should() {
    let calibration = calibration(1.0);
    for (number, field) in calibration.fields.iter().enumerate() {
        assert!((0.85..=0.95).contains(&field.coverage_90.share), "field {number}: {field:?}");
        assert!((0.40..=0.60).contains(&field.coverage_50.share), "field {number}: {field:?}");
        assert!(field.p_value > 0.001, "field {number}: {field:?}");
    }
    let width = |field: usize| calibration.fields[field].width;
    assert!((width(IDLE) - 1.0).abs() < 0.05, "{}", width(IDLE));
    assert!((0..FIELDS).all(|field| field == IDLE || width(field) < 0.7));
}

/// Readings of one run err together. Told so, intervals hold as many truths as they should; taken for runs of
/// their own, they predict one another, and the emulator is too sure.
#[test]
fn issue_readings_of_one_run_counted_as_runs() {
    let worst = |calibration: &Calibration| {
        calibration.fields.iter().map(|field| field.coverage_90.share).fold(1.0, f64::min)
    };
    let together = readings(8, 80, 3);
    let told = calibration_by(&together, 1.0);
    assert!(worst(&told) >= 0.85, "{told:?}");
    let apart = calibration_by(&Runs { simulations: Vec::new(), ..together }, 1.0);
    assert!(worst(&apart) < 0.8, "{apart:?}");
}

/// The same check finds an emulator whose scatter is half of the truths'.
#[test]
fn example_half_the_scatter_is_found_out() {
    let calibration = calibration(2.0);
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
