//! Shared by the tests of several crates: comparisons, rows of `docs/VALIDATION.md`, repeatable numbers,
//! temporary folders, damage to files, cases beside each other, the output of a program, a reference for
//! balls, and peers: other programs to compare with.
//!
//! It depends on no other crate of the workspace, so that all can have it as a dev-dependency. What needs the
//! solver stands in `tests/common` of the crate that uses it.

mod ball;
mod cases;
#[cfg(not(target_family = "wasm"))]
pub mod damage;
pub mod ledger;
mod noise;
pub mod peer;
mod said;
mod scratch;

pub use ball::ball_approach;
pub use cases::side_by_side;
pub use noise::Noise;
pub use said::{said, says};
pub use scratch::Scratch;

/// Fails unless `ours` is within `tolerance` (relative) of `theirs`.
#[track_caller]
pub fn assert_close(ours: f64, theirs: f64, tolerance: f64, what: &str) {
    let error = (ours - theirs).abs() / theirs.abs();
    assert!(
        error <= tolerance,
        "{what}: {ours:e}, expected {theirs:e}, off by {error:.2e} > {tolerance:.1e}"
    );
}

/// Fails unless `result` is an error whose message has `words`.
#[track_caller]
pub fn assert_refused<T, E: std::fmt::Display>(result: Result<T, E>, words: &str) {
    refuses(result, &[words]);
}

/// Fails unless `result` is an error whose message has all of these words.
#[track_caller]
pub fn refuses<T, E: std::fmt::Display>(result: Result<T, E>, words: &[&str]) {
    let Err(why) = result else { panic!("accepted, where {words:?} were expected") };
    assert_has(&why.to_string(), words);
}

/// Fails unless a text has all of these words.
#[track_caller]
pub fn assert_has(text: &str, words: &[&str]) {
    words.iter().for_each(|word| assert!(text.contains(word), "`{word}` is not in: {text}"));
}

/// Observed orders of convergence from errors on meshes or with steps that halve each time.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|w| (w[0] / w[1]).log2()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_errors_of_second_order_show_it() {
        assert_eq!(orders(&[16.0, 4.0, 1.0]), [2.0, 2.0]);
    }

    #[test]
    fn behaves_a_number_within_its_tolerance_is_close() {
        assert_close(-1.01, -1.0, 0.011, "a number");
    }

    #[test]
    #[should_panic(expected = "a number: 1.01e0, expected 1e0")]
    fn refuses_a_number_beyond_its_tolerance() {
        assert_close(1.01, 1.0, 0.009, "a number");
    }

    #[test]
    #[should_panic(expected = "a number: NaN")]
    fn refuses_what_is_not_a_number() {
        assert_close(f64::NAN, 1.0, 1.0, "a number");
    }
}
