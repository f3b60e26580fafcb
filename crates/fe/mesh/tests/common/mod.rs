//! Plane geometry that the tests of several shapes share.
#![allow(dead_code, reason = "each test file uses its own part of it")]

use stribeck_mesh::{Part, Surface, characteristic_length};

/// Poisson's ratio of steel, used wherever a characteristic length is compared.
pub(crate) const POISSON: f64 = 0.3;

/// Rounding of coordinates [relative]: a few operations in 64-bit floats.
pub(crate) const ROUNDING: f64 = 1e-13;

pub(crate) fn point(part: &Part, node: u32) -> [f64; 2] {
    [part.x[node as usize], part.y[node as usize]]
}

pub(crate) fn corners(part: &Part) -> impl Iterator<Item = Vec<[f64; 2]>> + '_ {
    let quads = part.quads.iter().map(|q| q.map(|n| point(part, n)).to_vec());
    quads.chain(part.triangles.iter().map(|t| t.map(|n| point(part, n)).to_vec()))
}

/// Twice the smallest area spanned by two neighbouring edges of any element [m²].
pub(crate) fn smallest_jacobian(part: &Part) -> f64 {
    let mut smallest = f64::INFINITY;
    for c in corners(part) {
        let n = c.len();
        for i in 0..n {
            let (a, b, d) = (c[i], c[(i + 1) % n], c[(i + n - 1) % n]);
            let jacobian = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
            smallest = smallest.min(jacobian);
        }
    }
    smallest
}

/// Area to the left of a closed polyline [m²], by the shoelace formula.
pub(crate) fn area_on_the_left(part: &Part, nodes: &[u32]) -> f64 {
    let mut area = 0.0;
    for i in 0..nodes.len() {
        let ([x1, y1], [x2, y2]) = (point(part, nodes[i]), point(part, nodes[(i + 1) % nodes.len()]));
        area += 0.5 * (x1 * y2 - x2 * y1);
    }
    area
}

pub(crate) fn surface<'a>(part: &'a Part, name: &str) -> &'a Surface {
    part.surface(name).unwrap_or_else(|| panic!("no surface {name}"))
}

/// Edges that belong to one element only, directed so that the element is on their left.
pub(crate) fn boundary_edges(part: &Part) -> Vec<[u32; 2]> {
    let mut edges = std::collections::BTreeSet::new();
    let quads = part.quads.iter().flat_map(|q| (0..4).map(|i| [q[i], q[(i + 1) % 4]]));
    let triangles = part.triangles.iter().flat_map(|t| (0..3).map(|i| [t[i], t[(i + 1) % 3]]));
    for edge in quads.chain(triangles) {
        assert!(edges.insert(edge), "edge {edge:?} is walked twice in the same direction");
    }
    edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a])).copied().collect()
}

/// The facets of the named surfaces must be exactly the boundary edges: no gap, none twice, solid on the
/// left.
pub(crate) fn assert_boundary_is(part: &Part, names: &[&str]) {
    let mut facets: Vec<[u32; 2]> = Vec::new();
    for name in names {
        let surface = surface(part, name);
        facets.extend((0..surface.facets()).map(|i| surface.facet(i)));
    }
    facets.sort_unstable();
    assert_eq!(facets, boundary_edges(part), "surfaces {names:?} are not the boundary");
}

/// Smallest characteristic length of the part over that of a square of the given side.
pub(crate) fn relative_length(part: &Part, side: f64) -> f64 {
    let square = side * (1.0 - POISSON).sqrt();
    let lengths = corners(part).map(|c| characteristic_length(&c, POISSON));
    lengths.fold(f64::INFINITY, f64::min) / square
}
