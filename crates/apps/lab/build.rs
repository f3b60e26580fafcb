//! Finds the module of the page, so that the program carries it (feature `embed`).
//!
//! It is `assets/module/stribeck_lab.wasm`, which `cargo xtask lab-module --embed` puts there and packages
//! hold, or the file that the variable `STRIBECK_LAB_EMBED` names. It is not compiled here: that takes half
//! a minute of a core and a target that few have (docs/DESIGN.md). One that is older than its sources is left
//! out.

use std::{
    env, fs,
    path::{Path, PathBuf},
    time::SystemTime,
};

/// Where it lies in this package.
const FOLDER: &str = "assets/module";
const FILE: &str = "stribeck_lab.wasm";

/// Names another file.
const VARIABLE: &str = "STRIBECK_LAB_EMBED";

/// Sources of the module, besides this crate, in the repository.
const SOURCES: [&str; 5] = ["lab", "reduced", "theory", "surface", "simd"];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(embedded)");
    // The module itself carries none.
    let for_page = env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|arch| arch == "wasm32");
    if for_page || env::var_os("CARGO_FEATURE_EMBED").is_none() {
        return;
    }
    println!("cargo::rerun-if-env-changed={VARIABLE}");
    // The folder and not the file: an absent file counts as changed at every build.
    println!("cargo::rerun-if-changed={FOLDER}");
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let Some(module) = module(&here) else { return };
    println!("cargo::rerun-if-changed={}", module.display());
    println!("cargo::rustc-env=STRIBECK_LAB_EMBEDDED={}", module.display());
    println!("cargo::rustc-cfg=embedded");
}

fn module(here: &Path) -> Option<PathBuf> {
    if let Some(named) = env::var_os(VARIABLE) {
        let named = PathBuf::from(named);
        if named.is_absolute() && named.is_file() {
            return Some(named);
        }
        println!("cargo::warning={VARIABLE} = {}: must be the whole path of a file", named.display());
    }
    let module = here.join(FOLDER).join(FILE);
    let made = fs::metadata(&module).and_then(|file| file.modified()).ok()?;
    // A package holds nothing but the module to go by.
    let sources = SOURCES.map(|name| here.join("..").join(name).join("src"));
    if !sources.iter().all(|folder| folder.is_dir()) {
        return Some(module);
    }
    for folder in &sources {
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    if sources.iter().any(|folder| newest(folder).is_some_and(|written| written > made)) {
        println!(
            "cargo::warning={FOLDER}/{FILE} is older than its sources and is left out: `cargo xtask \
             lab-module --embed` makes it anew"
        );
        return None;
    }
    Some(module)
}

/// When a file below a folder was written last.
fn newest(folder: &Path) -> Option<SystemTime> {
    let entries = fs::read_dir(folder).ok()?.flatten();
    let written = entries.filter_map(|entry| {
        let path = entry.path();
        if path.is_dir() { newest(&path) } else { entry.metadata().ok()?.modified().ok() }
    });
    written.max()
}
