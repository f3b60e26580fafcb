//! The power of the likelihood with which runs lie in their own intervals as often as they should.

use crate::simulator::{OUTPUTS, PRIORS, columns, runs, truths};
use stribeck_infer::{Calibration, Emulator, PosteriorOptions, Power};

const TRUTHS: usize = 200;
const OPTIONS: PosteriorOptions = PosteriorOptions { draws: 300, seed: 9 };

/// Every output taken three times over for three outputs of their own counts three times: the power has to
/// be a third, and with it intervals hold truths that no run has seen.
#[test]
fn example_evidence_that_counts_three_times_gets_a_third_of_its_weight() {
    let runs = runs(8, 96, 2);
    let once: Vec<(usize, f64)> = (0..OUTPUTS).map(|output| (output, 0.0)).collect();
    let thrice = once.repeat(3);
    let emulator = Emulator::fit(&runs, &columns(), 0).unwrap();
    let sound = Power::of(&runs, &columns(), &PRIORS, &once, usize::MAX, 3).unwrap();
    assert!(sound.truths == 96 && sound.power >= 0.8, "{sound:?}");
    let found = Power::of(&runs, &columns(), &PRIORS, &thrice, usize::MAX, 3).unwrap();
    assert!((0.2..=0.5).contains(&found.power) && found.held_plain < 0.85 && found.held >= 0.9, "{found:?}");
    let held = |power: f64| {
        let emulator = emulator.clone().with_power(power);
        let all = Calibration::of(&emulator, &PRIORS, &truths(80, TRUTHS, 1.0), &thrice, OPTIONS).unwrap();
        all.fields.iter().map(|field| field.coverage_90.share).fold(1.0, f64::min)
    };
    let [plain, mended] = [held(1.0), held(found.power)];
    assert!(plain < 0.8 && mended >= 0.85, "{plain} {mended}");
}

/// Few runs say nothing of their intervals: the power stays 1.
#[test]
fn example_few_runs_leave_likelihoods_as_they_are() {
    let all: Vec<(usize, f64)> = (0..OUTPUTS).map(|output| (output, 0.0)).collect();
    let found = Power::of(&runs(8, 30, 1), &columns(), &PRIORS, &all, usize::MAX, 3).unwrap();
    assert_eq!((found.power, found.truths), (1.0, 0));
}
