//! Modules that use each other in a circle: none may be read without the others.
//!
//! A circle that must be needs a line in ARCHITECTURE: "Circle in `contact`: `a` and `b`, because …". Modules
//! of a folder are looked at by themselves, under the name of the folder (`solver/kernel`). That a folder's
//! modules use what their parent defines, and the parent its modules, makes no circle; what tests use does
//! not count, in a file `tests.rs` either.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context, Result, anyhow};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use super::{layers, sources};

/// Names of modules from the crate's root on; empty for the root.
type Place = Vec<String>;

/// What one module says about others.
#[derive(Default)]
struct Module {
    /// Paths from the crate's root that it uses.
    uses: Vec<Place>,
    /// Names that it imports or re-exports, and their paths.
    imports: BTreeMap<String, Place>,
}

/// The modules of a crate.
#[derive(Default)]
struct Modules(BTreeMap<Place, Module>);

/// Modules in a circle.
#[derive(Debug, PartialEq)]
struct Circle {
    /// The crate or folder that they lie in.
    place: String,
    modules: BTreeSet<String>,
    /// A way round, from a module back to it.
    way: Vec<String>,
}

pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let mut circles = Vec::new();
    for folder in layers::folders(root)? {
        circles.extend(circles_of(folder.trim_start_matches("crates/"), &root.join(&folder).join("src"))?);
    }
    let architecture = std::fs::read_to_string(root.join("docs/ARCHITECTURE.md"))
        .context("cannot read docs/ARCHITECTURE.md")?;
    Ok(compare(&circles, &architecture))
}

fn circles_of(name: &str, folder: &Path) -> Result<Vec<Circle>> {
    let mut files = Vec::new();
    for file in sources::rust_files(folder)? {
        if file.file_name().is_some_and(|name| name == "tests.rs") {
            continue;
        }
        let text =
            std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        files.push((place_of(file.strip_prefix(folder)?), text));
    }
    Ok(Modules::read(&files)?.circles(name))
}

/// Holds circles against the sentences of ARCHITECTURE.
fn compare(circles: &[Circle], architecture: &str) -> Vec<String> {
    let mut allowed: Vec<_> = architecture.lines().filter_map(sentence).collect();
    let mut complaints = Vec::new();
    for Circle { place, modules, way } in circles {
        let named = allowed.iter().position(|(at, named)| at == place && named == modules);
        if let Some(named) = named {
            allowed.remove(named);
            continue;
        }
        let all = modules.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        complaints.push(format!(
            "{place}: {} modules use each other in a circle ({all}), for one {}: break it, or add a line \
             \"Circle in `{place}`: {all}, because …\" to ARCHITECTURE",
            modules.len(),
            way.join(" → ")
        ));
    }
    let gone = allowed.into_iter().map(|(place, modules)| {
        let all = modules.into_iter().collect::<Vec<_>>().join(", ");
        format!("ARCHITECTURE names a circle in `{place}` that is none: {all}")
    });
    complaints.extend(gone);
    complaints
}

/// The place and modules of a line "Circle in `contact`: `a` and `b`, because …".
fn sentence(line: &str) -> Option<(String, BTreeSet<String>)> {
    let rest = line.trim_start_matches(['-', ' ']).strip_prefix("Circle in ")?;
    let (names, reason) = rest.split_once("because")?;
    let mut names = names.split('`').skip(1).step_by(2).map(str::to_owned);
    let place = names.next().filter(|_| !reason.trim().is_empty())?;
    Some((place, names.collect()))
}

/// The module that a file is, by its path below `src`.
fn place_of(file: &Path) -> Place {
    let mut place: Place =
        file.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    let front = match place.as_slice() {
        [only] => only == "lib" || only == "main",
        [.., last] => last == "mod",
        [] => false,
    };
    if front {
        place.pop();
    }
    place
}

