//! The output of a program.

use std::process::Output;

/// Its standard output, then its standard error.
pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Fails unless its output contains all of these words.
#[track_caller]
pub fn says(output: &Output, words: &[&str]) {
    crate::assert_has(&said(output), words);
}
