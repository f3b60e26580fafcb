//! Approach of two bodies in point contact, after Hertz: a ball on its raceways.

use std::f64::consts::PI;

/// Radius of the grooves of raceways over the diameter of the balls [-]; 0.515 to 0.53 are usual.
pub const CONFORMITY: f64 = 0.52;

/// Approach [m] of a ball and a raceway under the force `load` [N]. `across` is the radius of the raceway in
/// the plane of rotation [m], negative where the ball lies inside it; `groove` that of its groove [m];
/// `modulus` is E/(1 − ν²) [Pa].
///
/// Source: Hamrock and Brewe 1983, *Simplified Solution for Stresses and Deformations*, J. Lubr. Technol.
/// 105, 171–177: fits of the elliptic integrals, within 2 % for balls in grooves.
pub fn approach(ball_radius: f64, across: f64, groove: f64, load: f64, modulus: f64) -> f64 {
    let Ellipse { ratio, ellipticity, second, radius } = Ellipse::of(ball_radius, across, groove);
    let first = 1.5277 + 0.6023 * libm::log(ratio);
    first * libm::cbrt(4.5 / (second * radius) * (load / (PI * ellipticity * modulus)).powi(2))
}

/// Half of the width of this contact across the raceway [m], its larger semi-axis.
///
/// Source: as [`approach`], whose D_y is twice this.
pub fn half_width(ball_radius: f64, across: f64, groove: f64, load: f64, modulus: f64) -> f64 {
    let Ellipse { ellipticity, second, radius, .. } = Ellipse::of(ball_radius, across, groove);
    libm::cbrt(6.0 * ellipticity.powi(2) * second * load * radius / (PI * modulus))
}

/// Largest pressure of this contact [Pa]: 3/2 of its mean over the ellipse.
///
/// Source: as [`approach`].
pub fn pressure(ball_radius: f64, across: f64, groove: f64, load: f64, modulus: f64) -> f64 {
    let half = half_width(ball_radius, across, groove, load, modulus);
    1.5 * load * Ellipse::of(ball_radius, across, groove).ellipticity / (PI * half * half)
}

/// Shape of a contact.
struct Ellipse {
    /// Of the radii of curvature across and along the raceway.
    ratio: f64,
    /// Of the semi-axes.
    ellipticity: f64,
    /// Elliptic integral of the second kind.
    second: f64,
    /// Of the curvature [m].
    radius: f64,
}

impl Ellipse {
    fn of(ball_radius: f64, across: f64, groove: f64) -> Self {
        let along = 1.0 / (1.0 / ball_radius + 1.0 / across);
        let beside = 1.0 / (1.0 / ball_radius - 1.0 / groove);
        let ratio = beside / along;
        Self {
            ratio,
            ellipticity: 1.0339 * libm::pow(ratio, 0.6360),
            second: 1.0003 + 0.5968 / ratio,
            radius: 1.0 / (1.0 / along + 1.0 / beside),
        }
    }
}

#[cfg(test)]
mod tests {
    use stribeck_testing::ball_approach;

    use super::*;

    /// Source: Johnson 1985, *Contact Mechanics*, equations 4.26 and 4.27, with the elliptic integrals
    /// themselves.
    #[test]
    fn analytic_a_ball_in_the_grooves_of_a_deep_groove_bearing() {
        const FIT: f64 = 0.02;
        let (ball, load, modulus) = (6.35e-3, 1000.0, 220e9);
        for race in [26.15e-3, -38.85e-3] {
            let groove = 2.0 * CONFORMITY * ball;
            let exact = ball_approach(ball, race, groove, load, modulus);
            let ours = approach(ball, race, groove, load, modulus);
            assert!((ours / exact - 1.0).abs() < FIT, "{ours:e} {exact:e}");
        }
    }

    /// A ball on a plane touches it in a circle of radius a³ = 3WR/4E*. Source: Johnson 1985, eq. 4.22.
    #[test]
    fn analytic_a_ball_on_a_plane_touches_it_in_a_circle() {
        // The fits of the elliptic integrals are within 3 % for a circle.
        const FIT: f64 = 0.03;
        let (ball, load, modulus): (f64, f64, f64) = (5e-3, 100.0, 220e9);
        let far = 1e9;
        let circle = (3.0 * load * ball / (4.0 * 0.5 * modulus)).cbrt();
        let ours = half_width(ball, far, -far, load, modulus);
        assert!((ours / circle - 1.0).abs() < FIT, "{ours:e} {circle:e}");
        // Its pressure is that of eq. 4.24, p₀³ = 6WE*²/π³R².
        let highest = (6.0 * load * (0.5 * modulus / ball).powi(2)).cbrt() / PI;
        let ours = pressure(ball, far, -far, load, modulus);
        assert!((ours / highest - 1.0).abs() < 2.0 * FIT, "{ours:e} {highest:e}");
    }
}
