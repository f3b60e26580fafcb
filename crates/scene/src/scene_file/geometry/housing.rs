//! The outer ring in its adapter or pedestal.

use super::bounds::{less_than, more_than};
use super::{OUTER_RACE, OUTER_RING};
use crate::field::wording::{number, round_up};
use crate::housing::HousingScene;
use crate::reading::finding::{Finding, Remedy};
use crate::scene::Scene;

/// Thinnest wall of a pedestal, as a part of the ring's outside radius.
const LEAST_PEDESTAL: f64 = 0.02;

/// The seat wraps part of the outer ring, never all of its width.
pub(super) fn adapter(scene: &Scene) -> Option<Finding> {
    let b = &scene.bearing;
    let outside = b.outer_race_diameter_mm + 2.0 * b.outer_ring_thickness_mm;
    let width = scene.adapter.width_mm;
    if width < outside || !scene.housing.is_adapter() {
        return None;
    }
    let message = format!(
        "the adapter is {} mm wide, as wide as the outer ring ({} mm): the seat would have no sides",
        number(width),
        number(outside)
    );
    let ring = (width - b.outer_race_diameter_mm) / 2.0;
    Some(Finding::new(
        message,
        vec![
            Remedy::new("adapter.width_mm", less_than(outside, "mm, the outside diameter of the outer ring")),
            Remedy::new(OUTER_RACE, more_than(width - 2.0 * b.outer_ring_thickness_mm, "mm")),
            Remedy::new(OUTER_RING, more_than(ring, "mm")),
        ],
    ))
}

/// Material around the bore of a pedestal.
pub(super) fn pedestal(scene: &Scene) -> Option<Finding> {
    let HousingScene::Pedestal(pedestal) = &scene.housing else { return None };
    let b = &scene.bearing;
    let outside = b.outer_race_diameter_mm + 2.0 * b.outer_ring_thickness_mm;
    let least = 0.5 * outside * (1.0 + LEAST_PEDESTAL);
    let sides = [
        ("housing.width_mm", pedestal.width_mm, 2.0),
        ("housing.base_mm", pedestal.base_mm, 1.0),
        ("housing.top_mm", pedestal.top_mm, 1.0),
    ];
    let (field, value, halves) = sides.into_iter().find(|(_, value, halves)| *value <= halves * least)?;
    let message = format!(
        "`{field}` is {}, which leaves no pedestal around the outer ring ({} mm across)",
        number(value),
        number(outside)
    );
    Some(Finding::new(message, vec![Remedy::new(field, more_than(round_up(halves * least, 3), "mm"))]))
}
