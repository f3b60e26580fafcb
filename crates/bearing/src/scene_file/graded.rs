//! Graded meshes that cannot be: coarse elements finer than the fine ones, facets that three do not divide.

use stribeck_mesh::Circle;

use super::geometry::finding;
use super::limits::number;
use super::origin::Finding;
use crate::grading::ring;
use crate::scene::Scene;

/// What is wrong with `mesh.grading`.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let (b, mesh) = (&scene.bearing, &scene.mesh);
    let Some(grading) = &mesh.grading else { return Vec::new() };
    let mut found = Vec::new();
    if grading.coarse_mm < mesh.size_mm {
        let fields = ["mesh.grading.coarse_mm", "mesh.size_mm"];
        let (coarse, size) = (number(grading.coarse_mm), number(mesh.size_mm));
        let message = format!("`mesh.grading.coarse_mm` is {coarse}, finer than `mesh.size_mm` ({size} mm)");
        let suggestion = format!("{} makes three facets one", number(3.0 * mesh.size_mm));
        found.push(finding(&fields, message, format!("{size} mm or more"), suggestion));
    }
    let rings = [
        ("mesh.outer_facets", mesh.outer_facets, b.outer_ring_thickness_mm, Circle::Inner),
        ("mesh.inner_facets", mesh.inner_facets, b.inner_ring_thickness_mm, Circle::Outer),
    ];
    for (field, facets, thickness_mm, fine) in rings {
        let (Some(facets), Some(grading)) = (facets, ring(mesh, thickness_mm, fine)) else { continue };
        let ratio = grading.ratio();
        if facets.is_multiple_of(ratio) {
            continue;
        }
        let message = format!("`{field}` is {facets}, but the grading makes one facet of {ratio}");
        let fields = [field, "mesh.grading.coarse_mm"];
        let suggestion = format!("`{field}: {}`, or `{field}: None`", (facets + ratio / 2) / ratio * ratio);
        found.push(finding(&fields, message, format!("a multiple of {ratio}"), suggestion));
    }
    found
}
