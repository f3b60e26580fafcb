//! Facets of a closed outline about the origin.

/// A facet that takes less than this share of the mean angle is a wall.
const WALL: f64 = 0.05;

/// One over the angle that each facet takes, seen from the origin [1/rad]; 0 for walls, which run along a
/// radius. Vertices go counter-clockwise [m].
pub fn per_angle(vertices: &[[f64; 2]]) -> Vec<f64> {
    let n = vertices.len();
    (0..n)
        .map(|i| {
            let ([ax, ay], [bx, by]) = (vertices[i], vertices[(i + 1) % n]);
            let angle = libm::atan2(ax * by - ay * bx, ax * bx + ay * by);
            if angle > WALL * std::f64::consts::TAU / n as f64 { 1.0 / angle } else { 0.0 }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square with a step in one of its sides.
    #[test]
    fn by_hand_a_step_along_a_radius_is_a_wall() {
        let square = [[1.0, -1.0], [1.0, 0.0], [1.1, 0.0], [1.1, 1.1], [-1.0, 1.0], [-1.0, -1.0]];
        let per_angle = per_angle(&square);
        assert_eq!(per_angle[1], 0.0);
        assert!((per_angle[4] - 2.0 / std::f64::consts::PI).abs() < 1e-15, "{per_angle:?}");
        assert_eq!(per_angle.iter().filter(|per| **per == 0.0).count(), 1);
    }
}
