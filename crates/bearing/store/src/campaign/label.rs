//! The label of a run, which a model is to learn: its bearing and the parts that are damaged.

use stribeck_scene::deviation::RollingSurface;
use stribeck_scene::scene::Scene;

/// The fault of a bearing that has none.
pub(super) const HEALTHY: &str = "healthy";

/// Bearing and fault of a scene.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Label {
    /// Designation of the bearing; empty for one without.
    pub bearing: String,
    /// Damaged parts, joined by `+`, or `healthy`.
    pub fault: String,
}

impl Label {
    /// Of a scene, possible or not.
    pub fn of(scene: &Scene) -> Self {
        let on = |on: &RollingSurface| match on {
            RollingSurface::Outer => "outer_race",
            RollingSurface::Inner => "inner_race",
            RollingSurface::Roller(_) => "rolling_element",
        };
        // In their order: rollers come last, one beside the other.
        let mut parts: Vec<&str> = scene.faults().iter().map(on).collect();
        parts.dedup();
        if scene.rollers_in_place().count() < scene.bearing.rollers {
            parts.push("missing_rolling_element");
        }
        let fault = if parts.is_empty() { HEALTHY.to_owned() } else { parts.join("+") };
        Self { bearing: scene.bearing.designation.clone(), fault }
    }

    /// The name of its bearing in a sentence.
    pub(super) fn bearing_in_words(&self) -> &str {
        if self.bearing.is_empty() { "the bearing" } else { &self.bearing }
    }
}

impl std::fmt::Display for Label {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let fault = self.fault.replace('_', " ");
        if self.bearing.is_empty() { to.write_str(&fault) } else { write!(to, "{} {fault}", self.bearing) }
    }
}
