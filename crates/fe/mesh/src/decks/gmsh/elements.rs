//! How many nodes the elements of each type have, and along how many dimensions they go.

/// Dimension and number of nodes by the type, from 1. Source: *Gmsh Reference Manual*, MSH file format.
const TYPES: [(i64, i64); 31] = [
    (1, 2),
    (2, 3),
    (2, 4),
    (3, 4),
    (3, 8),
    (3, 6),
    (3, 5),
    (1, 3),
    (2, 6),
    (2, 9),
    (3, 10),
    (3, 27),
    (3, 18),
    (3, 14),
    (0, 1),
    (2, 8),
    (3, 20),
    (3, 15),
    (3, 13),
    (2, 9),
    (2, 10),
    (2, 12),
    (2, 15),
    (2, 15),
    (2, 21),
    (1, 4),
    (1, 5),
    (1, 6),
    (3, 20),
    (3, 35),
    (3, 56),
];

/// Dimension and number of nodes of a type.
pub(super) fn dimension_and_nodes(kind: i64) -> Option<(i64, i64)> {
    TYPES.get(usize::try_from(kind).ok()?.checked_sub(1)?).copied()
}
