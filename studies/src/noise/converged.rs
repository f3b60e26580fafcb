//! Is the remaining signal right? The paper's method and the cure beside elements of half the size.

use stribeck_analysis::record::Record;
use stribeck_store::run_dir::Run;

use super::noise;
use crate::table::number;
use crate::{Finished, Sheet};

/// While roller 1 is over the defect and touches neither edge nor floor [s].
pub(super) const UNLOADED_S: std::ops::Range<f64> = 2.4e-3..4.3e-3;

/// Rollers that carry more than this are compared [N].
const CARRIES_N: f64 = 1000.0;

/// A number of a run.
type Quantity = (&'static str, usize, fn(&Finished) -> Option<f64>);

const QUANTITIES: [Quantity; 8] = [
    ("unloads ms", 3, |r| r.numbers()?.events.first()?.entry_ms),
    ("is loaded again ms", 3, |r| r.numbers()?.events.first()?.exit_ms),
    ("force of roller 2 N", 0, |r| forces(r).get(1).copied()),
    ("force of roller 24 N", 0, |r| forces(r).get(23).copied()),
    ("between the impulses, side g", 1, |r| noise(r, 0).map(|n| n.quiet_rms_g)),
    ("between, shoulder g", 1, |r| noise(r, 1).map(|n| n.quiet_rms_g)),
    ("between, seat g", 1, |r| noise(r, 2).map(|n| n.quiet_rms_g)),
    ("between, bottom g", 1, |r| noise(r, 3).map(|n| n.quiet_rms_g)),
];

/// Mean of each roller's force on the outer ring [N].
fn forces(run: &Finished) -> Vec<f64> {
    let Ok(read) = Run::read(&run.folder) else { return Vec::new() };
    let Ok(record) = Record::whole(&read) else { return Vec::new() };
    let time = record.time_s();
    let at = |s: f64| time.partition_point(|&t| t < s);
    let span = at(UNLOADED_S.start)..at(UNLOADED_S.end);
    let mean = |force: Vec<f64>| force[span.clone()].iter().sum::<f64>() / span.len() as f64;
    record.rollers().into_iter().map(|r| mean(r.outer_normal())).collect()
}

/// Mean, smallest and largest over the starts that yield the number.
fn over_starts(runs: &[Finished], of: fn(&Finished) -> Option<f64>) -> Option<[f64; 3]> {
    let values: Vec<f64> = runs.iter().filter_map(of).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let low = values.iter().copied().reduce(f64::min)?;
    Some([mean, low, values.iter().copied().reduce(f64::max)?])
}

/// Largest difference of a carrying roller's force from the last group's, means over the starts [%].
fn largest_difference(runs: &[Finished], fine: &[Finished]) -> Option<f64> {
    let mean = |group: &[Finished]| -> Vec<f64> {
        let all: Vec<Vec<f64>> = group.iter().map(forces).filter(|f| !f.is_empty()).collect();
        let rollers = all.first().map_or(0, Vec::len);
        (0..rollers).map(|i| all.iter().map(|f| f[i]).sum::<f64>() / all.len() as f64).collect()
    };
    let (ours, theirs) = (mean(runs), mean(fine));
    let carrying = ours.iter().zip(&theirs).filter(|(_, b)| **b > CARRIES_N);
    carrying.map(|(a, b)| 100.0 * (a / b - 1.0).abs()).max_by(f64::total_cmp)
}

/// Tables of groups of runs, the converged ones last.
pub(super) fn write(sheet: &mut Sheet, groups: &[(&str, Vec<Finished>)]) {
    let Some((_, fine)) = groups.last() else { return };
    sheet.heading("Is what is left right? Elements of 0.25 mm");
    sheet.say(
        "The same bearing on graded meshes, from three starts that differ by 0.01° of the cage (10 µs): \
         chords at 0.5 mm \
         (`chords`), the cure at 0.5 mm (`cured`), and the cure at 0.25 mm with the contact\u{2019}s \
         stiffness and damping over \
         an area and its onset unchanged (`fine`). Mean over the starts, smallest and largest in \
         brackets; forces are means from 2.4 to 4.3 ms, while roller 1 is over the defect, and *between* is \
         what it is in the tables \
         above.",
    );
    let names: Vec<&str> =
        std::iter::once("quantity").chain(groups.iter().map(|g| g.0)).chain(["cured − fine %"]).collect();
    let mut rows = Vec::new();
    for (name, decimals, of) in QUANTITIES {
        let mut row = vec![name.to_owned()];
        let mut means = Vec::new();
        for (group, runs) in groups {
            let found = over_starts(runs, of);
            means.push(found.map(|[mean, ..]| mean));
            for (word, k) in [("mean", 0), ("smallest", 1), ("largest", 2)] {
                sheet.value("converged", group, &format!("{name}, {word}"), found.map(|f| f[k]));
            }
            row.push(found.map_or("–".to_owned(), |[mean, low, high]| {
                let shown = |v| number(v, decimals);
                format!("{} ({} … {})", shown(mean), shown(low), shown(high))
            }));
        }
        let difference = match means[..] {
            [.., Some(cured), Some(fine)] => Some(100.0 * (cured / fine - 1.0)),
            _ => None,
        };
        sheet.value("converged", "cured", &format!("{name}, off fine %"), difference);
        row.push(difference.map_or("–".to_owned(), |v| number(v, 2)));
        rows.push(row);
    }
    let mut row = vec![format!("largest difference of a force above {CARRIES_N:.0} N, %")];
    for (group, runs) in groups {
        let found = largest_difference(runs, fine);
        sheet.value("converged", group, "largest difference of a force %", found);
        row.push(found.map_or("–".to_owned(), |v| number(v, 2)));
    }
    row.push(String::new());
    rows.push(row);
    sheet.table(&names, &rows);
}
