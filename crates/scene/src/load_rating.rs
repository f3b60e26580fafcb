//! Static load rating by ISO 76 from the dimensions of a bearing.

use crate::catalogue::{self, Element};
use crate::scene::Scene;

/// Basic static radial load rating of one row [N]: the load at which the most loaded contact reaches 4000 MPa
/// (rollers) or 4200 MPa (balls).
///
/// ```text
/// rollers   C₀ = 44 (1 − D_w/D_pw) Z L_we D_w
/// balls     C₀ = f₀ Z D_w²
/// ```
///
/// in mm, without contact angle. A bearing with the name of one of the catalogue's balls is rated as one, all
/// others as cylindrical rollers as long as the model is thick. Source: ISO 76:2006, 6.1 and 7.1, with f₀ of
/// its table 1.
pub fn static_rating_n(scene: &Scene) -> f64 {
    let b = &scene.bearing;
    let pitch = 0.5 * (b.outer_race_diameter_mm + b.inner_race_diameter_mm);
    let ratio = b.roller_diameter_mm / pitch;
    let rollers = b.rollers as f64;
    if is_ball_bearing(scene) {
        return balls_factor(ratio) * rollers * b.roller_diameter_mm.powi(2);
    }
    44.0 * (1.0 - ratio) * rollers * b.thickness_mm * b.roller_diameter_mm
}

/// Whether the scene's cylinders stand for balls.
pub fn is_ball_bearing(scene: &Scene) -> bool {
    let known = || catalogue::known().unwrap_or_else(|_| catalogue::all());
    let name = &scene.bearing.designation;
    !name.is_empty() && known().iter().any(|known| known.name == *name && known.element == Element::Ball)
}

/// f₀ of radial ball bearings over D_w/D_pw, ISO 76:2006, table 1, in steps of 0.01.
fn balls_factor(ratio: f64) -> f64 {
    const FACTORS: [f64; 41] = [
        14.7, 14.9, 15.1, 15.3, 15.5, 15.7, 15.9, 16.1, 16.3, 16.5, 16.4, 16.1, 15.9, 15.6, 15.4, 15.2, 14.9,
        14.7, 14.4, 14.2, 14.0, 13.7, 13.5, 13.2, 13.0, 12.8, 12.5, 12.3, 12.1, 11.8, 11.6, 11.4, 11.2, 10.9,
        10.7, 10.5, 10.3, 10.0, 9.8, 9.6, 9.4,
    ];
    let at = (100.0 * ratio).clamp(0.0, 40.0);
    let (low, part) = (at.floor() as usize, at.fract());
    let high = (low + 1).min(40);
    FACTORS[low] + part * (FACTORS[high] - FACTORS[low])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ratings printed by makers, with the bearing's own balls. Source: SKF, Rolling bearings (2018), deep
    /// groove ball bearings: C₀ of 6205 is 7.8 kN, of 6203 4.75 kN.
    #[test]
    fn peer_static_ratings_of_ball_bearings() {
        for (name, printed_n) in [("6205", 7_800.0), ("6203", 4_750.0)] {
            let scene = Scene::parse(&format!("(bearing: \"{name}\")"), "here").expect("known");
            let ours = static_rating_n(&scene);
            assert!((ours / printed_n - 1.0).abs() < 0.04, "{name}: {ours} N");
        }
    }

    /// By hand: 44 (1 − 7.5/39) 13 · 9 · 7.5 = 31.2 kN for 13 rollers 9 mm long and 7.5 mm thick (less a
    /// clearance of 32.5 µm, a fifth of a per cent).
    #[test]
    fn by_hand_static_rating_of_rollers() {
        let scene = Scene::parse("(bearing: \"NU 205\")", "here").expect("known");
        assert!((static_rating_n(&scene) / 31_185.0 - 1.0).abs() < 5e-3, "{}", static_rating_n(&scene));
    }
}
