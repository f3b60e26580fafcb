//! Shape optimisation: interior nodes move, smoothly, until the critical time step of the assembled elements
//! is long enough.

use std::collections::BTreeSet;

use crate::Part;
use crate::part::signed_area;
use crate::submesh::{Submesh, add, dot};

/// ω² of endless squares with sides of the unit of length, see [`Submesh`].
const GRID_WAVE: f64 = 4.0;

/// Weight of smoothness against frequencies that are too high.
const SMOOTHNESS: f64 = 1e-2;

/// Sine of the sharpest or flattest corner of a quadrilateral that costs nothing, and the weights of less:
/// the next one where corners stay turned over with the one before.
const SINE: f64 = 0.03;
pub(crate) const SHARPNESS: [f64; 3] = [3.0, 30.0, 300.0];

/// Step of central differences, relative to the side of a square.
const STEP: f64 = 1e-6;

const STEPS: usize = 150;

/// The search ends when a step lowers the cost by less than this share of it.
const GAIN: f64 = 1e-7;

/// Pairs of steps and changes of the gradient from which the search knows the curvature.
const MEMORY: usize = 10;

/// Share of the decrease promised by the gradient that a step must bring.
const ARMIJO: f64 = 1e-4;

/// Moves nodes so that all natural frequencies of the assembled elements come below that of endless squares
/// with sides of `length` [m], and their displacements from `plain`, the same mesh with straight rows, vary
/// smoothly (THEORY §2.4).
///
/// The cost is Σ (ω²/ω₀² − 1)² over the modes with ω > ω₀, plus small multiples of Σ |Δd|² and of what
/// corners are too sharp or too flat; d is the displacement of a node over `length` and Δd what its
/// neighbours' mean differs from it: a plate that is bent as little as the frequencies allow. An element
/// alone says little about the time step: one that is too small among large ones vibrates no faster than
/// squares, because its nodes carry their mass. Quasi-Newton steps (L-BFGS). Goes on with the next weight of
/// `sharpness` while some element stays inside out; returns the cost reached, by the first of [`SHARPNESS`],
/// and `None` when some stay so: areas stay positive, but a corner may turn over.
///
/// Source: J. Nocedal and S. J. Wright, *Numerical Optimization*, 2nd ed., 2006, algorithms 3.1 and 7.4.
pub(crate) fn raise_assembled_step(
    part: &mut Part,
    plain: &Part,
    movable: &[bool],
    poisson: f64,
    length: f64,
    sharpness: &[f64],
) -> Option<f64> {
    let submesh = Submesh::new(part, movable, poisson, length);
    if submesh.movable == 0 {
        return Some(0.0);
    }
    let in_units = |part: &Part, n: u32| [part.x[n as usize] / length, part.y[n as usize] / length];
    let mut at: Vec<[f64; 2]> = submesh.nodes.iter().map(|n| in_units(part, *n)).collect();
    let plain = submesh.nodes.iter().map(|n| in_units(plain, *n)).collect();
    let mut objective = Objective { stencils: stencils(part, &submesh), submesh, plain, sharpness: 0.0 };
    for weight in sharpness {
        objective.sharpness = *weight;
        at = objective.minimise(at);
        for (n, [x, y]) in objective.submesh.nodes.iter().zip(&at).take(objective.submesh.movable) {
            (part.x[*n as usize], part.y[*n as usize]) = (length * x, length * y);
        }
        if !objective.submesh.is_tangled(part) {
            objective.sharpness = SHARPNESS[0];
            return objective.cost(at).map(|found| found.cost);
        }
    }
    None
}

/// A node and its neighbours, for the smoothness at the node.
struct Stencil {
    node: usize,
    around: Vec<usize>,
}

/// Interior nodes of the submesh that are movable or next to such a node.
fn stencils(part: &Part, submesh: &Submesh) -> Vec<Stencil> {
    let boundary: BTreeSet<u32> = part.surfaces.iter().flat_map(|(_, s)| s.nodes.iter().copied()).collect();
    let mut around = vec![BTreeSet::new(); submesh.nodes.len()];
    for corners in &submesh.elements {
        for i in 0..4 {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            if a != b {
                around[a].insert(b);
                around[b].insert(a);
            }
        }
    }
    let moves = |node: usize| node < submesh.movable || around[node].iter().any(|n| *n < submesh.movable);
    let inner = |node: usize| !boundary.contains(&submesh.nodes[node]);
    let wanted = (0..submesh.nodes.len()).filter(|n| moves(*n) && inner(*n));
    wanted.map(|node| Stencil { node, around: around[node].iter().copied().collect() }).collect()
}

struct Objective {
    submesh: Submesh,
    stencils: Vec<Stencil>,
    plain: Vec<[f64; 2]>,
    /// Weight of what corners are too sharp or too flat.
    sharpness: f64,
}

/// Positions, their cost and its derivative with respect to those of movable nodes.
struct Evaluation {
    at: Vec<[f64; 2]>,
    cost: f64,
    slope: Vec<f64>,
}

