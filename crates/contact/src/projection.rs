//! Closest-point projection of a point onto a polyline, and the signed gap (THEORY §4.1).

use crate::surface::Surface;

/// Where a point projects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Gap [m]. Positive when apart, negative when penetrating: the signed distance to the polyline.
    pub gap: f64,
    /// Gradient of the gap with respect to the point: the outward unit normal of the primary surface.
    pub normal: [f64; 2],
    /// Facet of the primary surface.
    pub facet: usize,
    /// Place on the facet, 0 at its first node, 1 at its second.
    pub place: f64,
}

/// A projection whose place lies this close to an end is compared with the neighbouring facet.
const NEAR_END: f64 = 0.1;

/// Walks at most this many facets from the starting one.
const LONGEST_WALK: usize = 8;

/// Projects `p` onto `surface`, starting the walk at `facet`. `None` beyond the ends of an open surface.
#[inline]
pub fn project(surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2], facet: usize) -> Option<Projection> {
    let mut best = on_facet(surface, x, y, p, facet);
    for _ in 0..LONGEST_WALK {
        let at = best.facet;
        if best.inside && best.place > NEAR_END && best.place < 1.0 - NEAR_END && !surface.meets_corner(at) {
            break;
        }
        for forward in [false, true] {
            if let Some(next) = surface.neighbour(at, forward) {
                let other = on_facet(surface, x, y, p, next);
                // A foot inside a facet wins a tie against the vertex that both share.
                if other.distance < best.distance
                    || (other.distance == best.distance && other.inside && !best.inside)
                {
                    best = other;
                }
            }
        }
        if best.facet == at {
            break;
        }
    }
    if best.inside {
        let Foot { distance: _, gap, normal, facet, place, .. } = best;
        return Some(Projection { gap, normal, facet, place });
    }
    at_vertex(surface, x, y, p, &best)
}

/// The nearest point of one facet.
#[derive(Debug, Clone, Copy)]
struct Foot {
    facet: usize,
    place: f64,
    /// Unsigned distance [m].
    distance: f64,
    /// Signed distance from the facet's line [m].
    gap: f64,
    normal: [f64; 2],
    /// False when the nearest point is an end.
    inside: bool,
}

#[inline(always)]
fn on_facet(surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2], facet: usize) -> Foot {
    let (a, b) = surface.ends(facet);
    let (tx, ty) = (x[b] - x[a], y[b] - y[a]);
    let (rx, ry) = (p[0] - x[a], p[1] - y[a]);
    let squared = tx * tx + ty * ty;
    let place = (rx * tx + ry * ty) / squared;
    let inverse = 1.0 / squared.sqrt();
    let normal = [ty * inverse, -tx * inverse];
    let gap = rx * normal[0] + ry * normal[1];
    if (0.0..=1.0).contains(&place) {
        return Foot { facet, place, distance: gap.abs(), gap, normal, inside: true };
    }
    let place = if place < 0.0 { 0.0 } else { 1.0 };
    let (dx, dy) = (rx - place * tx, ry - place * ty);
    Foot { facet, place, distance: (dx * dx + dy * dy).sqrt(), gap, normal, inside: false }
}

/// The nearest point is a vertex: the gap is the distance to it, its sign that of the normals around it.
fn at_vertex(surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2], foot: &Foot) -> Option<Projection> {
    let forward = foot.place == 1.0;
    let other = surface.neighbour(foot.facet, forward)?;
    let second = on_facet(surface, x, y, p, other);
    let (a, b) = surface.ends(foot.facet);
    let vertex = if forward { b } else { a };
    let r = [p[0] - x[vertex], p[1] - y[vertex]];
    let mean = [foot.normal[0] + second.normal[0], foot.normal[1] + second.normal[1]];
    let sign = if r[0] * mean[0] + r[1] * mean[1] < 0.0 { -1.0 } else { 1.0 };
    let normal = if foot.distance > 0.0 {
        [sign * r[0] / foot.distance, sign * r[1] / foot.distance]
    } else {
        foot.normal
    };
    Some(Projection { gap: sign * foot.distance, normal, facet: foot.facet, place: foot.place })
}

/// Distance from a point to one facet [m].
pub(crate) fn distance(surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2], facet: usize) -> f64 {
    on_facet(surface, x, y, p, facet).distance
}
