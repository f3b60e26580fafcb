//! What a program is made of: licences of all packages in it, and a bill of materials (CycloneDX 1.5).

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde_json::{Value, json};

use super::{VERSION, output};
use crate::fmu;

/// First words of the names of files with a licence, in capitals.
const NAMES: [&str; 5] = ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE"];

/// Packages of others in the program or in the library of FMUs, on any platform, in the order of their names.
fn packages(root: &Path) -> Result<Vec<Value>> {
    let mut found = BTreeMap::new();
    for (manifest, top) in [("Cargo.toml", "stribeck"), (fmu::MANIFEST, "stribeck-fmu")] {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.current_dir(root).args(["metadata", "--format-version=1", "--manifest-path", manifest]);
        let metadata: Value = serde_json::from_str(&output(&mut cargo, "it comes with Rust")?)?;
        let packages = list(&metadata["packages"]).iter().map(|package| (text(&package["id"]), package));
        let packages: BTreeMap<&str, &Value> = packages.collect();
        let nodes = list(&metadata["resolve"]["nodes"]).iter().map(|node| (text(&node["id"]), node));
        let nodes: BTreeMap<&str, &Value> = nodes.collect();
        let first = packages.iter().find(|(_, package)| package["name"] == top);
        let mut open: Vec<&str> = first.map(|(id, _)| *id).into_iter().collect();
        ensure!(!open.is_empty(), "cargo metadata of {manifest} has no package `{top}`");
        let mut seen = BTreeSet::new();
        while let Some(id) = open.pop() {
            if seen.insert(id) {
                // A package that only builds or tests is not in the program.
                let linked =
                    |edge: &&Value| list(&edge["dep_kinds"]).iter().any(|kind| kind["kind"].is_null());
                let edges = nodes.get(id).map_or(&[][..], |node| list(&node["deps"]));
                open.extend(edges.iter().filter(linked).map(|edge| text(&edge["pkg"])));
            }
        }
        for package in seen.into_iter().filter_map(|id| packages.get(id)) {
            if !package["source"].is_null() {
                let key = (text(&package["name"]).to_owned(), text(&package["version"]).to_owned());
                found.insert(key, (*package).clone());
            }
        }
    }
    Ok(found.into_values().collect())
}

/// Licences of all packages of others: each text once, under the packages that bring it.
pub(super) fn licences(root: &Path) -> Result<String> {
    let mut all = format!(
        "Stribeck {VERSION} is made of the packages below and of Rust's standard library (MIT or Apache-2.0,\n\
         the Rust project's authors). Their licences follow, each text once.\n\n"
    );
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in packages(root)? {
        let name = format!("{} {}", text(&package["name"]), text(&package["version"]));
        let licence = package["license"].as_str().unwrap_or("see its file");
        all += &format!("{name}: {licence}, {}\n", package["repository"].as_str().unwrap_or("crates.io"));
        let folder =
            Path::new(text(&package["manifest_path"])).parent().context("a manifest without a folder")?;
        for words in files(folder)? {
            texts.entry(words).or_default().push(name.clone());
        }
    }
    for (words, names) in texts {
        all += &format!("\n{}\n{}\n\n{}\n", "=".repeat(80), names.join(", "), words.trim_end());
    }
    Ok(all)
}

/// Texts of licences in a package, and in a folder of foreign sources in it.
fn files(folder: &Path) -> Result<BTreeSet<String>> {
    let mut texts = BTreeSet::new();
    for entry in
        std::fs::read_dir(folder).with_context(|| format!("cannot read `{}`", folder.display()))?.flatten()
    {
        let name = entry.file_name().to_string_lossy().to_uppercase();
        let path = entry.path();
        if path.is_file() && NAMES.iter().any(|begin| name.starts_with(begin)) {
            texts.extend(std::fs::read_to_string(&path).map(|words| words.replace("\r\n", "\n")));
        } else if path.is_dir() && !["SRC", "TESTS", "BENCHES", "EXAMPLES"].contains(&name.as_str()) {
            texts.extend(files(&path)?);
        }
    }
    Ok(texts)
}

/// The bill of materials.
pub(super) fn bill(root: &Path) -> Result<String> {
    let component = |package: Value| {
        let (name, version) = (text(&package["name"]).to_owned(), text(&package["version"]).to_owned());
        let mut component = json!({
            "type": "library",
            "name": name,
            "version": version,
            "purl": format!("pkg:cargo/{name}@{version}"),
        });
        if let Some(licence) = package["license"].as_str() {
            // Before SPDX had expressions, a slash meant `or`.
            let licence = licence.replace(" / ", " OR ").replace('/', " OR ");
            component["licenses"] = json!([{ "expression": licence }]);
        }
        component
    };
    let bill = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": { "component": { "type": "application", "name": "stribeck", "version": VERSION } },
        "components": packages(root)?.into_iter().map(component).collect::<Vec<_>>(),
    });
    Ok(serde_json::to_string_pretty(&bill)? + "\n")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}
