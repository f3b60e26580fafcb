//! Texts of a release: installers, a formula of Homebrew, a container, the notes, schemas.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use stribeck_analysis::summary::Summary;

use super::VERSION;

/// Their templates, by file name.
const TEMPLATES: [(&str, &str); 4] = [
    ("install.sh", include_str!("../../assets/release/install.sh")),
    ("install.ps1", include_str!("../../assets/release/install.ps1")),
    ("Containerfile", include_str!("../../assets/release/Containerfile")),
    ("stribeck.rb", include_str!("../../assets/release/stribeck.rb")),
];

/// Name of the bill of materials.
pub(super) fn bill() -> String {
    format!("stribeck-{VERSION}.cdx.json")
}

pub(super) fn write(folder: &Path, name: &str, text: &str) -> Result<()> {
    std::fs::write(folder.join(name), text).with_context(|| format!("cannot write {name}"))
}

/// Writes all; `archives` have names and checksums.
pub(super) fn write_all(root: &Path, folder: &Path, archives: &[(String, String)]) -> Result<()> {
    let sums: Vec<String> = archives.iter().map(|(name, sum)| format!("{sum}  {name}")).collect();
    for (name, text) in TEMPLATES {
        let text =
            text.replace("{{version}}", VERSION).replace("{{repository}}", env!("CARGO_PKG_REPOSITORY"));
        let text = text.replace("{{sums}}", &sums.join("\n"));
        let text =
            archives.iter().fold(text, |text, (name, sum)| text.replace(&format!("{{{{{name}}}}}"), sum));
        // A formula needs the archives of both processors.
        if !text.contains("{{") {
            write(folder, name, &text)?;
        }
    }
    write(folder, "scene.schema.json", &format!("{:#}\n", stribeck_scene::fields::json_schema()))?;
    write(folder, "summary.schema.json", &format!("{:#}\n", Summary::json_schema()))?;
    write(folder, "findings.schema.json", &format!("{:#}\n", stribeck_report::findings_schema()))?;
    let changes = std::fs::read_to_string(root.join("CHANGELOG.md")).context("cannot read CHANGELOG.md")?;
    write(folder, "NOTES.md", notes(&changes)?)?;
    let citation = std::fs::read_to_string(root.join("CITATION.cff")).context("cannot read CITATION.cff")?;
    ensure!(
        citation.lines().any(|line| line == format!("version: {VERSION}")),
        "CITATION.cff has another version than {VERSION}"
    );
    write(folder, "CITATION.cff", &citation)
}

/// The section of this version in the changelog, or that of what is not released.
fn notes(changes: &str) -> Result<&str> {
    let of = |title: &str| {
        let (_, section) = changes.split_once(&format!("\n## {title}"))?;
        let (_, section) = section.split_once('\n')?;
        Some(section.split("\n## ").next().unwrap_or(section).trim_start())
    };
    of(VERSION).or_else(|| of("Unreleased")).context("CHANGELOG.md has no section of this version")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_notes_are_the_section_of_the_version() {
        let later =
            format!("# Changelog\n\n## Unreleased\n\n- New.\n\n## {VERSION} - 2026-01-01\n\n- Old.\n");
        assert_eq!(notes(&later).expect("a section"), "- Old.\n");
        assert_eq!(notes("# Changelog\n\n## Unreleased\n\n- New.\n").expect("a section"), "- New.\n");
        assert!(
            notes("# Changelog\n").is_err_and(|why| why.to_string().contains("no section of this version"))
        );
    }
}
