//! Numbers of a sample: quantiles, intervals, moments, ranks.

/// The central interval that holds a share (0 … 1) of the values.
pub fn interval(values: &[f64], share: f64) -> [f64; 2] {
    let half = 0.5 * (1.0 - share.clamp(0.0, 1.0));
    [quantile(values, half), quantile(values, 1.0 - half)]
}

/// The value with a share (0 … 1) of the others below it, between neighbours linear (Hyndman and Fan's
/// definition 7); NaN without values.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share.clamp(0.0, 1.0) * (sorted.len().saturating_sub(1)) as f64;
    let (low, part) = (place.floor() as usize, place.fract());
    match (sorted.get(low), sorted.get(low + 1)) {
        (Some(a), Some(b)) => a + part * (b - a),
        (Some(a), None) => *a,
        _ => f64::NAN,
    }
}

/// Mean and standard deviation (with n in the denominator).
pub fn moments(values: &[f64]) -> [f64; 2] {
    weighted_moments(values, &vec![1.0 / values.len() as f64; values.len()])
}

/// Mean and standard deviation under weights of sum 1.
pub(crate) fn weighted_moments(values: &[f64], weights: &[f64]) -> [f64; 2] {
    let mean: f64 = values.iter().zip(weights).map(|(x, w)| w * x).sum();
    let variance: f64 = values.iter().zip(weights).map(|(x, w)| w * (x - mean) * (x - mean)).sum();
    [mean, variance.sqrt()]
}

/// The share of draws below the truth, each with its weight (of sum 1); of those equal to it, the share
/// `between` (0 … 1), which is drawn uniformly where ranks are compared over many truths.
pub fn rank(truth: f64, draws: &[f64], weights: &[f64], between: f64) -> f64 {
    let one = |(x, w): (&f64, &f64)| match x.total_cmp(&truth) {
        std::cmp::Ordering::Less => *w,
        std::cmp::Ordering::Equal => between * w,
        std::cmp::Ordering::Greater => 0.0,
    };
    draws.iter().zip(weights).map(one).sum()
}
