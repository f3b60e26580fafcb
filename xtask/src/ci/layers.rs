//! Arrows between crates, which never run up.

use std::path::Path;

use anyhow::{Context, Result};

use super::sources;

/// Folders of `crates/`, from below.
const LAYERS: [&str; 5] = ["fe", "bearing", "signals", "results", "apps"];

/// Every crate uses those of its own layer and of lower ones.
pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let mut crates = Vec::new();
    for folder in sources::crates(root)? {
        let manifest = root.join(&folder).join("Cargo.toml");
        let text = std::fs::read_to_string(&manifest)
            .with_context(|| format!("cannot read {}", manifest.display()))?;
        crates.push((folder, text));
    }
    Ok(complaints(&crates))
}

/// What is wrong with crates, each a folder and its manifest.
fn complaints(crates: &[(String, String)]) -> Vec<String> {
    let place = |folder: &str| {
        let mut parts = folder.split('/').skip(1);
        let layer = parts.next().unwrap_or_default();
        (LAYERS.iter().position(|name| *name == layer), parts.next().unwrap_or(layer).to_owned())
    };
    let layer_of = |package: &str| {
        let name = package.strip_prefix("stribeck-").unwrap_or(package);
        crates.iter().map(|(folder, _)| place(folder)).find(|(_, own)| own == name)?.0
    };
    let mut found = Vec::new();
    for (folder, manifest) in crates {
        let Some(own) = place(folder).0 else { continue };
        let dependencies = manifest.split("\n[dependencies]").nth(1).unwrap_or_default();
        let names = dependencies.lines().take_while(|line| !line.starts_with('['));
        let names = names.filter_map(|line| line.split(['.', ' ', '=']).next());
        for name in names.filter(|name| layer_of(name).is_some_and(|layer| layer > own)) {
            found.push(format!("{folder} uses {name}, which lies in a higher layer"));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_an_arrow_that_runs_up_is_found() {
        let uses = |folder: &str, name: &str| {
            (
                folder.to_owned(),
                format!("[package]\n\n[dependencies]\n{name}.workspace = true\n\n[features]\n"),
            )
        };
        let crates =
            [uses("crates/fe/mesh", "stribeck-store"), uses("crates/bearing/store", "stribeck-mesh")];
        assert_eq!(complaints(&crates), ["crates/fe/mesh uses stribeck-store, which lies in a higher layer"]);
    }
}
