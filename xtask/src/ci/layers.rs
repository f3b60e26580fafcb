//! The crates and the arrows between them.

use std::path::Path;

use anyhow::{Context, Result};

/// What tests share: every crate may have it as a dev-dependency, and none otherwise.
const TESTING: &str = "testing";
/// The one crate whose package has the name of its folder alone.
const PROGRAM: &str = "stribeck";

/// Every crate in `crates/`, and those of ours that it depends on. A new arrow is the one change that
/// needs a paragraph in ARCHITECTURE.
const LAYERS: [(&str, &[&str]); 23] = [
    (TESTING, &[]),
    ("mesh", &[]),
    ("simd", &[]),
    ("solver", &["mesh", "simd"]),
    ("surface", &["simd"]),
    ("contact", &["mesh", "simd", "solver", "surface"]),
    ("theory", &[]),
    ("infer", &[]),
    ("scene", &["theory"]),
    ("store", &["scene"]),
    ("plans", &["scene", "store"]),
    ("system", &["contact", "mesh", "solver"]),
    ("reduced", &["simd", "surface", "theory"]),
    (
        "simulation",
        &["contact", "mesh", "reduced", "scene", "solver", "store", "surface", "system", "theory"],
    ),
    ("lab", &["reduced", "scene", "simulation", "theory"]),
    ("fmu", &["reduced"]),
    ("dsp", &[]),
    ("formats", &["dsp"]),
    ("diagnosis", &["dsp", "theory"]),
    ("analysis", &["diagnosis", "dsp", "scene", "store", "theory"]),
    ("report", &["analysis", "diagnosis", "dsp", "scene", "store", "theory"]),
    (
        "stribeck",
        &[
            "analysis",
            "diagnosis",
            "dsp",
            "formats",
            "infer",
            "lab",
            "mesh",
            "plans",
            "reduced",
            "report",
            "scene",
            "simulation",
            "store",
            "theory",
        ],
    ),
    (
        "python",
        &[
            "analysis",
            "diagnosis",
            "dsp",
            "formats",
            "report",
            "scene",
            "simulation",
            "store",
            "stribeck",
            "theory",
        ],
    ),
];

/// Arrows of tests alone, beside the layers: verdicts are tried on files of measured records, the lab on the
/// folder of a run.
const TESTS_ALONE: [(&str, &str); 2] = [("diagnosis", "formats"), ("lab", "store")];

/// Names of the folders in `crates/`, sorted.
pub(crate) fn crates(root: &Path) -> Result<Vec<String>> {
    let folder = root.join("crates");
    let entries = std::fs::read_dir(&folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut names: Vec<String> = entries
        .flatten()
        .filter(|entry| entry.path().join("Cargo.toml").is_file())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    Ok(names)
}

/// Folders of all packages, from the root: those in `crates/`, and what only the development uses.
pub(crate) fn folders(root: &Path) -> Result<Vec<String>> {
    let development = ["studies", "xtask"].map(str::to_owned);
    Ok(crates(root)?.iter().map(|name| format!("crates/{name}")).chain(development).collect())
}

pub(crate) fn check(root: &Path) -> Result<Vec<String>> {
    let mut complaints = Vec::new();
    for name in crates(root)? {
        let file = root.join("crates").join(&name).join("Cargo.toml");
        let text =
            std::fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        match LAYERS.iter().find(|layer| layer.0 == name) {
            Some((_, allowed)) => complaints.extend(compare(&name, &text, allowed)),
            None => complaints.push(format!("crate `{name}` has no place in the list of layers")),
        }
    }
    Ok(complaints)
}

/// Holds the dependencies in a manifest against those allowed; those of tests may be fewer but not others.
fn compare(name: &str, manifest: &str, allowed: &[&str]) -> Vec<String> {
    let mut section = "";
    let mut found = Vec::new();
    let mut complaints = Vec::new();
    for line in manifest.lines().map(str::trim) {
        if line.starts_with('[') {
            section = line;
        }
        let package = line.split(['.', ' ', '=']).next().unwrap_or_default();
        let ours = package.strip_prefix("stribeck-").or((package == PROGRAM).then_some(PROGRAM));
        let Some(to) = ours.filter(|_| section.ends_with("dependencies]")) else { continue };
        let of_tests_alone = to == TESTING || TESTS_ALONE.contains(&(name, to));
        if of_tests_alone && section == "[dev-dependencies]" {
            continue;
        }
        if !allowed.contains(&to) {
            complaints
                .push(format!("`{name}` depends on `{to}` ({section}), against the direction of the layers"));
        } else if section == "[dependencies]"
            || section.starts_with("[target.") && section.ends_with(".dependencies]")
        {
            found.push(to);
        }
    }
    for missing in allowed.iter().filter(|to| !found.contains(to)) {
        complaints.push(format!("`{name}` does not depend on `{missing}`: take the arrow out of the list"));
    }
    complaints
}

#[cfg(test)]
mod tests {
    use super::compare;

    #[test]
    fn behaves_arrows_against_the_layers_are_found() {
        let manifest = "[package]\nname = \"stribeck-solver\"\n[dependencies]\nstribeck-mesh.workspace = \
            true\n\
            stribeck-contact = { path = \"x\" }\n[dev-dependencies]\nstribeck-dsp.workspace = true\n";
        let complaints = compare("solver", manifest, &["mesh"]);
        assert_eq!(complaints.len(), 2);
        assert!(complaints[0].contains("`contact`") && complaints[1].contains("`dsp`"));
        assert_eq!(compare("solver", "[dependencies]\nfaer.workspace = true\n", &["mesh"]).len(), 1);
        assert!(compare("solver", "[dependencies]\nstribeck-mesh.workspace = true\n", &["mesh"]).is_empty());
        assert_eq!(compare("solver", "[dependencies]\nstribeck.workspace = true\n", &[]).len(), 1);
    }

    #[test]
    fn behaves_what_tests_share_is_for_tests() {
        let of = |section: &str| {
            compare("mesh", &format!("[{section}]\nstribeck-testing.workspace = true\n"), &[])
        };
        assert!(of("dev-dependencies").is_empty());
        assert_eq!(of("dependencies").len(), 1);
        let formats = |name: &str, section: &str| {
            compare(name, &format!("[{section}]\nstribeck-formats.workspace = true\n"), &[])
        };
        assert!(formats("diagnosis", "dev-dependencies").is_empty());
        assert_eq!(formats("diagnosis", "dependencies").len(), 1);
        assert_eq!(formats("report", "dev-dependencies").len(), 1);
    }
}
