//! The documents against the code.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result};
use clap::Parser;
use stribeck_scene::scene::Scene;

use super::{markdown, sources};
use crate::Cli;

fn read(root: &Path, name: &str) -> Result<String> {
    std::fs::read_to_string(root.join(name)).with_context(|| format!("cannot read {name}"))
}

/// Every section of THEORY that the crates cite exists.
pub(crate) fn check_citations(root: &Path) -> Result<Vec<String>> {
    let theory = read(root, "docs/THEORY.md")?;
    let sections: BTreeSet<&str> = theory.lines().filter_map(markdown::section_number).collect();
    let mut complaints = Vec::new();
    let folders = sources::FOLDERS.map(|folder| sources::rust_files(&root.join(folder)));
    for file in folders.into_iter().collect::<Result<Vec<_>>>()?.concat() {
        let text =
            std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        let name = file.strip_prefix(root).unwrap_or(&file).display().to_string();
        for cited in markdown::citations(&text).into_iter().filter(|cited| !sections.contains(cited)) {
            complaints.push(format!("{name} cites THEORY §{cited}, which has no heading"));
        }
    }
    Ok(complaints)
}

/// Every `cargo xtask …` and `stribeck …` in the documents is accepted by the command line, and every fixture
/// it names exists.
pub(crate) fn check_commands(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for name in documents(root)? {
        for command in markdown::code(&read(root, &name)?) {
            complaints.extend(wrong_command(root, command).map(|why| format!("{name}: `{command}`: {why}")));
        }
    }
    Ok(complaints)
}

/// Every block of RON in the documents is a scene.
pub(crate) fn check_scenes(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for name in documents(root)? {
        for block in markdown::blocks(&read(root, &name)?, "ron") {
            complaints.extend(Scene::parse(&block, &name).err().map(|why| why.to_string()));
        }
    }
    Ok(complaints)
}

/// Every file that a document links to exists. In the book, whose pages `docs/SUMMARY.md` lists, it lies in
/// `docs`, and a page is one of the book.
pub(crate) fn check_links(root: &Path) -> Result<Vec<String>> {
    let docs = root.join("docs").canonicalize().context("cannot find docs")?;
    let summary = read(root, "docs/SUMMARY.md")?;
    let pages: BTreeSet<_> = markdown::links(&summary)
        .into_iter()
        .filter_map(|page| docs.join(page).canonicalize().ok())
        .collect();
    let listed = markdown::links(&summary).into_iter().map(|page| format!("docs/{page}"));
    let names: BTreeSet<String> = documents(root)?.into_iter().chain(listed).collect();
    let mut complaints = Vec::new();
    for name in names {
        let text = read(root, &name)?;
        let document = root.join(&name).canonicalize().with_context(|| format!("cannot find {name}"))?;
        for link in markdown::links(&text) {
            let why = match document.with_file_name(link).canonicalize() {
                Err(_) => "is not there",
                Ok(_) if !pages.contains(&document) => continue,
                Ok(target) if !target.starts_with(&docs) => "is outside of docs, and so of the book",
                Ok(target) if target.extension().is_some_and(|e| e == "md") && !pages.contains(&target) => {
                    "docs/SUMMARY.md does not list"
                }
                Ok(_) => continue,
            };
            complaints.push(format!("{name} links to `{link}`, which {why}"));
        }
    }
    Ok(complaints)
}

/// README, CONTRIBUTING, the documents in `docs/`, `docs/notes/` and `docs/guide/src/`, and the README of
/// every crate.
fn documents(root: &Path) -> Result<Vec<String>> {
    let mut names = vec!["README.md".to_owned(), "CONTRIBUTING.md".to_owned()];
    for folder in ["docs", "docs/notes", "docs/guide/src"] {
        let entries =
            std::fs::read_dir(root.join(folder)).with_context(|| format!("cannot read {folder}"))?;
        let files =
            entries.flatten().map(|entry| format!("{folder}/{}", entry.file_name().to_string_lossy()));
        names.extend(files.filter(|name| name.ends_with(".md")));
    }
    names.extend(sources::crates(root)?.iter().map(|folder| format!("{folder}/README.md")));
    names.retain(|name| root.join(name).exists());
    names.sort();
    Ok(names)
}

/// Why a command of the documents would fail; `None` when it would not, or is no command of ours.
fn wrong_command(root: &Path, command: &str) -> Option<String> {
    // `cargo xtask` has the commands of `stribeck`.
    let begins = |name: &str| command.starts_with(name).then_some(name.len());
    let at =
        command.find("cargo xtask").map(|at| at + "cargo xtask".len()).or_else(|| begins("stribeck "))?;
    // Words behind a comment, a pipe or another command are not ours; nor is a placeholder such as
    // `[SCENE]`.
    let ours = &command[at..];
    let ends = |(n, sign): &(usize, char)| {
        "#|;&>".contains(*sign) && ours[..*n].matches('"').count().is_multiple_of(2)
    };
    let end = ours.char_indices().find(ends).map_or(ours.len(), |(n, _)| n);
    let words = words(&ours[..end]);
    let words: Vec<&str> =
        words.iter().map(String::as_str).filter(|w| !w.contains(['[', '…', '<'])).collect();
    if words.is_empty() {
        return None;
    }
    let missing = words.iter().find(|word| word.starts_with("fixtures/") && !root.join(word).exists());
    if let Some(missing) = missing {
        return Some(format!("there is no `{missing}`"));
    }
    // Of commands that are handed on only the names are known, except in `.ci/run`, whose `xtask` has all
    // features.
    let parsed = Cli::try_parse_from(std::iter::once("cargo xtask").chain(words.iter().copied()));
    let wrong = parsed.err().filter(clap::Error::use_stderr)?;
    let text = wrong.to_string();
    Some(text.lines().next().unwrap_or_default().to_owned())
}

/// Words of a command line; a quoted string is one.
fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for sign in command.chars() {
        match sign {
            '"' => quoted = !quoted,
            _ if sign.is_whitespace() && !quoted => words.push(String::new()),
            _ => words.iter_mut().last().into_iter().for_each(|word| word.push(sign)),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_words_in_quotation_marks_are_one() {
        assert_eq!(words(r#" export a  --sensor "rate_hz=1, bits=2; a=2""#).len(), 4);
    }

    #[test]
    fn behaves_commands_that_do_not_exist_are_found() {
        let root = Path::new("/nowhere");
        for fine in [
            "cargo xtask simulate",
            "cargo xtask simulate [SCENE] --set mesh.size_mm=1.0 --no-report # coarse",
            "time cargo xtask ci --quick && ls",
            "cargo build",
            "cargo xtask --help",
        ] {
            assert_eq!(wrong_command(root, fine), None, "{fine}");
        }
        for wrong in
            ["cargo xtask simulat", "cargo xtask report --fast", "cargo xtask simulate fixtures/scenes/x.ron"]
        {
            assert!(wrong_command(root, wrong).is_some(), "{wrong}");
        }
    }
}
