//! Triangles in the gap between two closed loops of points.

use std::f64::consts::{PI, TAU};

use crate::smoothing::score;

/// Poisson's ratio for which triangles are compared.
const POISSON: f64 = 0.3;

/// Triangles between an outer and an inner loop.
pub(crate) struct Gap {
    /// Corners: outer points by their position, inner points by their position plus the outer count.
    pub(crate) triangles: Vec<[usize; 3]>,
    /// Smallest score of a triangle [m].
    pub(crate) worst: f64,
}

/// Fills the gap with the triangles that minimise Σ (1/score)^8, by dynamic programming; `None` if every
/// filling turns a triangle inside out.
///
/// Both loops run counter-clockwise about the origin and their first points are joined by an edge. Walking
/// round, each triangle advances either on the outer or on the inner loop; every order of these steps is one
/// filling, and the table over (outer steps, inner steps) finds the best of them.
pub(crate) fn fill(outer: &[[f64; 2]], inner: &[[f64; 2]]) -> Option<Gap> {
    let (n, m) = (outer.len(), inner.len());
    let (outer_angle, inner_angle) = (angles(outer), angles(inner));
    // Edges that lean by several cells are never part of a good filling, and most of the table is such.
    let lean = 4.0 * TAU / n.min(m) as f64;
    let scale = libm::hypot(outer[1][0] - outer[0][0], outer[1][1] - outer[0][1]);
    let corners = |[a, b, c]: [usize; 3]| [a, b, c].map(|i| if i < n { outer[i] } else { inner[i - n] });
    let cost = |triangle| (scale / score(&corners(triangle), POISSON)).powi(8);
    let along_outer = |i: usize, j: usize| [n + j % m, i % n, (i + 1) % n];
    let along_inner = |i: usize, j: usize| [n + j % m, i % n, n + (j + 1) % m];

    let width = m + 1;
    let mut best = vec![f64::INFINITY; (n + 1) * width];
    let mut by_outer = vec![false; (n + 1) * width];
    best[0] = 0.0;
    for i in 0..=n {
        for j in 0..=m {
            if (outer_angle[i] - inner_angle[j]).abs() > lean {
                continue;
            }
            let here = i * width + j;
            if i > 0 && best[here - width].is_finite() {
                best[here] = best[here - width] + cost(along_outer(i - 1, j));
                by_outer[here] = true;
            }
            if j > 0 && best[here - 1].is_finite() {
                let total = best[here - 1] + cost(along_inner(i, j - 1));
                if total < best[here] {
                    (best[here], by_outer[here]) = (total, false);
                }
            }
        }
    }
    if !best[n * width + m].is_finite() {
        return None;
    }
    let (mut i, mut j) = (n, m);
    let mut triangles = Vec::with_capacity(n + m);
    while i + j > 0 {
        if by_outer[i * width + j] {
            i -= 1;
            triangles.push(along_outer(i, j));
        } else {
            j -= 1;
            triangles.push(along_inner(i, j));
        }
    }
    triangles.reverse();
    let worst = triangles.iter().map(|t| score(&corners(*t), POISSON)).fold(f64::INFINITY, f64::min);
    Some(Gap { triangles, worst })
}

/// Angles of a loop's points about the origin, rising by a whole turn from the first point back to itself.
fn angles(points: &[[f64; 2]]) -> Vec<f64> {
    let mut angles: Vec<f64> = points.iter().map(|[x, y]| libm::atan2(*y, *x)).collect();
    for i in 1..angles.len() {
        // A staircase seen from the centre may step back a little, but never by half a turn.
        while angles[i] < angles[i - 1] - PI {
            angles[i] += TAU;
        }
    }
    angles.push(angles[0] + TAU);
    angles
}
