//! Names of tests: a prefix for the basis of the expected result, and a source where one is needed.

use std::path::Path;

use anyhow::{Context, Result};

use super::sources;

/// Prefixes of test names, as the table in CONTRIBUTING explains them.
const PREFIXES: [&str; 14] = [
    "patch_",
    "conserves_",
    "invariant_",
    "analytic_",
    "converges_",
    "peer_",
    "golden_",
    "issue_",
    "by_hand_",
    "planted_",
    "behaves_",
    "refuses_",
    "roundtrip_",
    "survives_",
];

/// Tests that hold numbers of somebody else cite where they come from.
const CITING: [&str; 3] = ["analytic_", "converges_", "peer_"];

pub(super) struct Test {
    pub(super) file: String,
    pub(super) name: String,
    /// Comments of the file's head, of the test and in it.
    comments: String,
}

pub(super) fn all(root: &Path) -> Result<Vec<Test>> {
    let mut found = Vec::new();
    for folder in sources::FOLDERS {
        for file in sources::rust_files(&root.join(folder))? {
            let text =
                std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
            let name = file.strip_prefix(root).unwrap_or(&file).display().to_string();
            found.extend(of_file(&name, &text));
        }
    }
    Ok(found)
}

fn of_file(file: &str, text: &str) -> Vec<Test> {
    let lines: Vec<&str> = text.lines().collect();
    let comment = |line: &str| line.split_once("//").map(|(_, words)| format!("{words}\n"));
    let head: String =
        lines.iter().filter(|line| line.starts_with("//!")).filter_map(|line| comment(line)).collect();
    let is_attribute = |line: &&&str| line.trim_start().starts_with(['/', '#']);
    let mut found = Vec::new();
    for at in (0..lines.len()).filter(|&at| lines[at].trim() == "#[test]") {
        let Some(start) = (at..lines.len()).find(|&i| lines[i].trim_start().starts_with("fn ")) else {
            continue;
        };
        let indent = lines[start].len() - lines[start].trim_start().len();
        let name =
            lines[start].trim_start().trim_start_matches("fn ").split(['(', '<']).next().unwrap_or_default();
        let end_of_test = |line: &&&str| **line != format!("{}}}", " ".repeat(indent));
        let above = lines[..start].iter().rev().take_while(is_attribute);
        let inside = lines[start..].iter().take_while(end_of_test);
        let own: String = above.chain(inside).filter_map(|line| comment(line)).collect();
        found.push(Test { file: file.to_owned(), name: name.to_owned(), comments: head.clone() + &own });
    }
    found
}

/// Every test has one of the prefixes; those that need a source cite one.
pub(super) fn check(root: &Path) -> Result<Vec<String>> {
    let complaints = all(root)?.iter().filter_map(complaint).collect();
    Ok(complaints)
}

/// Whether a name begins as that of a test.
fn has_prefix(name: &str) -> bool {
    PREFIXES.iter().any(|prefix| name.starts_with(prefix))
}

fn complaint(test: &Test) -> Option<String> {
    let Test { file, name, comments } = test;
    if !has_prefix(name) {
        return Some(format!("{file}: `{name}` has none of the prefixes of CONTRIBUTING"));
    }
    let silent = CITING.iter().any(|prefix| name.starts_with(prefix)) && !cites(comments);
    silent.then(|| {
        format!("{file}: `{name}` cites no source (book and year, THEORY §, RFC, version of a program)")
    })
}

/// Whether a comment names a section, a standard, a year or a version.
fn cites(comments: &str) -> bool {
    let number = |word: &str| word.trim_matches(|c: char| !c.is_ascii_digit()).to_owned();
    let is_year =
        |word: &str| number(word).len() == 4 && (1600..2100).contains(&number(word).parse().unwrap_or(0));
    let is_version =
        |word: &str| number(word).split('.').filter(|part| part.parse::<u32>().is_ok()).count() == 3;
    comments.contains(['§'])
        || comments.contains("RFC ")
        || comments.split_whitespace().any(|word| is_year(word) || is_version(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(text: &str) -> Option<String> {
        complaint(&of_file("a.rs", text)[0])
    }

    #[test]
    fn refuses_tests_without_prefix_or_source() {
        assert!(one("#[test]\nfn it_works() {\n}\n").is_some());
        assert!(one("#[test]\nfn behaves_one() {\n}\n").is_none());
        assert!(one("/// Closed form.\n#[test]\nfn analytic_ring() {\n    // Thin.\n}\n// 1950\n").is_some());
        for source in ["THEORY §2.1", "Timoshenko (1951)", "RFC 4648", "scipy 1.17.1"] {
            assert_eq!(one(&format!("/// {source}.\n#[test]\nfn analytic_ring() {{\n}}\n")), None);
            assert_eq!(one(&format!("#[test]\nfn peer_ring() {{\n    // {source}.\n}}\n")), None);
            assert_eq!(one(&format!("//! {source}.\n#[test]\nfn converges_ring() {{\n}}\n")), None);
        }
    }
}
