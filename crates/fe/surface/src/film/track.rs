//! Where a film lies: the parts of a surface between its corners, and the place that is nearest to a round
//! body.

use serde::{Deserialize, Serialize};

use crate::{
    Surface,
    plane::{cross, dot, minus, unit_normal},
    polyline::Vertices,
    smooth::{Rise, bend, height, slope},
};

/// A land of fewer facets is a wall or a chamfer, and carries no film.
const LEAST_FACETS: usize = 3;

/// Tolerance at a joint, as a share of a facet: within it a place belongs to either facet.
const JOINT: f64 = 1e-12;

/// Most corrections of a place.
const CORRECTIONS: usize = 8;

/// Facets between two corners of a surface.
#[derive(Debug, Clone)]
pub struct Land {
    first: usize,
    facets: usize,
    /// Without ends.
    closed: bool,
    /// Curvature in the reference positions [1/m]: positive where the solid bulges.
    pub curvature: f64,
}

/// A place on a surface: a facet, and a share of it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Place {
    /// Number of the facet.
    pub facet: u32,
    /// 0 at its first node, 1 at its second.
    pub along: f64,
}

/// A point of a surface in present positions.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    /// Where on the surface.
    pub place: Place,
    /// Slots of the two nodes of its facet.
    pub ends: [u32; 2],
    /// Position [m].
    pub at: [f64; 2],
    /// Outward normal of the surface.
    pub normal: [f64; 2],
    /// Height above the chord [m], its normal and its length [m].
    height: f64,
    chord: [f64; 2],
    length: f64,
}

impl Land {
    /// All lands of a surface whose positions are the reference.
    pub fn of(surface: &Surface, x: &[f64], y: &[f64]) -> Vec<Self> {
        let (facets, n) = (surface.facets(), surface.slots.len());
        let starts: Vec<usize> = (0..facets).filter(|&f| surface.corners()[f]).collect();
        let mut lands = if starts.is_empty() {
            vec![Self { first: 0, facets, closed: surface.closed, curvature: 0.0 }]
        } else {
            let next = |i: usize| match starts.get(i + 1) {
                Some(&next) => next,
                None if surface.closed => starts[0] + facets,
                None => facets,
            };
            let each = starts.iter().enumerate();
            each.map(|(i, &first)| Self { first, facets: next(i) - first, closed: false, curvature: 0.0 })
                .collect()
        };
        lands.retain(|land| land.facets >= LEAST_FACETS);
        for land in &mut lands {
            let at = |v: usize| {
                let slot = surface.slots[v % n] as usize;
                [x[slot], y[slot]]
            };
            let direction = |f: usize| {
                let ([ax, ay], [bx, by]) = (at(f), at(f + 1));
                [bx - ax, by - ay]
            };
            let mut turn = 0.0;
            let joints = if land.closed { land.facets } else { land.facets - 1 };
            for f in land.first..land.first + joints {
                let ([px, py], [qx, qy]) = (direction(f % facets), direction((f + 1) % facets));
                turn += libm::atan2(px * qy - py * qx, px * qx + py * qy);
            }
            // Between the middles of the first facet and the last.
            let length: f64 = (0..joints)
                .map(|i| land.first + i)
                .map(|f| 0.5 * (surface.lengths()[f % facets] + surface.lengths()[(f + 1) % facets]))
                .sum();
            land.curvature = turn / length;
        }
        lands
    }

    /// The facet whose first node is nearest to a point: where a search begins.
    pub fn begin(&self, surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2]) -> Place {
        let at = Vertices { slots: &surface.slots, closed: surface.closed, x, y };
        let distance = |f: usize| {
            let ([ax, ay], [bx, by]) = at.ends(f);
            libm::hypot(0.5 * (ax + bx) - p[0], 0.5 * (ay + by) - p[1])
        };
        let facets = (self.first..self.first + self.facets).map(|f| f % surface.facets());
        let nearest = facets.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(self.first);
        Place { facet: nearest as u32, along: 0.5 }
    }

    /// The place nearest to `p` [m], by walking from another one; the walk stops at the ends of the land.
    #[inline]
    pub fn nearest(&self, surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2], from: Place) -> Point {
        let (mut facet, mut before) = (from.facet as usize, None);
        loop {
            let arc = Arc::new(surface, x, y, facet);
            let along = arc.nearest(p);
            let on = if along < -JOINT {
                self.neighbour(surface, facet, false)
            } else if along > 1.0 + JOINT {
                self.neighbour(surface, facet, true)
            } else {
                None
            };
            match on {
                // Of two facets that send on to each other their joint is nearest.
                Some(next) if before != Some(next) => (before, facet) = (Some(facet), next),
                _ => return arc.point(facet, along.clamp(0.0, 1.0)),
            }
        }
    }

    fn neighbour(&self, surface: &Surface, facet: usize, forward: bool) -> Option<usize> {
        let last = (self.first + self.facets - 1) % surface.facets();
        let at_end = if forward { facet == last } else { facet == self.first };
        if at_end && !self.closed { None } else { surface.neighbour(facet, forward) }
    }

    /// The curve of one of its facets, in reference positions.
    pub fn curve(&self, surface: &Surface, x: &[f64], y: &[f64], facet: u32) -> FacetCurve {
        let Arc { origin, length, tangent, rise, .. } = Arc::new(surface, x, y, facet as usize);
        let (whole, facet) = (surface.facets(), facet as usize);
        let before = (facet + whole - self.first) % whole;
        FacetCurve {
            origin,
            length,
            tangent,
            rise,
            before: before as f64,
            behind: (self.facets - before) as f64,
        }
    }

    /// The facet of the land before or after another one.
    pub fn beside(&self, surface: &Surface, facet: u32, forward: bool) -> Option<u32> {
        self.neighbour(surface, facet as usize, forward).map(|facet| facet as u32)
    }

    /// Whether it is closed: a whole circumference without corners.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Distance along the land from a place to its first and its last end [m]; infinite without ends.
    #[inline]
    pub fn to_ends(&self, surface: &Surface, place: Place) -> [f64; 2] {
        if self.closed {
            return [f64::INFINITY; 2];
        }
        let whole = surface.facets();
        let before = (place.facet as usize + whole - self.first) % whole;
        let mean = surface.lengths()[place.facet as usize];
        // The mean facet length serves for ends that are many facets away.
        let first = (before as f64 + place.along) * mean;
        let last = ((self.facets - before) as f64 - place.along) * mean;
        [first, last]
    }
}

