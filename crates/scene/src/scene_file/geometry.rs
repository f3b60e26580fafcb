//! Bodies that cannot exist: rollers that overlap the rings or each other, a cage outside its gap, a defect
//! deeper than the ring. Each relation says for every field in it what the field may be while the others
//! stay.

use std::f64::consts::PI;

use super::finding::{Finding, Remedy};
use super::named::{OFF_RACE, ROLLER_LENGTH};
use super::wording::{number, round_down, round_up};
use crate::housing::HousingScene;
use crate::resolved::CageGeometry;
use crate::scene::{CageScene, DefectRing, PocketWalls, Scene};

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
/// The clearance that is proposed, as a part of a roller: about that of the paper's bearing.
const USUAL_CLEARANCE_RATIO: f64 = 0.002;
/// Below the floor of a defect this part of the ring must be left to carry the load.
pub(super) const MAX_DEFECT_DEPTH_RATIO: f64 = 0.6;
/// Widest edge of a defect in facets, each edge being one, and as a part of the defect's length
/// (`stribeck_mesh::Groove`).
const WIDEST_WALL: f64 = 2.0;
const WALL_OF_LENGTH: f64 = 0.4;
/// Width of the paper's adapter over the outside diameter of its outer ring.
const ADAPTER_RATIO: f64 = 0.727;
/// Thinnest wall of a pedestal, as a part of the ring's outside radius.
const LEAST_PEDESTAL: f64 = 0.02;
/// How many roller counts below the limit are tried: a cage allows fewer than the pitch circle alone.
const FEWER_ROLLERS: usize = 8;

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

/// Digits of the ends of a range, and what rounding has left of them.
const DIGITS: i32 = 5;
const DUST: f64 = 1e-12;

/// The lower end of a range: a number within it.
fn lower(end: f64) -> String {
    number(round_up(end * (1.0 - DUST), DIGITS))
}

/// The upper end of one.
fn upper(end: f64) -> String {
    number(round_down(end * (1.0 + DUST), DIGITS))
}

/// `17.1 to 18 mm`, or a word where no value is left.
fn between(low: f64, high: f64) -> String {
    if high <= low || high <= 0.0 {
        return NOTHING.to_owned();
    }
    format!("{} to {} mm", lower(low.max(0.0)), upper(high))
}

fn more_than(low: f64, unit: &str) -> String {
    format!("more than {} {unit}", lower(low))
}

fn less_than(high: f64, unit: &str) -> String {
    if high <= 0.0 { NOTHING.to_owned() } else { format!("less than {} {unit}", upper(high)) }
}

fn at_most(high: f64, unit: &str) -> String {
    if high <= 0.0 { NOTHING.to_owned() } else { format!("at most {} {unit}", upper(high)) }
}

/// What a field may be when it cannot mend matters by itself.
const NOTHING: &str = "no value while the other dimensions stay";

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
    // Sums of decimal fractions leave rounding dust; a nanometre is none of the user's business.
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
    let (usual, most) = (2.0 + USUAL_CLEARANCE_RATIO, 2.0 + MAX_CLEARANCE_RATIO);
    let gap = outer - inner;
    let note = "a small clearance";
    Some(Finding::new(
        message,
        vec![
            Remedy::new(ROLLER, between(gap / most, gap / 2.0))
                .number(round_down(gap / usual, 4), note)
                .number(gap / 2.0, "no clearance"),
            Remedy::new(INNER_RACE, between(outer - most * roller, outer - 2.0 * roller))
                .number(round_down(outer - usual * roller, 5), note)
                .number(outer - 2.0 * roller, "no clearance"),
            Remedy::new(OUTER_RACE, between(inner + 2.0 * roller, inner + most * roller))
                .number(round_up(inner + usual * roller, 5), note)
                .number(inner + 2.0 * roller, "no clearance"),
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
        ("width_mm", b.width_mm, b.thickness_mm / ROLLER_LENGTH),
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
    let remedy = Remedy::new(field, "nothing beside a complete bearing").number(round_down(is, 5), "");
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
         diameter) and {:.0} µm ({} %) is \
         expected of fits and temperature",
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
        vec![Remedy::new(CHANGE, format!("{low} to {high} µm")).number(0.0, "as the diameters say")],
    ))
}

/// Something left inside the inner ring.
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
            Remedy::new(INNER_RING, less_than(diameter / 2.0, "mm")).number(round_up(diameter / 17.0, 2), ""),
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
            Remedy::new(ROLLER, at_most(pitch * chord, "mm")).number(round_down(pitch * chord, 3), ""),
            Remedy::new(OUTER_RACE, format!("at least {} mm", lower(needed - b.inner_race_diameter_mm))),
            Remedy::new(INNER_RACE, format!("at least {} mm", lower(needed - b.outer_race_diameter_mm))),
        ],
    ))
}

fn fewer_rollers(most: f64) -> Remedy {
    let remedy = Remedy::new(ROLLERS, at_most(most, "rollers"));
    (0..FEWER_ROLLERS).map(|less| most - less as f64).fold(remedy, |remedy, count| remedy.number(count, ""))
}

/// The cage inside the gap between the rings.
fn cage(scene: &Scene) -> Option<Finding> {
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
    let centred = (outer_race + inner_race) / 2.0 + cage.thickness_mm;
    let held = held_mm(scene, cage);
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
            Remedy::new("cage.outer_diameter_mm", diameter)
                .number(held, "where its pockets hold it")
                .number(round_down(centred, 4), ""),
            Remedy::new(
                "cage.thickness_mm",
                if_only(room_outside, less_than((outer - inner_race) / 2.0, "mm")),
            )
            .number(round_down((outer - inner_race) / 8.0, 2), "")
            .number(round_down((outer - inner_race) / 4.0, 2), ""),
            Remedy::new(OUTER_RACE, if_only(room_inside, more_than(outer, "mm"))),
            Remedy::new(INNER_RACE, if_only(room_outside, less_than(inner, "mm"))),
            without_cage(),
        ],
    ))
}

