//! Mesh smoothing: interior nodes move, one by one, until the smallest cells are larger.

use crate::Part;
use crate::characteristic::{characteristic_length, smallest_sine};
use crate::error::Error;
use crate::part::signed_area;

/// Powers of the sum that stands for the smallest length, used one after the other. The larger the power, the
/// more the worst element counts; a small one first moves its neighbours before they get stuck.
const POWERS: [i32; 3] = [6, 12, 20];

/// Sine of the sharpest corner angle that is not penalised. The one-point length sees only the diagonals
/// and would accept a quadrilateral that is nearly a triangle.
const SINE: f64 = 0.4;

/// Scores, relative to the longest edge, below which only the way out matters: the element is inside out or
/// nearly so, and its corner area shows the direction.
const FLOOR: f64 = 1e-3;

/// First step of the search, as a fraction of the longest edge at the node, and the factor below which a
/// step is given up.
const FIRST_STEP: f64 = 0.125;
const LAST_STEP: f64 = 1.0 / 512.0;

/// Directions that are tried: along the axes and the diagonals.
const DIRECTIONS: [[f64; 2]; 8] =
    [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [0.7, 0.7], [-0.7, 0.7], [-0.7, -0.7], [0.7, -0.7]];

/// Score at which cells of a graded mesh need not grow, relative to a fine square: a little more than one, so
/// that the worst cell, which falls short of it, is no smaller than in a mesh of fine cells only.
const ENOUGH: f64 = 1.1;

/// Poisson's ratio for which that square is measured; only the ratio of lengths matters, and hardly depends
/// on it.
const POISSON: f64 = 0.3;

/// Score [m] that cells need not exceed in a mesh whose finest cells are squares of this side [m].
pub(crate) fn enough(side: f64) -> f64 {
    ENOUGH * score(&[[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]], POISSON)
}

/// Moves nodes by pattern search so that the smallest characteristic length grows.
///
/// Each movable node in turn tries eight directions and keeps the first move that lowers Σ (1/s)^p over its
/// elements, where s is the characteristic length, reduced when the sine of a corner angle is below 0.4. A
/// node that finds nothing halves its step; a node that moves lengthens it and that of its neighbours.
/// Elements that are inside out are turned back where that is possible. The power p is 6, then 12, then 20.
///
/// `movable` has one entry per node; nodes beyond its end stay. The order is fixed, so equal input gives
/// equal output. Each power gets at most `sweeps` passes and ends when no step is left. `poisson` as in
/// [`characteristic_length`].
pub fn raise_critical_step(part: &mut Part, movable: &[bool], poisson: f64, sweeps: usize) {
    raise_critical_step_to(f64::INFINITY, part, movable, poisson, sweeps);
}

/// The same, but cells of the score `enough` [m] or more are left alone: among cells of different sizes the
/// small ones would otherwise grow at the cost of large ones, and the mesh would no longer be fine where it
/// should be.
pub(crate) fn raise_critical_step_to(
    enough: f64,
    part: &mut Part,
    movable: &[bool],
    poisson: f64,
    sweeps: usize,
) {
    let Some(mut search) = Search::new(part, movable, poisson) else { return };
    search.enough = enough;
    for power in POWERS {
        search.start(power);
        for _ in 0..sweeps {
            if !search.sweep(part) {
                break;
            }
        }
    }
}

struct Search {
    poisson: f64,
    /// Score beyond which an element costs no less [m].
    enough: f64,
    power: i32,
    /// Length that makes the costs plain numbers [m].
    scale: f64,
    nodes: Vec<Mover>,
    /// Position of a node in `nodes`, or `u32::MAX`.
    mover_of: Vec<u32>,
}

struct Mover {
    node: usize,
    /// Elements at the node: quadrilaterals, then triangles.
    quads: Vec<u32>,
    triangles: Vec<u32>,
    first_step: f64,
    step: f64,
}

impl Search {
    fn new(part: &Part, movable: &[bool], poisson: f64) -> Option<Search> {
        let mut mover_of = vec![u32::MAX; part.x.len()];
        let mut nodes = Vec::new();
        for node in (0..part.x.len().min(movable.len())).filter(|n| movable[*n]) {
            mover_of[node] = nodes.len() as u32;
            nodes.push(Mover { node, quads: vec![], triangles: vec![], first_step: 0.0, step: 0.0 });
        }
        for (e, corners) in part.quads.iter().enumerate() {
            for n in corners.iter().filter(|n| mover_of[**n as usize] != u32::MAX) {
                nodes[mover_of[*n as usize] as usize].quads.push(e as u32);
            }
        }
        for (e, corners) in part.triangles.iter().enumerate() {
            for n in corners.iter().filter(|n| mover_of[**n as usize] != u32::MAX) {
                nodes[mover_of[*n as usize] as usize].triangles.push(e as u32);
            }
        }
        nodes.retain(|m| !(m.quads.is_empty() && m.triangles.is_empty()));
        let mut scale: f64 = 0.0;
        for (i, mover) in nodes.iter_mut().enumerate() {
            mover_of[mover.node] = i as u32;
            let mut longest: f64 = 0.0;
            for q in &mover.quads {
                longest = longest.max(longest_edge(&part.corners(&part.quads[*q as usize])));
            }
            for t in &mover.triangles {
                longest = longest.max(longest_edge(&part.corners(&part.triangles[*t as usize])));
            }
            mover.first_step = FIRST_STEP * longest;
            mover.step = mover.first_step;
            scale = scale.max(longest);
        }
        (!nodes.is_empty()).then_some(Search {
            poisson,
            enough: f64::INFINITY,
            power: POWERS[0],
            scale,
            nodes,
            mover_of,
        })
    }

