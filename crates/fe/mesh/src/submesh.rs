//! The highest natural frequencies of a part of a mesh, and how they change as its nodes move.

use crate::Part;
use crate::part::signed_area;
use crate::smoothing::smallest_corner_area;
use crate::tridiagonal;

/// Dimension of the Krylov space: cells that are worse than all others stand out of it soon.
const KRYLOV: usize = 32;

/// Step of the central differences that give the derivative of an element's energy, in units of length.
const STEP: f64 = 1e-6;

/// The elements at some movable nodes, those around them, and the mass that their nodes have in the whole
/// part.
///
/// Units: a length, the density and the speed of pressure waves c_p. A frequency ω is then 2/L, where L / c_p
/// is the critical time step and L = 1 that of endless squares with sides of the unit of length. Elements are
/// those of [`characteristic_length`](crate::characteristic_length), and here their hourglass stiffness
/// counts: the one with which squares have their exact bending stiffness.
pub(crate) struct Submesh {
    /// Nodes of the part; the movable ones come first.
    pub(crate) nodes: Vec<u32>,
    /// Number of movable nodes.
    pub(crate) movable: usize,
    /// Corners as places in `nodes`; those at movable nodes come first. A triangle has its last corner twice.
    pub(crate) elements: Vec<[usize; 4]>,
    /// Number of elements at movable nodes.
    pub(crate) moving: usize,
    /// Mass of the nodes from elements that are not in the submesh.
    outside: Vec<f64>,
    moduli: Moduli,
}

/// A natural vibration of a submesh.
pub(crate) struct Mode {
    /// ω².
    pub(crate) square: f64,
    /// Displacements, with a kinetic energy of ½ ω².
    shape: Vec<[f64; 2]>,
}

#[derive(Clone, Copy)]
struct Moduli {
    lambda: f64,
    shear: f64,
    hourglass: f64,
}

/// Shape of an element, as its forces and energies need it.
#[derive(Clone, Copy)]
struct Shape {
    b1: [f64; 2],
    b2: [f64; 2],
    /// Parts of the hourglass vector along b1 and b2.
    s1: f64,
    s2: f64,
    area: f64,
}

impl Submesh {
    /// The submesh of the nodes with a true flag in `movable`, with `unit` [m] as the unit of length.
    pub(crate) fn new(part: &Part, movable: &[bool], poisson: f64, unit: f64) -> Self {
        let quads = part.quads.iter().copied();
        let all: Vec<[u32; 4]> = quads.chain(part.triangles.iter().map(|&[a, b, c]| [a, b, c, c])).collect();
        let mut nodes: Vec<u32> = (0..part.x.len().min(movable.len()) as u32).collect();
        nodes.retain(|n| movable[*n as usize]);
        let free = nodes.len();
        let mut place = vec![usize::MAX; part.x.len()];
        nodes.iter().enumerate().for_each(|(i, n)| place[*n as usize] = i);
        let (mut elements, mut taken, mut moving) = (Vec::new(), vec![false; all.len()], 0);
        for ring in 0..2 {
            let known = nodes.len();
            let touches =
                |corners: &[u32; 4], place: &[usize]| corners.iter().any(|n| place[*n as usize] < known);
            for (e, corners) in all.iter().enumerate() {
                if taken[e] || !touches(corners, &place) {
                    continue;
                }
                taken[e] = true;
                for n in corners {
                    if place[*n as usize] == usize::MAX {
                        place[*n as usize] = nodes.len();
                        nodes.push(*n);
                    }
                }
                elements.push(corners.map(|n| place[n as usize]));
            }
            if ring == 0 {
                moving = elements.len();
            }
        }
        let mut outside = vec![0.0; nodes.len()];
        for (corners, _) in all.iter().zip(&taken).filter(|(_, taken)| !**taken) {
            let area = signed_area(&part.corners(corners)) / (unit * unit);
            for (n, share) in corners.iter().zip(shares(corners)) {
                if let Some(mass) = outside.get_mut(place[*n as usize]) {
                    *mass += share * area;
                }
            }
        }
        Self { nodes, movable: free, elements, moving, outside, moduli: Moduli::new(poisson) }
    }

