//! Runs of a campaign that cannot be, before the first one runs: by reason and label, and what their absence gives
//! away.

use std::collections::BTreeMap;

use super::{Campaign, Label};

/// Runs that are refused for one reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Refused {
    /// Reason of the first, its values among it.
    pub reason: String,
    /// Their numbers.
    pub runs: Vec<usize>,
    /// How many there are of each label.
    pub labels: BTreeMap<Label, usize>,
}

/// Numbers of runs that a line names.
const MOST_NUMBERS: usize = 5;

impl std::fmt::Display for Refused {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let labels: Vec<String> =
            self.labels.iter().map(|(label, count)| format!("{label}: {count}")).collect();
        let mut numbers: Vec<String> = self.runs.iter().take(MOST_NUMBERS).map(ToString::to_string).collect();
        if self.runs.len() > MOST_NUMBERS {
            numbers.push("…".to_owned());
        }
        let (count, labels, numbers) = (self.runs.len(), labels.join(", "), numbers.join(", "));
        write!(to, "{count} refused ({labels}; runs {numbers}): {}", self.reason)
    }
}

impl Campaign {
    /// Refused runs by reason, the most frequent first. Reasons that differ in their numbers alone are one.
    pub fn refused(&self) -> Vec<Refused> {
        let mut all: BTreeMap<String, Refused> = BTreeMap::new();
        for run in &self.runs {
            let Err(why) = &run.scene else { continue };
            let reason = in_a_line(why);
            let words = reason.replace(|c: char| c.is_ascii_digit() || c == '.', "");
            let entry = all.entry(words).or_insert_with(|| Refused {
                reason,
                runs: Vec::new(),
                labels: BTreeMap::new(),
            });
            entry.runs.push(run.number);
            if let Some(label) = &run.label {
                *entry.labels.entry(label.clone()).or_default() += 1;
            }
        }
        let mut all: Vec<Refused> = all.into_values().collect();
        all.sort_by_key(|refused| (usize::MAX - refused.runs.len(), refused.runs[0]));
        all
    }

    /// Labels that were planned and have no run: where they are all faults of a bearing, its name alone says that
    /// it is healthy.
    pub fn lost_labels(&self) -> Vec<String> {
        let mut bearings: BTreeMap<&str, BTreeMap<&Label, [usize; 2]>> = BTreeMap::new();
        for run in &self.runs {
            let Some(label) = &run.label else { continue };
            let of_bearing = bearings.entry(&label.bearing).or_default();
            of_bearing.entry(label).or_default()[usize::from(run.scene.is_err())] += 1;
        }
        let mut lost = Vec::new();
        for labels in bearings.values() {
            let (left, gone): (Vec<_>, Vec<_>) = labels.iter().partition(|(_, [left, _])| *left > 0);
            let Some((first, _)) = gone.first() else { continue };
            let bearing = first.bearing_in_words();
            let count: usize = gone.iter().map(|(_, [_, refused])| refused).sum();
            let refused = format!("{count} of {count} refused");
            lost.push(match left.as_slice() {
                [] => format!("{bearing} has no run: {refused}"),
                [(only, _)] => format!(
                    "{bearing} is always {}, and its name gives the label away: of other runs {refused}",
                    only.fault.replace('_', " ")
                ),
                _ => {
                    let faults: Vec<String> =
                        gone.iter().map(|(label, _)| label.fault.replace('_', " ")).collect();
                    format!("{bearing} has no run labelled {}: {refused}", faults.join(" or "))
                }
            });
        }
        lost
    }
}

/// The reason in a line, with the allowed values where it names them.
pub fn in_a_line(why: &str) -> String {
    let allowed = why.lines().find_map(|line| line.trim_start().strip_prefix("= allowed: "));
    let allowed = allowed.map_or_else(String::new, |allowed| format!("; allowed: {allowed}"));
    format!("{}{allowed}", why.lines().next().unwrap_or_default())
}
