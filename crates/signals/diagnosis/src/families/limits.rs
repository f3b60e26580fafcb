//! Limits of a claim, and decibels.

/// Largest probability of a false alarm at which a family is there, and at which it is claimed.
pub(crate) const ALPHA: f64 = 1e-3;
/// Least modulation of the power of a band that is called an impact: of 6205s on two rigs the deepest of sound
/// ones is 0.37 and the shallowest of damaged raceways that show is 1.04 (docs/results/verdicts.md).
pub(crate) const IMPACT: f64 = 0.6;

/// The same of a rolling element whose family has the sidebands of the cage.
pub(crate) const IMPACT_OF_ELEMENT: f64 = 0.5;

pub(crate) fn decibel(power: f64) -> f64 {
    10.0 * power.max(1e-30).log10()
}
