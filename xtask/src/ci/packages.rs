//! Requirements on a crate before it can be published.

use std::path::Path;

use anyhow::{Context, Result};

use super::layers;

/// Fields of a manifest that crates.io shows or asks for.
const FIELDS: [&str; 6] = [
    "description = \"",
    "keywords = [\"",
    "categories = [\"",
    "license.workspace",
    "repository.workspace",
    "include.workspace",
];

/// Files that a package carries as copies, because a link would lead out of it.
const LICENSES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];

/// Every crate that is not kept private has a description, a README and the licences of the workspace.
pub(super) fn check(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for name in layers::crates(root)? {
        let folder = root.join("crates").join(&name);
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml"))
            .with_context(|| format!("cannot read the manifest of {name}"))?;
        let Some(missing) = missing_fields(&manifest) else { continue };
        complaints
            .extend(missing.into_iter().map(|field| format!("crates/{name}/Cargo.toml lacks `{field}`")));
        if std::fs::read_to_string(folder.join("README.md")).unwrap_or_default().lines().count() < 3 {
            complaints.push(format!("crates/{name}/README.md says nothing"));
        }
        for license in LICENSES {
            let copy = std::fs::read(folder.join(license)).ok();
            if copy.is_none() || copy != std::fs::read(root.join(license)).ok() {
                complaints.push(format!("crates/{name}/{license} is not the file of the root"));
            }
        }
    }
    Ok(complaints)
}

/// Names of the fields that a manifest lacks; `None` for a crate that is never published.
fn missing_fields(manifest: &str) -> Option<Vec<&'static str>> {
    if manifest.lines().any(|line| line.trim() == "publish = false") {
        return None;
    }
    let lacks = |field: &&str| !manifest.lines().any(|line| line.starts_with(*field));
    Some(
        FIELDS
            .into_iter()
            .filter(lacks)
            .map(|field| field.split([' ', '.']).next().unwrap_or_default())
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::missing_fields;

    #[test]
    fn refuses_manifests_that_lack_a_field() {
        assert_eq!(missing_fields("[package]\npublish = false\n"), None);
        assert_eq!(missing_fields("[package]\n").map(|fields| fields.len()), Some(6));
        let full = "description = \"x\"\nkeywords = [\"x\"]\ncategories = [\"science\"]\nlicense.workspace = \
            true\n\
            repository.workspace = true\ninclude.workspace = true\n";
        assert_eq!(missing_fields(full), Some(Vec::new()));
    }
}