impl Modules {
    fn read(files: &[(Place, String)]) -> Result<Self> {
        let mut modules = Self::default();
        files.iter().for_each(|(place, _)| _ = modules.0.entry(place.clone()).or_default());
        for (place, text) in files {
            let tokens: TokenStream =
                text.parse().map_err(|error| anyhow!("{}: {error}", place.join("::")))?;
            modules.walk(place, tokens);
        }
        Ok(modules)
    }

    /// Notes the paths in the code of the module at `place`, without code for tests.
    fn walk(&mut self, place: &Place, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        while let Some(token) = tokens.get(at) {
            at += 1;
            match token {
                TokenTree::Punct(mark) if mark.as_char() == '#' => {
                    if let Some(TokenTree::Group(attribute)) = tokens.get(at) {
                        at += 1;
                        if attribute.to_string().replace(' ', "") == "[cfg(test)]" {
                            at += tokens[at..].iter().take_while(|token| !ends_item(token)).count() + 1;
                        }
                    }
                }
                TokenTree::Ident(word) if word == "use" => {
                    let end = at + tokens[at..].iter().take_while(|token| !ends_item(token)).count();
                    // `use` with a brace ends at the semicolon behind it.
                    let end = end + usize::from(matches!(tokens.get(end), Some(TokenTree::Group(_))));
                    self.import(place, &Place::new(), &tokens[at..end]);
                    at = end;
                }
                TokenTree::Ident(word) if word == "mod" => {
                    let (name, body) = (tokens.get(at), tokens.get(at + 1));
                    if let (Some(TokenTree::Ident(name)), Some(TokenTree::Group(body))) = (name, body) {
                        let inner = [place.as_slice(), &[name.to_string()]].concat();
                        self.0.entry(inner.clone()).or_default();
                        self.walk(&inner, body.stream());
                    }
                    at += 2;
                }
                TokenTree::Ident(_) => {
                    let (path, len) = path_at(&tokens[at - 1..]);
                    if path.len() > 1
                        && let Some(path) = self.below_root(place, &path)
                    {
                        self.note(place, path);
                    }
                    at += len - 1;
                }
                TokenTree::Group(group) => self.walk(place, group.stream()),
                _ => {}
            }
        }
    }

    /// Notes the paths of a `use`, and the names that they get here. `before` is the path in front of a
    /// brace.
    fn import(&mut self, place: &Place, before: &Place, tree: &[TokenTree]) {
        let (path, len) = path_at(tree);
        let mut whole = [before.as_slice(), &path].concat();
        match tree.get(len) {
            Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Brace => {
                branches(group).iter().for_each(|branch| self.import(place, &whole, branch));
            }
            rest => {
                // `use a::b::{self}` is `use a::b`.
                whole.pop_if(|last| last == "self" && !before.is_empty());
                let glob = matches!(rest, Some(TokenTree::Punct(mark)) if mark.as_char() == '*');
                let name = match (rest, tree.get(len + 1)) {
                    (Some(TokenTree::Ident(word)), Some(TokenTree::Ident(name))) if word == "as" => {
                        Some(name.to_string())
                    }
                    _ => whole.last().cloned().filter(|_| !glob),
                };
                let Some(target) = self.below_root(place, &whole) else { return };
                if let (Some(name), Some(module)) = (name, self.0.get_mut(place)) {
                    module.imports.insert(name, target.clone());
                }
                self.note(place, target);
            }
        }
    }

    /// A path as written at `place`, from the crate's root on; `None` for other crates and local names.
    fn below_root(&self, place: &Place, path: &[String]) -> Option<Place> {
        let first = path.first()?;
        let up = path.iter().take_while(|part| *part == "super").count();
        if first == "crate" {
            return Some(path[1..].to_vec());
        }
        if first == "self" || up > 0 {
            let rest = &path[up.max(1)..];
            return Some([place.get(..place.len().checked_sub(up)?)?, rest].concat());
        }
        let below = [place.as_slice(), path].concat();
        self.0.contains_key(&below[..=place.len()]).then_some(below)
    }

