//! Points that fill the unit cube evenly.

use crate::error::Error;

/// The longest sequence.
pub const MOST_POINTS: usize = 1 << 16;

/// The most dimensions.
pub const MOST_DIMENSIONS: usize = 256;

/// Points of an Owen-scrambled Sobol sequence in the unit cube: `count` of them from `from_index` on, so that
/// a design can be extended later without loss of its evenness. The sequence is evenest where counts are
/// powers of two.
///
/// # Errors
/// Where the sequence ends before the last point, or has fewer dimensions.
pub fn sobol(seed: u64, dimensions: usize, from_index: usize, count: usize) -> Result<Vec<Vec<f64>>, Error> {
    if dimensions > MOST_DIMENSIONS {
        let expected = "at most 256";
        return Err(Error::Option { option: "dimensions", value: dimensions as f64, expected });
    }
    let end = from_index.saturating_add(count);
    if end > MOST_POINTS {
        let expected = "at most 65536 with the points before; another seed starts another sequence";
        return Err(Error::Option { option: "points", value: end as f64, expected });
    }
    Ok(points(seed, dimensions, from_index..end))
}

/// [`sobol`] within its limits. The half of a single-precision step keeps points off the cube's faces.
pub(crate) fn points(seed: u64, dimensions: usize, rows: std::ops::Range<usize>) -> Vec<Vec<f64>> {
    let seed = (seed ^ (seed >> 32)) as u32;
    let at = |row: usize, axis: usize| {
        f64::from(sobol_burley::sample(row as u32, axis as u32, seed)) + 2_f64.powi(-25)
    };
    rows.map(|row| (0..dimensions).map(|axis| at(row, axis)).collect()).collect()
}
