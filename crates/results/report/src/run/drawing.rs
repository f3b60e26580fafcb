//! What several figures of a run share.

use stribeck_analysis::findings::Findings;

use crate::plot::{Band, Colour, Series};

/// A signal over the time of the record.
pub(super) fn sampled(findings: &Findings, name: &str, colour: Colour, values: &[f64]) -> Series {
    Series::sampled(name, colour, findings.start_s, findings.interval_s, values.to_vec())
}

/// The time in which the notch still answers to the start.
pub(super) fn transient(findings: &Findings) -> Vec<Band> {
    let length = findings.transient_s();
    if length == 0.0 {
        return Vec::new();
    }
    let label = format!("transient of the notch, {:.1} ms", 1e3 * length);
    vec![Band { from: findings.start_s, to: findings.start_s + length, label }]
}