    /// Whether an element at a movable node is inside out.
    pub(crate) fn is_tangled(&self, part: &Part) -> bool {
        self.elements[..self.moving].iter().any(|corners| {
            let [a, b, c, d] = corners.map(|n| self.nodes[n]);
            let area = if c == d {
                smallest_corner_area(&part.corners(&[a, b, c]))
            } else {
                smallest_corner_area(&part.corners(&[a, b, c, d]))
            };
            !(area.is_finite() && area > 0.0)
        })
    }

    /// Vibrations with ω² above a bound, nodes at `at`, the highest first. Those near the bound are
    /// estimates.
    pub(crate) fn modes_above(&self, bound: f64, at: &[[f64; 2]]) -> Vec<Mode> {
        let shapes: Vec<Shape> = self.elements.iter().map(|c| Shape::new(&c.map(|n| at[n]))).collect();
        let mut root = self.outside.clone();
        for (corners, shape) in self.elements.iter().zip(&shapes) {
            corners.iter().zip(shares(corners)).for_each(|(n, share)| root[*n] += share * shape.area);
        }
        root.iter_mut().for_each(|m| *m = m.sqrt());
        let n = self.nodes.len();
        let space = KRYLOV.min(2 * n);
        let mut basis: Vec<Vec<[f64; 2]>> = vec![start_vector(n)];
        let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
        for k in 0..space {
            let mut next = vec![[0.0; 2]; n];
            for (corners, shape) in self.elements.iter().zip(&shapes) {
                let u = corners.map(|n| basis[k][n].map(|v| v / root[n]));
                for (n, f) in corners.iter().zip(shape.forces(u, &self.moduli)) {
                    next[*n] = [next[*n][0] + f[0] / root[*n], next[*n][1] + f[1] / root[*n]];
                }
            }
            let here = dot(next.as_flattened(), basis[k].as_flattened());
            diagonal.push(here);
            for earlier in &basis {
                let part = dot(next.as_flattened(), earlier.as_flattened());
                add(next.as_flattened_mut(), -part, earlier.as_flattened());
            }
            let length = dot(next.as_flattened(), next.as_flattened()).sqrt();
            if k + 1 == space || length <= 1e-12 * here.abs() {
                break;
            }
            beside.push(length);
            next.iter_mut().flatten().for_each(|v| *v /= length);
            basis.push(next);
        }
        let mut modes = Vec::new();
        for (square, part) in tridiagonal::eigenpairs(diagonal, beside) {
            if square > bound {
                let mut shape = vec![[0.0; 2]; n];
                basis
                    .iter()
                    .zip(&part)
                    .for_each(|(v, part)| add(shape.as_flattened_mut(), *part, v.as_flattened()));
                shape.iter_mut().zip(&root).for_each(|(u, root)| *u = u.map(|v| v / root));
                modes.push(Mode { square, shape });
            }
        }
        modes
    }

    /// Derivative of Σ `weight` · ω² of some modes with respect to the positions of movable nodes, at `at`;
    /// the others' is zero.
    pub(crate) fn derivative(&self, modes: &[(f64, Mode)], at: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let mut derivative = vec![[0.0; 2]; self.nodes.len()];
        for corners in &self.elements[..self.moving] {
            let here = corners.map(|n| at[n]);
            let shares = shares(corners);
            let lagrangian = |moved: &[[f64; 2]; 4]| {
                let shape = Shape::new(moved);
                let of = |(weight, mode): &(f64, Mode)| {
                    let u = corners.map(|n| mode.shape[n]);
                    let squares: f64 =
                        u.iter().zip(shares).map(|(u, s)| s * (u[0] * u[0] + u[1] * u[1])).sum();
                    weight * (shape.twice_energy(u, &self.moduli) - mode.square * squares * shape.area)
                };
                modes.iter().map(of).sum::<f64>()
            };
            for c in (0..4).filter(|c| corners[*c] < self.movable) {
                for axis in 0..2 {
                    let (mut more, mut less) = (here, here);
                    more[c][axis] += STEP;
                    less[c][axis] -= STEP;
                    derivative[corners[c]][axis] += (lagrangian(&more) - lagrangian(&less)) / (2.0 * STEP);
                }
            }
        }
        derivative
    }
}

impl Moduli {
    /// λ, µ and E' / 12 over λ + 2µ.
    fn new(poisson: f64) -> Self {
        let rest = 1.0 - poisson;
        Self {
            lambda: poisson / rest,
            shear: 0.5 * (1.0 - 2.0 * poisson) / rest,
            hourglass: (1.0 - 2.0 * poisson) / (12.0 * rest * rest),
        }
    }
}

