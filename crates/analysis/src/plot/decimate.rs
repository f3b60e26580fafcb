//! Fewer points, the same picture: each bucket keeps its smallest and its largest value, so no peak is lost.

use super::Series;

/// Points of `series` between `from` and `to`, at most about `limit` of them, extremes kept, in order.
///
/// Gaps (values that are not finite) are dropped.
pub(super) fn points(series: &Series, from: f64, to: f64, limit: usize) -> Vec<(f64, f64)> {
    let all: Vec<(f64, f64)> = series
        .y
        .iter()
        .enumerate()
        .map(|(n, &y)| (series.position(n), y))
        .filter(|&(x, y)| y.is_finite() && (from..=to).contains(&x))
        .collect();
    if all.len() <= limit {
        return all;
    }
    let bucket = (2 * all.len()).div_ceil(limit.max(2));
    all.chunks(bucket).flat_map(extremes).collect()
}

/// Smallest and largest point of a bucket, in the order in which they occur.
fn extremes(bucket: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
    match (bucket.iter().min_by(by_value), bucket.iter().max_by(by_value)) {
        (Some(&low), Some(&high)) if low.0 < high.0 => vec![low, high],
        (Some(&low), Some(&high)) if low.0 > high.0 => vec![high, low],
        (Some(&only), _) => vec![only],
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Colour;

    #[test]
    fn invariant_peaks_survive_and_order_is_kept() {
        let mut y: Vec<f64> = (0..10_000).map(|n| (0.01 * n as f64).sin()).collect();
        y[4321] = 50.0;
        y[4322] = -60.0;
        let few = points(&Series::sampled("s", Colour::Blue, 0.0, 1.0, y), 0.0, 1e4, 500);
        assert!(few.len() <= 500, "{}", few.len());
        assert!(few.contains(&(4321.0, 50.0)) && few.contains(&(4322.0, -60.0)));
        assert!(few.windows(2).all(|w| w[0].0 < w[1].0));
    }
}
