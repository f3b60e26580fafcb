//! The characteristic length against the eigenvalue problem it stands for, the quality report, the search.

mod common;

use common::*;
use proptest::prelude::*;
use stribeck_mesh::smoothing::raise_critical_step;
use stribeck_mesh::{Annulus, Mesh, Quality, Rectangle, characteristic_length};
use stribeck_testing::assert_close;

/// Critical time step of one element times c_p, from its stiffness and mass matrices.
///
/// Stiffness A BᵀCB with B at the centre, lumped mass ρA/n, ρ = 1, M = λ + 2µ = 1; the largest eigenvalue of
/// M⁻¹K by power iteration.
fn length_by_power_iteration(corners: &[[f64; 2]], poisson: f64) -> f64 {
    let n = corners.len();
    let lambda = poisson / (1.0 - poisson);
    let mu = 0.5 * (1.0 - lambda);
    let c = [[1.0, lambda, 0.0], [lambda, 1.0, 0.0], [0.0, 0.0, mu]];
    let [gx, gy] = centre_gradients(corners);
    // Strain rows xx, yy, xy; columns u_0 … u_n, v_0 … v_n.
    let b = |row: usize, column: usize| {
        let (node, vertical) = (column % n, column >= n);
        match (row, vertical) {
            (0, false) | (2, true) => gx[node],
            (1, true) | (2, false) => gy[node],
            _ => 0.0,
        }
    };
    let mut u: Vec<f64> = (0..2 * n).map(|i| 1.0 + (i as f64 * 1.7).sin()).collect();
    let mut omega2 = 0.0;
    for _ in 0..20_000 {
        let strain: Vec<f64> = (0..3).map(|r| (0..2 * n).map(|k| b(r, k) * u[k]).sum()).collect();
        let stress: Vec<f64> = (0..3).map(|r| (0..3).map(|s| c[r][s] * strain[s]).sum()).collect();
        let next: Vec<f64> =
            (0..2 * n).map(|k| n as f64 * (0..3).map(|r| b(r, k) * stress[r]).sum::<f64>()).collect();
        omega2 = next.iter().map(|v| v * v).sum::<f64>().sqrt();
        u = next.iter().map(|v| v / omega2).collect();
    }
    2.0 / omega2.sqrt()
}

/// Gradients of the shape functions at the centre, from the isoparametric map.
fn centre_gradients(corners: &[[f64; 2]]) -> [Vec<f64>; 2] {
    let local: Vec<[f64; 2]> = match corners.len() {
        3 => vec![[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]],
        _ => vec![[-0.25, -0.25], [0.25, -0.25], [0.25, 0.25], [-0.25, 0.25]],
    };
    let derivative = |component: usize, axis: usize| -> f64 {
        corners.iter().zip(&local).map(|(c, d)| c[component] * d[axis]).sum()
    };
    let (xr, xs, yr, ys) = (derivative(0, 0), derivative(0, 1), derivative(1, 0), derivative(1, 1));
    let jacobian = xr * ys - xs * yr;
    let gx = local.iter().map(|d| (d[0] * ys - d[1] * yr) / jacobian).collect();
    let gy = local.iter().map(|d| (d[1] * xr - d[0] * xs) / jacobian).collect();
    [gx, gy]
}

#[test]
fn by_hand_square_rectangle_and_equilateral_triangle() {
    let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    assert_close(characteristic_length(&square, 0.3), 2.0 * 0.7_f64.sqrt(), ROUNDING, "square");
    // A needle of a rectangle behaves like a bar across its short side: the length is that side.
    let needle = [[0.0, 0.0], [1e4, 0.0], [1e4, 1.0], [0.0, 1.0]];
    assert_close(characteristic_length(&needle, 0.3), 1.0, 1e-7, "needle");
    let triangle = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75_f64.sqrt()]];
    assert_close(characteristic_length(&triangle, 0.3), (1.4_f64 / 3.0).sqrt(), ROUNDING, "triangle");
    // Without lateral contraction the two axes are independent: the square is as long as its side.
    assert_close(characteristic_length(&square, 0.0), 2.0, ROUNDING, "square without contraction");
}

