//! Eigenpairs of small symmetric tridiagonal matrices.
//!
//! In plain scalar operations, so that meshes are the same on every machine.

/// Most sweeps for one eigenvalue; two or three are usual.
const SWEEPS: usize = 60;

/// Eigenvalues, the largest first, each with its eigenvector of length 1, of the matrix with this diagonal
/// and these numbers `beside` it (one fewer). A NaN gives no pairs.
///
/// Implicit QL with Wilkinson's shift. Source: G. H. Golub and C. F. Van Loan, *Matrix Computations*, 4th
/// ed., 2013, §8.3, there as QR.
pub(crate) fn eigenpairs(mut diagonal: Vec<f64>, mut beside: Vec<f64>) -> Vec<(f64, Vec<f64>)> {
    let n = diagonal.len();
    beside.push(0.0);
    // Columns are eigenvectors in the end.
    let mut vectors: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(i == j)).collect()).collect();
    for first in 0..n {
        'sweeps: for _ in 0..SWEEPS {
            let small = |k: usize| {
                let around = diagonal[k].abs() + diagonal[k + 1].abs();
                beside[k].abs() <= f64::EPSILON * around
            };
            let last = (first..n - 1).find(|&k| small(k)).unwrap_or(n - 1);
            if last == first {
                break;
            }
            let slope = (diagonal[first + 1] - diagonal[first]) / (2.0 * beside[first]);
            let shift = beside[first] / (slope + libm::hypot(slope, 1.0).copysign(slope));
            let mut bulge = diagonal[last] - diagonal[first] + shift;
            let (mut sine, mut cosine, mut carried) = (1.0, 1.0, 0.0);
            for k in (first..last).rev() {
                let (up, along) = (sine * beside[k], cosine * beside[k]);
                let length = libm::hypot(up, bulge);
                beside[k + 1] = length;
                if length == 0.0 {
                    // The matrix has decoupled: the remaining part is iterated separately.
                    diagonal[k + 1] -= carried;
                    beside[last] = 0.0;
                    continue 'sweeps;
                }
                (sine, cosine) = (up / length, bulge / length);
                let rest = diagonal[k + 1] - carried;
                let turned = (diagonal[k] - rest) * sine + 2.0 * cosine * along;
                carried = sine * turned;
                diagonal[k + 1] = rest + carried;
                bulge = cosine * turned - along;
                for row in &mut vectors {
                    let (a, b) = (row[k], row[k + 1]);
                    (row[k], row[k + 1]) = (cosine * a - sine * b, sine * a + cosine * b);
                }
            }
            diagonal[first] -= carried;
            beside[first] = bulge;
            beside[last] = 0.0;
        }
    }
    let pair = |k: usize| (diagonal[k], vectors.iter().map(|row| row[k]).collect());
    let mut pairs: Vec<(f64, Vec<f64>)> = (0..n).filter(|&k| diagonal[k].is_finite()).map(pair).collect();
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 on the diagonal and −1 beside it: 2 − 2 cos(kπ/(n + 1)), vectors sin(ikπ/(n + 1)).
    /// Source: Strang 2007, §1.5.
    #[test]
    fn analytic_eigenvalues_of_the_second_difference() {
        for n in [1, 2, 3, 32] {
            let pairs = eigenpairs(vec![2.0; n], vec![-1.0; n - 1]);
            assert_eq!(pairs.len(), n);
            for (at, (value, vector)) in pairs.iter().enumerate() {
                let angle = (n - at) as f64 * std::f64::consts::PI / (n + 1) as f64;
                assert!((value - (2.0 - 2.0 * libm::cos(angle))).abs() < 1e-13, "{n}, {at}: {value}");
                let shape: Vec<f64> = (1..=n).map(|i| libm::sin(i as f64 * angle)).collect();
                let scale = (0.5 * (n + 1) as f64).sqrt();
                let along: f64 = shape.iter().zip(vector).map(|(a, b)| a * b / scale).sum();
                assert!((along.abs() - 1.0).abs() < 1e-12, "{n}, {at}: {along}");
            }
        }
    }

    /// A diagonal matrix, equal eigenvalues, and NaN.
    #[test]
    fn behaves_matrices_that_fall_apart_or_hold_no_number() {
        let pairs = eigenpairs(vec![1.0, 1.0, 5.0], vec![0.0, 0.0]);
        assert_eq!(pairs.iter().map(|p| p.0).collect::<Vec<_>>(), [5.0, 1.0, 1.0]);
        assert!(eigenpairs(vec![f64::NAN; 3], vec![1.0; 2]).is_empty());
        assert!(eigenpairs(Vec::new(), Vec::new()).is_empty());
    }
}
