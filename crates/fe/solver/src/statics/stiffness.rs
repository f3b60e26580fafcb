//! Stiffness of single elements at the positions of their corners.

use crate::element::{QuadReference, Stiffness, TriangleReference};

/// k · d dᵀ summed over a few d, (x, y) of each corner in turn; N is twice the number of corners.
pub(super) struct ElementMatrix<const N: usize>(pub(super) [[f64; N]; N]);

/// Strain of one mode [1/m] that a unit displacement of a node gives, from its shape gradient and the
/// component.
type StrainOf = fn([f64; 2], usize) -> f64;

/// Stiffness of a quadrilateral with corners `c` [m].
pub(super) fn quad(c: [[f64; 2]; 4], reference: &QuadReference, k: &Stiffness) -> ElementMatrix<8> {
    let twice = (c[2][0] - c[0][0]) * (c[3][1] - c[1][1]) - (c[3][0] - c[1][0]) * (c[2][1] - c[0][1]);
    let b1 = [(c[1][1] - c[3][1]) / twice, (c[3][0] - c[1][0]) / twice];
    let b2 = [(c[2][1] - c[0][1]) / twice, (c[0][0] - c[2][0]) / twice];
    let b = [b1, b2, [-b1[0], -b1[1]], [-b2[0], -b2[1]]];
    let mut matrix = ElementMatrix([[0.0; 8]; 8]);
    matrix.strain_modes(&b, reference.volume, k);
    if k.hourglass > 0.0 {
        let gamma = [1.0 - reference.s1, -1.0 - reference.s2, 1.0 + reference.s1, -1.0 + reference.s2];
        for component in 0..2 {
            let along = |i: usize| if i % 2 == component { gamma[i / 2] } else { 0.0 };
            matrix.add(&std::array::from_fn(along), k.hourglass);
        }
    }
    matrix
}

/// Stiffness of a triangle with corners `c` [m].
pub(super) fn triangle(c: [[f64; 2]; 3], reference: &TriangleReference, k: &Stiffness) -> ElementMatrix<6> {
    let twice = (c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[2][0] - c[0][0]) * (c[1][1] - c[0][1]);
    let gradient = |i: usize| {
        let (p, q) = (c[(i + 1) % 3], c[(i + 2) % 3]);
        [(p[1] - q[1]) / twice, (q[0] - p[0]) / twice]
    };
    let mut matrix = ElementMatrix([[0.0; 6]; 6]);
    matrix.strain_modes(&[gradient(0), gradient(1), gradient(2)], reference.volume, k);
    matrix
}

impl<const N: usize> ElementMatrix<N> {
    fn add(&mut self, direction: &[f64; N], k: f64) {
        for (row, a) in self.0.iter_mut().zip(direction) {
            for (value, b) in row.iter_mut().zip(direction) {
                *value += k * a * b;
            }
        }
    }

    /// Plane-strain stiffness as a sum of rank-one pieces: dilatation, two shears.
    fn strain_modes(&mut self, b: &[[f64; 2]], volume: f64, k: &Stiffness) {
        // λ tr² + 2µ (exx² + eyy² + 2 exy²) = (λ + µ)(exx + eyy)² + µ (exx − eyy)² + µ (2 exy)².
        let shear = 0.5 * k.two_shear;
        let modes: [(StrainOf, f64); 3] = [
            (|b, c| b[c], k.lame + shear),
            (|b, c| if c == 0 { b[0] } else { -b[1] }, shear),
            (|b, c| b[1 - c], shear),
        ];
        for (strain, stiffness) in modes {
            self.add(&std::array::from_fn(|i| strain(b[i / 2], i % 2)), stiffness * volume);
        }
    }

    /// The part that couples two corners.
    pub(super) fn block(&self, row: usize, column: usize) -> [[f64; 2]; 2] {
        let of = |i: usize, j: usize| self.0[2 * row + i][2 * column + j];
        [[of(0, 0), of(0, 1)], [of(1, 0), of(1, 1)]]
    }
}