#[test]
fn behaves_length_of_what_is_no_element() {
    assert_eq!(characteristic_length(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]], 0.3), 0.0, "turned over");
    assert!(characteristic_length(&[[0.0, 0.0], [1.0, 0.0]], 0.3).is_nan(), "two corners");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    /// The closed form is the eigenvalue of the element, for any shape and place.
    /// Source: THEORY §2.4.
    #[test]
    fn analytic_length_is_the_eigenvalue(
        shift in prop::array::uniform8(-0.3_f64..0.3),
        triangle in any::<bool>(),
        poisson in -0.5_f64..0.49,
    ) {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let mut corners = Vec::new();
        for (i, [x, y]) in square.into_iter().enumerate().take(if triangle { 3 } else { 4 }) {
            corners.push([x + shift[2 * i], y + shift[2 * i + 1]]);
        }
        let expected = length_by_power_iteration(&corners, poisson);
        // The power iteration loses digits when two eigenvalues are close.
        assert_close(characteristic_length(&corners, poisson), expected, 1e-6, "length");
    }
}

#[test]
fn by_hand_report_of_two_bodies() {
    let mut mesh = Mesh::new();
    let cell = Rectangle { x0: 0.0, y0: 0.0, width: 0.02, height: 0.01, columns: 10, rows: 10 };
    mesh.add("plate", &cell.part().expect("a plate"));
    let ring = Annulus {
        inner_radius: 0.1,
        outer_radius: 0.11,
        facets: 628,
        layers: 10,
        start_angle: 0.0,
        grooves: Vec::new(),
    };
    mesh.add("ring", &ring.part().expect("a ring"));
    let quality = Quality::of(&mesh, POISSON, 5857.0);
    let [plate, ring] = &quality.bodies[..] else { panic!("two bodies") };
    assert_eq!((plate.nodes, plate.quads, plate.triangles), (121, 100, 0));
    assert_close(plate.worst_aspect, 2.0, 1e-12, "aspect of cells of 2 mm × 1 mm");
    assert_close(plate.smallest_angle.to_degrees(), 90.0, 1e-12, "angle of a rectangle");
    assert_close(plate.mean_length, plate.smallest_length, 1e-12, "equal cells");
    assert_close(plate.critical_time_step, plate.smallest_length / 5857.0, ROUNDING, "time step");
    // A trapezium of 628 in the circle leans by half of 360°/628 on each side.
    assert_close(ring.largest_angle.to_degrees(), 90.0 + 180.0 / 628.0, 1e-10, "angle of a trapezium");
    assert_eq!(quality.overall.quads, 100 + 6280);
    assert_eq!(quality.overall.nodes, mesh.x.len());
    assert_eq!(quality.overall.smallest_length, plate.smallest_length.min(ring.smallest_length));
    let table = quality.to_string();
    assert_eq!(table.lines().count(), 4, "a heading, two bodies and all of them");
    assert!(table.contains("plate") && table.contains("6380"), "{table}");
}

/// One node of a plate of squares is pulled out of place, even through its neighbours: the search restores
/// the squares to the precision of its last step, and moves nothing that it may not move.
#[test]
fn planted_search_restores_a_displaced_node() {
    let plate = Rectangle { x0: 0.0, y0: 0.0, width: 4.0, height: 4.0, columns: 4, rows: 4 };
    let plate = plate.part().expect("a plate");
    for (dx, dy) in [(0.4, -0.3), (1.3, 0.2)] {
        let mut part = plate.clone();
        (part.x[12], part.y[12]) = (2.0 + dx, 2.0 + dy);
        let mut movable = vec![false; 25];
        movable[12] = true;
        raise_critical_step(&mut part, &movable, POISSON, 100);
        let apart = (part.x[12] - 2.0).hypot(part.y[12] - 2.0);
        assert!(apart < 0.01, "the node ends {apart} from its place");
        part.x[12] = 2.0;
        part.y[12] = 2.0;
        assert_eq!(part, plate);
    }
}
