//! An end of a pocket's wall that presses on a roller (THEORY §9.4).

/// An end of a wall at the facet of a roller in the middle of its pocket. Its force depends on its depth in
/// the facet alone, whose gradient is the facet's normal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    /// Length of cage that its own point stands for [m].
    pub(crate) end: f64,
    /// The same of each further point of the wall [m], and how many there are.
    share: f64,
    points: usize,
    /// Depth decreases as `lean`·s + `bend`·s² with distance s from the corner: `lean` is the sine of the
    /// wall's inclination, `bend` [1/m] comes from the roundness of the roller.
    lean: f64,
    bend: f64,
    /// The wedge that the corner cuts from the facet presses with half of a pass's penalty times this and
    /// depth².
    wedge: f64,
}

impl Corner {
    /// `d` goes from the roller's centre to the corner, on the x axis the middle of the pocket, whose walls
    /// go along it, with the other side of the corner at a right angle. The wall has facets of the length
    /// `facet` with `points` each, or, collocated, one at either end.
    pub(crate) fn new(d: [f64; 2], facet: f64, points: Option<usize>) -> Self {
        let distance = libm::hypot(d[0], d[1]);
        let (cosine, sine) = ((d[1] / distance).abs().max(1e-3), (d[0] / distance).abs().max(1e-3));
        let (lean, bend) = (sine, 0.5 * cosine * cosine / distance);
        // The cut is depth (cot a + tan a) long, between sides at the angles a and 90° − a to the facet; what
        // is nearest to either presses along its normal. By the energy of all points, whose slope is along
        // that of the facet.
        let wedge = 1.0 / (sine * cosine * (sine + cosine).powi(2));
        match points {
            Some(n) => {
                let share = facet / n as f64;
                Self { end: 0.5 * share, share, points: n, lean, bend, wedge }
            }
            None => Self { end: facet, share: facet, points: 0, lean, bend, wedge },
        }
    }

    /// Force [N], stiffness [N/m] and stored energy [J] of a corner that is `depth` deep: of its own points,
    /// as far along the wall as they lie in the facet, and of those of the roller in the wedge that it cuts
    /// from it, each with half of the `penalty` [N/m²].
    #[inline(always)]
    pub(crate) fn press(&self, penalty: f64, depth: f64) -> [f64; 3] {
        let half = 0.5 * penalty;
        let cut = half * self.wedge * depth;
        let end = half * self.end;
        let mut sums = [depth * (end + 0.5 * cut), end + cut, depth * depth * (0.5 * end + cut / 6.0)];
        let point = half * self.share;
        for n in 0..self.points {
            let along = (n as f64 + 0.5) * self.share;
            let deep = depth - along * (self.lean + along * self.bend);
            if deep <= 0.0 {
                break;
            }
            sums[0] += point * deep;
            sums[1] += point;
            sums[2] += 0.5 * point * deep * deep;
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;

    /// The corner of the paper's cage in a roller of 112 facets, by all points of both.
    /// Source: the rules of THEORY §4.2 for the points and their weights.
    #[test]
    fn analytic_a_corner_presses_with_all_points_that_lie_in_the_roller() {
        const TOLERANCE: f64 = 0.03;
        const FACETS: usize = 112;
        let (radius, facet, points) = (9e-3_f64, 2e-3, 16);
        let d = [2.594e-3_f64, 8.722e-3];
        let corner = Corner::new(d, facet, Some(points));
        let towards = d[1].atan2(d[0]);
        let half_facet = PI / FACETS as f64;
        // How deep a place lies in a roller that is turned, and the direction of the facet there.
        let facet_at = |[x, y]: [f64; 2], phase: f64| {
            let from_middle = (y.atan2(x) - phase).rem_euclid(2.0 * half_facet) - half_facet;
            (radius * half_facet.cos() - x.hypot(y) * from_middle.cos(), y.atan2(x) - from_middle)
        };
        for deep in [10e-6, 20e-6, 40e-6, 60e-6] {
            let at = [(radius - deep) * towards.cos(), (radius - deep) * towards.sin()];
            let (turns, mut force, mut expected) = (24, 0.0, 0.0);
            for turn in 0..turns {
                let phase = 2.0 * half_facet * f64::from(turn) / f64::from(turns);
                force += corner.press(1.0, facet_at(at, phase).0.max(0.0))[0];
                let mut push = [0.0; 2];
                let mut add = |weight: f64, (gap, along): (f64, f64)| {
                    let pressed = 0.5 * weight * gap.max(0.0);
                    push = [push[0] + pressed * along.cos(), push[1] + pressed * along.sin()];
                };
                let share = facet / points as f64;
                add(0.5 * share, facet_at(at, phase));
                for n in 0..points {
                    add(share, facet_at([at[0] + (n as f64 + 0.5) * share, at[1]], phase));
                }
                // Points of the roller, by the side of the corner that is nearer.
                let length = 2.0 * radius * half_facet.sin();
                for (vertex, n) in (0..FACETS).flat_map(|vertex| (0..points).map(move |n| (vertex, n))) {
                    let middle = phase + TAU * (vertex as f64 + 0.5) / FACETS as f64;
                    let aside = length * ((n as f64 + 0.5) / points as f64 - 0.5);
                    let out = radius * half_facet.cos();
                    let [x, y] = [
                        out * middle.cos() - aside * middle.sin() - at[0],
                        out * middle.sin() + aside * middle.cos() - at[1],
                    ];
                    let along = if y < x { 0.5 * PI } else { 0.0 };
                    add(length / points as f64, (x.min(y), along));
                }
                expected += push[0].hypot(push[1]);
            }
            assert!((force / expected - 1.0).abs() < TOLERANCE, "{deep}: {force} {expected}");
        }
    }

    #[test]
    fn invariant_force_and_stiffness_are_slopes_of_what_is_stored() {
        let corner = Corner::new([2.594e-3, 8.722e-3], 2e-3, Some(16));
        for deep in [5e-6, 30e-6, 70e-6] {
            let step = 1e-9;
            let [low, here, high] = [deep - step, deep, deep + step].map(|depth| corner.press(1e12, depth));
            let slope = |n: usize| (high[n] - low[n]) / (2.0 * step);
            assert!((slope(2) / here[0] - 1.0).abs() < 1e-6 && (slope(0) / here[1] - 1.0).abs() < 1e-6);
        }
    }
}