    fn note(&mut self, place: &Place, path: Place) {
        if let Some(module) = self.0.get_mut(place) {
            module.uses.push(path);
        }
    }

    /// The module in which the thing at `path` is defined, through at most `hops` re-exports.
    fn home(&self, path: &[String], hops: usize) -> Place {
        let mut at = Place::new();
        for (i, name) in path.iter().enumerate() {
            at.push(name.clone());
            if self.0.contains_key(&at) {
                continue;
            }
            at.pop();
            let target = self.0.get(&at).and_then(|module| module.imports.get(name));
            return match target.filter(|_| hops > 0) {
                Some(target) => self.home(&[target.as_slice(), &path[i + 1..]].concat(), hops - 1),
                None => at,
            };
        }
        at
    }

    /// Circles among the modules of each folder, the root's first.
    fn circles(&self, name: &str) -> Vec<Circle> {
        const HOPS: usize = 8;
        let mut arrows: BTreeMap<&[String], BTreeMap<&str, BTreeSet<String>>> = BTreeMap::new();
        for (place, module) in &self.0 {
            for used in &module.uses {
                let home = self.home(used, HOPS);
                let shared = place.iter().zip(&home).take_while(|(a, b)| a == b).count();
                if let (Some(from), Some(to)) = (place.get(shared), home.get(shared)) {
                    let arrows = arrows.entry(&place[..shared]).or_default();
                    arrows.entry(from).or_default().insert(to.clone());
                }
            }
        }
        let circles = arrows.into_iter().flat_map(|(folder, arrows)| {
            let place = [&[name.to_owned()], folder].concat().join("/");
            circles_among(&arrows).into_iter().map(move |(modules, way)| Circle {
                place: place.clone(),
                modules,
                way,
            })
        });
        circles.collect()
    }
}

/// Strongly connected modules, where they are more than one, with the shortest way from the first back to it.
fn circles_among(arrows: &BTreeMap<&str, BTreeSet<String>>) -> Vec<(BTreeSet<String>, Vec<String>)> {
    let reached: BTreeMap<&str, BTreeMap<String, Vec<String>>> =
        arrows.keys().map(|from| (*from, ways(arrows, from))).collect();
    let mut found: Vec<(BTreeSet<String>, Vec<String>)> = Vec::new();
    for (from, ways) in &reached {
        let Some(way) = ways.get(*from) else { continue };
        if !found.iter().any(|(modules, _)| modules.contains(*from)) {
            let back = |to: &str| reached.get(to).is_some_and(|ways| ways.contains_key(*from));
            let modules = ways.keys().filter(|to| back(to)).cloned().collect();
            found.push((modules, way.clone()));
        }
    }
    found
}

/// The shortest way from `from` to every module that can be reached, both ends included.
fn ways(arrows: &BTreeMap<&str, BTreeSet<String>>, from: &str) -> BTreeMap<String, Vec<String>> {
    let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let mut open = std::collections::VecDeque::from([vec![from.to_owned()]]);
    while let Some(way) = open.pop_front() {
        for to in way.last().and_then(|last| arrows.get(last.as_str())).into_iter().flatten() {
            if !found.contains_key(to) {
                let longer = [way.as_slice(), std::slice::from_ref(to)].concat();
                found.insert(to.clone(), longer.clone());
                open.push_back(longer);
            }
        }
    }
    found
}

fn ends_item(token: &TokenTree) -> bool {
    match token {
        TokenTree::Punct(mark) => mark.as_char() == ';',
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        _ => false,
    }
}

/// The names of the path that `tokens` begin with, and how many tokens it takes with the `::` behind it.
fn path_at(tokens: &[TokenTree]) -> (Place, usize) {
    let colon = |at: usize| matches!(tokens.get(at), Some(TokenTree::Punct(mark)) if mark.as_char() == ':');
    let (mut path, mut at) = (Place::new(), 0);
    while let Some(TokenTree::Ident(name)) = tokens.get(at) {
        path.push(name.to_string());
        at += 1;
        if !(colon(at) && colon(at + 1)) {
            break;
        }
        at += 2;
    }
    (path, at)
}

