//! The cage between the raceways, its pockets, and the rollers in them.

use std::f64::consts::PI;

use super::bounds::{NOTHING, less_than, lower, more_than, upper};
use super::{INNER_RACE, OUTER_RACE, ROLLER, fewer_rollers, pitch_circle};
use crate::field::wording::number;
use crate::reading::finding::{Finding, Remedy};
use crate::resolved::CageGeometry;
use crate::scene::{CageScene, PocketWalls, Scene};

/// The cage inside the gap between the rings.
pub(super) fn cage(scene: &Scene) -> Option<Finding> {
    let b = &scene.bearing;
    let cage = scene.cage.as_ref()?;
    let (outer_race, inner_race) = (b.outer_race_diameter_mm, b.inner_race_diameter_mm);
    let (outer, inner) = diameters(cage);
    if outer < outer_race && inner > inner_race {
        return None;
    }
    let message = format!(
        "the cage, from diameter {} to {} mm, does not lie between the raceways of {} and {} mm",
        number(inner),
        number(outer),
        number(inner_race),
        number(outer_race)
    );
    let widest = inner_race + 2.0 * cage.thickness_mm;
    let (room_outside, room_inside) = (outer < outer_race, inner > inner_race);
    let if_only = |possible: bool, words: String| if possible { words } else { NOTHING.to_owned() };
    let diameter = if widest < outer_race {
        format!("more than {} and less than {} mm", lower(widest), number(outer_race))
    } else {
        NOTHING.to_owned()
    };
    Some(Finding::new(
        message,
        vec![
            Remedy::new("cage.outer_diameter_mm", diameter),
            Remedy::new(
                "cage.thickness_mm",
                if_only(room_outside, less_than((outer - inner_race) / 2.0, "mm")),
            ),
            Remedy::new(OUTER_RACE, if_only(room_inside, more_than(outer, "mm"))),
            Remedy::new(INNER_RACE, if_only(room_outside, less_than(inner, "mm"))),
            without_cage(),
        ],
    ))
}

/// Outer and inner diameter [mm].
fn diameters(cage: &CageScene) -> (f64, f64) {
    (cage.outer_diameter_mm, cage.outer_diameter_mm - 2.0 * cage.thickness_mm)
}

fn without_cage() -> Remedy {
    Remedy::new("cage", "`None` for rollers without a cage").value("None", "rollers without a cage")
}

/// Pockets that cut through the cage, and leave something of it between two of them.
pub(super) fn pockets(scene: &Scene) -> Option<Finding> {
    // A wrong position of cage or rollers is reported already.
    if cage(scene).is_some() || pitch_circle(scene).is_some() {
        return None;
    }
    let b = &scene.bearing;
    let cage = scene.cage.as_ref()?;
    let (outer, inner) = diameters(cage);
    let (outer, inner) = (outer / 2.0, inner / 2.0);
    let pitch = (b.outer_race_diameter_mm + b.inner_race_diameter_mm) / 2.0;
    let clearance = cage.pocket_clearance_um * 1e-3;
    let pocket = b.roller_diameter_mm / 2.0 + clearance;
    let [innermost, _] =
        CageGeometry::of(cage).walls(0.5e-3 * pitch, 0.5e-3 * b.roller_diameter_mm).map(|r| 1e3 * r);
    let half_angle = |pocket: f64| {
        let round = widest_pocket(inner, outer, pitch / 2.0, pocket)?;
        // Straight walls leave least of the cage at their inner ends.
        let straight = cage.pocket == PocketWalls::Straight;
        Some(if straight { round.max((pocket / innermost).min(1.0).asin()) } else { round })
    };
    let Some(half) = half_angle(pocket) else {
        return Some(pockets_miss(cage, b.roller_diameter_mm, pitch));
    };
    let half_spacing = PI / b.rollers as f64;
    if half < half_spacing {
        return None;
    }
    let message = format!(
        "{} pockets leave nothing of the cage between them: each takes ±{:.3}°, half the spacing is {:.3}°",
        b.rollers,
        half.to_degrees(),
        half_spacing.to_degrees()
    );
    let fits = |pocket: f64| half_angle(pocket).is_none_or(|h| h < half_spacing);
    let largest = largest(pocket, fits);
    let closest = (largest - b.roller_diameter_mm / 2.0) * 1e3;
    Some(Finding::new(
        message,
        vec![
            fewer_rollers((PI / half).ceil() - 1.0),
            Remedy::new("cage.pocket_clearance_um", less_than(closest, "µm")).value("0", ""),
            Remedy::new(ROLLER, less_than(2.0 * (largest - clearance), "mm")),
            Remedy::new(
                "cage.outer_diameter_mm",
                format!("nearer to {} mm", number(pitch + cage.thickness_mm)),
            ),
            Remedy::new("cage.thickness_mm", "a thinner cage"),
            Remedy::new(OUTER_RACE, "a larger pitch circle"),
            Remedy::new(INNER_RACE, "a larger pitch circle"),
            without_cage(),
        ],
    ))
}

