//! Closest-point projection: against a search over all facets and against parry2d, at corners, beyond ends.

use parry2d_f64::{math::Vector, query::PointQueryWithLocation, shape::Polyline};
use proptest::{prelude::*, test_runner::RngSeed};
use stribeck_surface::{Projection, Surface, project};

/// Rounding of coordinates of order one.
const ROUNDING: f64 = 1e-12;

/// A closed polygon, counter-clockwise: the solid is inside.
fn polygon(x: &[f64], y: &[f64]) -> Surface {
    let slots = (0..x.len() as u32).collect();
    Surface::new("polygon", slots, true, x, y).expect("a polygon with sides")
}

/// Distance to the segment from `a` to `b`.
fn to_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (t, r) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let along = ((r[0] * t[0] + r[1] * t[1]) / (t[0] * t[0] + t[1] * t[1])).clamp(0.0, 1.0);
    (r[0] - along * t[0]).hypot(r[1] - along * t[1])
}

/// Nearest side and signed distance of a point to a closed polygon, inside by the crossing number.
fn slowly(x: &[f64], y: &[f64], p: [f64; 2]) -> (usize, f64) {
    let n = x.len();
    let end = |i: usize| [x[i % n], y[i % n]];
    let mut nearest = (0, f64::INFINITY);
    let mut inside = false;
    for i in 0..n {
        let (a, b) = (end(i), end(i + 1));
        let distance = to_segment(p, a, b);
        if distance < nearest.1 {
            nearest = (i, distance);
        }
        if (a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
            inside = !inside;
        }
    }
    (nearest.0, if inside { -nearest.1 } else { nearest.1 })
}

/// Corners of a convex polygon: places on an ellipse, at least a twentieth of a turn apart.
fn convex() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    (prop::collection::vec(0.05..1.0_f64, 3..14), 0.5..2.0_f64, 0.0..6.0_f64).prop_map(
        |(shares, flat, turn)| {
            let sum: f64 = shares.iter().sum();
            let mut angle = turn;
            let mut corners = (Vec::new(), Vec::new());
            for share in shares {
                corners.0.push(angle.cos());
                corners.1.push(flat * angle.sin());
                angle += std::f64::consts::TAU * share / sum;
            }
            corners
        },
    )
}

/// The projection is a foot: it lies on the polygon, at the distance of the gap, along the normal.
fn is_foot(x: &[f64], y: &[f64], p: [f64; 2], to: &Projection) -> bool {
    let next = (to.facet + 1) % x.len();
    let foot =
        [x[to.facet] + to.place * (x[next] - x[to.facet]), y[to.facet] + to.place * (y[next] - y[to.facet])];
    let unit = (to.normal[0].hypot(to.normal[1]) - 1.0).abs() < ROUNDING;
    unit && (0..2).all(|k| (foot[k] + to.gap * to.normal[k] - p[k]).abs() < ROUNDING)
}

