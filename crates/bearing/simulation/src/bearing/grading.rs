//! Grading: element sizes away from the rolling contacts.

use stribeck_mesh::{Circle, Grading};

use stribeck_scene::scene::{GradingScene, MeshScene};

/// A quotient of lengths that is meant to be whole may fall short of it by rounding.
const ROUNDING: f64 = 1e-9;

/// Layers of elements of the size asked for in a ring.
pub(crate) fn layers(mesh: &MeshScene, thickness_mm: f64) -> usize {
    ((1e-3 * thickness_mm / (1e-3 * mesh.size_mm)).round() as usize).max(1)
}

/// How a ring is graded: as often as `coarse_mm` and its thickness allow. `None` for elements of one size.
pub(crate) fn ring(mesh: &MeshScene, thickness_mm: f64, fine: Circle) -> Option<Grading> {
    let scene = mesh.grading.as_ref()?;
    let with = |transitions| Grading { fine, fine_layers: scene.fine_layers, transitions };
    let fits = |grading: &Grading| {
        let edge = mesh.size_mm * grading.ratio() as f64;
        grading.layers_needed() <= layers(mesh, thickness_mm) && edge <= scene.coarse_mm * (1.0 + ROUNDING)
    };
    (1..=Grading::MOST_TRANSITIONS).map(with).take_while(fits).last()
}

/// Side of the squares inside a roller [mm].
pub(crate) fn roller_core_mm(mesh: &MeshScene, facet_mm: f64) -> f64 {
    match &mesh.grading {
        None => mesh.size_mm,
        Some(grading) => grading.roller_core_mm(facet_mm),
    }
}

/// Polar layers of a graded roller: as many as a raceway has rows of full fineness, the last of which begins
/// its transition. With one fewer the pattern of the core shows at the rim: the tone is off by up to 9
/// % instead of 5 %.
pub(crate) fn roller_layers(grading: &GradingScene) -> usize {
    grading.fine_layers + 1
}

/// Nodes [m] of the adapter's seat from left to right: those of the ring that sits in it, so that the two
/// surfaces fit facet to facet, however long their facets are. Where both are `round`, facets standing for arcs, so are
/// its two ends; else they continue the facets of the ring. No column becomes narrower than `narrowest` [m]; a node of
/// the ring that would need it gets none.
pub(crate) fn seat(back: &[[f64; 2]], half_width: f64, narrowest: f64, round: bool) -> Vec<[f64; 2]> {
    let mut above: Vec<[f64; 2]> = back.iter().copied().filter(|p| p[1] > 0.0).collect();
    above.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let crown = above.partition_point(|p| p[0] < 0.0);
    let (left, right) = above.split_at(crown);
    // Both halves from the crown to their sides; the left one is mirrored for that.
    let left: Vec<[f64; 2]> = left.iter().rev().map(|[x, y]| [-x, *y]).collect();
    let mut seat: Vec<[f64; 2]> =
        half_seat(&left, half_width, narrowest, round).into_iter().rev().map(|[x, y]| [-x, y]).collect();
    let room = seat.last().map_or(0.0, |last| last[0] + narrowest);
    let right: Vec<[f64; 2]> = right.iter().copied().skip_while(|p| p[0] < room).collect();
    seat.extend(half_seat(&right, half_width, narrowest, round));
    seat
}

/// The part of the seat on the right of its crown, ending at the side of the adapter.
fn half_seat(ring: &[[f64; 2]], half_width: f64, narrowest: f64, round: bool) -> Vec<[f64; 2]> {
    let mut seat: Vec<[f64; 2]> = Vec::with_capacity(ring.len() + 1);
    for node in ring.iter().filter(|node| node[0] <= half_width - narrowest) {
        if seat.last().is_none_or(|last| node[0] - last[0] >= narrowest) {
            seat.push(*node);
        }
    }
    // A vertex of the ring inside the last chord would press on it: the chord runs through that vertex
    // instead, a few micrometres above the circle at its end.
    let next = seat.last().and_then(|last| ring.iter().find(|node| node[0] > last[0]));
    let end = match (seat.last(), next) {
        (Some(last), Some(next)) if !round => {
            last[1] + (next[1] - last[1]) * (half_width - last[0]) / (next[0] - last[0])
        }
        _ => ring
            .first()
            .map_or(0.0, |node| (node[0] * node[0] + node[1] * node[1] - half_width * half_width).sqrt()),
    };
    seat.push([half_width, end]);
    seat
}
