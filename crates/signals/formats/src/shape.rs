//! Arrays as channels, by one rule for all formats: extents of one do not count, the longer of two others is
//! the time, and an array of more extents is no signal, because it is ambiguous which of them is the time.

/// Most channels of one array.
pub(crate) const MOST_CHANNELS: u64 = 100_000;

/// Rows and columns of an array without its extents of one, in their order; otherwise why it is no table.
pub(crate) fn table(shape: &[u64]) -> Result<(u64, u64), String> {
    let wide: Vec<u64> = shape.iter().copied().filter(|n| *n != 1).collect();
    match wide[..] {
        [] => Ok((1, 1)),
        // A row of a table stays one.
        [n] if shape.first() == Some(&1) && shape.len() == 2 => Ok((1, n)),
        [n] => Ok((n, 1)),
        [rows, columns] if rows.min(columns) <= MOST_CHANNELS => Ok((rows, columns)),
        [rows, columns] => Err(format!("{rows} × {columns} numbers are more channels than {MOST_CHANNELS}")),
        _ => {
            let sizes: Vec<String> = shape.iter().map(u64::to_string).collect();
            Err(format!(
                "it has {} dimensions, {}, and nothing says which is the time: save each record as a vector \
                 or a table",
                shape.len(),
                sizes.join(" × ")
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand_extents_of_one_do_not_count() {
        assert_eq!(table(&[1, 9, 1]), Ok((9, 1)));
        assert_eq!(table(&[1, 9]), Ok((1, 9)));
        assert_eq!(table(&[2, 1, 9]), Ok((2, 9)));
        assert_eq!(table(&[]), Ok((1, 1)));
        assert!(table(&[2, 3, 9]).unwrap_err().contains("3 dimensions, 2 × 3 × 9"));
    }
}
