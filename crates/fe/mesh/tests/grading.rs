//! Graded annuli: areas, surfaces, counts, strips, and cells no smaller than in a mesh of fine cells only.

mod common;

use std::f64::consts::{PI, TAU};

use common::*;
use stribeck_mesh::{Annulus, Circle, Error, Grading, Groove, Part, find_strips};
use stribeck_testing::assert_close;

/// A ring of 200 mm bore and 10 mm thickness, fine cells of 0.5 mm; 1257 = 3 · 419.
const RING: Annulus = Annulus {
    inner_radius: 0.1,
    outer_radius: 0.11,
    facets: 1257,
    layers: 20,
    start_angle: 0.3,
    grooves: Vec::new(),
};

const GROOVE: Groove = Groove::rectangular(0.5 * PI, 0.01, 0.2e-3);

/// Two layers of 0.5 mm, then one facet of three.
const INWARDS: Grading = Grading { fine: Circle::Inner, fine_layers: 2, transitions: 1 };

fn made(ring: Annulus, grading: Grading) -> Part {
    ring.graded_part(&grading).expect("a ring that can be graded")
}

/// Area of a regular polygon of n corners on a circle [m²].
fn polygon(radius: f64, n: usize) -> f64 {
    0.5 * n as f64 * radius * radius * (TAU / n as f64).sin()
}

/// Three columns of fine cells become one: 4 cells per 3 facets in the transition, 5 coarse rows in the 8 mm
/// that remain (cells of 1.59 mm), and area, boundary and both circles are those of two polygons. Where three
/// do not divide the facets, one or two groups of two facets cost 2 quadrilaterals and a triangle each.
#[test]
fn by_hand_area_surfaces_and_counts() {
    for (facets, threes, pairs) in [(1257, 419, 0), (1256, 418, 1), (1255, 417, 2)] {
        for fine in [Circle::Inner, Circle::Outer] {
            let part = made(Annulus { facets, ..RING }, Grading { fine, ..INWARDS });
            let coarse = threes + pairs;
            let (inner, outer) = if fine == Circle::Inner { (facets, coarse) } else { (coarse, facets) };
            assert_eq!(part.quads.len(), 2 * facets + 4 * threes + 2 * pairs + 5 * coarse, "{fine:?}");
            assert_eq!(part.triangles.len(), pairs);
            // The sum over thousands of cells adds their roundings. A group of two makes a longer chord
            // shorter.
            let polygons = polygon(0.11, outer) - polygon(0.1, inner);
            let tolerance = if pairs == 0 { 1e-12 } else { 1e-6 };
            assert_close(part.area(), polygons, tolerance, "area");
            assert!(smallest_jacobian(&part) > 0.0);
            assert_boundary_is(&part, &["inner", "outer"]);
            for (name, count, radius, sign) in [("inner", inner, 0.1, -1.0), ("outer", outer, 0.11, 1.0)] {
                let circle = surface(&part, name);
                assert_eq!(circle.facets(), count);
                let area = area_on_the_left(&part, &circle.nodes);
                assert_close(area, sign * polygon(radius, count), tolerance, name);
                for &n in &circle.nodes {
                    let [x, y] = point(&part, n);
                    assert_close(x.hypot(y), radius, ROUNDING, "radius of a surface node");
                }
            }
            let [x, y] = point(&part, surface(&part, "outer").nodes[0]);
            assert_close(y.atan2(x), 0.3, ROUNDING, "start angle");
        }
    }
}

/// Fine cells keep their size: the ring is the uniform one down to the last fine row.
#[test]
fn invariant_fine_rows_are_those_of_the_uniform_ring() {
    let (uniform, graded) = (RING.part().expect("a ring"), made(RING, INWARDS));
    let fine = 3 * 1257;
    assert_eq!(graded.x[..fine], uniform.x[..fine]);
    assert_eq!(graded.y[..fine], uniform.y[..fine]);
    assert_eq!(graded.quads[..2 * 1257], uniform.quads[..2 * 1257]);
}

/// All but the cells above the zigzag, the first coarse row and the one that closes each row lie in strips.
#[test]
fn by_hand_most_cells_lie_in_strips() {
    let part = made(RING, INWARDS);
    let strips: Vec<usize> = find_strips(&part.quads).iter().map(|s| s.len).filter(|&len| len > 1).collect();
    assert_eq!(strips, [1256, 1256, 1256, 418, 418, 418, 418]);
}

