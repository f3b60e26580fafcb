//! Structured numbering: nodes in rows, quadrilaterals between neighbouring rows.
//!
//! Consecutive quadrilaterals of a row have corners that all advance by one, so each row is one strip
//! (see [`crate::strips`]).

/// Which way the next row lies when one walks along a row of nodes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum NextRow {
    /// Rows from left to right, the next one above.
    Above,
    /// Rows that run counter-clockwise about the origin, the next one farther out.
    Outwards,
    /// Rows that run counter-clockwise about the origin, the next one farther in.
    Inwards,
}

/// Quadrilaterals between `rows + 1` rows of `nodes` nodes each, the first node being number `first`.
///
/// A `closed` row joins its last node to its first; that quadrilateral stands last in its row.
pub(crate) fn quads(first: u32, rows: usize, nodes: usize, closed: bool, next: NextRow) -> Vec<[u32; 4]> {
    let columns = if closed { nodes } else { nodes - 1 };
    let mut quads = Vec::with_capacity(rows * columns);
    for row in 0..rows {
        let near = first + (row * nodes) as u32;
        let far = near + nodes as u32;
        for i in 0..columns {
            let (a, b) = (i as u32, ((i + 1) % nodes) as u32);
            quads.push(match next {
                // One arm, two directions: walking along the row, the next one lies on the left.
                NextRow::Above | NextRow::Inwards => [near + a, near + b, far + b, far + a],
                NextRow::Outwards => [far + a, far + b, near + b, near + a],
            });
        }
    }
    quads
}

/// The node in a given row and column of rows of `nodes` nodes.
pub(crate) fn node(row: usize, column: usize, nodes: usize) -> u32 {
    (row * nodes + column) as u32
}