impl Objective {
    /// None when an element has no positive area.
    fn cost(&self, at: Vec<[f64; 2]>) -> Option<Evaluation> {
        // Corners may turn over on the way; `flatness` turns most of them back.
        let mut elements = self.submesh.elements[..self.submesh.moving].iter();
        if !elements.all(|corners| signed_area(&corners.map(|n| at[n])) > 0.0) {
            return None;
        }
        let modes = self.submesh.modes_above(GRID_WAVE, &at);
        let excess: Vec<f64> = modes.iter().map(|m| m.square / GRID_WAVE - 1.0).collect();
        let mut cost: f64 = excess.iter().map(|e| e * e).sum();
        let weighted: Vec<_> = excess.iter().map(|e| 2.0 * e / GRID_WAVE).zip(modes).collect();
        let mut slope = self.submesh.derivative(&weighted, &at);
        for Stencil { node, around } in &self.stencils {
            let share = 1.0 / around.len() as f64;
            for k in 0..2 {
                let moved = |n: usize| at[n][k] - self.plain[n][k];
                let bent = share * around.iter().map(|n| moved(*n)).sum::<f64>() - moved(*node);
                cost += SMOOTHNESS * bent * bent;
                slope[*node][k] -= 2.0 * SMOOTHNESS * bent;
                around.iter().for_each(|n| slope[*n][k] += 2.0 * SMOOTHNESS * share * bent);
            }
        }
        for corners in &self.submesh.elements[..self.submesh.moving] {
            let here = corners.map(|n| at[n]);
            let flatness = self.flatness(&here);
            if flatness == 0.0 {
                continue;
            }
            cost += flatness;
            for c in 0..4 {
                for k in 0..2 {
                    let (mut more, mut less) = (here, here);
                    more[c][k] += STEP;
                    less[c][k] -= STEP;
                    slope[corners[c]][k] += (self.flatness(&more) - self.flatness(&less)) / (2.0 * STEP);
                }
            }
        }
        let slope = slope[..self.submesh.movable].as_flattened().to_vec();
        Some(Evaluation { at, cost, slope })
    }

    /// Σ (s₀ − s)² over the corners whose sine s is below s₀, with its weight; that of a triangle is zero.
    fn flatness(&self, points: &[[f64; 2]; 4]) -> f64 {
        let corner = |i: usize| {
            let ([x, y], [x1, y1], [x2, y2]) = (points[i], points[(i + 1) % 4], points[(i + 3) % 4]);
            let (ax, ay, bx, by) = (x1 - x, y1 - y, x2 - x, y2 - y);
            let sine = (ax * by - ay * bx) / ((ax * ax + ay * ay) * (bx * bx + by * by)).sqrt();
            self.sharpness * (SINE - sine).max(0.0).powi(2)
        };
        if points[2] == points[3] { 0.0 } else { (0..4).map(corner).sum() }
    }

    /// Positions of less cost than `start`, or `start`.
    fn minimise(&self, start: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
        let Some(mut best) = self.cost(start.clone()) else { return start };
        let mut pairs: Vec<(Vec<f64>, Vec<f64>, f64)> = Vec::new();
        for _ in 0..STEPS {
            let mut along = search_direction(&best.slope, &pairs);
            let mut promise = dot(&along, &best.slope);
            if promise >= 0.0 {
                pairs.clear();
                along = search_direction(&best.slope, &pairs);
                promise = dot(&along, &best.slope);
            }
            let Some(next) = self.line_search(&best, &along, promise) else {
                if pairs.is_empty() {
                    break;
                }
                // What is remembered of the curvature misleads where another mode has become the highest.
                pairs.clear();
                continue;
            };
            let gain = (best.cost - next.cost) / best.cost;
            let positions = next.at.as_flattened().iter().zip(best.at.as_flattened());
            let moved: Vec<f64> = positions.take(next.slope.len()).map(|(a, b)| a - b).collect();
            let turned: Vec<f64> = next.slope.iter().zip(&best.slope).map(|(a, b)| a - b).collect();
            let curvature = dot(&moved, &turned);
            if curvature > 0.0 {
                if pairs.len() == MEMORY {
                    pairs.remove(0);
                }
                pairs.push((moved, turned, curvature));
            }
            best = next;
            if gain < GAIN {
                break;
            }
        }
        best.at
    }

    /// The first of ever shorter steps that lowers the cost enough.
    fn line_search(&self, from: &Evaluation, along: &[f64], promise: f64) -> Option<Evaluation> {
        let mut scale = 1.0;
        for _ in 0..20 {
            let mut at = from.at.clone();
            at.as_flattened_mut().iter_mut().zip(along).for_each(|(x, d)| *x += scale * d);
            if let Some(next) = self.cost(at)
                && next.cost <= from.cost + ARMIJO * scale * promise
            {
                return Some(next);
            }
            scale *= 0.5;
        }
        None
    }
}

