//! The documents against the code.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result};
use clap::Parser;
use stribeck_scene::scene::Scene;

use super::{layers, markdown, sources};
use crate::Cli;

fn read(root: &Path, name: &str) -> Result<String> {
    std::fs::read_to_string(root.join(name)).with_context(|| format!("cannot read {name}"))
}

/// Every crate is in ARCHITECTURE, and every crate in ARCHITECTURE exists.
pub(crate) fn check_architecture(root: &Path) -> Result<Vec<String>> {
    let text = read(root, "docs/ARCHITECTURE.md")?;
    let exist: BTreeSet<String> = layers::crates(root)?.into_iter().collect();
    Ok(compare_crates(&text, &exist))
}

fn compare_crates(text: &str, exist: &BTreeSet<String>) -> Vec<String> {
    let mut named = BTreeSet::new();
    for prefix in ["crates/", "stribeck-", "stribeck_"] {
        for (at, _) in text.match_indices(prefix) {
            let rest = &text[at + prefix.len()..];
            let end = rest.find(|c: char| !c.is_ascii_lowercase()).unwrap_or(rest.len());
            named.insert(rest[..end].to_owned());
        }
    }
    named.remove("");
    let unknown =
        named.difference(exist).map(|name| format!("ARCHITECTURE names the crate `{name}`: there is none"));
    let silent =
        exist.difference(&named).map(|name| format!("ARCHITECTURE says nothing about `crates/{name}`"));
    unknown.chain(silent).collect()
}

/// Every section of THEORY that the crates cite exists.
pub(crate) fn check_citations(root: &Path) -> Result<Vec<String>> {
    let theory = read(root, "docs/THEORY.md")?;
    let sections: BTreeSet<&str> = theory.lines().filter_map(markdown::section_number).collect();
    let mut complaints = Vec::new();
    let folders = ["crates", "studies"].map(|folder| sources::rust_files(&root.join(folder)));
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

/// The terms of each section of GLOSSARY are in order, and none is there twice.
pub(crate) fn check_glossary(root: &Path) -> Result<Vec<String>> {
    Ok(compare_terms(&read(root, "docs/GLOSSARY.md")?))
}

fn compare_terms(text: &str) -> Vec<String> {
    let sections = markdown::terms(text);
    let mut complaints = Vec::new();
    let mut count = BTreeMap::new();
    for term in sections.iter().flatten() {
        *count.entry(term.to_lowercase()).or_insert(0) += 1;
    }
    if count.is_empty() {
        complaints.push("GLOSSARY has no terms (`**term**` at the start of a line)".to_owned());
    }
    for pair in sections.iter().flat_map(|terms| terms.windows(2)) {
        if pair[0].to_lowercase() > pair[1].to_lowercase() {
            complaints.push(format!("GLOSSARY: `{}` stands behind `{}`", pair[1], pair[0]));
        }
    }
    let twice = count.iter().filter(|(_, count)| **count > 1);
    complaints.extend(twice.map(|(term, _)| format!("GLOSSARY explains `{term}` twice")));
    complaints
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

/// Every file that a document links to exists.
pub(crate) fn check_links(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for name in documents(root)? {
        let text = read(root, &name)?;
        let folder = root.join(&name).parent().map_or_else(|| root.to_owned(), Path::to_owned);
        let missing = markdown::links(&text).into_iter().filter(|target| !folder.join(target).exists());
        complaints.extend(missing.map(|target| format!("{name} links to `{target}`, which is not there")));
    }
    Ok(complaints)
}

/// The pages of the book of `docs` link to each other and to pictures and tables beside them: a page that
/// SUMMARY does not list is not in the book, and files outside of `docs` are not in it.
pub(crate) fn check_book(root: &Path) -> Result<Vec<String>> {
    let summary = read(root, "docs/SUMMARY.md")?;
    let pages = markdown::links(&summary).into_iter();
    let pages = pages.map(|page| read(root, &format!("docs/{page}")).map(|text| (page, text)));
    Ok(links_out_of_a_book(&pages.collect::<Result<Vec<_>>>()?))
}

/// Links that break in a book of these pages, each by its path with its text.
fn links_out_of_a_book(pages: &[(&str, String)]) -> Vec<String> {
    let mut complaints = Vec::new();
    for (page, text) in pages {
        for link in markdown::links(text) {
            let mut place: Vec<&str> = page.split('/').collect();
            place.pop();
            let inside = link.split('/').filter(|part| *part != ".").all(|part| match part {
                ".." => place.pop().is_some(),
                part => {
                    place.push(part);
                    true
                }
            });
            let target = place.join("/");
            let listed = !target.ends_with(".md") || pages.iter().any(|(page, _)| *page == target);
            if !(inside && listed) {
                let why = if inside { "docs/SUMMARY.md does not list it" } else { "it is outside of docs" };
                complaints.push(format!("docs/{page} links to `{link}`, which breaks in the book: {why}"));
            }
        }
    }
    complaints
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
    names.extend(layers::crates(root)?.iter().map(|name| format!("crates/{name}/README.md")));
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
        assert_eq!(words(r#" export a  --path "mass=1, damping=0.1; mass=2""#).len(), 4);
    }

    #[test]
    fn behaves_crates_and_architecture_agree() {
        let exist = BTreeSet::from(["mesh".to_owned(), "solver".to_owned()]);
        assert!(compare_crates("`crates/mesh`, stribeck-solver", &exist).is_empty());
        let complaints = compare_crates("crates/mesh and crates/mush", &exist);
        assert_eq!(complaints.len(), 2, "{complaints:?}");
    }

    #[test]
    fn behaves_links_that_break_in_the_book_are_found() {
        let pages = |a: &str, b: &str| [("guide/a.md", a.to_owned()), ("B.md", b.to_owned())];
        let fine = pages(
            "[b](../B.md#x), ![p](a/p.svg), [t](../t.csv), https://x.org",
            "[a](guide/a.md), [a](./guide/a.md)",
        );
        assert_eq!(links_out_of_a_book(&fine), [""; 0]);
        for (a, b, why) in [
            ("[f](../../fixtures/x.ron)", "", "docs/guide/a.md links to `../../fixtures/x.ron`"),
            ("", "[c](../CONTRIBUTING.md)", "outside of docs"),
            ("[c](../guide/c.md)", "", "SUMMARY.md does not list"),
        ] {
            let found = links_out_of_a_book(&pages(a, b));
            assert!(found.len() == 1 && found[0].contains(why), "{found:?}");
        }
    }

    #[test]
    fn behaves_glossaries_out_of_order_are_found() {
        assert!(compare_terms("**Bore** x\n**cage** y").is_empty());
        assert_eq!(compare_terms("**cage** x\n**Bore** y").len(), 1);
        assert_eq!(compare_terms("**cage** x\n## More\n**Cage** y").len(), 1);
        assert_eq!(compare_terms("no terms").len(), 1);
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
