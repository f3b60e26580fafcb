//! How far a number changes over a field, beyond what runs of one value scatter.

use stribeck_diagnosis::words::numbers::significant;

use super::{Abscissa, CampaignIndex, Drawn};
use crate::field_words::FieldWords;

/// A change of less than this many standard deviations of the runs at one value is none.
const BEYOND: f64 = 3.0;
/// Where no value has several runs their scatter is unknown, and a change of less than this part is none …
const PART: f64 = 0.1;
/// … or of less than this level.
const PART_DB: f64 = 3.0;
/// However little the runs scatter, a change of less than this part is not worth a sentence.
const LEAST_PART: f64 = 0.01;

/// A number over a field: its means from the first value to the last.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Change {
    /// Place of the field, and mean there, ascending.
    means: Vec<(f64, f64)>,
    /// Standard deviation of the runs at one value about their mean; `None` where no value has several.
    scatter: Option<f64>,
    /// Whether it has enough places, in an order, for a trend.
    is_trend: bool,
}

/// Fewest places of a field over which a number may grow or fall: of three, chance orders one set in three.
const LEAST_PLACES: usize = 4;

impl Change {
    /// `None` where fewer than two values of the field have the number.
    pub(super) fn of(index: &CampaignIndex, abscissa: &Abscissa, path: &str) -> Option<Self> {
        let known = index.runs.iter().zip(&abscissa.places);
        let known = known.filter_map(|(run, place)| Some((*place, *run.numbers.get(path)?)));
        let mut known: Vec<(f64, f64)> = known.filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        known.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mean = |all: &[(f64, f64)]| all.iter().map(|(_, y)| y).sum::<f64>() / all.len() as f64;
        let groups: Vec<&[(f64, f64)]> = known.chunk_by(|a, b| a.0 == b.0).collect();
        let means: Vec<(f64, f64)> = groups.iter().map(|all| (all[0].0, mean(all))).collect();
        let squares = groups.iter().flat_map(|all| all.iter().map(|(_, y)| (y - mean(all)).powi(2)));
        let degrees = known.len() - groups.len();
        let scatter = (degrees > 0).then(|| (squares.sum::<f64>() / degrees as f64).sqrt());
        let is_trend = abscissa.is_ordered && means.len() >= LEAST_PLACES;
        (means.len() > 1).then_some(Self { means, scatter, is_trend })
    }

    fn range(&self) -> [f64; 2] {
        self.means.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], (_, y)| [a.min(*y), b.max(*y)])
    }

    /// Whether it never falls from one value of the field to the next, or never grows.
    pub(super) fn is_monotone(&self) -> bool {
        self.means.is_sorted_by(|a, b| a.1 <= b.1) || self.means.is_sorted_by(|a, b| a.1 >= b.1)
    }

    /// By how much it changes, over the least change that counts.
    pub(super) fn size(&self, unit: &str) -> f64 {
        let [least, most] = self.range();
        let counts = match self.scatter {
            Some(scatter) => BEYOND * scatter,
            None if unit == "dB" => PART_DB,
            None => PART * least.abs().max(most.abs()),
        };
        let worth = LEAST_PART * least.abs().max(most.abs());
        (most - least) / counts.max(worth).max(f64::MIN_POSITIVE)
    }

    /// In words: what happens from the first value of the field to the last. Over names, seeds and a few values there
    /// is no trend.
    pub(super) fn words(&self, Drawn { words, unit, .. }: &Drawn, field: &str) -> String {
        let (field, [least, most]) = (FieldWords::of(field).inside(), self.range());
        let number = |y: f64| significant(y, 3).replace('-', "−");
        let (from, to) = (self.means[0].1, self.means[self.means.len() - 1].1);
        if !(self.is_trend && self.is_monotone()) {
            let text =
                format!("{words} varies over the {field}: {} to {} {unit}", number(least), number(most));
            return text.trim_end().to_owned();
        }
        let verb = if to >= from { "grows with the" } else { "falls with the" };
        let mean = if self.scatter.is_some() { "on average " } else { "" };
        format!("{words} {verb} {field}: {mean}{} → {} {unit}", number(from), number(to))
            .trim_end()
            .to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::drawn;
    use crate::campaign::tests::{index, run};

    #[test]
    fn by_hand_a_change_counts_beyond_the_scatter_of_its_runs() {
        let one = |runs| {
            let index = index(runs);
            Change::of(&index, &Abscissa::of(&index, 0), "levels.record.rms_g").expect("a change")
        };
        // Means 2 and 12, and a standard deviation of √((1 + 1 + 1 + 1)/2).
        let seen =
            one(vec![run(1, "100", 1.0), run(2, "100", 3.0), run(3, "200", 11.0), run(4, "200", 13.0)]);
        assert!((seen.size("g") - 10.0 / (3.0 * 2.0_f64.sqrt())).abs() < 1e-12, "{seen:?}");
        let words = |change: &Change| change.words(&drawn()[0], "operation.load_n");
        assert!(words(&seen).ends_with("varies over the load: 2 to 12 g"), "{}", words(&seen));
        let four = (1..=4).map(|n| run(n, &format!("{n}00"), n as f64)).collect();
        assert!(words(&one(four)).ends_with("grows with the load: 1 → 4 g"));
        let lost = one(vec![run(1, "100", 1.0), run(2, "100", 9.0), run(3, "200", 2.0), run(4, "200", 10.0)]);
        assert!(lost.size("g") < 1.0, "{lost:?}");
        // One run a value: a tenth counts.
        assert!(one(vec![run(1, "100", 1.0), run(2, "200", 1.05)]).size("g") < 1.0);
        let back = one(vec![run(1, "100", 1.0), run(2, "200", 3.0), run(3, "300", 2.0)]);
        assert!(words(&back).contains("varies over the load: 1 to 3 g"));
    }

    /// "Root mean square falls with the bearing", whose names are numbers, and with the seed.
    #[test]
    fn issue_names_and_seeds_have_no_trend() {
        for field in ["bearing", "defects[0].form.roughness.seed"] {
            let runs = (1..=5).map(|n| run(n, &format!("620{n}"), n as f64)).collect();
            let index = CampaignIndex { fields: vec![field.into()], ..index(runs) };
            let change = Change::of(&index, &Abscissa::of(&index, 0), "levels.record.rms_g");
            let words = change.expect("a change").words(&drawn()[0], field);
            assert!(words.contains("varies over") && words.ends_with("1 to 5 g"), "{words}");
        }
    }
}
