//! Errors of an inference's file, as those of scenes.

use super::{MOST_RUNS, MOST_STARTS};
use crate::document::Kind;

/// The file of an inference.
pub(super) const INFERENCE: Kind = Kind {
    noun: "an inference",
    example: "an inference has `name`, `unknowns` and `targets`, and may have `scene`, `set`, `seed`, \
        `starts` and `budget`; fixtures/infer/quick.ron is one",
    part,
    lacking,
    for_fields_of_scenes: "a field of the scene stands in `set: [\"{}=…\"]`, or in `unknowns` where it is \
        not known",
    most,
};

/// A file to look at.
pub(super) const FILE: &str = "fixtures/infer/quick.ron";

fn part(outer: Option<&str>) -> &'static str {
    match outer {
        Some("unknown") => "an unknown",
        Some("target") => "a target",
        Some("budget") => "`budget`",
        _ => "an inference",
    }
}

fn lacking(outer: Option<&str>) -> Option<&'static str> {
    match outer {
        Some("unknown") => Some("`(field: \"operation.load_n\", from: 5000, to: 50000, log: true)` is one"),
        Some("target") => Some("`(of: \"levels.impulse_g\", value: 180, tolerance: 18)` is one"),
        _ => None,
    }
}

fn most(field: &str) -> Option<u64> {
    match field {
        "seed" => Some(u64::MAX),
        "starts" => Some(MOST_STARTS as u64),
        "runs" | "first" | "round" | "check" => Some(MOST_RUNS as u64),
        _ => None,
    }
}