/// Pockets that do not reach through the cage.
fn pockets_miss(cage: &CageScene, roller: f64, pitch: f64) -> Finding {
    let (outer, inner) = diameters(cage);
    let pocket = roller + 2e-3 * cage.pocket_clearance_um;
    let message = format!(
        "the pockets, {} mm wide on the pitch circle of diameter {} mm, do not cut through the cage, whose \
         diameters are {} and {} mm",
        number(pocket),
        number(pitch),
        number(inner),
        number(outer)
    );
    // Both surfaces of the cage lie less than a pocket's radius from the pitch circle.
    let needed = (outer - pitch).abs().max((pitch - inner).abs());
    let (low, high) = (pitch - pocket + 2.0 * cage.thickness_mm, pitch + pocket);
    let diameter = if low < high {
        format!("more than {} and less than {} mm", lower(low), upper(high))
    } else {
        NOTHING.to_owned()
    };
    let thickness = (outer - pitch + pocket) / 2.0;
    let reached = outer < high;
    let clearance = (needed - roller) * 500.0;
    Finding::new(
        message,
        vec![
            Remedy::new("cage.outer_diameter_mm", diameter),
            Remedy::new(
                "cage.thickness_mm",
                if reached { less_than(thickness, "mm") } else { NOTHING.to_owned() },
            ),
            Remedy::new("cage.pocket_clearance_um", more_than(clearance, "µm")),
            Remedy::new(ROLLER, more_than(needed - 2e-3 * cage.pocket_clearance_um, "mm")),
            Remedy::new(OUTER_RACE, "a pitch circle inside the cage"),
            Remedy::new(INNER_RACE, "a pitch circle inside the cage"),
            without_cage(),
        ],
    )
}

/// An offset in its pocket for every roller, or for none.
pub(super) fn places(scene: &Scene) -> Option<Finding> {
    const OFFSETS: &str = "cage.roller_offsets_um";
    let cage = scene.cage.as_ref()?;
    let (offsets, rollers, clearance) =
        (&cage.roller_offsets_um, scene.bearing.rollers, cage.pocket_clearance_um);
    if offsets.is_empty() {
        return None;
    }
    if offsets.len() != rollers {
        let message = format!("`{OFFSETS}` has {} numbers for {rollers} rollers", offsets.len());
        let allowed = format!("{rollers} numbers, one for each roller, or `[]`");
        let remedy = Remedy::new(OFFSETS, allowed).value("[]", "every roller in the middle of its pocket");
        return Some(Finding::new(message, vec![remedy]));
    }
    let farthest = |a: &usize, b: &usize| offsets[*a].abs().total_cmp(&offsets[*b].abs());
    let worst = (0..rollers).max_by(farthest).filter(|&i| offsets[i].abs() > clearance)?;
    let path = format!("{OFFSETS}[{worst}]");
    let message = format!(
        "`{path}` is {}: roller {} would start in the wall of its pocket, which leaves it {} µm to either \
         side",
        number(offsets[worst]),
        worst + 1,
        number(clearance)
    );
    Some(Finding::new(
        message,
        vec![
            Remedy::new(path, format!("{} to {} µm", number(-clearance), number(clearance))),
            Remedy::new("cage.pocket_clearance_um", format!("at least {} µm", lower(offsets[worst].abs()))),
            Remedy::new(OFFSETS, "smaller ones").value("[]", "every roller in the middle of its pocket"),
        ],
    ))
}

/// Largest x in 0 … `high` with `fits(x)`, which turns false once; by bisection, from below.
fn largest(high: f64, fits: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, high);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Largest half angle [rad] that a pocket cuts out of the ring between two radii; `None` when it misses a
/// surface.
fn widest_pocket(inner: f64, outer: f64, pitch_radius: f64, pocket: f64) -> Option<f64> {
    let half_angle = |r: f64| {
        let cosine = (r * r + pitch_radius * pitch_radius - pocket * pocket) / (2.0 * r * pitch_radius);
        (cosine < 1.0).then(|| cosine.max(-1.0).acos())
    };
    // Seen from the bearing's centre a pocket is widest where the ray touches it.
    let tangent = (pitch_radius * pitch_radius - pocket * pocket).max(0.0).sqrt();
    let at_edges = half_angle(inner)?.max(half_angle(outer)?);
    let touched = if (inner..=outer).contains(&tangent) { half_angle(tangent).unwrap_or(0.0) } else { 0.0 };
    Some(at_edges.max(touched))
}
