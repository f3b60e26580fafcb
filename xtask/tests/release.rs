//! What a release is made from.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

#[test]
fn refuses_a_release_of_a_checkout_with_changes() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("release");
    std::fs::create_dir_all(&folder).expect("a folder");
    // What answers in the place of git.
    let git = folder.join("git");
    std::fs::write(&git, "#!/bin/sh\n[ \"$1\" = status ] && echo ' M crates/fe/mesh/src/lib.rs'\n")
        .expect("written");
    std::fs::set_permissions(&git, std::fs::Permissions::from_mode(0o755)).expect("its own file");
    let mut release = Command::new(env!("CARGO_BIN_EXE_xtask"));
    release
        .env("PATH", &folder)
        .env_remove("SOURCE_DATE_EPOCH")
        .arg("release")
        .arg("--out")
        .arg(folder.join("out"));
    let output = release.output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(said.contains("commit or stash") && said.contains("crates/fe/mesh/src/lib.rs"), "{said}");
}
