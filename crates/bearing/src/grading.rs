//! How coarse the bodies become where nothing rolls.

use stribeck_mesh::{Circle, Grading, Surface};

use crate::scene::MeshScene;

/// Side of the squares inside a graded roller, in facets of its rim. With longer ones the triangles between rim and
/// core become needles, and nothing is left to save: most elements of a roller lie along its rim.
const CORE_FACETS: f64 = 3.0;

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

/// Facets of a raceway of this circumference [m] in elements of `size` [m], as many as its grading can divide.
pub(crate) fn facets(circumference: f64, size: f64, grading: Option<&Grading>) -> usize {
    let ratio = grading.map_or(1, Grading::ratio);
    ((circumference / (size * ratio as f64)).round() as usize).max(8) * ratio
}

/// Side of the squares inside a roller [mm].
pub(crate) fn roller_core_mm(mesh: &MeshScene, facet_mm: f64) -> f64 {
    match &mesh.grading {
        None => mesh.size_mm,
        Some(grading) => grading.coarse_mm.min(CORE_FACETS * facet_mm),
    }
}

/// Abscissae [m] at which the columns of the adapter meet: those of the nodes of the ring in its seat, so that the two
/// surfaces fit node to node, however long their facets are. No column becomes narrower than `narrowest` [m].
pub(crate) fn seat_lines(back: &Surface, x: &[f64], y: &[f64], half_width: f64, narrowest: f64) -> Vec<f64> {
    let nodes = back.nodes.iter().map(|&n| n as usize);
    let mut above: Vec<f64> = nodes.filter(|&n| y[n] > 0.0).map(|n| x[n]).collect();
    above.sort_by(f64::total_cmp);
    // From the crown to both sides: nodes come closer together there, as seen from above.
    let crown = above.partition_point(|&x| x < 0.0);
    let (left, right) = above.split_at(crown);
    let room = half_width - narrowest;
    let mut lines: Vec<f64> = Vec::with_capacity(above.len());
    for &x in right.iter().filter(|&&x| x <= room) {
        if lines.last().is_none_or(|last| x - last >= narrowest) {
            lines.push(x);
        }
    }
    lines.reverse();
    for &x in left.iter().rev().filter(|&&x| -x <= room) {
        if lines.last().is_none_or(|last| last - x >= narrowest) {
            lines.push(x);
        }
    }
    lines.reverse();
    lines
}
