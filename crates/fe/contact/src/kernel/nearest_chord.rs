//! After a search: the facet of the primary surface at which each point of a candidate starts.

use pulp::{Simd, WithSimd};
use stribeck_simd::lanes::{LANES, Number, Vector};

use crate::points::Points;
use stribeck_surface::Surface;

/// The points of one facet, and facets of the other surface that may be near them.
pub(crate) struct NearestChord<'a> {
    pub(crate) secondary: &'a Surface,
    pub(crate) primary: &'a Surface,
    pub(crate) points: &'a Points,
    pub(crate) x: &'a [f64],
    pub(crate) y: &'a [f64],
    pub(crate) facet: usize,
    /// Pairs of this facet and one of the other surface.
    pub(crate) pairs: &'a [(u32, u32)],
    /// For the nearest facet of each point.
    pub(crate) found: &'a mut Vec<u32>,
}

impl WithSimd for NearestChord<'_> {
    type Output = ();

    /// Chords stand for curves: near enough to begin a walk.
    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { secondary, primary, points, x, y, facet, pairs, found } = self;
        found.clear();
        let range = points.of_facet[facet].range();
        let (a, b) = secondary.ends(facet);
        let (zero, one) = (Vector::all(simd, 0.0), Vector::all(simd, 1.0));
        for i in range.clone().step_by(Vector::<V>::LEN) {
            let place = Vector::load(simd, &points.place, i);
            let (mut least, mut nearest) = (Vector::all(simd, f64::INFINITY), zero);
            for &(_, other) in pairs {
                let (c, d) = primary.ends(other as usize);
                let along = [x[d] - x[c], y[d] - y[c]];
                let inverse = Vector::all(simd, 1.0 / (along[0] * along[0] + along[1] * along[1]));
                let along = [Vector::all(simd, along[0]), Vector::all(simd, along[1])];
                let rx = place.times_plus(Vector::all(simd, x[b] - x[a]), Vector::all(simd, x[a] - x[c]));
                let ry = place.times_plus(Vector::all(simd, y[b] - y[a]), Vector::all(simd, y[a] - y[c]));
                let foot = (rx.times_plus(along[0], ry * along[1]) * inverse).max(zero).min(one);
                let (dx, dy) = (rx - foot * along[0], ry - foot * along[1]);
                let square = dx.times_plus(dx, dy * dy);
                nearest = square.choose_below(least, Vector::all(simd, f64::from(other)), nearest);
                least = least.min(square);
            }
            let mut facets = [0.0; LANES];
            nearest.store(&mut facets, 0);
            found.extend(facets.iter().take(Vector::<V>::LEN.min(range.end - i)).map(|&f| f as u32));
        }
    }
}
