//! Smooth surfaces: how far the true curve stands off the chords of a polyline (THEORY §4.4).

use stribeck_simd::lanes::Number;

use crate::polyline::Vertices;

/// Curve that a polyline represents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Smoothing {
    /// Itself: contact is with the chords.
    Facet,
    /// A circle about a known centre [m]: facets whose two ends are equally far from it become arcs, others
    /// (walls of a groove, radial sides) stay chords.
    Arc {
        /// Centre in the reference positions [m].
        centre: [f64; 2],
    },
    /// Any smooth curve through the vertices: Nagata patches from vertex normals. Corners stay corners.
    Nagata,
}

/// Ends of a facet count as equally far from the centre of an arc when their distances differ by less than
/// this share of its length: a facet that leans by more is no part of that circle.
const LEAN: f64 = 1e-3;

/// Vertices where the smoothed curve still turns by more than this keep the rules of a polyline's vertex
/// [rad].
pub const KINK: f64 = 1e-3;

/// Height of the curve above its chord, towards the outward normal, as a function of the place s on the
/// facet: h = s(1−s)(r₀(1−s) − r₁s), the cubic that leaves its ends with slopes r₀ and r₁ [m per facet].
pub type Rise = [f64; 2];

/// Height [m] of the curve at a place.
#[inline(always)]
pub fn height<N: Number>([r0, r1]: [N; 2], s: N) -> N {
    let rest = s.constant(1.0) - s;
    s * rest * (r0 * rest - r1 * s)
}

/// Slope of the height [m per facet].
#[inline(always)]
pub fn slope<N: Number>([r0, r1]: [N; 2], s: N) -> N {
    let (one, three) = (s.constant(1.0), s.constant(3.0));
    r0 * (one - s) * (one - three * s) - r1 * s * (s.constant(2.0) - three * s)
}

/// Rate of the slope [m per facet, per facet].
#[inline(always)]
pub fn bend<N: Number>([r0, r1]: [N; 2], s: N) -> N {
    let six = s.constant(6.0) * s;
    r0 * (six - s.constant(4.0)) + r1 * (six - s.constant(2.0))
}

/// Rise of every facet of a polyline, given its corners.
pub fn rises(smoothing: Smoothing, at: &Vertices<'_>, corner: &[bool]) -> Vec<Rise> {
    match smoothing {
        Smoothing::Facet => vec![[0.0; 2]; at.facets()],
        Smoothing::Arc { centre } => (0..at.facets()).map(|f| arc(at, f, centre)).collect(),
        Smoothing::Nagata => nagata(at, corner),
    }
}

/// A parabola through the middle of the arc: for 112 facets a turn it is nowhere 0.1 nm off.
fn arc(at: &Vertices<'_>, f: usize, [cx, cy]: [f64; 2]) -> Rise {
    let ([ax, ay], [bx, by]) = at.ends(f);
    let (from, to) = (libm::hypot(ax - cx, ay - cy), libm::hypot(bx - cx, by - cy));
    let (tx, ty) = (bx - ax, by - ay);
    let length = libm::hypot(tx, ty);
    let (mx, my) = (0.5 * (ax + bx) - cx, 0.5 * (ay + by) - cy);
    if (from - to).abs() > LEAN * length || 0.5 * length >= from.min(to) {
        return [0.0; 2];
    }
    let radius = 0.5 * (from + to);
    let sag = radius - (radius * radius - 0.25 * length * length).sqrt();
    // Outward is to the right of the walk; the arc lies away from the centre.
    let outward = (mx * ty - my * tx).signum();
    [4.0 * sag * outward, -4.0 * sag * outward]
}

/// Slopes of each facet from directions at its vertices: that of the circle through a vertex and its two
/// neighbours, or of the facet's own neighbour where one of its ends is a corner. Source: the curve is
/// Nagata's patch in the plane.
fn nagata(at: &Vertices<'_>, corner: &[bool]) -> Vec<Rise> {
    let n = at.facets();
    let along = |f: usize| {
        let ([ax, ay], [bx, by]) = at.ends(f);
        [bx - ax, by - ay]
    };
    // Angle [rad] by which the curve leaves a facet's chord, at its first and its second end: the turn at the
    // vertex, shared in proportion to the lengths, as on a circle.
    let share = |f: usize, g: usize, of: usize| {
        let (p, q) = (along(f), along(g));
        let turn = libm::atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]);
        let length = |t: [f64; 2]| libm::hypot(t[0], t[1]);
        turn * length(along(of)) / (length(p) + length(q))
    };
    (0..n)
        .map(|f| {
            let (first, second) = at.vertices(f);
            let before = at.before(f).filter(|_| !corner[first]).map(|g| share(g, f, f));
            let after = at.after(f).filter(|_| !corner[second]).map(|g| share(f, g, f));
            // Beside a corner the curve goes on as an arc; between two corners it is the chord.
            let (start, end) = match (before, after) {
                (Some(a), Some(b)) => (a, b),
                (Some(a), None) => (a, a),
                (None, Some(b)) => (b, b),
                (None, None) => (0.0, 0.0),
            };
            let length = libm::hypot(along(f)[0], along(f)[1]);
            // A curve that turns left (convex) starts to the right of its chord, outwards.
            [libm::tan(start) * length, -libm::tan(end) * length]
        })
        .collect()
}
