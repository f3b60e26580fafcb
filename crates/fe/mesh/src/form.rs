//! Circles that are not quite round: the nodes of a meshed body moved so that one of its surfaces deviates
//! from its circle.

use std::f64::consts::{PI, TAU};

use crate::polar_grid::Circle;
use crate::smoothing::{enough, inside_out};
use crate::walls::shape_by_walls;
use crate::{Error, Part};

/// Facets on either side of a corner over which the spacing of the nodes returns to the regular one.
const BESIDE: f64 = 8.0;

/// Two corners nearer than this share of a facet are the ends of a wall.
const WALL: f64 = 0.1;

/// Facets about a wall within which nodes move for the time step, beside as many as the wall is high.
const BELOW: f64 = 9.0;

/// What their cells are to reach, in facets: a little more than a disc has elsewhere, because not all is
/// reached.
const SIDE: f64 = 1.06;

/// A surface about the origin that deviates from its circle.
///
/// No element is removed and none becomes a sliver: nodes of the surface move along their radius by the depth
/// there, after those nearest to corners of the profile have moved onto them along the surface; below the
/// surface displacements fall off in proportion to the distance from the other side of the body, in a disc
/// from its centre.
///
/// Two corners next to each other that are nearer than a tenth of a facet are the ends of a wall, which is
/// one facet. Nodes below such walls move for the critical time step of the assembled cells instead (THEORY
/// §2.4); walls need facets as long as cells of the body are thick.
pub struct FormDeviation<'a> {
    /// How far below its circle the surface lies at an angle [rad], into the body [m].
    pub depth: &'a dyn Fn(f64) -> f64,
    /// Angles of corners of the profile [rad]: each becomes a node.
    pub corners: &'a [f64],
    /// Which circle of its body the surface is.
    pub circle: Circle,
}

impl FormDeviation<'_> {
    /// The part with its surface of that name changed.
    ///
    /// # Errors
    /// [`Error::Tangled`] when the surface is so steep or so deep that an element turns inside out; not of a part
    /// that had such elements before ([`Annulus::unshaped_part`](crate::Annulus::unshaped_part)).
    ///
    /// # Panics
    /// If the part has no surface of that name.
    pub fn of_part(&self, part: &Part, surface: &str) -> Result<Part, Error> {
        let nodes = &part.surface(surface).expect("the part has a surface of that name").nodes;
        let mut rim: Vec<[f64; 2]> =
            nodes.iter().map(|&n| [part.x[n as usize], part.y[n as usize]]).collect();
        let radii: Vec<f64> = part.x.iter().zip(&part.y).map(|(x, y)| libm::hypot(*x, *y)).collect();
        let of_surface = |fold: fn(f64, f64) -> f64, first: f64| {
            nodes.iter().map(|&n| radii[n as usize]).fold(first, fold)
        };
        let (near, far) = match self.circle {
            Circle::Inner => (of_surface(f64::min, f64::INFINITY), radii.iter().copied().fold(0.0, f64::max)),
            Circle::Outer => (of_surface(f64::max, 0.0), radii.iter().copied().fold(f64::INFINITY, f64::min)),
        };
        let moves = self.moves(&rim);
        let walls = moves.walls();
        let mut moved = part.clone();
        for (n, radius) in radii.iter().enumerate().filter(|(_, radius)| **radius > 0.0) {
            let share = ((radius - far) / (near - far)).clamp(0.0, 1.0);
            let along = if walls.is_empty() { share } else { 0.0 };
            [moved.x[n], moved.y[n]] = self.place([part.x[n], part.y[n]], [along, share], &moves);
        }
        // Those of the surface move by all of it, whatever the rounding of a share.
        for (at, &n) in rim.iter_mut().zip(nodes) {
            [moved.x[n as usize], moved.y[n as usize]] = self.place(*at, [1.0; 2], &moves);
        }
        if !walls.is_empty() {
            self.shape(near, &walls, nodes.len(), part, &mut moved);
        }
        match inside_out(&moved).filter(|_| inside_out(part).is_none()) {
            None => Ok(moved),
            Some((element, area)) => {
                let advice = "make the deviation shallower or longer, or use more facets";
                Err(Error::Tangled { shape: "deviation from round", element, area, advice })
            }
        }
    }

    /// The same of the vertices of a polygon alone [m].
    pub fn of_polygon(&self, vertices: &mut [[f64; 2]]) {
        let moves = self.moves(vertices);
        for vertex in vertices {
            *vertex = self.place(*vertex, [1.0; 2], &moves);
        }
    }

    /// Moves nodes below `walls`, which stand at these angles on the circle of the radius `near`, for the
    /// time step.
    fn shape(&self, near: f64, walls: &[f64], facets: usize, plain: &Part, part: &mut Part) {
        let facet = TAU * near / facets as f64;
        let beside = |wall: f64| [wall - WALL * facet / near, wall + WALL * facet / near].map(self.depth);
        let depth = walls.iter().flat_map(|wall| beside(*wall)).fold(0.0, f64::max);
        let layers = (depth / facet).ceil();
        let reach = facet * (BELOW + layers);
        let near_wall = |(x, y): (&f64, &f64)| {
            walls
                .iter()
                .any(|wall| libm::hypot(x - near * libm::cos(*wall), y - near * libm::sin(*wall)) < reach)
        };
        let mut movable: Vec<bool> = plain.x.iter().zip(&plain.y).map(near_wall).collect();
        plain.surfaces.iter().flat_map(|(_, s)| &s.nodes).for_each(|&n| movable[n as usize] = false);
        shape_by_walls(part, plain, &movable, SIDE * facet, enough(facet), layers as usize);
    }

    /// New position of a node that takes these shares of the surface's displacement along itself and into the
    /// body.
    fn place(&self, at: [f64; 2], [along, share]: [f64; 2], moves: &Moves) -> [f64; 2] {
        let angle = libm::atan2(at[1], at[0]);
        let by = along * moves.at(angle);
        let depth = (self.depth)(angle + by) * share;
        if by == 0.0 && depth == 0.0 {
            return at;
        }
        let outwards = match self.circle {
            Circle::Inner => 1.0,
            Circle::Outer => -1.0,
        };
        let radius = libm::hypot(at[0], at[1]) + outwards * depth;
        let (s, c) = libm::sincos(angle + by);
        [radius * c, radius * s]
    }

    /// Moves the nodes nearest to corners onto them.
    fn moves(&self, vertices: &[[f64; 2]]) -> Moves {
        let mut angles: Vec<f64> = vertices.iter().map(|v| libm::atan2(v[1], v[0])).collect();
        angles.sort_by(f64::total_cmp);
        let mut knots: Vec<[f64; 2]> = Vec::new();
        let mut taken = vec![false; angles.len()];
        for corner in self.corners {
            let off = |i: &usize| turn(corner - angles[*i]).abs();
            let free = (0..angles.len()).filter(|&i| !taken[i]);
            let Some(nearest) = free.min_by(|a, b| off(a).total_cmp(&off(b))) else { continue };
            taken[nearest] = true;
            knots.push([angles[nearest], turn(corner - angles[nearest])]);
        }
        // Corners in the order of the nodes, so that none overtakes another.
        knots.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let n = knots.len();
        for (a, b) in (0..n).map(|b| ((b + n - 1) % n, b)) {
            let apart = (knots[b][0] - knots[a][0]).rem_euclid(TAU);
            if apart + knots[b][1] < knots[a][1] {
                (knots[a][1], knots[b][1]) = (apart + knots[b][1], knots[a][1] - apart);
            }
        }
        Moves { knots, facet: TAU / angles.len().max(1) as f64 }
    }
}

