//! The spall in its ring: length, edges, depth.

use std::f64::consts::PI;

use super::bounds::{at_most, lower};
use super::{INNER_RACE, INNER_RING, OUTER_RACE, OUTER_RING};
use crate::field::wording::{number, round_down, round_up};
use crate::reading::finding::{Finding, Remedy};
use crate::scene::{DefectRing, Scene};

/// Below the floor of a defect this part of the ring must be left to carry the load.
pub(in crate::scene_file) const MAX_DEFECT_DEPTH_RATIO: f64 = 0.6;

/// Widest edge of a defect in facets, each edge being one, and as a part of the defect's length
/// (`stribeck_mesh::Groove`).
const WIDEST_WALL: f64 = 2.0;

const WALL_OF_LENGTH: f64 = 0.4;

/// The spall is no longer than half of the raceway.
pub(super) fn defect_length(scene: &Scene) -> Option<Finding> {
    let defect = scene.defect.as_ref()?;
    let (length, b) = (defect.length_mm, &scene.bearing);
    let (name, field, diameter) = match defect.ring {
        DefectRing::Outer => ("outer", OUTER_RACE, b.outer_race_diameter_mm),
        DefectRing::Inner => ("inner", INNER_RACE, b.inner_race_diameter_mm),
    };
    let around = PI * diameter;
    if length <= around / 2.0 {
        return None;
    }
    let what = if length >= around { "the whole raceway" } else { "any load zone" };
    let message = format!(
        "the defect, {} mm long, is longer than {what}: the raceway measures {:.1} mm, its loaded half {:.1} \
         mm",
        number(length),
        around,
        around / 2.0
    );
    Some(Finding::new(
        message,
        vec![
            Remedy::new(
                "defect.length_mm",
                at_most(around / 2.0, &format!("mm, half of the {name} raceway")),
            ),
            Remedy::new(field, format!("at least {} mm", lower(2.0 * length / PI))),
        ],
    ))
}

/// Walls of the spall are single facets, and leave a floor.
pub(super) fn defect_edges(scene: &Scene) -> Option<Finding> {
    const SLOPE: &str = "defect.edge_slope_deg";
    let defect = scene.defect.as_ref().filter(|defect| defect.edge_slope_deg < 90.0)?;
    let wall = defect.depth_mm / defect.edge_slope_deg.to_radians().tan();
    let widest = (WIDEST_WALL * scene.mesh.size_mm).min(WALL_OF_LENGTH * defect.length_mm);
    if wall <= widest {
        return None;
    }
    let steep = round_up((defect.depth_mm / widest).atan().to_degrees(), 1);
    let message = format!(
        "the edges of the defect, {} mm deep at {}°, would be {:.3} mm wide; a mesh of {} mm and a defect of \
         {} mm have room for {:.3} mm",
        number(defect.depth_mm),
        number(defect.edge_slope_deg),
        wall,
        number(scene.mesh.size_mm),
        number(defect.length_mm),
        widest
    );
    let shallow = round_down(widest * defect.edge_slope_deg.to_radians().tan(), 3);
    Some(Finding::new(
        message,
        vec![
            Remedy::new(SLOPE, format!("at least {}°", lower(steep))),
            Remedy::new("defect.depth_mm", at_most(shallow, "mm")),
        ],
    ))
}

/// The spall leaves some of the ring below it.
pub(super) fn defect_depth(scene: &Scene) -> Option<Finding> {
    let defect = scene.defect.as_ref()?;
    let depth = defect.depth_mm;
    let (name, field, ring) = match defect.ring {
        DefectRing::Outer => ("outer", OUTER_RING, scene.bearing.outer_ring_thickness_mm),
        DefectRing::Inner => ("inner", INNER_RING, scene.bearing.inner_ring_thickness_mm),
    };
    let deepest = MAX_DEFECT_DEPTH_RATIO * ring;
    if depth <= deepest {
        return None;
    }
    let message = format!(
        "the defect, {} mm deep, is too deep for an {name} ring of {} mm",
        number(depth),
        number(ring)
    );
    let thinnest = depth / MAX_DEFECT_DEPTH_RATIO;
    Some(Finding::new(
        message,
        vec![
            Remedy::new("defect.depth_mm", at_most(deepest, "mm, 60 % of the ring's thickness")),
            Remedy::new(field, format!("at least {} mm", lower(thinnest))),
        ],
    ))
}
