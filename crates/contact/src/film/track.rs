//! Where a film lies: the parts of a surface between its corners, and the place that is nearest to a round body.

use serde::{Deserialize, Serialize};

use crate::{facet::Facet, polyline::Vertices, spline_facet::SplineFacet, surface::Surface};

/// A land of fewer facets is a wall or a chamfer, and carries no film.
const LEAST_FACETS: usize = 3;

/// Nodes that a place hangs on.
pub(crate) const SUPPORT: usize = 6;

/// Facets between two corners of a surface.
#[derive(Debug, Clone)]
pub(crate) struct Land {
    first: usize,
    facets: usize,
    /// Without ends.
    closed: bool,
    /// Curvature in the reference positions [1/m]: positive where the solid bulges.
    pub(crate) curvature: f64,
}

/// A place on a surface.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Place {
    pub(crate) facet: u32,
    /// 0 at its first node, 1 at its second.
    pub(crate) along: f64,
}

/// What is nearest to a point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest {
    pub(crate) place: Place,
    /// Position on the spline [m].
    pub(crate) at: [f64; 2],
    /// Height of the surface above it [m].
    pub(crate) height: f64,
    /// Outward normal of the surface.
    pub(crate) normal: [f64; 2],
}

impl Land {
    /// All lands of a surface whose positions are the reference.
    pub(crate) fn of(surface: &Surface, x: &[f64], y: &[f64]) -> Vec<Self> {
        let (facets, n) = (surface.facets(), surface.slots.len());
        let starts: Vec<usize> = (0..facets).filter(|&f| surface.corner[f]).collect();
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
                turn += (px * qy - py * qx).atan2(px * qx + py * qy);
            }
            // Between the middles of the first facet and the last.
            let length: f64 = (0..joints)
                .map(|i| land.first + i)
                .map(|f| 0.5 * (surface.length[f % facets] + surface.length[(f + 1) % facets]))
                .sum();
            land.curvature = turn / length;
        }
        lands
    }

    /// The facet whose first node is nearest to a point: where a search begins.
    pub(crate) fn begin(&self, surface: &Surface, x: &[f64], y: &[f64], p: [f64; 2]) -> Place {
        let at = Vertices { slots: &surface.slots, closed: surface.closed, x, y };
        let distance = |f: usize| {
            let ([ax, ay], [bx, by]) = at.ends(f);
            (0.5 * (ax + bx) - p[0]).hypot(0.5 * (ay + by) - p[1])
        };
        let facets = (self.first..self.first + self.facets).map(|f| f % surface.facets());
        let nearest = facets.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(self.first);
        Place { facet: nearest as u32, along: 0.5 }
    }

    /// The place nearest to `p`, walking on from another; ends are never passed.
    pub(crate) fn nearest(
        &self,
        surface: &Surface,
        x: &[f64],
        y: &[f64],
        p: [f64; 2],
        from: Place,
    ) -> Nearest {
        let mut facet = from.facet as usize;
        for _ in 0..self.facets {
            let patch = SplineFacet::new(surface, x, y, facet);
            let along = patch.foot(p).place;
            let on = if along < 0.0 {
                self.neighbour(surface, facet, false)
            } else if along > 1.0 {
                self.neighbour(surface, facet, true)
            } else {
                None
            };
            match on {
                Some(next) => facet = next,
                None => return Nearest::at(&patch, facet, along.clamp(0.0, 1.0)),
            }
            // A joint that either facet sends on to the other.
            if (along > -1e-9 && along < 0.0) || (along > 1.0 && along < 1.0 + 1e-9) {
                let along = if along < 0.0 { 1.0 } else { 0.0 };
                return Nearest::at(&SplineFacet::new(surface, x, y, facet), facet, along);
            }
        }
        let patch = SplineFacet::new(surface, x, y, facet);
        Nearest::at(&patch, facet, patch.foot(p).place.clamp(0.0, 1.0))
    }

    fn neighbour(&self, surface: &Surface, facet: usize, forward: bool) -> Option<usize> {
        let last = (self.first + self.facets - 1) % surface.facets();
        let at_end = if forward { facet == last } else { facet == self.first };
        if at_end && !self.closed { None } else { surface.neighbour(facet, forward) }
    }

    /// Distance along the land from a place to its first and its last end [m]; infinite without ends.
    pub(crate) fn to_ends(&self, surface: &Surface, place: Place) -> [f64; 2] {
        if self.closed {
            return [f64::INFINITY; 2];
        }
        let whole = surface.facets();
        let before = (place.facet as usize + whole - self.first) % whole;
        let mean = surface.length[place.facet as usize];
        // Ends that are many facets away need not be known to the last digit.
        let first = (before as f64 + place.along) * mean;
        let last = ((self.facets - before) as f64 - place.along) * mean;
        [first, last]
    }
}

impl Nearest {
    fn at(patch: &SplineFacet, facet: usize, along: f64) -> Self {
        let height = patch.patch.height_at(along);
        let point = patch.point(along, 0.0);
        let place = Place { facet: facet as u32, along };
        Self { place, at: point.at, height, normal: point.normal }
    }
}

impl Place {
    /// Distance along the surface from another place, the shorter way round [m].
    pub(crate) fn since(self, surface: &Surface, other: Self) -> f64 {
        let facets = surface.facets() as f64;
        let mut by = f64::from(self.facet) - f64::from(other.facet) + self.along - other.along;
        if surface.closed {
            by -= facets * (by / facets).round();
        }
        by * surface.length[self.facet as usize]
    }
}
