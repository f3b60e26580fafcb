//! Strips: runs of quadrilaterals whose four corners all advance by one.
//!
//! A kernel over a strip loads consecutive node values instead of gathering scattered ones. Strips are found
//! from connectivity, so a mesh from elsewhere gains too.

/// A run of consecutive quadrilaterals; corner `c` of the `i`-th of them is node `corners[c] + i`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strip {
    /// Position of the first quadrilateral in the list.
    pub first_element: usize,
    /// Number of quadrilaterals, at least one.
    pub len: usize,
    /// Corners of the first quadrilateral.
    pub corners: [u32; 4],
}

/// Splits a list of quadrilaterals into maximal strips, in order; each quadrilateral is in exactly one.
pub fn find_strips(quads: &[[u32; 4]]) -> Vec<Strip> {
    let mut strips: Vec<Strip> = Vec::new();
    for (element, quad) in quads.iter().enumerate() {
        match strips.last_mut() {
            Some(strip) if strip.corners.map(|c| c + strip.len as u32) == *quad => strip.len += 1,
            _ => strips.push(Strip { first_element: element, len: 1, corners: *quad }),
        }
    }
    strips
}
