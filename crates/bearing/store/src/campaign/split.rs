//! Which variants a model learns from, is tuned with and is tested with: of each fault of each bearing as large
//! a share as of all.

use std::collections::BTreeMap;

use stribeck_scene::dice::Dice;

use super::{Label, Split, Variant};

/// Number of a scene that decides its place in the draw.
pub(super) type Drawn = u64;

/// Sets the part of every run; equal numbers in `drawn` are equal scenes and stay together.
pub(super) fn assign(runs: &mut [Variant], drawn: &[Drawn], split: &Split, seed: u64) {
    // Those that cannot be take no place of those that can.
    let mut classes: BTreeMap<Option<Label>, Vec<Drawn>> = BTreeMap::new();
    for (run, number) in runs.iter().zip(drawn) {
        let label = run.label.clone().filter(|_| run.scene.is_ok());
        classes.entry(label).or_default().push(*number);
    }
    let mut parts: BTreeMap<Drawn, &'static str> = BTreeMap::new();
    for mut numbers in classes.into_values() {
        numbers.sort_unstable();
        numbers.dedup();
        let place = |number: &Drawn| Dice::stream(seed, *number).share();
        numbers.sort_by(|a, b| place(a).total_cmp(&place(b)));
        let up_to = |share: f64| (share * numbers.len() as f64).round() as usize;
        let (train, tuned) = (up_to(split.train), up_to(split.train + split.validation));
        parts.extend(numbers.iter().enumerate().map(|(at, number)| {
            let part = if at < train {
                "train"
            } else if at < tuned {
                "validation"
            } else {
                "test"
            };
            (*number, part)
        }));
    }
    for (run, number) in runs.iter_mut().zip(drawn) {
        run.split = parts.get(number).copied().unwrap_or("train");
    }
}
