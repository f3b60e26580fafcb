//! A roller on a straight wall of its pocket: the part of it beyond the wall, in series with its local
//! compliance (THEORY §9.4).

use crate::modal::compliance::Curve;

use crate::rollers::polygon::{Cut, Polygon};

/// The shape that presses on a flat: a circle, or a polygon with the direction of its vertex 0 from the foot
/// of its centre.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape<'a> {
    Circle(f64),
    Polygon(&'a Polygon, [f64; 2]),
}

impl Shape<'_> {
    fn cut(self, distance: f64) -> Cut {
        match self {
            Self::Circle(radius) => circle(radius, radius - distance),
            Self::Polygon(polygon, d) => polygon.beyond(d, distance),
        }
    }
}

/// The part of a circle beyond a flat, which it crosses by `depth`.
fn circle(radius: f64, depth: f64) -> Cut {
    if depth <= 0.0 {
        return Cut::default();
    }
    let half = (2.0 * radius * depth).sqrt();
    let area = 4.0 / 3.0 * depth * half;
    Cut { area, square: 0.8 * depth * area, first: 0.0, length: 2.0 * half }
}

/// A roller that is pressed against a flat.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnFlat {
    /// Force [N], and its lever about the foot of the centre, counter-clockwise positive [m].
    pub(crate) force: f64,
    pub(crate) lever: f64,
    /// Length of the contact [m].
    pub(crate) length: f64,
    /// Share of an approach that the penalty spring takes [-].
    pub(crate) part: f64,
    /// Energy of penalty and compliance [J].
    pub(crate) stored: f64,
}

/// Most steps of Newton's method for the force, and the relative change at which it ends: the error is then
/// the square of this.
const STEPS: usize = 20;
const ENOUGH: f64 = 1e-6;

