//! Pages of results against the program: `docs/results/made_by.csv` says which one made each.
//!
//! A program is known by `fixtures/golden/digest`, which `golden_traces` holds to its traces. A page that another
//! one made says so in its first line, which `ci --mark` writes; a study that runs again leaves it out.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, ensure};

const MADE_BY: &str = "docs/results/made_by.csv";
const HEAD: &str = "page,digest,commit,date,minutes,command";
/// First words of the line.
const OLDER: &str = "Made by an older program";
/// Where programs are that made pages of which no command is left.
const TAG: &str = "before-fewer-doors";

/// Pages whose first line is not what it must be.
pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for (name, [text, marked]) in pages(root)? {
        if text != marked {
            complaints.push(format!(
                "the first line of {name} does not say which program made it: `ci --mark` writes it"
            ));
        }
    }
    Ok(complaints)
}

/// Writes these lines, and takes those away that no longer hold.
pub(crate) fn mark(root: &Path) -> Result<()> {
    for (name, [text, marked]) in pages(root)? {
        if text != marked {
            std::fs::write(root.join(&name), marked).with_context(|| format!("cannot write {name}"))?;
            println!("{name}");
        }
    }
    Ok(())
}

/// Each page as it is, and as it must be.
fn pages(root: &Path) -> Result<BTreeMap<String, [String; 2]>> {
    let read =
        |name: &str| std::fs::read_to_string(root.join(name)).with_context(|| format!("cannot read {name}"));
    let digest = read("fixtures/golden/digest")?;
    let made = read(MADE_BY)?;
    let mut lines = made.lines();
    ensure!(lines.next() == Some(HEAD), "{MADE_BY}: its first line is not `{HEAD}`");
    let mut pages = BTreeMap::new();
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        let fields: [&str; 6] =
            fields.try_into().ok().with_context(|| format!("{MADE_BY}: six fields: `{line}`"))?;
        let name = format!("docs/results/{}.md", fields[0]);
        let text = read(&name)?;
        let marked = marked(&text, fields, digest.trim());
        pages.insert(name, [text, marked]);
    }
    for entry in std::fs::read_dir(root.join("docs/results")).context("cannot read docs/results")? {
        let name = format!("docs/results/{}", entry?.file_name().to_string_lossy());
        ensure!(!name.ends_with(".md") || pages.contains_key(&name), "{MADE_BY} has no line for {name}");
    }
    Ok(pages)
}

/// A page with the first line that it must have.
fn marked(text: &str, [_, made, commit, date, minutes, command]: [&str; 6], digest: &str) -> String {
    let first = text.lines().next().unwrap_or_default();
    let is_marked = first.starts_with(OLDER);
    let page = if is_marked { text[first.len()..].trim_start() } else { text };
    let by = format!("{OLDER} ({date}, {commit})");
    match (made == digest, command) {
        (true, _) => page.to_owned(),
        // Words of its own, which name the tag, will do.
        (_, "") if !is_marked && first.contains(TAG) => text.to_owned(),
        (_, "") => format!("{by}; what made it is at the tag `{TAG}`.\n\n{page}"),
        _ => {
            let time = if minutes.is_empty() { String::new() } else { format!(", in {minutes} minutes") };
            format!("{by}: `{command}` makes it anew{time}.\n\n{page}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::marked;

    #[test]
    fn behaves_a_page_is_marked_while_its_program_is_an_older_one() {
        let made = ["noise", "0a", "5a0c2626", "2026-11-29", "12", "cargo xtask study noise"];
        let page = "# Noise\n\nWords.\n";
        let line = "Made by an older program (2026-11-29, 5a0c2626): `cargo xtask study noise` makes it anew, in 12 minutes.";
        let older = format!("{line}\n\n{page}");
        for text in [page, &older] {
            assert_eq!(marked(text, made, "0b"), older);
            assert_eq!(marked(text, made, "0a"), page);
        }
        let gone = ["inferred", "", "f772299f", "2026-11-28", "", ""];
        assert!(
            marked(page, gone, "0b")
                .starts_with("Made by an older program (2026-11-28, f772299f); what made it is at")
        );
        let own = format!("By the tag `before-fewer-doors`.\n\n{page}");
        assert_eq!(marked(&own, gone, "0b"), own);
    }
}