/// Minus the slope times the inverse of the curvature that the pairs of steps and changes of slope
/// approximate.
fn search_direction(slope: &[f64], pairs: &[(Vec<f64>, Vec<f64>, f64)]) -> Vec<f64> {
    let mut along: Vec<f64> = slope.iter().map(|g| -g).collect();
    let mut parts = Vec::new();
    for (moved, turned, curvature) in pairs.iter().rev() {
        let part = dot(moved, &along) / curvature;
        add(&mut along, -part, turned);
        parts.push(part);
    }
    // Without a pair the first step is at most a tenth of a side.
    let scale = match pairs.last() {
        Some((_, turned, curvature)) => curvature / dot(turned, turned),
        None => 0.1 / along.iter().fold(f64::MIN_POSITIVE, |a, b| a.max(b.abs())),
    };
    along.iter_mut().for_each(|v| *v *= scale);
    for ((moved, turned, curvature), part) in pairs.iter().zip(parts.into_iter().rev()) {
        let back = dot(turned, &along) / curvature;
        add(&mut along, part - back, moved);
    }
    along
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use crate::{Annulus, Circle, Grading, Groove, Part, submesh::Submesh};

    const POISSON: f64 = 0.3;

    /// Length of the squares that vibrate as fast as the part does near the groove, over `side`.
    fn assembled_length(part: &Part, groove: &Groove, side: f64) -> f64 {
        let half = 0.5 * groove.length + 12.0 * side;
        let (sin, cos) = libm::sincos(groove.centre_angle);
        let near = |(x, y): (&f64, &f64)| x * cos + y * sin > 0.0 && (y * cos - x * sin).abs() < half;
        let near: Vec<bool> = part.x.iter().zip(&part.y).map(near).collect();
        let submesh = Submesh::new(part, &near, POISSON, side);
        let at: Vec<[f64; 2]> =
            submesh.nodes.iter().map(|n| [part.x[*n as usize] / side, part.y[*n as usize] / side]).collect();
        2.0 / submesh.modes_above(0.0, &at)[0].square.sqrt()
    }

    /// Each of several grooves is shaped by itself: beside others, around a ring and as close as two may
    /// be, one costs as much as alone.
    #[test]
    fn behaves_several_grooves_keep_the_time_step_of_one() {
        let at = |angle, depth| Groove::rectangular(angle, 0.01, depth);
        let eight: Vec<Groove> = (0..8).map(|k| at(0.1 + k as f64 * TAU / 8.0, 0.2e-3)).collect();
        let two = vec![at(0.5, 3e-3), at(0.72, 3e-3)];
        let ring = |grooves: &[Groove]| {
            let (inner_radius, outer_radius, grooves) = (0.1, 0.11, grooves.to_vec());
            let (facets, layers, start_angle) = (628, 10, 0.0);
            let ring = Annulus { inner_radius, outer_radius, facets, layers, start_angle, grooves };
            ring.part().expect("grooves that can be cut")
        };
        for grooves in [eight, two] {
            let all = ring(&grooves);
            for groove in &grooves[..2] {
                let kept = |part| assembled_length(part, groove, 1e-3);
                let (alone, beside) = (kept(&ring(&[*groove])), kept(&all));
                assert!(
                    beside > 0.98 * alone,
                    "{groove:?}: {beside:.3} of the length of squares, alone {alone:.3}"
                );
            }
        }
    }

    /// A wall of 0.2 mm among cells of 0.5 mm costs a tenth of the time step of squares, among cells of 1 mm
    /// an eighth, where columns that follow it straight would cost four tenths; short grooves cost up to a
    /// fifth, deep ones a third.
    #[test]
    fn behaves_grooves_keep_the_time_step() {
        let graded = Grading { fine: Circle::Inner, fine_layers: 2, transitions: 1 };
        for (mesh, (facets, layers)) in [(1257, 20), (628, 10)].into_iter().enumerate() {
            for (length, depth, least) in [
                (0.01, 0.2e-3, [0.89, 0.87]),
                (0.01, 0.05e-3, [0.89, 0.87]),
                (0.001, 0.2e-3, [0.88, 0.79]),
                (0.04, 0.5e-3, [0.89; 2]),
                (0.01, 1e-3, [0.89; 2]),
                (0.02, 3e-3, [0.69; 2]),
            ] {
                let groove = Groove::rectangular(0.25 * TAU, length, depth);
                let (inner_radius, outer_radius) = (0.1, 0.11);
                let grooves = vec![groove];
                let ring = Annulus { inner_radius, outer_radius, facets, layers, start_angle: 0.0, grooves };
                for part in [ring.part(), ring.graded_part(&graded)] {
                    let part = part.expect("a groove that can be cut");
                    let kept = assembled_length(&part, &groove, 0.01 / layers as f64);
                    assert!(
                        kept > least[mesh],
                        "{facets} facets, {groove:?}: {kept:.3} of the length of squares"
                    );
                }
            }
        }
    }
}