impl Shape {
    /// A triangle with its last corner twice comes out as it should: nothing is left for the hourglass vector
    /// to see.
    fn new(c: &[[f64; 2]; 4]) -> Self {
        let area = signed_area(c);
        let scale = 0.5 / area;
        let b1 = [(c[1][1] - c[3][1]) * scale, (c[3][0] - c[1][0]) * scale];
        let b2 = [(c[2][1] - c[0][1]) * scale, (c[0][0] - c[2][0]) * scale];
        let h = [c[0][0] - c[1][0] + c[2][0] - c[3][0], c[0][1] - c[1][1] + c[2][1] - c[3][1]];
        Self { b1, b2, s1: h[0] * b1[0] + h[1] * b1[1], s2: h[0] * b2[0] + h[1] * b2[1], area }
    }

    /// Displacement gradient, and the hourglass amplitude.
    fn strains(&self, u: [[f64; 2]; 4]) -> ([[f64; 2]; 2], [f64; 2]) {
        let (p, r) = ([u[0][0] - u[2][0], u[0][1] - u[2][1]], [u[1][0] - u[3][0], u[1][1] - u[3][1]]);
        let gradient = [0, 1].map(|i| [0, 1].map(|j| p[i] * self.b1[j] + r[i] * self.b2[j]));
        let seen = [0, 1].map(|i| u[0][i] + u[2][i] - u[1][i] - u[3][i] - self.s1 * p[i] - self.s2 * r[i]);
        (gradient, seen)
    }

    fn twice_energy(&self, u: [[f64; 2]; 4], m: &Moduli) -> f64 {
        let ([[xx, xy], [yx, yy]], [wx, wy]) = self.strains(u);
        let trace = xx + yy;
        let strain = m.lambda * trace * trace + m.shear * (2.0 * (xx * xx + yy * yy) + (xy + yx) * (xy + yx));
        self.area * strain + m.hourglass * (wx * wx + wy * wy)
    }

    /// Forces that hold the displacements `u`.
    fn forces(&self, u: [[f64; 2]; 4], m: &Moduli) -> [[f64; 2]; 4] {
        let ([[xx, xy], [yx, yy]], w) = self.strains(u);
        let (pressure, shear) = (m.lambda * (xx + yy), m.shear * (xy + yx));
        let stress = [[pressure + 2.0 * m.shear * xx, shear], [shear, pressure + 2.0 * m.shear * yy]];
        let along = |i: usize, b: [f64; 2], s: f64| {
            self.area * (stress[i][0] * b[0] + stress[i][1] * b[1]) - m.hourglass * s * w[i]
        };
        let (g1, g2) =
            ([0, 1].map(|i| along(i, self.b1, self.s1)), [0, 1].map(|i| along(i, self.b2, self.s2)));
        let h = w.map(|w| m.hourglass * w);
        [
            [g1[0] + h[0], g1[1] + h[1]],
            [g2[0] - h[0], g2[1] - h[1]],
            [h[0] - g1[0], h[1] - g1[1]],
            [-g2[0] - h[0], -g2[1] - h[1]],
        ]
    }
}

/// Shares of the corners in the mass of an element: quarters, or thirds.
fn shares<T: PartialEq>(corners: &[T; 4]) -> [f64; 4] {
    if corners[2] == corners[3] { [1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0] } else { [0.25; 4] }
}

/// a · b
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// a += scale · b
pub(crate) fn add(a: &mut [f64], scale: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += scale * b);
}

