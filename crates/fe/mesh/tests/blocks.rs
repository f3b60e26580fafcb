//! Rectangles, seated blocks and arc blocks: areas, surfaces, walls.

mod common;

use std::f64::consts::PI;

use common::*;
use stribeck_mesh::{ArcBlock, Mesh, Part, Rectangle, SeatedBlock, find_strips};
use stribeck_testing::assert_close;

const RECTANGLE: Rectangle =
    Rectangle { x0: -0.01, y0: 0.02, width: 0.03, height: 0.01, columns: 60, rows: 20 };

const BLOCK: SeatedBlock =
    SeatedBlock { width: 0.16, height: 0.04, seat_radius: 0.11, columns: 320, rows: 80 };

/// One of 24 pieces of a ring, between gaps of 18.1 mm.
const PIECE: ArcBlock = ArcBlock {
    inner_radius: 0.094,
    outer_radius: 0.098,
    left_line_angle: 0.5 * PI + PI / 24.0,
    right_line_angle: 0.5 * PI - PI / 24.0,
    half_width: 9.05e-3,
    rows: 8,
    columns: 14,
};

/// A row-major grid: one strip per row, every element in order.
fn assert_is_a_grid(part: &Part, rows: usize, columns: usize) {
    assert_eq!(part.x.len(), (rows + 1) * (columns + 1));
    assert!(smallest_jacobian(part) > 0.0);
    let strips = find_strips(&part.quads);
    assert!(strips.iter().all(|s| s.len == columns), "each row is one strip");
    assert_eq!(strips.len(), rows);
}

#[test]
fn by_hand_rectangle() {
    let part = RECTANGLE.part().expect("a rectangle");
    assert_is_a_grid(&part, 20, 60);
    assert_close(part.area(), 0.03 * 0.01, 1e-12, "area");
    assert_boundary_is(&part, &["bottom", "right", "top", "left"]);
    assert_close(relative_length(&part, 0.5e-3), 1.0, 1e-10, "length of a square");
    let ends = |name: &str| {
        let nodes = &surface(&part, name).nodes;
        (point(&part, nodes[0]), point(&part, nodes[nodes.len() - 1]))
    };
    assert_eq!(ends("bottom"), ([-0.01, 0.02], [-0.01 + 0.03, 0.02]));
    assert_eq!(ends("top"), ([-0.01 + 0.03, 0.02 + 0.01], [-0.01, 0.02 + 0.01]));
    assert_eq!(surface(&part, "right").facets(), 20);
}

/// Area = rectangle up to the top edge, less the polygon under the seat (trapezia of equal width).
#[test]
fn by_hand_seated_block() {
    let part = BLOCK.part().expect("a block");
    assert_is_a_grid(&part, 80, 320);
    assert_boundary_is(&part, &["seat", "right", "top", "left"]);
    let seat_at = |i: usize| {
        let x = 0.16 * (i as f64 / 320.0 - 0.5);
        (0.11_f64 * 0.11 - x * x).sqrt()
    };
    let under: f64 = (0..320).map(|i| 0.5 * (seat_at(i) + seat_at(i + 1)) * 0.16 / 320.0).sum();
    assert_close(part.area(), 0.16 * 0.15 - under, 1e-12, "area");
    for node in &surface(&part, "seat").nodes {
        let [x, y] = point(&part, *node);
        assert_close(x.hypot(y), 0.11, ROUNDING, "seat radius");
    }
    let seat = &surface(&part, "seat").nodes;
    assert_eq!(point(&part, seat[160]), [0.0, 0.11], "the crown is on the y axis");
    assert!(point(&part, seat[0])[0] < 0.0, "solid on the left: the seat is walked towards positive x");
    for node in &surface(&part, "top").nodes {
        assert_close(point(&part, *node)[1], 0.15, ROUNDING, "top edge");
    }
}

#[test]
fn by_hand_arc_block_has_parallel_walls() {
    let part = PIECE.part().expect("a piece");
    assert_is_a_grid(&part, 8, 14);
    for (name, line, side) in [("left", PIECE.left_line_angle, -1.0), ("right", PIECE.right_line_angle, 1.0)]
    {
        for node in &surface(&part, name).nodes {
            let [x, y] = point(&part, *node);
            // Signed distance from the radial line, positive counter-clockwise of it.
            let distance = y * line.cos() - x * line.sin();
            assert_close(distance, side * PIECE.half_width, 1e-11, "distance of a wall from its line");
        }
    }
    for (name, radius) in [("inner", 0.094), ("outer", 0.098)] {
        for node in &surface(&part, name).nodes {
            let [x, y] = point(&part, *node);
            assert_close(x.hypot(y), radius, ROUNDING, "radius");
        }
    }
}

