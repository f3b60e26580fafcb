//! Writes the commit into the program, so that a run can say what made it, and finds the library of FMUs that
//! the program carries: the file that `STRIBECK_FMU_EMBED` names, as `cargo xtask release` does. It is not
//! compiled here, because its bindings need libclang.

use std::path::PathBuf;
use std::process::Command;

/// Names the library.
const FMU: &str = "STRIBECK_FMU_EMBED";

fn main() {
    // Whatever changes in the crates changes the program, and with it perhaps the answer.
    println!("cargo:rerun-if-changed=..");
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo:rerun-if-changed={log}");
    }
    // `cargo xtask release` sets it, having seen that nothing was changed.
    println!("cargo:rerun-if-env-changed=SOURCE_DATE_EPOCH");
    println!("cargo:rustc-env=STRIBECK_COMMIT={}", commit());
    println!("cargo:rerun-if-env-changed={FMU}");
    println!("cargo:rustc-check-cfg=cfg(fmu_embedded)");
    let Some(library) = std::env::var_os(FMU).map(PathBuf::from) else { return };
    if !library.is_absolute() || !library.is_file() {
        println!("cargo:warning={FMU} = {}: must be the whole path of a file", library.display());
        return;
    }
    println!("cargo:rerun-if-changed={}", library.display());
    println!("cargo:rustc-env=STRIBECK_FMU_EMBEDDED={}", library.display());
    println!("cargo:rustc-cfg=fmu_embedded");
}

/// Commit of the checkout, with a mark when its files have been changed since; `unknown` outside a checkout.
fn commit() -> String {
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]).filter(|commit| !commit.is_empty()) else {
        return "unknown".to_owned();
    };
    let changed =
        git(&["status", "--porcelain", "--untracked-files=no"]).is_some_and(|files| !files.is_empty());
    if changed { commit + " with changes" } else { commit }
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
