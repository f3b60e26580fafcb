//! Modules that use each other in a circle: none may be read without the others.
//!
//! Looked for are the paths `crate::…` and `super::…` as they are written, tests apart. Modules of a folder are
//! looked at by themselves, under the name of the folder (`solver/kernel`). A circle that must be needs a line
//! in ARCHITECTURE: "Circle in `contact`: `a` and `b`, because …".

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result};

use super::{layers, sources};

/// Names of modules from the crate's root on; empty for the root.
type Place = Vec<String>;

/// A folder of modules, and those in it that use each other in a circle.
type Circle = (String, BTreeSet<String>);

pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let mut found = BTreeSet::new();
    let crates = layers::crates(root)?.into_iter().map(|name| (format!("crates/{name}/src"), name));
    for (folder, name) in
        crates.chain(["studies", "xtask"].map(|name| (format!("{name}/src"), name.to_owned())))
    {
        let folder = root.join(folder);
        let mut files = Vec::new();
        for file in sources::rust_files(&folder)? {
            let text =
                std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
            files.push((place_of(file.strip_prefix(&folder)?), text));
        }
        found.extend(circles(&name, &files));
    }
    let architecture = std::fs::read_to_string(root.join("docs/ARCHITECTURE.md"))
        .context("cannot read docs/ARCHITECTURE.md")?;
    let allowed: BTreeSet<Circle> = architecture.lines().filter_map(sentence).collect();
    let words = |(place, modules): &Circle| {
        let names: Vec<String> = modules.iter().map(|name| format!("`{name}`")).collect();
        format!("Circle in `{place}`: {}", names.join(" and "))
    };
    let unknown = found
        .difference(&allowed)
        .map(|circle| format!("break it, or add a line \"{}, because …\" to ARCHITECTURE", words(circle)));
    let gone =
        allowed.difference(&found).map(|circle| format!("ARCHITECTURE, \"{}\": it is none", words(circle)));
    Ok(unknown.chain(gone).collect())
}

/// The circle of a line "Circle in `contact`: `a` and `b`, because …".
fn sentence(line: &str) -> Option<Circle> {
    let (names, reason) =
        line.trim_start_matches(['-', ' ']).strip_prefix("Circle in ")?.split_once("because")?;
    let mut names = names.split('`').skip(1).step_by(2).map(str::to_owned);
    let place = names.next().filter(|_| !reason.trim().is_empty())?;
    Some((place, names.collect()))
}

/// The module that a file is, by its path below `src`.
fn place_of(file: &Path) -> Place {
    let mut place: Place =
        file.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if matches!(place.last().map(String::as_str), Some("lib" | "main" | "mod")) {
        place.pop();
    }
    place
}

/// Circles among the modules of each folder of a crate, whose files are given with their modules.
fn circles(name: &str, files: &[(Place, String)]) -> Vec<Circle> {
    let places: BTreeSet<&[String]> = files.iter().map(|(place, _)| &place[..]).collect();
    let mut arrows: BTreeMap<&[String], BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for (place, text) in files.iter().filter(|(place, _)| place.last().is_none_or(|name| name != "tests")) {
        for used in paths(place, text) {
            let home =
                (0..=used.len()).rev().find(|&n| places.contains(&used[..n])).map_or(&[][..], |n| &used[..n]);
            let shared = place.iter().zip(home).take_while(|(a, b)| a == b).count();
            if let (Some(from), Some(to)) = (place.get(shared), home.get(shared)) {
                arrows
                    .entry(&place[..shared])
                    .or_default()
                    .entry(from.clone())
                    .or_default()
                    .insert(to.clone());
            }
        }
    }
    let mut found = Vec::new();
    for (folder, arrows) in arrows {
        let reached: BTreeMap<&String, BTreeSet<&String>> =
            arrows.keys().map(|from| (from, reach(&arrows, from))).collect();
        for (from, all) in reached.iter().filter(|(from, all)| all.contains(*from)) {
            let back = |to: &&&String| reached.get(**to).is_some_and(|all| all.contains(*from));
            let place = [&[name.to_owned()], folder].concat().join("/");
            found.push((place, all.iter().filter(back).map(|to| (*to).clone()).collect()));
        }
    }
    found
}

