//! Texts of a release: installers, a formula of Homebrew, a container, the notes.

use std::path::Path;

use anyhow::{Context, Result, ensure};

use super::VERSION;

/// Their templates, by file name.
const TEMPLATES: [(&str, &str); 3] = [
    ("install.sh", include_str!("../../assets/release/install.sh")),
    ("install.ps1", include_str!("../../assets/release/install.ps1")),
    ("Containerfile", include_str!("../../assets/release/Containerfile")),
];

/// Name of the bill of materials.
pub(super) fn bill() -> String {
    format!("stribeck-{VERSION}.cdx.json")
}

/// Writes one file.
pub(super) fn write(folder: &Path, name: &str, text: &str) -> Result<()> {
    std::fs::write(folder.join(name), text).with_context(|| format!("cannot write {name}"))
}

/// Writes all; `archives` have names and checksums.
pub(super) fn write_all(root: &Path, folder: &Path, archives: &[(String, String)]) -> Result<()> {
    let sums: Vec<String> = archives.iter().map(|(name, sum)| format!("{sum}  {name}")).collect();
    for (name, text) in TEMPLATES {
        let text =
            text.replace("{{version}}", VERSION).replace("{{repository}}", env!("CARGO_PKG_REPOSITORY"));
        write(folder, name, &text.replace("{{sums}}", &sums.join("\n")))?;
    }
    write(folder, "stribeck.rb", &formula(archives))?;
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

/// A formula of Homebrew for the archives of Linux and macOS.
fn formula(archives: &[(String, String)]) -> String {
    let mut text = format!(
        "class Stribeck < Formula\n  desc \"Explicit dynamics of rolling element bearings\"\n  homepage \
         \"{repository}\"\n  version \"{VERSION}\"\n  license any_of: [\"MIT\", \"Apache-2.0\"]\n",
        repository = env!("CARGO_PKG_REPOSITORY")
    );
    for (system, on_system) in [("linux", "on_linux"), ("darwin", "on_macos")] {
        for (processor, on_processor) in [("x86_64", "on_intel"), ("aarch64", "on_arm")] {
            let wanted = |(name, _): &&(String, String)| {
                name.contains(system) && name.contains(processor) && !name.contains("musl")
            };
            if let Some((name, sum)) = archives.iter().find(wanted) {
                text += &format!(
                    "\n  {on_system} do\n    {on_processor} do\n      url \
                     \"{}/releases/download/v{VERSION}/{name}\"\n      sha256 \"{sum}\"\n    end\n  end\n",
                    env!("CARGO_PKG_REPOSITORY")
                );
            }
        }
    }
    text + "\n  def install\n    bin.install \"stribeck\"\n  end\n\n  test do\n    system bin/\"stribeck\", \
            \"demo\"\n  end\nend\n"
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
        assert!(notes("# Changelog\n").is_err());
    }
}