#[test]
fn invariant_arc_block_boundary_is_one_loop() {
    let part = PIECE.part().expect("a piece");
    assert_boundary_is(&part, &["boundary"]);
    assert_boundary_is(&part, &["outer", "left", "inner", "right"]);
    let boundary = surface(&part, "boundary");
    assert!(boundary.closed);
    assert_eq!(boundary.facets(), 2 * (8 + 14), "each corner node stands once");
    assert_close(area_on_the_left(&part, &boundary.nodes), part.area(), 1e-11, "area left of the boundary");
}

#[test]
fn by_hand_mesh_keeps_bodies_apart() {
    let mut mesh = Mesh::new();
    let rectangle = RECTANGLE.part().expect("a rectangle");
    let first = mesh.add("first", &rectangle);
    let second = mesh.add("second", &rectangle.rotated(0.5 * PI).translated(1.0, -2.0));
    assert_eq!((first.body, second.body), (0, 1));
    let [a, b] = &mesh.bodies[..] else { panic!("two bodies") };
    assert_eq!((a.nodes.end, a.quads.end, a.triangles.end), (b.nodes.start, b.quads.start, 0));
    assert_eq!(b.nodes.end, mesh.x.len());
    let shift = a.nodes.end as u32;
    let bottom = second.surface("bottom").expect("a bottom");
    assert_eq!(bottom.nodes[0], rectangle.surface("bottom").expect("a bottom").nodes[0] + shift);
    assert_eq!(mesh.quads[b.quads.start], rectangle.quads[0].map(|n| n + shift));
    // A quarter turn sends (x, y) to (−y, x).
    let node = b.nodes.start;
    assert!(
        (mesh.x[node] - (1.0 - 0.02)).abs() < ROUNDING && (mesh.y[node] - (-2.0 - 0.01)).abs() < ROUNDING
    );
}

#[test]
fn refuses_with_field_and_limit() {
    let refusals = [
        (Rectangle { width: -1.0, ..RECTANGLE }.part(), ["width", "-1"]),
        (Rectangle { rows: 0, ..RECTANGLE }.part(), ["rows", "between 1"]),
        (Rectangle { x0: f64::NAN, ..RECTANGLE }.part(), ["x0", "NaN"]),
        (Rectangle { rows: 1_000_000, columns: 1_000_000, ..RECTANGLE }.part(), ["rows", "coarser"]),
        (SeatedBlock { width: 0.23, ..BLOCK }.part(), ["width", "99 %"]),
        (SeatedBlock { seat_radius: f64::INFINITY, ..BLOCK }.part(), ["seat_radius", "inf"]),
        (ArcBlock { outer_radius: 0.09, ..PIECE }.part(), ["outer_radius", "above"]),
        (ArcBlock { half_width: 0.02, ..PIECE }.part(), ["half_width", "below"]),
        (ArcBlock { half_width: -1e-3, ..PIECE }.part(), ["half_width", "at least 0"]),
        (ArcBlock { left_line_angle: 0.0, ..PIECE }.part(), ["left_line_angle", "above"]),
        (ArcBlock { left_line_angle: 9.0, ..PIECE }.part(), ["left_line_angle", "turn"]),
    ];
    for (result, parts) in refusals {
        let message = result.expect_err("a block that cannot be made").to_string();
        assert!(parts.iter().all(|p| message.contains(p)), "{message}");
    }
}

/// A polyline as the seat: columns of different widths, each a trapezium under the top edge.
#[test]
fn by_hand_seated_block_on_a_polyline() {
    let seat = [[-0.08, 0.07], [-0.05, 0.1], [-0.01, 0.109], [0.0, 0.11], [0.03, 0.105], [0.08, 0.075]];
    let block = SeatedBlock { columns: 5, rows: 10, ..BLOCK };
    let part = block.part_on(&seat).expect("a block");
    assert_is_a_grid(&part, 10, 5);
    assert_boundary_is(&part, &["seat", "right", "top", "left"]);
    let nodes = &surface(&part, "seat").nodes;
    assert!(nodes.iter().zip(seat).all(|(n, p)| point(&part, *n) == p), "the seat is the polyline");
    let under = |w: &[[f64; 2]]| (w[1][0] - w[0][0]) * (0.15 - 0.5 * (w[0][1] + w[1][1]));
    assert_close(part.area(), seat.windows(2).map(under).sum(), 1e-12, "area");

    let refused =
        |block: SeatedBlock, seat: &[[f64; 2]]| block.part_on(seat).expect_err("no seat").to_string();
    let with = |i: usize, p: [f64; 2]| {
        let mut other = seat;
        other[i] = p;
        other
    };
    for (message, part) in [
        (refused(block, &seat[1..]), "columns"),
        (refused(block, &[]), "columns"),
        (refused(block, &with(0, [-0.07, 0.07])), "at -0.08"),
        (refused(block, &with(2, [-0.06, 0.1])), "left to right"),
        (refused(block, &with(3, [f64::NAN, 0.11])), "left to right"),
        (refused(block, &with(3, [0.0, 0.15])), "below 0.15"),
        (refused(block, &with(3, [0.0, f64::NAN])), "below 0.15"),
    ] {
        assert!(message.contains("seat") && message.contains(part), "{message}");
    }
}
