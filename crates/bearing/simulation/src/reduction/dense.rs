//! Dense systems of equations.

use faer::{Mat, linalg::solvers::Solve};

/// Solves a square system from its matrix, row by row, and its right-hand side, by LU with partial pivoting.
///
/// # Panics
/// When the matrix has not as many numbers as the square of the right-hand side.
pub fn solve(matrix: &[f64], right: &[f64]) -> Vec<f64> {
    let n = right.len();
    assert_eq!(matrix.len(), n * n, "a square matrix");
    let matrix = Mat::from_fn(n, n, |i, j| matrix[n * i + j]);
    let solution = matrix.partial_piv_lu().solve(&Mat::from_fn(n, 1, |i, _| right[i]));
    (0..n).map(|i| solution[(i, 0)]).collect()
}