    /// Gives every node its first step again, for a new power.
    fn start(&mut self, power: i32) {
        self.power = power;
        self.nodes.iter_mut().for_each(|m| m.step = m.first_step);
    }

    /// One pass over the nodes; says whether any node still has a step left.
    fn sweep(&mut self, part: &mut Part) -> bool {
        let mut alive = false;
        for i in 0..self.nodes.len() {
            if self.nodes[i].step < LAST_STEP * self.nodes[i].first_step {
                continue;
            }
            alive = true;
            if self.try_directions(part, i) {
                let mover = &mut self.nodes[i];
                mover.step = (2.0 * mover.step).min(mover.first_step);
                self.lengthen_steps_around(part, i);
            } else {
                self.nodes[i].step *= 0.5;
            }
        }
        alive
    }

    /// Moves a node along the first direction that lowers its cost.
    fn try_directions(&self, part: &mut Part, mover: usize) -> bool {
        let mover = &self.nodes[mover];
        let (n, step) = (mover.node, mover.step);
        let (x, y) = (part.x[n], part.y[n]);
        // A gain in the last digits would keep the search alive for nothing.
        let before = self.cost(part, mover) * (1.0 - 1e-6);
        for [dx, dy] in DIRECTIONS {
            (part.x[n], part.y[n]) = (x + dx * step, y + dy * step);
            if self.cost(part, mover) < before {
                return true;
            }
        }
        (part.x[n], part.y[n]) = (x, y);
        false
    }

    fn lengthen_steps_around(&mut self, part: &Part, mover: usize) {
        let step = 0.5 * self.nodes[mover].step;
        let quads = self.nodes[mover].quads.iter().flat_map(|q| part.quads[*q as usize]);
        let triangles = self.nodes[mover].triangles.iter().flat_map(|t| part.triangles[*t as usize]);
        let around: Vec<u32> = quads.chain(triangles).map(|n| self.mover_of[n as usize]).collect();
        for m in around.into_iter().filter(|m| *m != u32::MAX && *m as usize != mover) {
            let neighbour = &mut self.nodes[m as usize];
            neighbour.step = neighbour.step.max(step.min(neighbour.first_step));
        }
    }

    fn cost(&self, part: &Part, mover: &Mover) -> f64 {
        let quads = mover.quads.iter().map(|q| self.element(&part.corners(&part.quads[*q as usize])));
        let triangles =
            mover.triangles.iter().map(|t| self.element(&part.corners(&part.triangles[*t as usize])));
        quads.sum::<f64>() + triangles.sum::<f64>()
    }

    fn element(&self, corners: &[[f64; 2]]) -> f64 {
        let score = score(corners, self.poisson).min(self.enough) / self.scale;
        if score > FLOOR {
            return score.powi(-self.power);
        }
        // A corner area lies within ±½ of the square of the longest edge, so this stays above every cost of
        // an element that is in order.
        FLOOR.powi(-self.power) * (2.0 - smallest_corner_area(corners) / (self.scale * self.scale))
    }
}

/// Characteristic length, reduced in proportion when a corner is too sharp or too flat [m].
pub(crate) fn score(corners: &[[f64; 2]], poisson: f64) -> f64 {
    let sine = smallest_sine(corners);
    if sine <= 0.0 {
        return 0.0;
    }
    characteristic_length(corners, poisson) * (sine / SINE).min(1.0)
}

/// Smallest signed area spanned by the two edges at a corner [m²]; positive for a convex element.
pub(crate) fn smallest_corner_area(corners: &[[f64; 2]]) -> f64 {
    let n = corners.len();
    let area = |i: usize| signed_area(&[corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]]);
    (0..n).map(area).fold(f64::INFINITY, f64::min)
}

fn longest_edge(corners: &[[f64; 2]]) -> f64 {
    let n = corners.len();
    let edge = |i: usize| {
        let ([x1, y1], [x2, y2]) = (corners[i], corners[(i + 1) % n]);
        libm::hypot(x2 - x1, y2 - y1)
    };
    (0..n).map(edge).fold(0.0, f64::max)
}

/// The element whose smallest corner area is not positive or infinite, if there is one, and that area [m²].
/// Quadrilaterals are numbered first.
pub(crate) fn inside_out(part: &Part) -> Option<(usize, f64)> {
    let quads = part.quads.iter().map(|q| smallest_corner_area(&part.corners(q)));
    let triangles = part.triangles.iter().map(|t| smallest_corner_area(&part.corners(t)));
    quads.chain(triangles).enumerate().find(|(_, area)| !(area.is_finite() && *area > 0.0))
}

/// The part, when every element has a positive area: dimensions may each be possible and together be none, or
/// so small or so large that their squares underflow or overflow.
pub(crate) fn sound(shape: &'static str, part: Part) -> Result<Part, Error> {
    match inside_out(&part) {
        None => Ok(part),
        Some((element, area)) => {
            let advice = "check the dimensions against each other and their unit (metres)";
            Err(Error::Tangled { shape, element, area, advice })
        }
    }
}