/// The parts between the commas of a brace.
fn branches(group: &Group) -> Vec<Vec<TokenTree>> {
    let tokens: Vec<TokenTree> = group.stream().into_iter().collect();
    let comma = |token: &TokenTree| matches!(token, TokenTree::Punct(mark) if mark.as_char() == ',');
    tokens.split(comma).map(<[TokenTree]>::to_vec).filter(|branch| !branch.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles(files: &[(&str, &str)]) -> Vec<Circle> {
        let files: Vec<_> =
            files.iter().map(|(name, text)| (place_of(Path::new(name)), (*text).to_owned())).collect();
        Modules::read(&files).expect("code that can be read").circles("x")
    }

    fn names(circles: &[Circle]) -> Vec<(&str, Vec<&str>)> {
        circles.iter().map(|c| (c.place.as_str(), c.modules.iter().map(String::as_str).collect())).collect()
    }

    #[test]
    fn invariant_circles_are_found_by_any_way_of_naming_a_module() {
        let root = ("lib.rs", "mod a; mod b; mod c; pub use b::{Thing, inner as other};");
        for uses in [
            "use crate::b::Thing;",
            "use crate::{c, b::{self, Thing as T}};",
            "use super::b;",
            "fn f() -> super::b::Thing { g(|x| crate::b::new(x)) }",
            "use crate::Thing;",
            "fn f() { crate::other() }",
            "fn f() { assert!(crate::b::ok()); }",
            "mod inner { use super::super::b; }",
        ] {
            let found =
                circles(&[root, ("a.rs", uses), ("b.rs", "use crate::c;"), ("c.rs", "use super::a::A;")]);
            assert_eq!(names(&found), [("x", vec!["a", "b", "c"])], "{uses}");
        }
    }

    #[test]
    fn invariant_tests_words_and_parents_make_no_circle() {
        for uses in [
            "#[cfg(test)] mod tests { use crate::b; }",
            "#[cfg(test)] use crate::b;",
            "// crate::b\n/// [`crate::b`]\nconst WHERE: &str = \"crate::b\";",
            "use other::b; fn f() { b::g(); }",
            "use crate::NotInAModule;",
        ] {
            let found = circles(&[("lib.rs", "mod a; mod b;"), ("a.rs", uses), ("b.rs", "use crate::a;")]);
            assert_eq!(names(&found), [], "{uses}");
        }
        let child = ("a/child.rs", "use super::Parent;");
        assert_eq!(names(&circles(&[("a.rs", "mod child; use child::Child;"), child])), []);
    }

    #[test]
    fn invariant_modules_of_a_folder_are_looked_at_by_themselves() {
        let found = circles(&[
            ("a/mod.rs", "mod b; mod c;"),
            ("a/b.rs", "use super::c::C;"),
            ("a/c.rs", "use crate::a::b;"),
            ("d.rs", "use crate::a;"),
        ]);
        assert_eq!(names(&found), [("x/a", vec!["b", "c"])]);
    }

    #[test]
    fn invariant_a_circle_needs_its_sentence_and_a_sentence_its_circle() {
        let found = circles(&[("a.rs", "use crate::b;"), ("b.rs", "use crate::a;")]);
        assert_eq!(found[0].way, ["a", "b", "a"]);
        assert!(compare(&found, "Circle in `x`: `b` and `a`, because they are one.").is_empty());
        for wrong in ["", "Circle in `x`: `a` and `b`, because", "Circle in `y`: `a` and `b`, because."] {
            assert!(!compare(&found, wrong).is_empty(), "{wrong}");
        }
        assert_eq!(compare(&[], "Circle in `x`: `a` and `b`, because they are one.").len(), 1);
    }
}
