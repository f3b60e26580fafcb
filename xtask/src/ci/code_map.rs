//! ARCHITECTURE against the tree: the files that it names exist, and none is left out.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result};

use super::{layers, markdown, sources, test_names};

/// Files that every crate may have; ARCHITECTURE describes them once.
const EVERYWHERE: [&str; 4] = ["lib.rs", "error.rs", "mod.rs", "tests.rs"];

/// Every file and test that ARCHITECTURE names exists, and its code map names every source file or a folder
/// around it.
pub(super) fn check(root: &Path) -> Result<Vec<String>> {
    let text = std::fs::read_to_string(root.join("docs/ARCHITECTURE.md"))
        .context("cannot read docs/ARCHITECTURE.md")?;
    let mut files = BTreeSet::new();
    let folders = layers::folders(root)?;
    for folder in folders.iter().map(String::as_str).chain(["fixtures"]) {
        for file in sources::rust_files(&root.join(folder))? {
            files.insert(file.strip_prefix(root).unwrap_or(&file).display().to_string());
        }
    }
    let tests: BTreeSet<String> = test_names::all(root)?.into_iter().map(|test| test.name).collect();
    Ok(compare(&text, &files, &folders, &tests))
}

/// `text` against all Rust files, the folders of crates and the names of tests.
fn compare(
    text: &str,
    files: &BTreeSet<String>,
    folders: &[String],
    tests: &BTreeSet<String>,
) -> Vec<String> {
    let mut complaints = Vec::new();
    // Entries of the code map: whole files, and folders with a slash at their end.
    let mut covered = Vec::new();
    let mut section = "";
    let mut fenced = false;
    for line in text.lines() {
        fenced ^= line.starts_with("```");
        if line.starts_with('#') {
            section = folders
                .iter()
                .find(|folder| line.contains(&format!("`{folder}`")))
                .map_or("", String::as_str);
        }
        for name in markdown::code(line).into_iter().filter(|_| !fenced) {
            if name.ends_with(".rs") || (!section.is_empty() && name.ends_with('/')) {
                let place = format!("{section}/src/{name}");
                let known = |path: &str| {
                    files.iter().any(|file| file == path || name.ends_with('/') && file.starts_with(path))
                };
                if !section.is_empty() && known(&place) {
                    covered.push(place);
                } else if !known(name) && !files.iter().any(|file| file.ends_with(&format!("/{name}"))) {
                    complaints.push(format!("ARCHITECTURE names `{name}`: there is no such file"));
                }
            } else if test_names::has_prefix(name) && !tests.contains(name) {
                complaints.push(format!("ARCHITECTURE names the test `{name}`: there is none"));
            }
        }
    }
    let is_source = |file: &&String| folders.iter().any(|folder| file.starts_with(&format!("{folder}/src/")));
    let everywhere = |file: &str| EVERYWHERE.iter().any(|name| file.ends_with(&format!("/{name}")));
    let is_covered = |file: &str| {
        covered.iter().any(|place| file == place || place.ends_with('/') && file.starts_with(place))
    };
    let left_out = files.iter().filter(is_source).filter(|file| !everywhere(file) && !is_covered(file));
    complaints.extend(left_out.map(|file| format!("the code map of ARCHITECTURE leaves out {file}")));
    complaints
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(names: &[&str]) -> BTreeSet<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    #[test]
    fn refuses_files_and_tests_that_are_not_there_and_files_left_out() {
        let files =
            set(&["crates/mesh/src/lib.rs", "crates/mesh/src/part.rs", "crates/mesh/src/ring/rows.rs"]);
        let tests = set(&["patch_test"]);
        let complain = |text: &str| compare(text, &files, &["crates/mesh".to_owned()], &tests);
        let map = "### `crates/mesh` (geometry)\n| `part.rs`, `ring/` | parts |\n## Invariants\n";
        assert!(
            complain(&format!("{map}`patch_test` in `crates/mesh/src/ring/rows.rs`, `rows.rs`")).is_empty()
        );
        assert_eq!(complain(&format!("{map}`patch_tests`")).len(), 1);
        assert_eq!(complain(&format!("{map}`nowhere.rs`")).len(), 1);
        // Named outside the code map only.
        assert_eq!(complain("### `crates/mesh`\n`ring/`\n## Step\n`part.rs`").len(), 1);
    }
}