/// A transition has no cell of a shorter characteristic length than a fine square, so it costs no time step.
#[test]
fn behaves_grading_keeps_the_critical_step() {
    for (layers, transitions) in [(10, 1), (20, 1), (20, 2), (60, 3)] {
        let side = 0.01 / layers as f64;
        for fine_layers in [1, 2] {
            for (fine, radius) in [(Circle::Inner, 0.1), (Circle::Outer, 0.11)] {
                let grading = Grading { fine, fine_layers, transitions };
                // Facets as long as the layers are thick; three need not divide their number.
                let facets = (TAU * radius / side) as usize;
                let part = made(Annulus { facets, layers, ..RING }, grading);
                let kept = relative_length(&part, side);
                // Inside a fine outer circle cells narrow: by 2 % in the 2 mm that the coarsest fine layers
                // take.
                assert!(kept > 0.98, "{layers} {fine_layers} {transitions} {fine:?}: {kept:.4}");
                assert!(smallest_jacobian(&part) > 0.0);
                assert_boundary_is(&part, &["inner", "outer"]);
            }
        }
    }
}

/// The groove has the same walls and floor as in the uniform ring.
#[test]
fn invariant_groove_in_the_fine_circle() {
    let ring = Annulus { start_angle: 0.0, grooves: vec![GROOVE], ..RING };
    let uniform = ring.part().expect("a ring with a groove");
    for fine_layers in [1, 2, 3] {
        let part = made(ring.clone(), Grading { fine_layers, ..INWARDS });
        assert_eq!(part.x[..1257], uniform.x[..1257], "the inner surface does not know of the grading");
        assert_eq!(part.y[..1257], uniform.y[..1257]);
        assert!(smallest_jacobian(&part) > 0.0);
        assert_boundary_is(&part, &["inner", "outer"]);
        // The search for better cells leaves the coarse circle alone: its nodes are every third of the
        // uniform one's.
        for &n in &surface(&part, "outer").nodes {
            let [x, y] = point(&part, n);
            let is = |m: usize| (uniform.x[m] - x).hypot(uniform.y[m] - y) < 1e-12;
            assert!((20 * 1257..21 * 1257).any(is), "{fine_layers} fine layers, node {n}");
        }
    }
}

#[test]
fn invariant_grooves_of_any_place_and_depth_stay_in_order() {
    for (facets, layers) in [(1257, 20), (630, 10), (315, 6)] {
        for (centre_angle, length, depth) in
            [(0.0, 0.01, 0.05e-3), (-2.0, 0.04, 0.5e-3), (7.0, 0.01, 1e-3), (3.0, 0.02, 3e-3)]
        {
            let groove = Groove::rectangular(centre_angle, length, depth);
            let ring = Annulus { facets, layers, grooves: vec![groove], ..RING };
            let part = made(ring, Grading { fine_layers: 1, ..INWARDS });
            assert!(smallest_jacobian(&part) > 0.0, "{facets} facets, {groove:?}");
            assert_boundary_is(&part, &["inner", "outer"]);
        }
    }
}

/// Without a transition a graded ring is the uniform one.
#[test]
fn invariant_no_transition_is_the_uniform_ring() {
    for grooves in [vec![], vec![GROOVE]] {
        let sound = grooves.is_empty();
        let ring = Annulus { grooves, ..RING };
        let none = Grading { transitions: 0, ..INWARDS };
        let (part, uniform) = (made(ring.clone(), none), ring.part().expect("a ring"));
        assert_eq!(part.quads, uniform.quads);
        assert_eq!(part.surfaces, uniform.surfaces);
        if sound {
            assert_eq!((part.x, part.y), (uniform.x, uniform.y));
        }
    }
}

#[test]
fn refuses_with_field_and_limit() {
    let refused = |ring: Annulus, grading: Grading| {
        ring.graded_part(&grading).expect_err("a ring that cannot be graded").to_string()
    };
    for (message, parts) in [
        (refused(Annulus { facets: 21, ..RING }, INWARDS), ["facets", "between 24"]),
        (refused(Annulus { layers: 5, ..RING }, INWARDS), ["layers", "between 6"]),
        (refused(RING, Grading { fine_layers: 0, ..INWARDS }), ["fine_layers", "between 1"]),
        (refused(RING, Grading { transitions: 11, ..INWARDS }), ["transitions", "and 10"]),
        (refused(Annulus { inner_radius: 0.2, ..RING }, INWARDS), ["outer_radius", "above 0.2"]),
    ] {
        assert!(parts.iter().all(|p| message.contains(p)), "{message}");
    }
    let outer = Grading { fine: Circle::Outer, ..INWARDS };
    let cut = Annulus { grooves: vec![GROOVE], ..RING };
    assert!(matches!(cut.graded_part(&outer), Err(Error::Conflict { field: "grooves", .. })));
    let least = Annulus { layers: INWARDS.layers_needed(), ..RING };
    assert!(least.graded_part(&INWARDS).is_ok(), "the fewest layers are enough");
}
