//! What is handed on reaches its program, which cargo builds.
#![cfg(unix)]

use std::process::{Command, Output};

/// `xtask` with these words, and what it takes for cargo.
fn xtask(cargo: &str, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    command.env("CARGO", cargo).args(words).output().expect("the program starts")
}

#[test]
fn behaves_a_study_is_built_and_run_by_cargo_with_all_its_words() {
    // What prints its arguments in the place of cargo.
    let output = xtask("echo", &["--quiet", "study", "long", "--only", "3", "--help"]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{output:?}");
    assert!(said.starts_with("run --release --package stribeck-studies --manifest-path"), "{said}");
    assert!(said.trim_end().ends_with(" -- --quiet long --only 3 --help"), "{said}");
}

#[test]
fn behaves_a_command_that_reads_records_is_handed_on_to_the_program() {
    let output = xtask("echo", &["-q", "analyse", "a record.csv", "--bearing", "6205"]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{output:?}");
    assert!(said.starts_with("run --release --package stribeck --manifest-path"), "{said}");
    assert!(said.trim_end().ends_with(" --quiet -- -q analyse a record.csv --bearing 6205"), "{said}");
}

#[test]
fn behaves_without_cargo_a_study_says_what_it_needs() {
    let output = xtask("/nowhere/cargo", &["study", "noise"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(said.contains("cannot start cargo") && said.contains("PATH"), "{said}");
}
