//! `docs/VALIDATION.md` from the rows that tests have written (`crates/testing/src/ledger.rs`).

use std::fmt::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::test_names;

/// Names the folder into which tests write their rows.
pub(super) const FOLDER: &str = "STRIBECK_LEDGER";

/// A number may differ from the document's by this share of its row's tolerance: other processors round
/// otherwise.
const ROUNDING: f64 = 0.3;

/// … or by this share of itself, the last digit shown.
const SHOWN: f64 = 2e-4;

/// One comparison.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    package: String,
    quantity: String,
    unit: String,
    source: String,
    test: String,
    ours: f64,
    theirs: f64,
    tolerance: f64,
}

/// Checks the document against the rows in the folder that the environment names, and rewrites it when
/// they differ. Without one, checks that each row's test stands in the crate of its section: a test that has
/// moved or another name is found without being run.
pub(super) fn check(root: &Path) -> Result<Vec<String>> {
    match std::env::var_os(FOLDER) {
        Some(folder) => renew(root, &PathBuf::from(folder)),
        None => {
            let text = std::fs::read_to_string(document(root)).context("cannot read docs/VALIDATION.md")?;
            let tests = test_names::all(root)?;
            Ok(strays(&text, |package, name| {
                let folder = format!("/{package}/");
                tests.iter().any(|test| test.name == name && test.file.contains(&folder))
            }))
        }
    }
}

/// Rows of the document whose test is not in the crate of their section, which `stands` decides.
fn strays(text: &str, stands: impl Fn(&str, &str) -> bool) -> Vec<String> {
    let mut package = "";
    let mut found = Vec::new();
    for line in text.lines() {
        if let Some(name) = line.strip_prefix("## ") {
            package = name;
        } else if let Some(test) = line.strip_suffix("` |").and_then(|row| row.rsplit('`').next()) {
            let name = test.rsplit("::").next().unwrap_or(test);
            if !stands(package, name) {
                found.push(format!("docs/VALIDATION.md: the crate {package} has no test `{name}`"));
            }
        }
    }
    found
}

/// Rewrites the document when it differs from the rows in `folder` by more than rounding, with a
/// complaint.
pub(super) fn renew(root: &Path, folder: &Path) -> Result<Vec<String>> {
    let complaints = compare(root, folder)?;
    if !complaints.is_empty() {
        std::fs::write(document(root), render(&read(folder)?)).context("cannot write docs/VALIDATION.md")?;
    }
    Ok(complaints)
}

fn document(root: &Path) -> PathBuf {
    root.join("docs/VALIDATION.md")
}

fn compare(root: &Path, folder: &Path) -> Result<Vec<String>> {
    let rows = read(folder)?;
    ensure!(!rows.is_empty(), "the tests have written no rows into {}", folder.display());
    let new = render(&rows);
    let old = std::fs::read_to_string(document(root)).unwrap_or_default();
    let mut complaints = Vec::new();
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let (old, new) = (lines(&old), lines(&new));
    if old.len() != new.len() {
        complaints.push(format!("docs/VALIDATION.md has {} lines, the tests make {}", old.len(), new.len()));
    }
    let changed = old.iter().zip(&new).filter(|(a, b)| !same(a, b));
    complaints.extend(changed.take(5).map(|(a, b)| {
        format!("docs/VALIDATION.md says\n           {a}\n         and the tests\n           {b}")
    }));
    if !complaints.is_empty() {
        complaints.push(
            "it has been written anew in this checkout; look at what has changed before you commit it".into(),
        );
    }
    Ok(complaints)
}

/// Whether two lines say the same; in rows of numbers, but for rounding.
fn same(old: &str, new: &str) -> bool {
    let cells = |line: &str| line.split('|').map(|c| c.trim().to_owned()).collect::<Vec<_>>();
    let (a, b) = (cells(old), cells(new));
    if a.len() != b.len() || a.len() < 8 {
        return old == new;
    }
    // Cells: nothing, quantity, ours, theirs, unit, difference, tolerance, source, test, nothing. The
    // difference follows.
    let words = [1, 3, 4, 6, 7, 8].iter().all(|&i| a[i] == b[i]);
    let number = |text: &str| text.parse::<f64>().ok();
    let (Some(p), Some(q), Some(theirs)) = (number(&a[2]), number(&b[2]), number(&b[3])) else {
        return a == b;
    };
    let tolerance = b[6].parse::<f64>().unwrap_or(0.0) / 100.0;
    words && (p - q).abs() <= (ROUNDING * tolerance).max(SHOWN) * theirs.abs()
}

