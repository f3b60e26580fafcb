//! Point contact of a ball in a groove, by the elliptic integrals themselves: the reference of closed forms
//! and fits.

use std::f64::consts::PI;

/// Complete elliptic integrals K and E of the square of the modulus, by the midpoint rule, which converges
/// exponentially for periodic functions.
fn elliptic(m: f64) -> [f64; 2] {
    const POINTS: usize = 2000;
    let root = |i: usize| (1.0 - m * (0.5 * PI * (i as f64 + 0.5) / POINTS as f64).sin().powi(2)).sqrt();
    let step = 0.5 * PI / POINTS as f64;
    [(0..POINTS).map(|i| step / root(i)).sum(), (0..POINTS).map(|i| step * root(i)).sum()]
}

/// Approach [m] of a ball and a raceway under the force `load` [N], for the radii [m] of the ball, of the
/// raceway in the plane of rotation (negative where the ball lies inside it) and of its groove; `modulus` is
/// E/(1 − ν²) [Pa].
///
/// Source: Johnson 1985, *Contact Mechanics*, equations 4.26 and 4.27, solved by bisection on the square of
/// the eccentricity: ½/R_beside = p₀/E* (b/a) (K − E)/(e² a), with p₀ = 3Q/(2πab) and E* = `modulus`/2.
pub fn ball_approach(ball: f64, race: f64, groove: f64, load: f64, modulus: f64) -> f64 {
    let (along, beside) = (1.0 / ball + 1.0 / race, 1.0 / ball - 1.0 / groove);
    let (mut low, mut high) = (0.0, 1.0 - 1e-6);
    for _ in 0..60 {
        let m = 0.5 * (low + high);
        let [k, e] = elliptic(m);
        if (e / (1.0 - m) - k) / (k - e) < along / beside { low = m } else { high = m }
    }
    let [k, e] = elliptic(low);
    let line = 1.5 * load / (PI * 0.5 * modulus);
    let a = (line * (k - e) / low / (0.5 * beside)).cbrt();
    line * k / a
}