/// Modules that one leads to, itself only by way of others.
fn reach<'a>(arrows: &'a BTreeMap<String, BTreeSet<String>>, from: &String) -> BTreeSet<&'a String> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&String> = arrows[from].iter().collect();
    while let Some(at) = open.pop() {
        if found.insert(at) {
            open.extend(arrows.get(at).into_iter().flatten());
        }
    }
    found
}

/// The paths in a file's code that begin with `crate` or `super`, from the crate's root on.
fn paths(place: &[String], text: &str) -> Vec<Place> {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let code: String =
        text.lines().flat_map(|line| [line.split("//").next().unwrap_or_default(), "\n"]).collect();
    let mut found = Vec::new();
    for (at, word) in code.match_indices("crate::").chain(code.match_indices("super::")) {
        let before = code[..at].chars().next_back();
        if !before.is_some_and(|c| c.is_alphanumeric() || "_:$".contains(c)) {
            let up = if word == "crate::" { place.len() } else { 1 };
            let base = place[..place.len().saturating_sub(up)].to_vec();
            tree(&code[at + word.len()..], base, &mut found);
        }
    }
    found
}

/// Notes the paths of a tree such as `a::{b, super::c}`; returns the text behind it.
fn tree<'a>(text: &'a str, mut path: Place, found: &mut Vec<Place>) -> &'a str {
    let mut rest = text.trim_start();
    if let Some(inner) = rest.strip_prefix('{') {
        rest = inner;
        while !rest.is_empty() && !rest.starts_with('}') {
            rest = tree(rest, path.clone(), found).trim_start_matches([' ', '\n', ',']);
        }
        return rest.get(1..).unwrap_or_default();
    }
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
    let (name, mut rest) = rest.split_at(end);
    match name {
        "super" => _ = path.pop(),
        "self" => {}
        _ => path.push(name.to_owned()),
    }
    if let Some(further) = rest.strip_prefix("::") {
        return tree(further, path, found);
    }
    found.push(path);
    // Behind `*`, and `as` with its name.
    rest = rest.trim_start_matches(|c: char| !"{},;".contains(c) && c != '\n');
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<(String, String)> {
        let files: Vec<_> =
            files.iter().map(|(name, text)| (place_of(Path::new(name)), (*text).to_owned())).collect();
        let circles: BTreeSet<Circle> = circles("x", &files).into_iter().collect();
        circles
            .into_iter()
            .map(|(place, names)| (place, names.into_iter().collect::<Vec<_>>().join(" ")))
            .collect()
    }

    #[test]
    fn refuses_circles_by_any_way_of_naming_a_module() {
        for uses in [
            "use crate::b::Thing;",
            "use crate::{c, b::{self, Thing as T}};",
            "use super::b;",
            "fn f() -> super::b::Thing { g(|x| crate::b::new(x)) }",
            "fn f() { assert!(crate::b::ok()); }",
        ] {
            let files = [
                ("lib.rs", "mod a;"),
                ("a.rs", uses),
                ("b.rs", "use crate::c;"),
                ("c.rs", "use super::a::A;"),
            ];
            assert_eq!(found(&files), [("x".to_owned(), "a b c".to_owned())], "{uses}");
        }
        let folder = [
            ("a/mod.rs", ""),
            ("a/b.rs", "use super::c::C;"),
            ("a/c.rs", "use crate::a::b;"),
            ("d.rs", "use crate::a;"),
        ];
        assert_eq!(found(&folder), [("x/a".to_owned(), "b c".to_owned())]);
    }

    #[test]
    fn behaves_tests_words_and_parents_make_no_circle() {
        for uses in
            ["#[cfg(test)]\nmod tests { use crate::b; }", "// crate::b", "use other::b;", "use crate::Root;"]
        {
            assert_eq!(found(&[("a.rs", uses), ("b.rs", "use crate::a;")]), [], "{uses}");
        }
        assert_eq!(found(&[("a.rs", "use child::Child;"), ("a/child.rs", "use super::Parent;")]), []);
    }

    #[test]
    fn behaves_a_sentence_names_a_circle_and_its_reason() {
        let (place, names) =
            sentence("- Circle in `x`: `b` and `a`, because they are one.").expect("a circle");
        assert_eq!(
            (place.as_str(), names.into_iter().collect::<Vec<_>>()),
            ("x", vec!["a".to_owned(), "b".to_owned()])
        );
        assert_eq!(sentence("Circle in `x`: `a` and `b`, because"), None);
    }
}
