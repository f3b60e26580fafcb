//! Intervals as wide as they have to be for the runs themselves, each inferred by an emulator of the others.

use crate::simulator::{OUTPUTS, PRIORS, columns, runs, truths};
use stribeck_infer::{Calibration, Emulator, Levels, PosteriorOptions};

const TRUTHS: usize = 200;
const OPTIONS: PosteriorOptions = PosteriorOptions { draws: 300, seed: 9 };

/// Every output taken three times over, as if for outputs of their own: the central 90 % of the draws are too
/// narrow, and the intervals that the runs ask for hold truths that no run has seen.
#[test]
fn example_evidence_that_counts_three_times_is_found_out_by_the_runs() {
    let runs = runs(8, 80, 2);
    let once: Vec<(usize, f64)> = (0..OUTPUTS).map(|output| (output, 0.0)).collect();
    let thrice = once.repeat(3);
    let levels = Levels::of(&runs, &columns(), &PRIORS, &thrice, usize::MAX, 3).unwrap().unwrap();
    assert_eq!(levels.truths, 80);
    let emulator = Emulator::fit(&runs, &columns(), 0).unwrap();
    let truths = truths(80, TRUTHS, 1.0);
    let calibration = Calibration::of(&emulator, &PRIORS, &truths, &thrice, OPTIONS).unwrap();
    let mut plain = 0.0;
    for (field, ranks) in levels.fields.iter().zip(&calibration.ranks) {
        let held = |level: f64| {
            ranks.iter().filter(|rank| (2.0 * **rank - 1.0).abs() <= level).count() as f64 / TRUTHS as f64
        };
        plain += held(0.9) / ranks.len().min(levels.fields.len()) as f64;
        assert!(held(field.level_90) >= 0.85, "{field:?}: {}", held(field.level_90));
        assert!((0.4..0.65).contains(&held(field.level_50)), "{field:?}: {}", held(field.level_50));
    }
    assert!(plain < 0.82, "{plain}");
}

/// Where intervals hold, they stay nearly as they are; few runs say nothing.
#[test]
fn example_sound_intervals_stay_and_few_runs_say_nothing() {
    let all: Vec<(usize, f64)> = (0..OUTPUTS).map(|output| (output, 0.0)).collect();
    let levels = Levels::of(&runs(8, 80, 2), &columns(), &PRIORS, &all, usize::MAX, 3).unwrap().unwrap();
    assert!(levels.fields.iter().all(|field| (0.9..0.97).contains(&field.level_90)), "{levels:?}");
    assert!(Levels::of(&runs(8, 30, 1), &columns(), &PRIORS, &all, usize::MAX, 3).unwrap().is_none());
}
