//! Eight facets of a boundary about a contact, in vectors: only where u increases along all of them.

use pulp::Simd;
use stribeck_simd::lanes::{LANES, Number, Vector, vector_starts};

use crate::contact::outline::{Facet, PAD, Parts, View};

/// Ends of eight facets.
const ENDS: usize = LANES + 1;

/// Facets before the one that the ray along d intersects.
const BEFORE: usize = 3;

/// Eight neighbouring facets with increasing u.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
pub struct EightFacets {
    from: [f64; LANES],
    to: [f64; LANES],
    slope: [f64; LANES],
    base: [f64; LANES],
}

impl EightFacets {
    /// Projects the facets about that of a view; false where a wall or the far side of the boundary is among
    /// them. `along` is whether vertices follow along +t.
    #[inline(always)]
    pub(crate) fn look<S: Simd>(&mut self, simd: S, view: &View<'_>, along: bool) -> bool {
        let n = view.outline.len();
        let (start, [x, y]) = if along {
            (PAD + view.facet, view.outline.ahead())
        } else {
            // The facet from vertex i to i + 1, backwards.
            (PAD + n - 2 - view.facet, view.outline.back())
        };
        let start = start - BEFORE;
        // Vertices are repeated at both ends of a boundary.
        let [Some(x), Some(y)] = [x, y].map(|all| all[start..].first_chunk::<ENDS>()) else { return false };
        let all = |value: f64| Vector::all(simd, value);
        let (dx, dy, minus) = (all(view.d[0]), all(view.d[1]), all(-view.d[1]));
        let (cx, cy) = (all(view.from[0]), all(view.from[1]));
        let mut rising = 0;
        for at in vector_starts(simd) {
            let (x0, y0) = (Vector::load(simd, x, at) - cx, Vector::load(simd, y, at) - cy);
            let (x1, y1) = (Vector::load(simd, x, at + 1) - cx, Vector::load(simd, y, at + 1) - cy);
            let (u0, u1) = (minus.times_plus(x0, dx * y0), minus.times_plus(x1, dx * y1));
            let (h0, h1) = (dx.times_plus(x0, dy * y0), dx.times_plus(x1, dy * y1));
            let width = u1 - u0;
            let slope = (h1 - h0) / width;
            u0.store(&mut self.from, at);
            u1.store(&mut self.to, at);
            slope.store(&mut self.slope, at);
            (-slope).times_plus(u0, h0).store(&mut self.base, at);
            rising |= all(0.0).bits_below(width) << at;
        }
        rising == (1 << LANES) - 1
    }

    #[inline(always)]
    fn holds(&self, reach: f64) -> bool {
        self.from[0] <= -reach && self.to[LANES - 1] >= reach
    }

    /// The facet that holds u = `start`.
    #[inline(always)]
    fn first<S: Simd>(&self, simd: S, start: f64) -> usize {
        let start = Vector::all(simd, start);
        let mut ahead = 0;
        for at in vector_starts(simd) {
            ahead += start.bits_below(Vector::load(simd, &self.to, at)).count_ones();
        }
        LANES - ahead as usize
    }

    #[inline(always)]
    fn facet(&self, at: usize) -> Facet {
        Facet { from: self.from[at], to: self.to[at], slope: self.slope[at], base: self.base[at] }
    }
}

/// Walks along roller and raceway up to `reach` [m] to either side, and passes on the parts between two
/// places where neither has a vertex. False, with no part passed on, where the eight facets do not extend so
/// far.
#[inline(always)]
pub(crate) fn segments<S: Simd>(
    simd: S,
    [roller, raceway]: &[EightFacets; 2],
    reach: f64,
    parts: &mut impl Parts,
) -> bool {
    if !(roller.holds(reach) && raceway.holds(reach)) {
        return false;
    }
    let mut u = -reach;
    let (mut i, mut j) = (roller.first(simd, u) % LANES, raceway.first(simd, u) % LANES);
    for _ in 0..2 * LANES {
        let (of_roller, of_raceway) = (roller.to[i], raceway.to[j]);
        let end = if of_roller < of_raceway { of_roller } else { of_raceway };
        let end = if end < reach { end } else { reach };
        if end > u {
            parts.add([u, end], roller.facet(i), raceway.facet(j));
            u = end;
        }
        if end >= reach {
            break;
        }
        // A branch, because the processor guesses it: mostly one passes after the other. The last facet ends
        // beyond the reach.
        if of_roller <= of_raceway { i = (i + 1) % LANES } else { j = (j + 1) % LANES }
    }
    true
}
