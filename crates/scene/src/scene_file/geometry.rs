//! Bodies that cannot exist: rollers that overlap the rings or each other, a cage outside its gap, a defect
//! deeper than the ring. Each relation names for every field in it the values allowed while the others stay.

mod bounds;
mod cage;
mod defect;
mod housing;

use std::f64::consts::PI;

use super::named::length_in;
use crate::field::wording::{number, round_down};
use crate::reading::finding::{Finding, Remedy};
use crate::scene::Scene;
use bounds::{at_most, between, less_than, lower, more_than};
use cage::{cage, places, pockets};
pub(super) use defect::MAX_DEFECT_DEPTH_RATIO;
use defect::{defect_depth, defect_edges, defect_length};
use housing::{adapter, pedestal};

const OUTER_RACE: &str = "bearing.outer_race_diameter_mm";
const OUTER_RING: &str = "bearing.outer_ring_thickness_mm";
const INNER_RACE: &str = "bearing.inner_race_diameter_mm";
const INNER_RING: &str = "bearing.inner_ring_thickness_mm";
const ROLLERS: &str = "bearing.rollers";
const ROLLER: &str = "bearing.roller_diameter_mm";

/// A wider gap than this part of a roller is a mistake in a diameter, not a clearance.
const MAX_CLEARANCE_RATIO: f64 = 0.1;

/// Rollers that are pressed in by more than this part of their diameter are a mistake, too: they would yield.
const MAX_PRELOAD_RATIO: f64 = 0.005;

/// Every impossibility of a scene whose numbers are in range.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let groups = [
        rings,
        described_twice,
        clearance_change,
        bore,
        pitch_circle,
        cage,
        pockets,
        places,
        adapter,
        pedestal,
        defect_length,
        defect_edges,
        defect_depth,
    ];
    groups.iter().filter_map(|group| group(scene)).collect()
}

/// Rollers between raceways.
fn rings(scene: &Scene) -> Option<Finding> {
    let b = &scene.bearing;
    let (outer, inner, roller) = (b.outer_race_diameter_mm, b.inner_race_diameter_mm, b.roller_diameter_mm);
    let clearance = outer - inner - 2.0 * roller;
    let sum = format!(
        "outer raceway {} − inner raceway {} − 2 × roller {} = {} mm",
        number(outer),
        number(inner),
        number(roller),
        number(clearance)
    );
    // Sums of decimal fractions have rounding errors; less than a nanometre is not worth a message.
    let message = if clearance < -1e-6 {
        format!("the rollers do not fit between the rings, the bodies overlap: {sum}")
    } else if clearance > MAX_CLEARANCE_RATIO * roller {
        format!(
            "the gap between rollers and rings is too wide: {sum}, more than {} % of the roller",
            100.0 * MAX_CLEARANCE_RATIO
        )
    } else {
        return None;
    };
    let most = 2.0 + MAX_CLEARANCE_RATIO;
    let gap = outer - inner;
    Some(Finding::new(
        message,
        vec![
            Remedy::new(ROLLER, between(gap / most, gap / 2.0)),
            Remedy::new(INNER_RACE, between(outer - most * roller, outer - 2.0 * roller)),
            Remedy::new(OUTER_RACE, between(inner + 2.0 * roller, inner + most * roller)),
        ],
    ))
}

/// Pitch, bore, outside diameter and width that a bearing has beside its other dimensions, as one that was
/// named or built in memory, must be those that follow from them.
fn described_twice(scene: &Scene) -> Option<Finding> {
    let b = &scene.bearing;
    let pitch = 0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm);
    let all = [
        ("pitch_mm", b.pitch_mm, pitch),
        ("bore_mm", b.bore_mm, b.inner_race_diameter_mm - 2.0 * b.inner_ring_thickness_mm),
        ("outside_mm", b.outside_mm, b.outer_race_diameter_mm + 2.0 * b.outer_ring_thickness_mm),
        ("width_mm", b.width_mm, b.thickness_mm / length_in(1.0, scene.element())),
    ];
    let differs =
        |(_, given, is): &(_, Option<f64>, f64)| given.is_some_and(|mm| (mm - is).abs() > 0.01 * pitch);
    let (name, given, is) = all.into_iter().find(differs)?;
    let field = format!("bearing.{name}");
    let message = format!(
        "`{field}` is {}, and the other dimensions of this bearing make it {}",
        number(given.unwrap_or(is)),
        number(round_down(is, 5))
    );
    let remedy = Remedy::new(field, "nothing beside a complete bearing");
    Some(Finding::new(message, vec![remedy]))
}