/// A fixed vector of length 1, of pseudo-random numbers: it has a part along every mode.
fn start_vector(n: usize) -> Vec<[f64; 2]> {
    let mut seed = 0x2545_f491_4f6c_dd1d_u64;
    let mut number = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut vector: Vec<[f64; 2]> = (0..n).map(|_| [number(), number()]).collect();
    let length = dot(vector.as_flattened(), vector.as_flattened()).sqrt();
    vector.iter_mut().flatten().for_each(|v| *v /= length);
    vector
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rectangle, characteristic_length};

    const POISSON: f64 = 0.3;

    fn submesh_of(part: &Part) -> (Submesh, Vec<[f64; 2]>) {
        let submesh = Submesh::new(part, &vec![true; part.x.len()], POISSON, 1.0);
        let at = submesh.nodes.iter().map(|n| [part.x[*n as usize], part.y[*n as usize]]).collect();
        (submesh, at)
    }

    fn single(corners: &[[f64; 2]]) -> Part {
        let mut part = Part::default();
        corners.iter().for_each(|[x, y]| _ = part.push_node(*x, *y));
        match corners {
            [_, _, _] => part.triangles.push([0, 1, 2]),
            _ => part.quads.push([0, 1, 2, 3]),
        }
        part
    }

    /// One element alone vibrates as the formula for its length says; in these shapes hourglass stiffness has
    /// no part in it.
    #[test]
    fn invariant_single_elements_have_their_characteristic_length() {
        let shapes: [&[[f64; 2]]; 3] = [
            &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
            &[[0.0, 0.0], [1.1, -0.1], [1.2, 0.8], [0.1, 0.9]],
            &[[0.0, 0.0], [1.0, 0.1], [0.3, 0.9]],
        ];
        for corners in shapes {
            let (submesh, at) = submesh_of(&single(corners));
            let highest = submesh.modes_above(0.0, &at)[0].square;
            let expected = 4.0 / characteristic_length(corners, POISSON).powi(2);
            assert!((highest / expected - 1.0).abs() < 1e-9, "{corners:?}: {highest} instead of {expected}");
        }
    }

    /// A plane wave that alternates from column to column has ω² = 4 in endless squares, free corners make a
    /// hundredth more of it, and one by one squares have 5.7.
    /// Source: THEORY §2.4.
    #[test]
    fn analytic_squares_vibrate_as_the_grid_wave() {
        let grid = Rectangle { x0: 0.0, y0: 0.0, width: 16.0, height: 16.0, columns: 16, rows: 16 };
        let (submesh, at) = submesh_of(&grid.part().expect("a grid"));
        let highest = submesh.modes_above(0.0, &at)[0].square;
        assert!((3.95..4.06).contains(&highest), "ω² = {highest}");
    }

    /// Nodes of a submesh have the mass of the whole part: what is far away does not change its frequencies.
    #[test]
    fn invariant_mass_of_the_surroundings_counts() {
        let grid = |n: usize| {
            let side = n as f64;
            let grid = Rectangle { x0: 0.0, y0: 0.0, width: side, height: side, columns: n, rows: n };
            let part = grid.part().expect("a grid");
            let centre: Vec<bool> =
                part.x.iter().zip(&part.y).map(|(x, y)| [*x, *y] == [0.5 * side; 2]).collect();
            let submesh = Submesh::new(&part, &centre, POISSON, 1.0);
            let at: Vec<[f64; 2]> =
                submesh.nodes.iter().map(|n| [part.x[*n as usize], part.y[*n as usize]]).collect();
            submesh.modes_above(0.0, &at)[0].square
        };
        let (small, large) = (grid(6), grid(10));
        assert!((small - large).abs() < 1e-9 * large, "{small} and {large}");
    }

    #[test]
    fn invariant_derivative_is_that_of_differences() {
        let grid = Rectangle { x0: 0.0, y0: 0.0, width: 4.0, height: 3.0, columns: 4, rows: 3 };
        let mut part = grid.part().expect("a grid");
        for (i, (x, y)) in part.x.iter_mut().zip(&mut part.y).enumerate() {
            (*x, *y) = (*x + 0.13 * libm::sin(3.0 * i as f64), *y + 0.11 * libm::cos(5.0 * i as f64));
        }
        let (submesh, mut at) = submesh_of(&part);
        let highest = |at: &[[f64; 2]]| submesh.modes_above(0.0, at)[0].square;
        let mode = submesh.modes_above(0.0, &at).swap_remove(0);
        let derivative = submesh.derivative(&[(1.0, mode)], &at);
        let scale = derivative.iter().flatten().fold(0.0_f64, |a, b| a.max(b.abs()));
        for (n, axis) in [(0, 0), (7, 1), (9, 0), (12, 1)] {
            let mut moved = |by: f64| {
                at[n][axis] += by;
                let value = highest(&at);
                at[n][axis] -= by;
                value
            };
            let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            let error = (difference - derivative[n][axis]).abs() / scale;
            assert!(error < 1e-6, "node {n}, axis {axis}: {difference} and {}", derivative[n][axis]);
        }
    }
}