/// Outer diameter of a cage of this thickness whose corners touch rollers above their middles [mm], as those
/// of the catalogue; not a number where it would not lie between the raceways, or has straight pockets.
fn held_mm(scene: &Scene, cage: &CageScene) -> f64 {
    let b = &scene.bearing;
    let outer = b.outer_race_diameter_mm - OFF_RACE * b.roller_diameter_mm;
    let above = outer - 2.0 * cage.thickness_mm > 0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm);
    if cage.pocket == PocketWalls::Corners && above { round_down(outer, 4) } else { f64::NAN }
}

/// Outer and inner diameter [mm].
fn diameters(cage: &CageScene) -> (f64, f64) {
    (cage.outer_diameter_mm, cage.outer_diameter_mm - 2.0 * cage.thickness_mm)
}

fn without_cage() -> Remedy {
    Remedy::new("cage", "`None` for rollers without a cage").value("None", "rollers without a cage")
}

/// Pockets that cut through the cage, and leave something of it between two of them.
fn pockets(scene: &Scene) -> Option<Finding> {
    // What is wrong with the cage's or the rollers' place would only be said again.
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
            Remedy::new("cage.pocket_clearance_um", less_than(closest, "µm"))
                .number(round_down(closest / 2.0, 2), "")
                .value("0", ""),
            Remedy::new(ROLLER, less_than(2.0 * (largest - clearance), "mm")),
            Remedy::new(
                "cage.outer_diameter_mm",
                format!("nearer to {} mm", number(pitch + cage.thickness_mm)),
            )
            .number(round_down(pitch + cage.thickness_mm, 4), "centred on the pockets"),
            Remedy::new("cage.thickness_mm", "a thinner cage").number(cage.thickness_mm / 2.0, ""),
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
         diameters \
         are {} and {} mm",
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
            Remedy::new("cage.outer_diameter_mm", diameter)
                .number(round_down(pitch + cage.thickness_mm, 4), "centred on the pockets"),
            Remedy::new(
                "cage.thickness_mm",
                if reached { less_than(thickness, "mm") } else { NOTHING.to_owned() },
            )
            .number(round_down(thickness / 2.0, 2), ""),
            Remedy::new("cage.pocket_clearance_um", more_than(clearance, "µm"))
                .number(round_up(1.01 * clearance, 3), ""),
            Remedy::new(ROLLER, more_than(needed - 2e-3 * cage.pocket_clearance_um, "mm")),
            Remedy::new(OUTER_RACE, "a pitch circle inside the cage"),
            Remedy::new(INNER_RACE, "a pitch circle inside the cage"),
            without_cage(),
        ],
    )
}

/// A place in its pocket for every roller, or for none.
fn places(scene: &Scene) -> Option<Finding> {
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
            Remedy::new(path, format!("{} to {} µm", number(-clearance), number(clearance)))
                .number(clearance.copysign(offsets[worst]), "at the wall"),
            Remedy::new("cage.pocket_clearance_um", format!("at least {} µm", lower(offsets[worst].abs())))
                .number(offsets[worst].abs(), ""),
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

/// The seat wraps part of the outer ring, never all of its width.
fn adapter(scene: &Scene) -> Option<Finding> {
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
            Remedy::new("adapter.width_mm", less_than(outside, "mm, the outside diameter of the outer ring"))
                .number(round_down(ADAPTER_RATIO * outside, 3), "as in the paper's proportions"),
            Remedy::new(OUTER_RACE, more_than(width - 2.0 * b.outer_ring_thickness_mm, "mm")),
            Remedy::new(OUTER_RING, more_than(ring, "mm")).number(round_up(1.01 * ring, 2), ""),
        ],
    ))
}

/// Material around the bore of a pedestal.
fn pedestal(scene: &Scene) -> Option<Finding> {
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
    let wide = round_up(halves * 0.7 * outside, 2);
    Some(Finding::new(
        message,
        vec![
            Remedy::new(field, more_than(round_up(halves * least, 3), "mm"))
                .number(wide, "a fifth of the ring around it"),
        ],
    ))
}

/// The spall is no longer than half of the raceway.
fn defect_length(scene: &Scene) -> Option<Finding> {
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
    let spacing = around / b.rollers as f64;
    Some(Finding::new(
        message,
        vec![
            Remedy::new(
                "defect.length_mm",
                at_most(around / 2.0, &format!("mm, half of the {name} raceway")),
            )
            .number(
                round_down(spacing / 2.0, 2),
                "less than the distance of two rollers, to see single impacts",
            ),
            Remedy::new(field, format!("at least {} mm", lower(2.0 * length / PI))),
        ],
    ))
}

/// Walls of the spall are single facets, and leave a floor.
fn defect_edges(scene: &Scene) -> Option<Finding> {
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
            Remedy::new(SLOPE, format!("at least {}°", lower(steep))).number(steep, ""),
            Remedy::new("defect.depth_mm", at_most(shallow, "mm")).number(shallow, ""),
        ],
    ))
}

/// The spall leaves some of the ring below it.
fn defect_depth(scene: &Scene) -> Option<Finding> {
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
            Remedy::new("defect.depth_mm", at_most(deepest, "mm, 60 % of the ring's thickness"))
                .number(round_down(ring / 50.0, 2), ""),
            Remedy::new(field, format!("at least {} mm", lower(thinnest))).number(round_up(thinnest, 2), ""),
        ],
    ))
}
