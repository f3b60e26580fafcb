//! Rows for the labels above a chart, so that neighbours never overlap.

/// Row (0 is nearest the chart) of each label, given its centre and its width in pixels.
///
/// Labels are placed from left to right, each in the lowest row that has room for it.
pub(super) fn rows(labels: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..labels.len()).collect();
    order.sort_by(|&a, &b| labels[a].0.total_cmp(&labels[b].0));
    let mut ends: Vec<f64> = Vec::new();
    let mut row_of = vec![0; labels.len()];
    for at in order {
        let (centre, width) = labels[at];
        let (start, end) = (centre - 0.5 * width, centre + 0.5 * width);
        let row = ends.iter().position(|&taken| taken <= start).unwrap_or(ends.len());
        match ends.get_mut(row) {
            Some(taken) => *taken = end,
            None => ends.push(end),
        }
        row_of[at] = row;
    }
    row_of
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_overlapping_labels_take_different_rows() {
        assert_eq!(rows(&[(100.0, 80.0), (110.0, 80.0), (200.0, 80.0)]), [0, 1, 0]);
        assert!(rows(&[]).is_empty());
    }
}
