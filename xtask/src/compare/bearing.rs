//! The bearing of `docs/results/second_code.md`, timed by `fixtures/peers/second_code.py cost`: OpenRadioss is no package.

use std::path::Path;

use anyhow::{Context, Result};

use super::measure::{Entry, Measured, Pace, Round};
use super::program::About;

/// Rows of the script, in the columns of `compare.csv`.
const FILE: &str = "docs/results/second_code_cost.csv";

/// The bearing on one thread, then on two.
pub(super) fn measured(root: &Path) -> Result<Vec<Measured>> {
    let text = std::fs::read_to_string(root.join(FILE)).with_context(|| format!("cannot read `{FILE}`"))?;
    let mut problems: Vec<Measured> = Vec::new();
    for (row, number) in text.lines().zip(1..).skip(1) {
        read(row, &mut problems).with_context(|| {
            format!("`{FILE}`, line {number}: `{row}` is no row of names, numbers and four times")
        })?;
    }
    Ok(problems)
}

fn read(row: &str, problems: &mut Vec<Measured>) -> Option<()> {
    let [title, elements, program, version, element, _, times @ ..] = &row.split(',').collect::<Vec<_>>()[..]
    else {
        return None;
    };
    let times: Vec<f64> = times.iter().map(|t| t.parse().ok()).collect::<Option<_>>()?;
    let [ours_cpu, ours_wall, cpu, wall] = times[..] else { return None };
    let round = Round { ours: Pace { cpu: ours_cpu, wall: ours_wall }, theirs: Pace { cpu, wall } };
    let about = |names: [&str; 3]| {
        let [program, version, element] = names.map(str::to_owned);
        About { program, version, element }
    };
    let problem = match problems.iter().position(|m| m.title == *title) {
        Some(known) => &mut problems[known],
        None => {
            problems.push(Measured {
                title: (*title).to_owned(),
                text: "The scene `second_code`, whose forces agree ([second code](second_code.md)), from \
                       [second_code_cost.csv](second_code_cost.csv)."
                    .to_owned(),
                elements: elements.parse().ok()?,
                ours: about(["Stribeck", "", "one-point, total Lagrangian; node-to-segment"]),
                entries: Vec::new(),
            });
            problems.last_mut()?
        }
    };
    match problem.entries.iter_mut().find(|e| e.about.element == *element) {
        Some(entry) => entry.rounds.push(round),
        None => problem.entries.push(Entry {
            about: about([program, version, element]),
            differences: Vec::new(),
            rounds: vec![round],
        }),
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::super::tables;
    use super::{measured, read};

    #[test]
    fn golden_page_has_the_table_of_the_bearing() {
        let root = crate::workspace::root();
        let table = tables::of_problem(&measured(&root).unwrap()[0]);
        let page = std::fs::read_to_string(root.join("docs/results/compare.md")).unwrap();
        assert!(page.contains(&table), "`docs/results/compare.md` lacks{table}");
    }

    #[test]
    fn refuses_rows_without_four_times() {
        assert!(read("Bearing,10,OpenRadioss,1,one-point,1,1.0,1.0,2.0", &mut Vec::new()).is_none());
        assert!(read("Bearing,10,OpenRadioss,1,one-point,1,1.0,1.0,2.0,2.0", &mut Vec::new()).is_some());
    }
}