/// The curve of a facet of a land, as data for vector loads: heights over its chord along the normal, which
/// is the tangent turned clockwise by a right angle.
#[derive(Debug, Clone, Copy)]
pub struct FacetCurve {
    /// Its first node [m].
    pub origin: [f64; 2],
    /// Length of its chord [m], and the direction.
    pub length: f64,
    /// See `length`.
    pub tangent: [f64; 2],
    /// Heights, as of [`crate::smooth::height`].
    pub rise: Rise,
    /// Facets of the land before it, and those from it on.
    pub before: f64,
    /// See `before`.
    pub behind: f64,
}

/// The curve of a facet in present positions.
struct Arc {
    ends: [u32; 2],
    origin: [f64; 2],
    length: f64,
    tangent: [f64; 2],
    normal: [f64; 2],
    rise: Rise,
}

impl Arc {
    fn new(surface: &Surface, x: &[f64], y: &[f64], facet: usize) -> Self {
        let (a, b) = surface.ends(facet);
        let along = [x[b] - x[a], y[b] - y[a]];
        let (normal, inverse) = unit_normal(along);
        let tangent = along.map(|t| t * inverse);
        let ends = [a as u32, b as u32];
        Self {
            ends,
            origin: [x[a], y[a]],
            length: 1.0 / inverse,
            tangent,
            normal,
            rise: surface.rises()[facet],
        }
    }

    /// Foot of `p` on the curve, which is extended beyond its ends.
    #[inline]
    fn nearest(&self, p: [f64; 2]) -> f64 {
        let from = minus(p, self.origin);
        let (along, off) = (dot(from, self.tangent), dot(from, self.normal));
        let mut s = along / self.length;
        for _ in 0..CORRECTIONS {
            let (e, de, dde) = (height(self.rise, s), slope(self.rise, s), bend(self.rise, s));
            let rest = (along - s * self.length) * self.length + (off - e) * de;
            let stiff = self.length * self.length + de * de - (off - e) * dde;
            let correction = rest / stiff;
            s += correction;
            if correction.abs() < JOINT {
                break;
            }
        }
        s
    }

    fn point(&self, facet: usize, along: f64) -> Point {
        let (height, slope) = (height(self.rise, along), slope(self.rise, along) / self.length);
        let (t, n) = (self.tangent, self.normal);
        let at = [0, 1].map(|k| self.origin[k] + along * self.length * t[k] + height * n[k]);
        // Outwards from the curve, which climbs against its chord.
        let turned = [0, 1].map(|k| (n[k] - slope * t[k]) / libm::hypot(slope, 1.0));
        let place = Place { facet: facet as u32, along };
        Point { place, ends: self.ends, at, normal: turned, height, chord: n, length: self.length }
    }
}

impl Point {
    /// Sine of the angle from the surface's normal here to another direction.
    #[inline]
    pub fn tilt(&self, direction: [f64; 2]) -> f64 {
        cross(self.normal, direction)
    }

    /// Forces on the facet's two nodes that are worth the force `f` on the point, which turns with its chord.
    #[inline]
    pub fn shares(&self, f: [f64; 2]) -> [[f64; 2]; 2] {
        let lever = -self.height / self.length * cross(self.chord, f);
        let second = [0, 1].map(|k| self.place.along * f[k] + lever * self.chord[k]);
        [minus(f, second), second]
    }
}

impl Place {
    /// The point at a distance [m] along the facet's curve, which is extended beyond its ends.
    #[inline]
    pub fn ahead(self, surface: &Surface, x: &[f64], y: &[f64], by: f64) -> Point {
        let facet = self.facet as usize;
        let arc = Arc::new(surface, x, y, facet);
        arc.point(facet, self.along + by / arc.length)
    }

    /// Distance along the surface from another place, the shorter way round [m].
    #[inline]
    pub fn since(self, surface: &Surface, other: Self) -> f64 {
        let facets = surface.facets() as f64;
        let mut by = f64::from(self.facet) - f64::from(other.facet) + self.along - other.along;
        if surface.closed {
            by -= facets * (by / facets).round();
        }
        by * surface.lengths()[self.facet as usize]
    }
}
