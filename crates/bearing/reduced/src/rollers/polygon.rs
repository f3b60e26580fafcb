//! The polygon of a roller in contact with walls and corners of the cage (THEORY §9.4).

use crate::plane::{Rotation, Vec2};

/// Half the length over which a vertex of a roller is rounded for corners of the cage, in facets. At a sharp
/// vertex the force of a corner jumps within a step, which changes the energy by the place of the jump in the
/// step; rounding over a tenth of a facet, which takes several steps, removes that, and a tenth of the
/// vertex's height.
const ROUNDED: f64 = 0.05;

/// Part of a roller beyond a flat, with the penetration p over the distance u from the foot of its
/// centre, counter-clockwise about it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Cut {
    /// ∫ p du [m²].
    pub(crate) area: f64,
    /// ∫ p² du [m³].
    pub(crate) square: f64,
    /// ∫ p u du [m³].
    pub(crate) first: f64,
    /// Length [m].
    pub(crate) length: f64,
}

impl Cut {
    /// Adds a part between two places u with these penetrations.
    #[inline(always)]
    pub(crate) fn add(&mut self, [u1, u2]: [f64; 2], [p1, p2]: [f64; 2]) {
        if p1 <= 0.0 && p2 <= 0.0 {
            return;
        }
        // Where p is zero.
        let root = || u1 + (u2 - u1) * p1 / (p1 - p2);
        let ([u1, u2], [p1, p2]) = match (p1 < 0.0, p2 < 0.0) {
            (true, _) => ([root(), u2], [0.0, p2]),
            (_, true) => ([u1, root()], [p1, 0.0]),
            _ => ([u1, u2], [p1, p2]),
        };
        let length = u2 - u1;
        self.area += 0.5 * length * (p1 + p2);
        self.square += length / 3.0 * (p1 * p1 + p1 * p2 + p2 * p2);
        self.first += length / 6.0 * (p1 * (u1 + u1 + u2) + p2 * (u1 + u2 + u2));
        self.length += length;
    }
}

/// A regular polygon about the origin with vertex 0 on the x axis, counter-clockwise.
#[derive(Debug, Clone)]
pub(crate) struct Polygon {
    /// Distance of the facets from the centre [m].
    apothem: f64,
    /// Half the angle of a facet, and its rounded part [rad].
    half: f64,
    rounded: f64,
    /// Directions of the middles of the facets.
    middles: Vec<[f64; 2]>,
    /// Cosine and sine of half the angle of a facet and of the whole, and the sine of the part of half of it
    /// that is not rounded.
    half_turn: [f64; 2],
    turn: [f64; 2],
    sine_sharp: f64,
}

impl Polygon {
    /// With `facets` facets and vertices on a circle of a radius [m].
    pub(crate) fn new(facets: usize, radius: f64) -> Self {
        let half = std::f64::consts::PI / facets as f64;
        let rounded = 2.0 * half * ROUNDED;
        let direction = |angle: f64| {
            let (s, c) = libm::sincos(angle);
            [c, s]
        };
        let middle = |facet: usize| direction(half * (2 * facet + 1) as f64);
        Self {
            apothem: radius * libm::cos(half),
            half,
            rounded,
            middles: (0..facets).map(middle).collect(),
            half_turn: direction(half),
            turn: direction(2.0 * half),
            sine_sharp: libm::sin(half - rounded),
        }
    }

    /// Depth of the point at `distance` from the centre in the direction `d` [m], and how far
    /// a metre along d and one across it, counter-clockwise, bring it outwards.
    #[inline(always)]
    pub(crate) fn depth(&self, d: [f64; 2], distance: f64) -> (f64, [f64; 2]) {
        let [cosine, sine] = self.beside_middle(d);
        // Most places are beside a middle, not beside a vertex: no sine has to be computed there.
        if sine.abs() <= self.sine_sharp {
            return (self.apothem - distance * cosine, [cosine, sine]);
        }
        // Beside a vertex the distance from it is that of a parabola, which is even there and goes on
        // smoothly.
        let tilt = libm::asin(sine);
        let from_vertex = self.half - tilt.abs();
        let smooth = 0.5 * (from_vertex * from_vertex / self.rounded + self.rounded);
        let (sine, cosine) = libm::sincos((self.half - smooth).copysign(tilt));
        (self.apothem - distance * cosine, [cosine, from_vertex / self.rounded * sine])
    }

    /// Length of a facet [m].
    pub(crate) fn facet(&self) -> f64 {
        2.0 * self.apothem * self.half_turn[1] / self.half_turn[0]
    }

