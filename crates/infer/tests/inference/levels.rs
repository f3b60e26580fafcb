//! Intervals as wide as they have to be for the runs themselves, each inferred by an emulator of the others.

use crate::simulator::{PRIORS, columns, only, runs, truths};
use stribeck_infer::{Calibration, Emulator, Levels, Output, PosteriorOptions, Truth};

const TRUTHS: usize = 100;
const OPTIONS: PosteriorOptions = PosteriorOptions { draws: 300, seed: 9 };

/// Three outputs are enough, and quick.
const KEPT: [usize; 3] = [1, 2, 5];

/// Every output taken three times over, as if for outputs of their own: the central 90 % of the draws are too
/// narrow, and the intervals that the runs ask for hold truths that no run has seen.
#[test]
fn planted_evidence_that_counts_three_times_is_found_out_by_the_runs() {
    let names: Vec<Output> = KEPT.iter().map(|&output| columns()[output].clone()).collect();
    let runs = only(runs(8, 60, 1), &KEPT);
    let once: Vec<(usize, f64)> = (0..KEPT.len()).map(|output| (output, 0.0)).collect();
    let thrice = once.repeat(3);
    let of = |columns: &[(usize, f64)]| Levels::of(&runs, &names, &PRIORS, columns, usize::MAX, 3).unwrap();
    let levels = of(&thrice).unwrap();
    assert_eq!(levels.truths, 60);
    let emulator = Emulator::fit(&runs, &names, 0).unwrap();
    let kept = |truth: Truth| Truth { outputs: KEPT.map(|output| truth.outputs[output]).to_vec(), ..truth };
    let truths: Vec<Truth> = truths(80, TRUTHS, 1.0).into_iter().map(kept).collect();
    let calibration = Calibration::of(&emulator, &PRIORS, &truths, &thrice, OPTIONS).unwrap();
    let held = |level: &dyn Fn(usize) -> f64| {
        let within = |field: usize| {
            let ranks = calibration.ranks[field].iter();
            ranks.filter(|rank| (2.0 * **rank - 1.0).abs() <= level(field)).count() as f64
        };
        (0..PRIORS.len()).map(within).sum::<f64>() / (TRUTHS * PRIORS.len()) as f64
    };
    let [plain, widened] = [held(&|_| 0.9), held(&|field| levels.fields[field].level_90)];
    assert!(plain < 0.85 && (0.86..0.97).contains(&widened), "{plain} {widened} {levels:?}");
    let wider = |levels: &Levels| levels.fields.iter().map(|field| field.level_90 - 0.9).sum::<f64>();
    let sound = of(&once).unwrap();
    assert!(wider(&sound) < 0.6 * wider(&levels), "{sound:?} {levels:?}");
}

/// Few runs say nothing of their intervals.
#[test]
fn behaves_few_runs_have_no_levels() {
    let all: Vec<(usize, f64)> = (0..columns().len()).map(|output| (output, 0.0)).collect();
    let levels = Levels::of(&runs(8, 30, 1), &columns(), &PRIORS, &all, usize::MAX, 3).unwrap();
    assert!(levels.is_none());
}
