//! Strips of lists that no generator would make.

use stribeck_mesh::{Strip, find_strips};

#[test]
fn by_hand_runs_end_where_one_corner_does_not_advance() {
    let quads = [[0, 1, 11, 10], [1, 2, 12, 11], [2, 3, 14, 13], [3, 4, 15, 14], [9, 8, 7, 6]];
    let strips = find_strips(&quads);
    let expected = [(0, 2, quads[0]), (2, 2, quads[2]), (4, 1, quads[4])];
    let expected = expected.map(|(first_element, len, corners)| Strip { first_element, len, corners });
    assert_eq!(strips, expected);
    assert!(find_strips(&[]).is_empty());
}

#[test]
fn by_hand_any_order_of_corners_advances() {
    // The same row, each quadrilateral begun at another corner: no strip, but nothing is lost.
    let quads = [[0, 1, 11, 10], [2, 12, 11, 1], [13, 12, 2, 3]];
    assert_eq!(find_strips(&quads).iter().map(|s| s.len).collect::<Vec<_>>(), [1, 1, 1]);
}
