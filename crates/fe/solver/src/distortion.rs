//! Distortion of elements from their reference shape, by which a run stops before an element turns inside
//! out.

use crate::dynamics::Dynamics;

/// The most distorted elements of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distortion {
    /// Least area over reference area of any element [-]: 1 at rest, zero or less when an element has turned
    /// inside out.
    pub least_area: f64,
    /// Where that element is [m].
    pub place: [f64; 2],
    /// Largest principal stretch of any element [-]: stiffness and the largest frequency grow with it.
    pub largest_stretch: f64,
}

impl Dynamics {
    /// The most distorted elements of the present positions, measured at element centres. A position that is
    /// NaN gives an area that is NaN.
    pub fn distortion(&self) -> Distortion {
        let (x, y) = (&self.state.x, &self.state.y);
        let mut worst = Distortion { least_area: f64::INFINITY, place: [0.0; 2], largest_stretch: 0.0 };
        let mut take = |p: [f64; 2], r: [f64; 2], b1: [f64; 2], b2: [f64; 2], node: usize| {
            let f = [
                [p[0] * b1[0] + r[0] * b2[0], p[0] * b1[1] + r[0] * b2[1]],
                [p[1] * b1[0] + r[1] * b2[0], p[1] * b1[1] + r[1] * b2[1]],
            ];
            let area = f[0][0] * f[1][1] - f[0][1] * f[1][0];
            // Once NaN, it stays NaN.
            if area < worst.least_area || area.is_nan() && !worst.least_area.is_nan() {
                (worst.least_area, worst.place) = (area, [x[node], y[node]]);
            }
            // λ₁² + λ₂² = |F|², λ₁ λ₂ = det F.
            let squares: f64 = f.as_flattened().iter().map(|v| v * v).sum();
            let largest = 0.5 * (squares + (squares * squares - 4.0 * area * area).max(0.0).sqrt());
            worst.largest_stretch = worst.largest_stretch.max(largest.sqrt());
        };
        let elements = self.elements();
        for body in &elements.bodies {
            for (c, q) in &elements.quads[body.quads.clone()] {
                let [a, b, c, d] = c.map(|n| n as usize);
                take([x[a] - x[c], y[a] - y[c]], [x[b] - x[d], y[b] - y[d]], q.b1, q.b2, a);
            }
            for (c, t) in &elements.triangles[body.triangles.clone()] {
                let [a, b, c] = c.map(|n| n as usize);
                take([x[a] - x[c], y[a] - y[c]], [x[b] - x[c], y[b] - y[c]], t.b1, t.b2, a);
            }
        }
        worst
    }
}
