//! Fewer points, the same picture: each bucket keeps its smallest and its largest value, so no peak is lost.

use super::Series;

/// Points of `series` between `from` and `to` in runs without a gap, at most about `limit` of them, extremes
/// kept, in order.
pub(super) fn runs(series: &Series, from: f64, to: f64, limit: usize) -> Vec<Vec<(f64, f64)>> {
    let shown: Vec<(f64, f64)> = (0..series.y.len())
        .map(|n| (series.position(n), series.y[n]))
        .filter(|p| (from..=to).contains(&p.0))
        .collect();
    let bucket = if shown.len() <= limit { 1 } else { (2 * shown.len()).div_ceil(limit.max(2)) };
    shown
        .split(|p| !p.1.is_finite())
        .filter(|run| !run.is_empty())
        .map(|run| run.chunks(bucket).flat_map(extremes).collect())
        .collect()
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
        let runs = runs(&Series::sampled("s", Colour::Blue, 0.0, 1.0, y), 0.0, 1e4, 500);
        let [few] = &runs[..] else { panic!("{} runs", runs.len()) };
        assert!(few.len() <= 500, "{}", few.len());
        assert!(few.contains(&(4321.0, 50.0)) && few.contains(&(4322.0, -60.0)));
        assert!(few.windows(2).all(|w| w[0].0 < w[1].0));
    }

    #[test]
    fn invariant_gaps_stay_gaps() {
        let y = vec![f64::NAN, 1.0, 2.0, f64::NAN, f64::NAN, 3.0];
        let runs = runs(&Series::sampled("s", Colour::Blue, 0.0, 1.0, y), 0.0, 9.0, 100);
        assert_eq!(runs, [vec![(1.0, 1.0), (2.0, 2.0)], vec![(5.0, 3.0)]]);
    }
}
