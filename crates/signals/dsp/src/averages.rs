//! Median and running mean of plain slices.

/// Median; the mean of the two middle values of an even number, NaN of none. Sorts in place.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let upper = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[upper],
        _ => 0.5 * (values[upper - 1] + values[upper]),
    }
}

/// Means over every whole window of `width` samples, the first at the first sample: `len − width + 1` values;
/// the mean of all when there are fewer samples than `width`.
pub fn running_mean(values: &[f64], width: usize) -> Vec<f64> {
    /// Sums that grow side by side, each in the order of its window.
    const SIDE_BY_SIDE: usize = 1024;
    let width = width.clamp(1, values.len().max(1));
    let mut means = vec![0.0; (values.len() + 1).saturating_sub(width)];
    for (at, sums) in means.chunks_mut(SIDE_BY_SIDE).enumerate() {
        for n in 0..width {
            sums.iter_mut().zip(&values[at * SIDE_BY_SIDE + n..]).for_each(|(sum, value)| *sum += value);
        }
        sums.iter_mut().for_each(|sum| *sum /= width as f64);
    }
    means
}