fn read(folder: &Path) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    let entries = std::fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    for entry in entries {
        let path = entry?.path();
        let text =
            std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
        rows.push(parse(text.trim_end()).with_context(|| format!("{} is no row", path.display()))?);
    }
    rows.sort_by(|a, b| (&a.package, &a.quantity).cmp(&(&b.package, &b.quantity)));
    Ok(rows)
}

fn parse(line: &str) -> Option<Row> {
    let cells: Vec<&str> = line.split('\t').collect();
    let [package, quantity, unit, source, test, ours, theirs, tolerance] = cells.as_slice() else {
        return None;
    };
    let word = |w: &&str| w.replace('|', "/");
    Some(Row {
        package: word(package),
        quantity: word(quantity),
        unit: word(unit),
        source: word(source),
        test: word(test),
        ours: ours.parse().ok()?,
        theirs: theirs.parse().ok()?,
        tolerance: tolerance.parse().ok()?,
    })
}

fn render(rows: &[Row]) -> String {
    let mut text = String::from(
        "# Validation\n\nWhat the tests compare with closed forms and with other programs. Written by `cargo \
         xtask ci` from the tests themselves (`crates/testing/src/ledger.rs`), which fail beyond the \
         tolerance; an empty cell is that above it. Whole problems solved by other codes are in \
         [compare](results/compare.md), error against work in [work_precision](results/work_precision.md), \
         extreme cases in [stability](results/stability.md).\n",
    );
    let mut package = "";
    let mut before: Option<&Row> = None;
    for row in rows {
        if row.package != package {
            package = &row.package;
            let _ = write!(
                text,
                "\n## {}\n\n| quantity | ours | theirs | unit | difference, % | tolerance, % | source | \
                 test |\n|---|---|---|---|---|---|---|---|\n",
                package.trim_start_matches("stribeck-")
            );
        }
        // Rows of one test below each other name it and its source once.
        let is_more = before
            .is_some_and(|b| (&b.package, &b.source, &b.test) == (&row.package, &row.source, &row.test));
        before = Some(row);
        let from = if is_more { "| | |".to_owned() } else { format!("| {} | `{}` |", row.source, row.test) };
        let off = (row.ours / row.theirs - 1.0).abs();
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} {from}",
            row.quantity,
            digits(row.ours, 5),
            digits(row.theirs, 5),
            row.unit,
            digits(100.0 * off, 2),
            digits(100.0 * row.tolerance, 2),
        );
    }
    text
}

/// A number to this many significant digits.
fn digits(value: f64, count: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let size = value.abs().log10().floor();
    if !(-4.0..6.0).contains(&size) {
        return format!("{value:.*e}", count - 1);
    }
    let decimals = (count as f64 - 1.0 - size).max(0.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: &str = "stribeck-solver\tspeed of a wave\tm/s\tAchenbach 1973, \
        §1.3\tanalytic_speed\t5.8561234e3\t5.8560e3\t1e-3";

    #[test]
    fn by_hand_rows_are_rendered_with_their_digits() {
        let text = render(&[parse(LINE).expect("a row")]);
        let row = "| speed of a wave | 5856.1 | 5856 | m/s | 0.0021 | 0.1 | Achenbach 1973, §1.3 | \
            `analytic_speed` |";
        assert!(text.contains("## solver") && text.contains(row), "{text}");
        assert_eq!([digits(0.0, 3), digits(1.5e-7, 3), digits(123_456.0, 2)], ["0", "1.50e-7", "123456"]);
    }

    #[test]
    fn behaves_a_test_that_has_moved_is_found_without_being_run() {
        let text = render(&[parse(LINE).expect("a row")]);
        assert_eq!(strays(&text, |package, name| package == "solver" && name == "analytic_speed"), [""; 0]);
        assert_eq!(
            strays(&text, |package, _| package == "mesh"),
            ["docs/VALIDATION.md: the crate solver has no test `analytic_speed`"]
        );
    }

    #[test]
    fn behaves_rounding_is_no_change_and_everything_else_is() {
        let line = |ours: &str, word: &str| {
            let row = LINE.replace("5.8561234e3", ours).replace("Achenbach", word);
            render(&[parse(&row).expect("a row")]).lines().last().unwrap_or_default().to_owned()
        };
        let old = line("5.8561234e3", "Achenbach");
        assert!(same(&old, &line("5.8562e3", "Achenbach")), "the last digit");
        assert!(!same(&old, &line("5.8590e3", "Achenbach")), "half of the tolerance");
        assert!(!same(&old, &line("5.8561234e3", "Timoshenko")), "another source");
        assert_eq!(parse("too\tfew"), None);
    }
}