    /// The part beyond a flat at `distance` from the centre, normal to the direction `d`.
    pub(crate) fn beyond(&self, d: [f64; 2], distance: f64) -> Cut {
        let mut cut = Cut::default();
        let middle = self.beside_middle(d);
        let radius = self.apothem / self.half_turn[0];
        // A vertex in the direction [cosine, sine] from d: its u, and how far it lies beyond the flat.
        let place = |[c, s]: [f64; 2]| [radius * s, radius * c - distance];
        let turned = |direction: Vec2, by: Vec2| Rotation::to(direction).forth(by);
        let back = |[c, s]: [f64; 2]| [c, -s];
        let ends = [turned(middle, back(self.half_turn)), turned(middle, self.half_turn)];
        let [[u1, p1], [u2, p2]] = ends.map(place);
        cut.add([u1, u2], [p1, p2]);
        // Facet by facet to either side, as long as the last vertex lies beyond the flat.
        for (end, forwards) in ends.into_iter().zip([false, true]) {
            let (mut vertex, mut at) = (end, place(end));
            while at[1] > 0.0 {
                vertex = turned(vertex, if forwards { self.turn } else { back(self.turn) });
                let next = place(vertex);
                let [first, last] = if forwards { [at, next] } else { [next, at] };
                cut.add([first[0], last[0]], [first[1], last[1]]);
                at = next;
            }
        }
        cut
    }

    /// Cosine and sine of the angle by which the middle of the facet there is ahead of a direction.
    #[inline(always)]
    fn beside_middle(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let count = self.middles.len();
        let mut facet = (rough_turns(x, y) * count as f64) as usize % count;
        // A whole turn at most, should nothing fit.
        for _ in 0..count {
            let [mx, my] = self.middles[facet];
            let sine = my * x - mx * y;
            if sine > self.half_turn[1] {
                facet = if facet == 0 { count - 1 } else { facet - 1 };
            } else if sine < -self.half_turn[1] {
                facet = if facet + 1 == count { 0 } else { facet + 1 };
            } else {
                return [mx * x + my * y, sine];
            }
        }
        [1.0, 0.0]
    }
}

/// The angle of a direction in turns from the x axis, to a thousandth: enough to begin a search with.
#[inline(always)]
fn rough_turns(x: f64, y: f64) -> f64 {
    let (across, along) = (x.abs().min(y.abs()), x.abs().max(y.abs()));
    let share = across / along;
    let eighth = share * (0.154_76 - 0.030_55 * share * share);
    let quarter = if x.abs() >= y.abs() { eighth } else { 0.25 - eighth };
    let half = if x >= 0.0 { quarter } else { 0.5 - quarter };
    if y >= 0.0 { half } else { 1.0 - half }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All around polygons of few and of many facets: beside a middle as deep as below the line through both
    /// vertices, beside a vertex less deep than that by no more than the vertex stands out by, at a vertex as
    /// deep as its parabola and even, and everywhere the gradient is that of the depth.
    /// Source: own, plane geometry.
    #[test]
    fn analytic_depths_are_those_below_facets_and_their_gradients_theirs() {
        let radius = 9e-3;
        for facets in [3, 7, 56, 112] {
            let polygon = Polygon::new(facets, radius);
            let facet = std::f64::consts::TAU / facets as f64;
            let apothem = radius * (0.5 * facet).cos();
            // At a vertex the depth is even.
            let (depth, [_, across]) = polygon.depth([1.0, 0.0], apothem);
            let parabola = apothem - apothem * (0.5 * (1.0 - ROUNDED) * facet).cos();
            assert!((depth - parabola).abs() < 1e-15 && across.abs() < 1e-12, "{facets} facets: {depth} m");
            for n in 0..5000 {
                let angle = std::f64::consts::TAU * (n as f64 + 0.37) / 5000.0 - std::f64::consts::PI;
                let distance = 0.9 * apothem;
                let at = |angle: f64, distance: f64| polygon.depth([angle.cos(), angle.sin()], distance);
                let (depth, [along, across]) = at(angle, distance);
                let tilt = (angle / facet - (angle / facet).floor() - 0.5) * facet;
                let below = apothem - distance * tilt.cos();
                if tilt.abs() < (0.5 - ROUNDED) * facet {
                    assert!((depth - below).abs() < 1e-15, "{facets} facets, {angle}: {depth} and {below} m");
                } else {
                    let sagged = distance * ((0.5 - ROUNDED) * facet).cos() - distance * (0.5 * facet).cos();
                    assert!(
                        (-1e-15..=sagged).contains(&(below - depth)),
                        "{facets} facets, {angle}: {depth} m"
                    );
                }
                let step = 1e-6;
                let outwards =
                    (at(angle, distance).0 - at(angle, distance + step * radius).0) / (step * radius);
                assert!((outwards - along).abs() < 1e-9, "{facets} facets, {angle}: {outwards} and {along}");
                let beside =
                    (at(angle - step, distance).0 - at(angle + step, distance).0) / (2.0 * step * distance);
                assert!((beside - across).abs() < 1e-4, "{facets} facets, {angle}: {beside} and {across}");
            }
        }
    }
}
