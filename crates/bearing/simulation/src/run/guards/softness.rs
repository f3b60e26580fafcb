//! Contact that is softer than the bearing itself.

use stribeck_scene::{resolved::ResolvedScene, scene::ContactFormula};
use stribeck_theory::contact_law::ContactLawKind;
use stribeck_theory::static_load::RigidRings;

use super::When;

/// Contact that sinks in by more than this share of the defect's depth moves its edges.
const OF_DEPTH: f64 = 0.5;

/// Contact that sinks in by more than this times what steel gives way by in equilibrium is soft: a load that is put
/// on at once presses twice as much.
const SOFTER: f64 = 2.0;

/// Reference of penetrations [m]: a contact with a larger penetration is softer than the bearing itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Softness {
    /// What steel gives way by, in words, and by how much: the approach of the most loaded contact between
    /// rigid rings, by Hertz; where nothing carries in equilibrium, half of the diametral clearance.
    steel: (&'static str, f64),
    /// Depth of the shallowest spall; infinite without one.
    depth: f64,
    /// Whether contact gives way as Hertz's does, or less.
    is_steel: bool,
}

impl Softness {
    pub(super) fn of(scene: &ResolvedScene) -> Self {
        let [_, most] = scene.duty.load_range_n(scene.duration);
        let load =
            RigidRings::new(scene, scene.contact_law).distribute(most, &scene.written.angles_to_load_deg());
        let hertz = load.map_or(0.0, |load| 0.5 * load.max_approach_m());
        let steel = if hertz > 0.0 {
            ("by Hertz the most loaded one gives way by", hertz)
        } else {
            ("the radial clearance is", 0.5 * scene.clearance)
        };
        let depth = scene.written.spalls().iter().map(|d| 1e-3 * d.depth_mm).fold(f64::INFINITY, f64::min);
        let contact = &scene.written.contact;
        let is_steel = contact.formula == ContactFormula::Hertz && contact.penalty_scale >= 1.0;
        // Balls of steel sink in by the approach that they have.
        let depth = if is_steel && scene.contact_law == ContactLawKind::Ball { f64::INFINITY } else { depth };
        Self { steel, depth, is_steel }
    }

    /// Penetration above which there is a warning [m].
    pub(super) fn limit(&self) -> f64 {
        let soft = if self.is_steel { f64::INFINITY } else { SOFTER * self.steel.1 };
        soft.min(OF_DEPTH * self.depth)
    }

    pub(super) fn warning(&self, penetration: f64, when: &When) -> String {
        let um = |length: f64| format!("{:.1} µm", 1e6 * length);
        let depth = if self.depth.is_finite() {
            format!(", the defect is {} deep", um(self.depth))
        } else {
            String::new()
        };
        let (steel, by) = self.steel;
        format!(
            "the penetration of a contact has reached {} {when}: contact is softer than the bearing, {steel} \
             {}{depth}. Load zone, times and impulses are those of a softer bearing; `contact.formula: hertz` is \
             as stiff as steel",
            um(penetration),
            um(by),
        )
    }
}