/// The same cases every time, so that a failure is not a matter of luck; `PROPTEST_CASES` tries more of them.
fn cases() -> ProptestConfig {
    ProptestConfig { rng_seed: RngSeed::Fixed(1882), failure_persistence: None, ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn invariant_gap_is_the_signed_distance((x, y) in convex(), side in 0..14_usize, along in 0.0..1.0_f64, off in -0.5..0.5_f64) {
        // A point near a side: outside by up to half that side, inside by up to half the shortest of all.
        // Deeper points may belong to the side after next, and are not what contact meets.
        let surface = polygon(&x, &y);
        let (a, n) = (side % x.len(), x.len());
        let b = (a + 1) % n;
        let (tx, ty) = (x[b] - x[a], y[b] - y[a]);
        let length = |k: usize| (x[(k + 1) % n] - x[k]).hypot(y[(k + 1) % n] - y[k]);
        let shortest = (0..n).map(length).fold(f64::INFINITY, f64::min);
        let off = if off < 0.0 { off * shortest / length(a) } else { off };
        let p = [x[a] + along * tx + off * ty, y[a] + along * ty - off * tx];
        let (nearest, distance) = slowly(&x, &y, p);
        // The search hands over the nearest side, and a point moves on by less than a side between two steps.
        for start in [nearest, (nearest + 1) % n, (nearest + n - 1) % n] {
            let found = project(&surface, &x, &y, p, start).expect("a closed surface has no ends");
            prop_assert!((found.gap - distance).abs() < ROUNDING, "from {start}: {found:?}, distance \
                {distance}");
            prop_assert!(is_foot(&x, &y, p, &found), "{found:?}");
        }
    }

    #[test]
    fn invariant_gap_moves_along_its_normal((x, y) in convex(), px in -2.0..2.0_f64, py in -2.0..2.0_f64) {
        // The normal is the gradient of the gap, which is what makes the force of a penalty that of its
        // energy.
        let surface = polygon(&x, &y);
        let (nearest, distance) = slowly(&x, &y, [px, py]);
        if distance < 0.01 {
            return Ok(());
        }
        let at = |dx: f64, dy: f64| project(&surface, &x, &y, [px + dx, py + dy], nearest).expect("closed").gap;
        let normal = project(&surface, &x, &y, [px, py], nearest).expect("closed").normal;
        let h = 1e-6;
        let gradient = [(at(h, 0.0) - at(-h, 0.0)) / (2.0 * h), (at(0.0, h) - at(0.0, -h)) / (2.0 * h)];
        // Second differences of a distance above 0.01 are below 100.
        prop_assert!((gradient[0] - normal[0]).abs() < 1e-3 && (gradient[1] - normal[1]).abs() < 1e-3);
    }
}

/// An L: unit square without its upper right quarter; the concave corner is at (0.5, 0.5), vertex 3.
const L: ([f64; 6], [f64; 6]) = ([0.0, 1.0, 1.0, 0.5, 0.5, 0.0], [0.0, 0.0, 0.5, 0.5, 1.0, 1.0]);

#[test]
fn by_hand_gap_at_a_concave_corner() {
    let (x, y) = L;
    let surface = polygon(&x, &y);
    // Outside, in the notch: the nearer of both walls, from whichever side the walk begins.
    for (p, gap, facet) in [([0.8, 0.6], 0.1, 2), ([0.6, 0.8], 0.1, 3), ([0.52, 0.51], 0.01, 2)] {
        for start in [2, 3] {
            let found = project(&surface, &x, &y, p, start).expect("closed");
            assert!(
                (found.gap - gap).abs() < ROUNDING && found.facet == facet,
                "{p:?} from {start}: {found:?}"
            );
        }
    }
    // Inside, diagonally behind the corner: the vertex itself, its normal away from the solid.
    for start in [2, 3] {
        let found = project(&surface, &x, &y, [0.4, 0.4], start).expect("closed");
        let diagonal = 0.5_f64.sqrt();
        assert!((found.gap + 0.1 * 2.0_f64.sqrt()).abs() < ROUNDING, "{found:?}");
        assert!(
            (found.normal[0] - diagonal).abs() < ROUNDING && (found.normal[1] - diagonal).abs() < ROUNDING
        );
    }
}

#[test]
fn by_hand_gap_at_a_convex_corner() {
    // Outside a corner the vertex is nearest, its normal points to the point.
    let (x, y) = L;
    let surface = polygon(&x, &y);
    for start in [0, 1] {
        let found = project(&surface, &x, &y, [1.3, -0.4], start).expect("closed");
        assert!((found.gap - 0.5).abs() < ROUNDING, "{found:?}");
        assert!((found.normal[0] - 0.6).abs() < ROUNDING && (found.normal[1] + 0.8).abs() < ROUNDING);
    }
    // At the vertex itself the gap is zero and the normal that of a side.
    let found = project(&surface, &x, &y, [1.0, 0.0], 0).expect("closed");
    assert!(found.gap == 0.0 && found.normal[0].hypot(found.normal[1]) == 1.0, "{found:?}");
}

#[test]
fn by_hand_open_surfaces_end() {
    // A wall of three facets along x, solid below (walked to the left).
    let (x, y) = ([3.0, 2.0, 1.0, 0.0], [0.0; 4]);
    let wall = Surface::new("wall", vec![0, 1, 2, 3], false, &x, &y).expect("a wall");
    let above = |px: f64, start: usize| project(&wall, &x, &y, [px, 0.2], start);
    for start in 0..3 {
        let found = above(1.4, start).expect("above the wall");
        assert!(
            (found.gap - 0.2).abs() < ROUNDING && found.facet == 1 && found.normal == [0.0, 1.0],
            "{found:?}"
        );
        assert!(project(&wall, &x, &y, [1.4, -0.2], start).expect("below").gap < 0.0);
        assert!(above(-0.1, start).is_none() && above(3.1, start).is_none(), "beyond the ends");
    }
    // The ends themselves belong to the wall.
    assert!(above(0.0, 2).is_some() && above(3.0, 0).is_some());
}

/// A point of parry2d, whose bounding-volume trees are our broad phase.
fn vector([x, y]: [f64; 2]) -> Vector {
    Vector::new(x, y)
}

/// A polyline about the origin that is neither convex nor even: radii within a tenth, angles within a third
/// of their mean distance.
fn uneven() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    prop::collection::vec((-0.05..0.05_f64, -0.33..0.33_f64), 12..80).prop_map(|vertices| {
        let n = vertices.len() as f64;
        let at = |(k, (radius, angle)): (usize, (f64, f64))| {
            let (s, c) = (std::f64::consts::TAU * (k as f64 + angle) / n).sin_cos();
            ((1.0 + radius) * c, (1.0 + radius) * s)
        };
        vertices.into_iter().enumerate().map(at).unzip()
    })
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn peer_closest_points_of_parry2d_on_polylines((x, y) in uneven(), closed in any::<bool>(), side in 0..80_usize, along in 0.0..1.0_f64, off in -0.4..0.4_f64, offset in 0..3_usize) {
        // parry2d 0.31.1, `Polyline::project_local_point_and_get_location`.
        let n = x.len();
        let slots = (0..n as u32).collect();
        let surface = Surface::new("polyline", slots, closed, &x, &y).expect("a polyline with facets");
        let facets = if closed { n } else { n - 1 };
        let indices = (0..facets).map(|f| [f as u32, ((f + 1) % n) as u32]).collect();
        let theirs = Polyline::new(x.iter().zip(&y).map(|(x, y)| vector([*x, *y])).collect(), Some(indices));

        // A point beside a facet, closer to it than the facets' shortest: farther off, two places may be
        // equally close.
        let (a, b) = (side % facets, (side % facets + 1) % n);
        let (tx, ty) = (x[b] - x[a], y[b] - y[a]);
        let shortest = (0..facets).map(|f| (x[(f + 1) % n] - x[f]).hypot(y[(f + 1) % n] - y[f])).fold(1.0, f64::min);
        let off = off * shortest / tx.hypot(ty);
        let p = [x[a] + along * tx + off * ty, y[a] + along * ty - off * tx];

        let (found, (facet, _)) = theirs.project_local_point_and_get_location(vector(p), false);
        let distance = (found.point - vector(p)).length();
        // A search leaves the nearest facet or one beside it to start from.
        let start = facet as usize + offset;
        let start = if closed { (start + n - 1) % n } else { start.saturating_sub(1).min(facets - 1) };
        match project(&surface, &x, &y, p, start) {
            Some(ours) => {
                prop_assert!((ours.gap.abs() - distance).abs() < ROUNDING, "{ours:?}, {found:?}");
                let next = (ours.facet + 1) % n;
                let foot = [
                    x[ours.facet] + ours.place * (x[next] - x[ours.facet]),
                    y[ours.facet] + ours.place * (y[next] - y[ours.facet]),
                ];
                prop_assert!((vector(foot) - found.point).length() < 1e-6, "{ours:?}, {found:?}");
                // The gradient of a distance is the direction from the closest point, outwards when it is
                // apart.
                let away = (vector(p) - found.point) / ours.gap;
                let close = distance < 1e-4;
                prop_assert!(close || (away - vector(ours.normal)).length() < 1e-8, "{ours:?}, {found:?}");
                if closed {
                    let inside = slowly(&x, &y, p).1 < 0.0;
                    prop_assert!(distance < ROUNDING || inside == (ours.gap < 0.0), "{ours:?}, inside {inside}");
                }
            }
            // Beyond the ends of an open surface there is no gap: there the closest point is the first or the
            // last node.
            None => {
                let ends = [[x[0], y[0]], [x[n - 1], y[n - 1]]];
                let at_end = ends.iter().any(|end| (vector(*end) - found.point).length() < ROUNDING);
                prop_assert!(!closed && at_end, "no foot, but {found:?}");
            }
        }
    }
}
