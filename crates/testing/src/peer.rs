//! Other programs that tests compare ours with: where one is absent a test prints so and checks nothing,
//! unless it must be there.

use std::process::Command;

/// The Python interpreter in `STRIBECK_PYTHON`, or `python3`, if it has these modules.
///
/// Where the variable is set the modules must be there: a test that needs them fails without them. Otherwise
/// it prints which check it skips.
///
/// # Panics
/// When the interpreter that `STRIBECK_PYTHON` names lacks a module.
pub fn python_with(modules: &[&str]) -> Option<String> {
    const VARIABLE: &str = "STRIBECK_PYTHON";
    let python = std::env::var(VARIABLE).unwrap_or_else(|_| "python3".to_owned());
    let import = format!("import {}", modules.join(", "));
    let has = Command::new(&python).args(["-c", &import]).output().is_ok_and(|o| o.status.success());
    has.then(|| python.clone())
        .or_else(|| absent(VARIABLE, &format!("`{python}` does not have {}", modules.join(", "))))
}

/// Says that a peer is absent; fails where `variable` is set, which says that it must be there.
///
/// # Panics
/// When `variable` is set.
pub fn absent<T>(variable: &str, why: &str) -> Option<T> {
    assert!(std::env::var_os(variable).is_none(), "{variable} is set, and {why}");
    eprintln!("left out: {why}");
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_peer_may_be_absent_unless_a_variable_asks_for_it() {
        assert_eq!(absent::<()>("STRIBECK_NO_SUCH_VARIABLE", "nobody is there"), None);
        // PATH is set everywhere.
        assert!(std::panic::catch_unwind(|| absent::<()>("PATH", "nobody is there")).is_err());
    }
}
