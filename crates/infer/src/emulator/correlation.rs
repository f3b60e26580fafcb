//! Correlation of outputs' residuals, so that two outputs that err together count as less than two.

use faer::{Mat, Side};

/// Correlations of columns of normal deviates, none where a run has no output, shrunk towards none by as much
/// as their own uncertainty asks for (Schäfer and Strimmer, *A shrinkage approach to large-scale covariance
/// matrix estimation*, Statistical Applications in Genetics and Molecular Biology 4, 2005, target D), and
/// further until positive definite. `simulations` has the number of the simulation of each row; their
/// uncertainty is that of so many simulations.
pub(super) fn correlations(columns: &[Vec<Option<f64>>], simulations: &[usize]) -> Mat<f64> {
    let n = columns.len();
    let mut matrix = Mat::<f64>::identity(n, n);
    let [mut squares, mut errors] = [0.0, 0.0];
    for i in 0..n {
        for j in 0..i {
            let (value, error) = one(&columns[i], &columns[j], simulations);
            matrix[(i, j)] = value;
            matrix[(j, i)] = value;
            squares += value * value;
            errors += error;
        }
    }
    let shrinkage = if squares > 0.0 { (errors / squares).clamp(0.02, 1.0) } else { 1.0 };
    let mut keep = 1.0 - shrinkage;
    loop {
        let shrunk = Mat::from_fn(n, n, |i, j| if i == j { 1.0 } else { keep * matrix[(i, j)] });
        if keep == 0.0 || shrunk.llt(Side::Lower).is_ok() {
            return shrunk;
        }
        keep = if keep < 0.05 { 0.0 } else { 0.9 * keep };
    }
}

/// Correlation of two columns over the rows that have both, and its variance.
fn one(a: &[Option<f64>], b: &[Option<f64>], simulations: &[usize]) -> (f64, f64) {
    let pairs: Vec<[f64; 2]> = a.iter().zip(b).filter_map(|(p, q)| Some([(*p)?, (*q)?])).collect();
    if pairs.len() < 4 {
        return (0.0, 0.0);
    }
    let n = pairs.len() as f64;
    let means = [0, 1].map(|k| pairs.iter().map(|pair| pair[k]).sum::<f64>() / n);
    let centred = |k: usize, pair: &[f64; 2]| pair[k] - means[k];
    let product = |i, j| pairs.iter().map(|pair| centred(i, pair) * centred(j, pair)).sum::<f64>();
    let norm = (product(0, 0) * product(1, 1)).sqrt();
    if norm.is_nan() || norm <= 0.0 {
        return (0.0, 0.0);
    }
    let value = (product(0, 1) / norm).clamp(-1.0, 1.0);
    let both = (0..a.len()).filter(|&row| a[row].is_some() && b[row].is_some());
    let simulations: std::collections::BTreeSet<usize> = both.map(|row| simulations[row]).collect();
    (value, (1.0 - value * value).powi(2) / (simulations.len() as f64 - 1.0).max(1.0))
}
