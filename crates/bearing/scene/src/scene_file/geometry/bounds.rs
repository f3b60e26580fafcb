//! Ends of the ranges that messages propose.

use crate::field::wording::{number, round_down, round_up};

/// Significant digits of the ends of a range, and their relative rounding error.
const DIGITS: i32 = 5;

const DUST: f64 = 1e-12;

/// The lower end of a range: a number within it.
pub(super) fn lower(end: f64) -> String {
    number(round_up(end * (1.0 - DUST), DIGITS))
}

/// The upper end of one.
pub(super) fn upper(end: f64) -> String {
    number(round_down(end * (1.0 + DUST), DIGITS))
}

/// `17.1 to 18 mm`, or a text where no value is possible.
pub(super) fn between(low: f64, high: f64) -> String {
    if high <= low || high <= 0.0 {
        return NOTHING.to_owned();
    }
    format!("{} to {} mm", lower(low.max(0.0)), upper(high))
}

pub(super) fn more_than(low: f64, unit: &str) -> String {
    format!("more than {} {unit}", lower(low))
}

pub(super) fn less_than(high: f64, unit: &str) -> String {
    if high <= 0.0 { NOTHING.to_owned() } else { format!("less than {} {unit}", upper(high)) }
}

pub(super) fn at_most(high: f64, unit: &str) -> String {
    if high <= 0.0 { NOTHING.to_owned() } else { format!("at most {} {unit}", upper(high)) }
}

/// Text for a field that no value of its own can repair.
pub(super) const NOTHING: &str = "no value while the other dimensions stay";
