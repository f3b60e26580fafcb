//! Narrow phase: the foot of a point on a surface, and the signed gap (THEORY §4.1, §4.4).
//!
//! Between two steps a foot moves by a small part of a facet, so the search sets out from the facet where the
//! point was found last and walks from neighbour to neighbour. parry2d, which does the broad phase, projects
//! points too; the walk is our own because the gap needs more than a closest point: a sign that does
//! not depend on a closed interior, a normal that turns without a jump at joints, curves above the chords and
//! splines, and no descent into a tree for a facet that is already known. On plain polylines both must agree:
//! a test holds them together (`tests/projection.rs`).

use crate::{chord::ChordFacet, facet::Facet, foot::Foot, spline_facet::SplineFacet, surface::Surface};

/// Where a point projects.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Projection {
    /// Gap [m]. Positive when apart, negative when penetrating: the signed distance to a polyline, or the
    /// height above the curve of a smooth surface.
    pub gap: f64,
    /// Gradient of the gap with respect to the point: the outward normal of the primary surface.
    pub normal: [f64; 2],
    /// Facet of the primary surface.
    pub facet: usize,
    /// Place on the facet, 0 at its first node, 1 at its second.
    pub place: f64,
}

/// Walks at most this many facets from the starting one.
const LONGEST_WALK: usize = 8;

/// Projects `p` onto `surface`, starting the walk at `facet`. `None` beyond the ends of an open surface.
pub fn project(surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2], facet: usize) -> Option<Projection> {
    if surface.spline.is_some() {
        projected(SplineFacet::new(surface, x, y, facet), surface, x, y, p)
    } else {
        projected(ChordFacet::new(surface, x, y, facet), surface, x, y, p)
    }
}

fn projected<F: Facet>(
    mut facet: F,
    surface: &Surface,
    x: &[f64],
    y: &[f64],
    p: [f64; 2],
) -> Option<Projection> {
    let Foot { gap, normal, place, .. } = find_foot(&mut facet, surface, x, y, p)?;
    Some(Projection { gap, normal, facet: facet.number(), place })
}

/// The foot of `p`, walking on to the facet where it is; `None` beyond the ends of an open surface.
#[inline(always)]
pub fn find_foot<F: Facet>(
    facet: &mut F,
    surface: &Surface,
    x: &[f64],
    y: &[f64],
    p: [f64; 2],
) -> Option<Foot<f64>> {
    let foot = facet.foot(p);
    if !surface.beside_corner[facet.number()] && facet.holds(&foot) {
        return Some(foot);
    }
    walk(facet, surface, x, y, p)
}

#[inline(never)]
fn walk<F: Facet>(facet: &mut F, surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2]) -> Option<Foot<f64>> {
    let mut best = facet.closest(p);
    for _ in 0..LONGEST_WALK {
        let at = facet.number();
        if !surface.beside_corner[at] && facet.holds(&best.foot) {
            break;
        }
        let mut nearer = *facet;
        for forward in [false, true] {
            let Some(next) = surface.neighbour(at, forward) else { continue };
            let smooth = surface.smooth[if forward { surface.second(at) } else { at }];
            if smooth && nearer.number() != at {
                continue;
            }
            let other = F::new(surface, x, y, next);
            let closest = other.closest(p);
            let better = if smooth {
                facet.is_past(&best.foot, &other, forward, p)
            } else {
                // A foot inside a facet wins a tie against the vertex that both share.
                closest.distance < best.distance
                    || (closest.distance == best.distance && closest.inside && !best.inside)
            };
            if better {
                (best, nearer) = (closest, other);
            }
        }
        if nearer.number() == at {
            break;
        }
        *facet = nearer;
    }
    if best.inside {
        return Some(best.foot);
    }
    let forward = best.foot.place > 1.0;
    let vertex = if forward { surface.second(facet.number()) } else { facet.number() };
    if surface.smooth[vertex] {
        // Curves that join without a kink leave no wedge: either goes on a little beyond its end.
        return Some(best.foot);
    }
    at_vertex(&ChordFacet::new(surface, x, y, facet.number()), surface, x, y, p, forward)
}

/// The closest point is a vertex: the gap is the distance to it, its sign that of the normals around it.
fn at_vertex(
    facet: &ChordFacet,
    surface: &Surface,
    x: &[f64],
    y: &[f64],
    p: [f64; 2],
    forward: bool,
) -> Option<Foot<f64>> {
    let other = surface.neighbour(facet.number(), forward)?;
    let second = ChordFacet::new(surface, x, y, other);
    let vertex = if forward { facet.ends.1 } else { facet.ends.0 };
    let r = [p[0] - x[vertex], p[1] - y[vertex]];
    let distance = (r[0] * r[0] + r[1] * r[1]).sqrt();
    let mean = [facet.normal[0] + second.normal[0], facet.normal[1] + second.normal[1]];
    let sign = if r[0] * mean[0] + r[1] * mean[1] < 0.0 { -1.0 } else { 1.0 };
    let normal = if distance > 0.0 { [sign * r[0] / distance, sign * r[1] / distance] } else { facet.normal };
    let place = if forward { 1.0 } else { 0.0 };
    Some(Foot { gap: sign * distance, normal, place, turn: 0.0, height: 0.0, ..facet.foot_at(p, place) })
}