/// Force between a roller, `distance` from its centre to the flat, and the flat on a penalty [N/m²], where
/// `curve` is the compliance of the roller; `None` where they are clear of each other.
pub(crate) fn press(shape: Shape<'_>, distance: f64, penalty: f64, curve: &Curve) -> Option<OnFlat> {
    let mut cut = shape.cut(distance);
    if cut.area <= 0.0 {
        return None;
    }
    // From the penalty alone, which is too much. The first step may go past the force, those after it come to
    // it from one side.
    let mut force = penalty * cut.area;
    let mut flexibility = 0.0;
    for _ in 0..STEPS {
        let ([deflection, slope], _) = curve.approach(force);
        cut = shape.cut(distance + deflection);
        flexibility = slope;
        let by = (penalty * cut.area - force) / (1.0 + penalty * cut.length * slope);
        force = (force + by).max(0.0);
        if by.abs() <= ENOUGH * force {
            break;
        }
    }
    let lever = if cut.area > 0.0 { cut.first / cut.area } else { 0.0 };
    let part = 1.0 / (1.0 + penalty * cut.length * flexibility);
    let stored = 0.5 * penalty * cut.square + curve.energy(force);
    Some(OnFlat { force, lever, length: cut.length, part, stored })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modal::compliance::Compliance;

    const RADIUS: f64 = 9e-3;
    const PENALTY: f64 = 2e12;

    fn soft() -> Curve {
        Compliance::through(&[10.0, 1e3, 1e4], &[2e-8, 2e-6, 1.8e-5], 48).curve()
    }

    /// Of many facets it is the circle: 4/3 p √(2Rp), the chord of which is the contact; of few it is the sum
    /// along the outline.
    /// Source: own, plane geometry.
    #[test]
    fn analytic_what_lies_beyond_a_flat_is_that_of_the_outline() {
        let depth = 8e-6;
        let fine = Polygon::new(20_000, RADIUS).beyond([0.6, 0.8], RADIUS - depth);
        let round = circle(RADIUS, depth);
        for (a, b) in [(fine.area, round.area), (fine.square, round.square), (fine.length, round.length)] {
            assert!((a / b - 1.0).abs() < 1e-3, "{a} and {b}");
        }
        for (facets, angle) in [(112, 0.0_f64), (112, 0.013), (112, 1.234), (24, 0.1), (7, 2.0)] {
            let polygon = Polygon::new(facets, RADIUS);
            let facet = std::f64::consts::TAU / facets as f64;
            let distance = RADIUS * (0.5 * facet).cos() - depth;
            let found = polygon.beyond([angle.cos(), angle.sin()], distance);
            // Places along the facets, in the frame of the flat.
            let (mut area, mut first) = (0.0, 0.0);
            for n in 0..facets {
                let vertex = |n: usize| {
                    let at = facet * n as f64 - angle;
                    [RADIUS * at.sin(), RADIUS * at.cos() - distance]
                };
                let ([u1, p1], [u2, p2]) = (vertex(n), vertex(n + 1));
                let parts = 4000;
                for k in 0..parts {
                    let share = (f64::from(k) + 0.5) / f64::from(parts);
                    let (u, p) = (u1 + share * (u2 - u1), p1 + share * (p2 - p1));
                    // The far side of the roller lies behind.
                    if p > 0.0 && u2 > u1 {
                        area += p * (u2 - u1) / f64::from(parts);
                        first += p * u * (u2 - u1) / f64::from(parts);
                    }
                }
            }
            assert!((found.area / area - 1.0).abs() < 1e-3, "{facets}, {angle}: {} and {area}", found.area);
            assert!(
                (found.first - first).abs() < 1e-3 * area * RADIUS,
                "{facets}, {angle}: {found:?}, {first}"
            );
        }
    }

    /// Force and lever are the slopes of the energy, by the distance and by a turn of the roller.
    /// Source: own, the force of a spring is the slope of its energy.
    #[test]
    fn analytic_force_and_moment_on_a_flat_are_slopes_of_the_energy() {
        let curve = soft();
        for (facets, depth) in [(112, 2e-6), (112, 12e-6), (56, 20e-6)] {
            let polygon = Polygon::new(facets, RADIUS);
            let facet = std::f64::consts::TAU / facets as f64;
            for turn in [0.1, 0.3, 0.48, 0.7, 0.9] {
                let at = |turn: f64, distance: f64| {
                    let angle = -turn * facet;
                    press(Shape::Polygon(&polygon, [angle.cos(), angle.sin()]), distance, PENALTY, &curve)
                        .expect("it touches")
                };
                let distance = RADIUS * (0.5 * facet).cos() - depth;
                let (h, found) = (1e-10, at(turn, distance));
                let force = (at(turn, distance - h).stored - at(turn, distance + h).stored) / (2.0 * h);
                assert!((force / found.force - 1.0).abs() < 1e-4, "{force} and {}", found.force);
                let h = 1e-6;
                let moment =
                    (at(turn + h, distance).stored - at(turn - h, distance).stored) / (2.0 * h * facet);
                // A turn lowers the part ahead of the foot, with the force on it.
                let expected = -found.force * found.lever;
                let size = found.force * RADIUS * facet;
                assert!((moment - expected).abs() < 1e-4 * size, "{moment} and {expected} N m");
            }
        }
        let circle = press(Shape::Circle(RADIUS), RADIUS - 5e-6, PENALTY, &curve).expect("it touches");
        let h = 1e-10;
        let of = |distance: f64| {
            press(Shape::Circle(RADIUS), distance, PENALTY, &curve).expect("it touches").stored
        };
        let force = (of(RADIUS - 5e-6 - h) - of(RADIUS - 5e-6 + h)) / (2.0 * h);
        assert!((force / circle.force - 1.0).abs() < 1e-4 && circle.lever == 0.0);
        assert!(press(Shape::Circle(RADIUS), RADIUS, PENALTY, &curve).is_none());
    }
}
