//! Static load rating by ISO 76 from the dimensions of a bearing.

use crate::bearing::Dimensions;
use crate::catalogue::Element;

/// Basic static radial load rating of one row [N]: the load at which the most loaded contact reaches 4000 MPa
/// (rollers) or 4200 MPa (balls).
///
/// ```text
/// rollers   C₀ = 44 (1 − D_w/D_pw) Z L_we D_w
/// balls     C₀ = f₀ Z D_w²
/// ```
///
/// in mm, without contact angle, for rollers as long as `length_mm`. Source: ISO 76:2006, 6.1 and 7.1, with f₀
/// of its table 1.
pub fn static_rating_n(bearing: impl Into<Dimensions>, element: Element, length_mm: f64) -> f64 {
    let bearing = bearing.into();
    let (d, rollers) = (bearing.roller_mm, bearing.rollers as f64);
    let ratio = d / bearing.pitch_mm();
    match element {
        Element::Ball => balls_factor(ratio) * rollers * d.powi(2),
        Element::Roller => 44.0 * (1.0 - ratio) * rollers * length_mm * d,
    }
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
    use crate::catalogue::CatalogueBearing;

    fn rating(name: &str, length_mm: f64) -> f64 {
        let b = CatalogueBearing::parse(name).expect("known");
        let (outer_race_mm, inner_race_mm) = (b.pitch_mm + b.diameter_mm, b.pitch_mm - b.diameter_mm);
        let rollers = b.elements.expect("given") as usize;
        let dimensions = Dimensions { outer_race_mm, inner_race_mm, roller_mm: b.diameter_mm, rollers };
        static_rating_n(dimensions, b.element, length_mm)
    }

    /// Ratings printed by makers, with the bearing's own balls. Source: SKF, Rolling bearings (2018), deep
    /// groove ball bearings: C₀ of 6205 is 7.8 kN, of 6203 4.75 kN.
    #[test]
    fn peer_static_ratings_of_ball_bearings() {
        for (name, printed_n) in [("6205", 7_800.0), ("6203", 4_750.0)] {
            let ours = rating(name, 0.0);
            assert!((ours / printed_n - 1.0).abs() < 0.04, "{name}: {ours} N");
        }
    }

    /// By hand: 44 (1 − 7.5/39) 13 · 9 · 7.5 = 31.2 kN for 13 rollers 9 mm long and 7.5 mm thick.
    #[test]
    fn by_hand_static_rating_of_rollers() {
        let ours = rating("NU 205, elements=13", 9.0);
        assert!((ours / 31_185.0 - 1.0).abs() < 1e-4, "{ours}");
    }
}
