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
    for (name, template) in TEMPLATES {
        let text = filled(template, archives);
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

/// A template with version, address and checksums in their places.
fn filled(template: &str, archives: &[(String, String)]) -> String {
    let sums: Vec<String> = archives.iter().map(|(name, sum)| format!("{sum}  {name}")).collect();
    let text = template.replace("{{version}}", VERSION).replace("{{sums}}", &sums.join("\n"));
    let text = text.replace("{{repository}}", env!("CARGO_PKG_REPOSITORY"));
    archives.iter().fold(text, |text, (name, sum)| text.replace(&format!("{{{{{name}}}}}"), sum))
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
    use std::process::Command;

    use super::*;

    /// The installer takes the archive beside itself, from another folder too, and the one of a relative
    /// `STRIBECK_FROM`; without network.
    #[test]
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    fn issue_the_installer_takes_the_archive_beside_it() {
        let folder = stribeck_testing::Scratch::create("installer");
        let name = format!("stribeck-{VERSION}-x86_64-unknown-linux-gnu");
        let script = r#"
            mkdir -p release "$1" && echo program >"$1/stribeck" && tar -czf "release/$1.tar.gz" "$1"
            sha256sum "release/$1.tar.gz" | cut -d ' ' -f 1
        "#;
        let made = Command::new("sh")
            .args(["-euc", script, "sh", &name])
            .current_dir(folder.path())
            .output()
            .expect("a shell");
        let sum = String::from_utf8(made.stdout).expect("text").trim().to_owned();
        let release = folder.path().join("release");
        write(&release, "install.sh", &filled(TEMPLATES[0].1, &[(format!("{name}.tar.gz"), sum)]))
            .expect("written");
        for (place, from) in [(folder.path(), None), (folder.path(), Some("release")), (&release, Some("."))]
        {
            let mut install = Command::new("sh");
            install.arg(release.join("install.sh")).current_dir(place).env_remove("STRIBECK_FROM");
            install.env("STRIBECK_TO", "bin").envs(from.map(|from| ("STRIBECK_FROM", from)));
            let output = install.output().expect("a shell");
            assert!(output.status.success(), "{output:?}");
            let program = std::fs::read_to_string(place.join("bin/stribeck")).expect("the program");
            assert_eq!(program, "program\n");
            std::fs::remove_dir_all(place.join("bin")).expect("removed");
        }
    }

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
