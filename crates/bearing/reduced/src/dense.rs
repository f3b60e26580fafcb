//! A dense system of equations, for the equilibrium at the start: for programs that hold no library for it.

/// Solves a square system from its matrix, row by row, and its right-hand side, by elimination with partial
/// pivoting.
///
/// # Panics
/// When the matrix has not as many numbers as the square of the right-hand side.
pub fn solve(matrix: &[f64], right: &[f64]) -> Vec<f64> {
    let n = right.len();
    assert_eq!(matrix.len(), n * n, "a square matrix");
    let (mut a, mut b) = (matrix.to_vec(), right.to_vec());
    for k in 0..n {
        let pivot = (k..n).max_by(|i, j| a[i * n + k].abs().total_cmp(&a[j * n + k].abs())).unwrap_or(k);
        if pivot != k {
            (0..n).for_each(|j| a.swap(k * n + j, pivot * n + j));
            b.swap(k, pivot);
        }
        for i in k + 1..n {
            let factor = a[i * n + k] / a[k * n + k];
            if factor != 0.0 {
                for j in k..n {
                    a[i * n + j] -= factor * a[k * n + j];
                }
                b[i] -= factor * b[k];
            }
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| a[k * n + j] * b[j]).sum();
        b[k] = (b[k] - known) / a[k * n + k];
    }
    b
}

#[cfg(test)]
mod tests {
    use super::solve;

    /// A system whose first pivot is zero, worked out by hand: 2y = 4, x + y = 5.
    #[test]
    fn by_hand_rows_are_exchanged_where_a_pivot_is_zero() {
        assert_eq!(solve(&[0.0, 2.0, 1.0, 1.0], &[4.0, 5.0]), [3.0, 2.0]);
    }

    #[test]
    fn invariant_the_solution_fulfils_its_equations() {
        let n = 24;
        let a: Vec<f64> = (0..n * n).map(|i| ((i * i + 7 * i) % 101) as f64 - 50.0).collect();
        let x: Vec<f64> = (0..n).map(|i| i as f64 - 3.5).collect();
        let right: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[i * n + j] * x[j]).sum()).collect();
        let solved = solve(&a, &right);
        // A condition of some thousands leaves twelve digits of sixteen.
        assert!(solved.iter().zip(&x).all(|(found, x)| (found - x).abs() < 1e-9), "{solved:?}");
    }
}
