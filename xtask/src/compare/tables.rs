//! What `compare` writes: a page to read and every run as a table.

use std::fmt::Write as _;

use super::measure::{Absent, Entry, Measured, OURS, Pace};

/// Least and median.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spread {
    least: f64,
    median: f64,
}

impl Spread {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let n = values.len();
        let at = |i: usize| values.get(i).copied().unwrap_or(f64::NAN);
        Self { least: at(0), median: 0.5 * (at(n.saturating_sub(1) / 2) + at(n / 2)) }
    }
}

/// The page. Writing to a string cannot fail, so results of `write!` are dropped.
pub(super) fn page(rounds: usize, measured: &[Measured], absent: &[Absent]) -> String {
    let mut page = String::new();
    let others =
        measured.iter().flat_map(|m| &m.entries).filter(|e| !e.about.program.starts_with("Stribeck"));
    let ratios: Vec<f64> = others.map(|e| ratio(e).median).collect();
    let [least, most] =
        [f64::min, f64::max].map(|end| ratios.iter().copied().reduce(end).unwrap_or(f64::NAN));
    let _ = writeln!(
        page,
        "# The same work in other programs\n\n\
         The same work takes {} to {} times ours in other programs.\n\n\
         Timed is the step loop alone, in ns of processor time per element and step on one thread in double \
         precision, least and median of {} runs; ours ran again directly before each run of another program, \
         and the ratio is the median over these pairs. E 200 GPa, ν 0.3, ρ 7850 kg/m³. Written by `cargo xtask \
         peers`; all runs are in [compare.csv](compare.csv).",
        digits(least),
        digits(most),
        rounds
    );
    // Of blocks of several sizes the first is shown; the others are in the file of all runs.
    let kind = |m: &Measured| m.title.split(' ').next().map(str::to_owned);
    let is_first = |(n, m): &(usize, &Measured)| measured[..*n].iter().all(|before| kind(before) != kind(m));
    measured.iter().enumerate().filter(is_first).for_each(|(_, m)| page.push_str(&of_problem(m)));
    if !absent.is_empty() {
        let _ = writeln!(page, "\n## Left out\n");
        for a in absent {
            let _ = writeln!(page, "- {}: {}", a.label, a.reason);
        }
    }
    page
}

pub(super) fn of_problem(measured: &Measured) -> String {
    let mut page = String::new();
    let all = measured.entries.iter().flat_map(|e| &e.rounds);
    let ours = Spread::of(all.map(|r| r.ours.cpu));
    let _ = writeln!(
        page,
        "\n## {}\n\n{}\n\n\
         | program | element | least | median | times ours | displacements differ by |\n\
         |---|---|---|---|---|---|\n\
         | **{}** | {} | **{}** | **{}** | 1 | |",
        measured.title,
        measured.text,
        measured.ours.program,
        measured.ours.element,
        digits(ours.least),
        digits(ours.median)
    );
    measured.entries.iter().for_each(|e| row(&mut page, e));
    page
}

/// Their time over ours, of each pair of runs.
fn ratio(entry: &Entry) -> Spread {
    Spread::of(entry.rounds.iter().map(|r| r.theirs.cpu / r.ours.cpu))
}

fn row(page: &mut String, entry: &Entry) {
    let theirs = Spread::of(entry.rounds.iter().map(|r| r.theirs.cpu));
    let differences: Vec<String> = entry
        .differences
        .iter()
        .map(|d| {
            let from = if d.from == OURS { String::new() } else { format!(" from {}", d.from) };
            let mark = if d.found <= d.limit { "" } else { " **too much**" };
            format!("{:.1e}{from}, limit {:.0e} ({}){mark}", d.found, d.limit, d.reason)
        })
        .collect();
    let _ = writeln!(
        page,
        "| {} {} | {} | {} | {} | {} | {} |",
        entry.about.program,
        entry.about.version,
        entry.about.element,
        digits(theirs.least),
        digits(theirs.median),
        digits(ratio(entry).median),
        differences.join("; ")
    );
}

/// Three digits.
fn digits(value: f64) -> String {
    match value.abs() {
        v if v < 10.0 => format!("{value:.2}"),
        v if v < 100.0 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

/// Every run.
pub(super) fn csv(measured: &[Measured]) -> String {
    let mut text = String::from(
        "problem,elements,program,version,element,round,ours_cpu_ns,ours_wall_ns,theirs_cpu_ns,theirs_wall_ns\n",
    );
    let pace = |p: Pace| format!("{:.4},{:.4}", p.cpu, p.wall);
    for m in measured {
        for e in &m.entries {
            for (i, r) in e.rounds.iter().enumerate() {
                let a = &e.about;
                let _ = writeln!(
                    text,
                    "\"{}\",{},\"{}\",\"{}\",\"{}\",{},{},{}",
                    m.title,
                    m.elements,
                    a.program,
                    a.version,
                    a.element,
                    i + 1,
                    pace(r.ours),
                    pace(r.theirs)
                );
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Spread, digits};

    #[test]
    fn by_hand_least_and_median() {
        assert_eq!(Spread::of([3.0, 1.0, 2.0].into_iter()), Spread { least: 1.0, median: 2.0 });
        assert_eq!(Spread::of([4.0, 1.0].into_iter()), Spread { least: 1.0, median: 2.5 });
        assert!(Spread::of(std::iter::empty()).median.is_nan(), "of nothing there is none");
    }

    #[test]
    fn by_hand_numbers_have_three_digits() {
        assert_eq!([digits(1.234), digits(12.34), digits(1234.5)], ["1.23", "12.3", "1234"]);
    }
}
