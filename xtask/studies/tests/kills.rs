//! A study as a program.

#![cfg(unix)]

use std::process::Command;

#[test]
fn survives_random_kills_with_the_same_bytes() {
    // Five here; `cargo xtask study kills` does a hundred.
    let output = Command::new(env!("CARGO_BIN_EXE_stribeck-studies"))
        .args(["kills", "--kills", "5", "--duration-ms", "0.6"])
        .output()
        .expect("it starts");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        output.status.success() && said.contains("5 kills"),
        "{said}{}",
        String::from_utf8_lossy(&output.stderr)
    );
}