/// An angle between −π and π [rad].
fn turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// By which angle nodes move along the surface.
struct Moves {
    /// Angles of nodes that move onto corners, ascending, and by how much [rad].
    knots: Vec<[f64; 2]>,
    /// Angle of a facet [rad].
    facet: f64,
}

impl Moves {
    /// Angles where walls stand [rad].
    fn walls(&self) -> Vec<f64> {
        let pairs = self.knots.iter().zip(self.knots.iter().cycle().skip(1));
        let wall = |([a, by_a], [b, by_b]): (&[f64; 2], &[f64; 2])| {
            let (from, wide) = (a + by_a, turn(b + by_b - a - by_a));
            (wide > 0.0 && wide < WALL * self.facet).then_some(from + 0.5 * wide)
        };
        pairs.filter_map(wall).collect()
    }

    fn at(&self, angle: f64) -> f64 {
        let n = self.knots.len();
        if n == 0 {
            return 0.0;
        }
        let after = self.knots.partition_point(|knot| knot[0] <= angle);
        let [before, after] = [self.knots[(after + n - 1) % n], self.knots[after % n]];
        let (behind, ahead) = ((angle - before[0]).rem_euclid(TAU), (after[0] - angle).rem_euclid(TAU));
        let reach = BESIDE * self.facet;
        let fade = |by: f64, off: f64| by * (1.0 - off / reach).max(0.0);
        if n == 1 {
            return fade(before[1], behind.min(ahead));
        }
        let gap = behind + ahead;
        if gap <= 2.0 * reach {
            return (before[1] * ahead + after[1] * behind) / gap;
        }
        fade(before[1], behind) + fade(after[1], ahead)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moves(knots: &[[f64; 2]]) -> Moves {
        Moves { knots: knots.to_vec(), facet: 0.0625 }
    }

    /// Source: THEORY §6.4.
    #[test]
    fn analytic_moves_reach_corners_and_fade() {
        let one = moves(&[[1.0, 0.1]]);
        for (angle, by) in [(1.0, 0.1), (1.25, 0.05), (0.75, 0.05), (1.6, 0.0), (-2.0, 0.0)] {
            assert!((one.at(angle) - by).abs() < 1e-15, "{angle}");
        }
        // Neighbours share the facets between them.
        let two = moves(&[[1.0, 0.1], [1.4, -0.1]]);
        for (angle, by) in [(1.0, 0.1), (1.2, 0.0), (1.4, -0.1), (1.65, -0.05), (0.75, 0.05), (3.0, 0.0)] {
            assert!((two.at(angle) - by).abs() < 1e-15, "{angle}");
        }
        // Across the cut of the angles.
        let cut = moves(&[[-3.1, 0.02], [3.1, 0.04]]);
        assert!((cut.at(PI) - 0.03).abs() < 1e-12 && (cut.at(-PI) - 0.03).abs() < 1e-12);
    }
}