/// A clearance that fits and temperature leave.
fn clearance_change(scene: &Scene) -> Option<Finding> {
    const CHANGE: &str = "bearing.clearance_change_um";
    let b = &scene.bearing;
    let by_diameters = b.outer_race_diameter_mm - b.inner_race_diameter_mm - 2.0 * b.roller_diameter_mm;
    let clearance = by_diameters + 1e-3 * b.clearance_change_um;
    let (least, most) =
        (-MAX_PRELOAD_RATIO * b.roller_diameter_mm, MAX_CLEARANCE_RATIO * b.roller_diameter_mm);
    // Diameters that do not fit each other are found by themselves.
    if b.clearance_change_um == 0.0 || (least..=most).contains(&clearance) {
        return None;
    }
    let message = format!(
        "`{CHANGE}` is {}, which leaves a clearance of {:.0} µm: between {:.0} µm ({} % of the roller's \
         diameter) and {:.0} µm ({} %) is expected of fits and temperature",
        number(b.clearance_change_um),
        1e3 * clearance,
        1e3 * least,
        -100.0 * MAX_PRELOAD_RATIO,
        1e3 * most,
        100.0 * MAX_CLEARANCE_RATIO,
    );
    let [low, high] = [least, most].map(|limit| number((1e3 * (limit - by_diameters)).trunc()));
    Some(Finding::new(
        message,
        vec![Remedy::new(CHANGE, format!("{low} to {high} µm")).value("0", "as the diameters say")],
    ))
}

/// A bore within the inner ring.
fn bore(scene: &Scene) -> Option<Finding> {
    let (thickness, diameter) = (scene.bearing.inner_ring_thickness_mm, scene.bearing.inner_race_diameter_mm);
    if 2.0 * thickness < diameter {
        return None;
    }
    let message = format!(
        "an inner ring {} mm thick has no bore: its raceway's diameter is {} mm",
        number(thickness),
        number(diameter)
    );
    Some(Finding::new(
        message,
        vec![
            Remedy::new(INNER_RING, less_than(diameter / 2.0, "mm")),
            Remedy::new(INNER_RACE, more_than(2.0 * thickness, "mm")),
        ],
    ))
}

/// Rollers beside each other on the pitch circle.
fn pitch_circle(scene: &Scene) -> Option<Finding> {
    let b = &scene.bearing;
    let pitch = (b.outer_race_diameter_mm + b.inner_race_diameter_mm) / 2.0;
    let roller = b.roller_diameter_mm;
    let most = if roller < pitch { (PI / (roller / pitch).asin() + 1e-9).floor() } else { 1.0 };
    if b.rollers as f64 <= most {
        return None;
    }
    let message = format!(
        "{} rollers of {} mm do not fit on the pitch circle of diameter {} mm",
        number(b.rollers as f64),
        number(roller),
        number(pitch)
    );
    let chord = (PI / b.rollers as f64).sin();
    let needed = 2.0 * roller / chord;
    Some(Finding::new(
        message,
        vec![
            fewer_rollers(most),
            Remedy::new(ROLLER, at_most(pitch * chord, "mm")),
            Remedy::new(OUTER_RACE, format!("at least {} mm", lower(needed - b.inner_race_diameter_mm))),
            Remedy::new(INNER_RACE, format!("at least {} mm", lower(needed - b.outer_race_diameter_mm))),
        ],
    ))
}

fn fewer_rollers(most: f64) -> Remedy {
    Remedy::new(ROLLERS, at_most(most, "rollers"))
}
