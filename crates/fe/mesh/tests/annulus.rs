//! Annuli with and without a groove: areas, walls, orientation, size of the cells.

mod common;

use std::f64::consts::{PI, TAU};

use common::*;
use stribeck_mesh::{Annulus, Circle, Error, Grading, Groove, Part, find_strips};
use stribeck_testing::assert_close;

/// A ring of 200 mm bore and 10 mm thickness in cells of 0.5 mm.
const RING: Annulus = Annulus {
    inner_radius: 0.1,
    outer_radius: 0.11,
    facets: 1257,
    layers: 20,
    start_angle: 0.3,
    grooves: Vec::new(),
};

const GROOVE: Groove = Groove::rectangular(0.5 * PI, 0.01, 0.2e-3);

fn ring(groove: Option<Groove>) -> Part {
    Annulus { grooves: groove.into_iter().collect(), ..RING }.part().expect("a ring that can be made")
}

/// Area of a regular polygon of n corners on a circle [m²].
fn polygon(radius: f64, n: usize) -> f64 {
    0.5 * n as f64 * radius * radius * (TAU / n as f64).sin()
}

/// Position in row 0 of the upper node of the clockwise wall: the only one followed by a node at its angle.
fn wall_column(part: &Part, n: usize) -> usize {
    let same_angle = |c: usize| {
        let ([x1, y1], [x2, y2]) = (point(part, c as u32), point(part, ((c + 1) % n) as u32));
        (x1 * y2 - x2 * y1).abs() < 1e-12 && x1.hypot(y1) < x2.hypot(y2)
    };
    let found: Vec<usize> = (0..n).filter(|c| same_angle(*c)).collect();
    assert_eq!(found.len(), 1, "one wall climbs along the row");
    found[0]
}

#[test]
fn by_hand_area_of_two_polygons() {
    let part = ring(None);
    let expected = polygon(0.11, 1257) - polygon(0.1, 1257);
    // The sum over 25 140 elements adds their roundings.
    assert_close(part.area(), expected, 1e-12, "area");
    assert!(smallest_jacobian(&part) > 0.0);
}

#[test]
fn by_hand_boundary_is_two_oriented_circles() {
    let part = ring(None);
    assert_boundary_is(&part, &["inner", "outer"]);
    // Solid on the left: the outer circle encloses it, the inner one is walked the other way round.
    assert_close(
        area_on_the_left(&part, &surface(&part, "outer").nodes),
        polygon(0.11, 1257),
        1e-12,
        "outer",
    );
    assert_close(
        area_on_the_left(&part, &surface(&part, "inner").nodes),
        -polygon(0.1, 1257),
        1e-12,
        "inner",
    );
    let [x, y] = point(&part, surface(&part, "outer").nodes[0]);
    assert_close(y.atan2(x), 0.3, ROUNDING, "start angle");
}

#[test]
fn by_hand_rows_are_two_strips_each() {
    let part = ring(Some(GROOVE));
    let strips = find_strips(&part.quads);
    assert_eq!(strips.len(), 2 * 20, "one strip and the quadrilateral that closes the row");
    let mut covered = 0;
    for strip in &strips {
        assert_eq!(strip.first_element, covered, "strips follow each other");
        for i in 0..strip.len {
            let expected = strip.corners.map(|c| c + i as u32);
            assert_eq!(part.quads[strip.first_element + i], expected);
        }
        covered += strip.len;
    }
    assert_eq!(covered, part.quads.len());
    assert_eq!(strips.iter().map(|s| s.len).max(), Some(1256));
}

/// The groove takes the polygonal ring sector between floor and inner surface out of the ring.
#[test]
fn by_hand_groove_has_its_length_depth_and_area() {
    let part = ring(Some(GROOVE));
    let n = 1257;
    let sector = GROOVE.length / RING.inner_radius;
    let floor_facets = (GROOVE.length / (TAU * 0.1 / n as f64)).round() as usize;
    assert_eq!(floor_facets, 20);
    let top = wall_column(&part, n);
    let floor_radius = RING.inner_radius + GROOVE.depth;
    for (column, angle, radius) in [
        (top, 0.5 * PI - 0.5 * sector, RING.inner_radius),
        (top + 1, 0.5 * PI - 0.5 * sector, floor_radius),
        (top + 1 + floor_facets, 0.5 * PI + 0.5 * sector, floor_radius),
        (top + 2 + floor_facets, 0.5 * PI + 0.5 * sector, RING.inner_radius),
    ] {
        let [x, y] = point(&part, (column % n) as u32);
        assert_close(y.atan2(x), angle, ROUNDING, "wall angle");
        assert_close(x.hypot(y), radius, ROUNDING, "wall radius");
    }
    for wall in [top, top + 1 + floor_facets] {
        let ([x1, y1], [x2, y2]) = (point(&part, (wall % n) as u32), point(&part, ((wall + 1) % n) as u32));
        // The wall is short beside the coordinates, which costs three digits.
        assert_close((x2 - x1).hypot(y2 - y1), GROOVE.depth, 1e-10, "wall length");
    }

    let fan = |radius: f64, sector: f64, facets: usize| {
        0.5 * facets as f64 * radius * radius * (sector / facets as f64).sin()
    };
    let rest = fan(RING.inner_radius, TAU - sector, n - 2 - floor_facets);
    let outside = area_on_the_left(&part, &surface(&part, "outer").nodes);
    assert_close(outside, polygon(RING.outer_radius, n), 1e-8, "outside");
    let expected = outside - rest - fan(floor_radius, sector, floor_facets);
    assert_close(part.area(), expected, 1e-12, "area");
}

#[test]
fn invariant_groove_keeps_facets_outer_circle_and_orientation() {
    let (plain, cut) = (ring(None), ring(Some(GROOVE)));
    assert_eq!(surface(&cut, "inner").facets(), 1257);
    assert_eq!(cut.quads, plain.quads, "no element is removed or renumbered");
    for n in 20 * 1257..21 * 1257 {
        assert_close(cut.x[n].hypot(cut.y[n]), RING.outer_radius, ROUNDING, "outer radius");
        let moved = (cut.x[n] - plain.x[n]).hypot(cut.y[n] - plain.y[n]);
        assert!(moved < 1.1e-3, "an outer node lies {moved} m from where it was, more than two facets");
    }
    assert!(smallest_jacobian(&cut) > 0.0);
    // Far from the groove every cell still has nearly its nominal size.
    let row = |r: usize, c: usize| cut.x[r * 1257 + c].hypot(cut.y[r * 1257 + c]);
    let opposite = (wall_column(&cut, 1257) + 640) % 1257;
    for r in 0..=20 {
        assert_close(row(r, opposite), 0.1 + 0.5e-3 * r as f64, 1e-12, "radius of a far row");
    }
}

/// Beyond two thicknesses from the walls the cells of a row are alike, so that solvers need only one of them.
#[test]
fn invariant_cells_away_from_a_groove_are_alike() {
    let part = ring(Some(GROOVE));
    let wall = wall_column(&part, 1257);
    let beside = (2.0 * 0.01 / (TAU * 0.1 / 1257.0)).ceil() as usize + 1;
    for row in 0..20 {
        // Sides and diagonals, from the column half a turn away on.
        let of = |column: usize| {
            let corners = part.quads[row * 1257 + column % 1257].map(|n| point(&part, n));
            let apart = |i: usize, j: usize| {
                let ([x, y], [u, v]): ([f64; 2], [f64; 2]) = (corners[i], corners[j]);
                (x - u).hypot(y - v)
            };
            [apart(0, 1), apart(1, 2), apart(2, 3), apart(3, 0), apart(0, 2), apart(1, 3)]
        };
        let far = of(wall + 640);
        let columns = wall + 22 + beside..wall + 1257 - beside;
        assert!(columns.len() > 1130);
        for column in columns {
            for (length, expected) in of(column).into_iter().zip(far) {
                assert_close(length, expected, 1e-11, "a length of a cell");
            }
        }
    }
}

/// A cell of 0.2 mm among cells of 0.5 mm would have 0.4 of the length; slanted cells keep three quarters.
#[test]
fn behaves_groove_keeps_the_critical_step() {
    let kept = relative_length(&ring(Some(GROOVE)), 0.5e-3);
    assert!(kept > 0.72, "the groove leaves {kept:.3} of the length of a 0.5 mm square");
    assert!(relative_length(&ring(None), 0.5e-3) > 0.99);
}

#[test]
fn invariant_grooves_of_any_place_and_depth_stay_in_order() {
    for (facets, layers) in [(1257, 20), (628, 10), (314, 5), (157, 2)] {
        for (centre_angle, length, depth) in [
            (0.0, 0.01, 0.05e-3),
            (0.5 * PI, 0.001, 0.2e-3),
            (-2.0, 0.04, 0.5e-3),
            (7.0, 0.01, 1e-3),
            (3.0, 0.02, 3e-3),
        ] {
            let groove = Groove::rectangular(centre_angle, length, depth);
            let ring = Annulus { facets, layers, grooves: vec![groove], ..RING };
            let part = ring.part().expect("a groove that can be cut");
            assert!(smallest_jacobian(&part) > 0.0, "{facets} facets, {groove:?}");
            // An element alone; what the assembled ones keep is tested in `shape_optimisation.rs`.
            let kept = relative_length(&part, 0.01 / layers as f64);
            assert!(kept > 0.45, "{facets} facets, {groove:?}: {kept:.3}");
            assert_boundary_is(&part, &["inner", "outer"]);
        }
    }
}

/// A ring of one layer has no node that could move.
#[test]
fn issue_groove_in_a_single_layer() {
    let ring = Annulus { facets: 63, layers: 1, grooves: vec![GROOVE], ..RING };
    let part = ring.part().expect("a groove that can be cut");
    assert!(smallest_jacobian(&part) > 0.0);
}

/// The deepest groove that is promised, through six layers of ten.
#[test]
fn behaves_deepest_groove_stays_in_order() {
    let grooves = vec![Groove { depth: 6e-3, ..GROOVE }];
    let part = Annulus { facets: 628, layers: 10, grooves, ..RING }.part().expect("60 % of the thickness");
    assert!(smallest_jacobian(&part) > 0.0);
    assert!(relative_length(&part, 1e-3) > 0.35);
}

/// A wall of a groove is shaped until that gains little, and the last digit of a sine decides where it stops. Sum
/// of the bits of all coordinates, each over its place.
#[test]
fn golden_a_groove_has_the_same_digits_on_every_platform() {
    let sloped = Groove { slope: PI / 4.0, ..Groove::rectangular(-0.2, 0.02, 0.1e-3) };
    let part = Annulus { grooves: vec![GROOVE, sloped], ..RING }.part().expect("grooves that can be cut");
    let bits = part.x.iter().chain(&part.y).zip(1_u64..);
    let sum = bits.fold(0_u64, |sum, (value, place)| sum.wrapping_add(value.to_bits().wrapping_mul(place)));
    assert_eq!(sum, 12_547_555_927_730_868_083);
}

/// Each groove as it would be alone, in whatever order they are given; facets between two of them are equally
/// long.
#[test]
fn behaves_several_grooves_of_one_surface() {
    let n = RING.facets;
    let short = Groove::rectangular(1.9, 0.004, 0.5e-3);
    let sloped = Groove { slope: PI / 4.0, ..Groove::rectangular(-0.2, 0.02, 0.1e-3) };
    // About the first node of a row, and so near to the first one that no column between them stays radial.
    let part = |grooves: &[Groove]| {
        Annulus { grooves: grooves.to_vec(), start_angle: -0.2, ..RING }
            .part()
            .expect("grooves that can be cut")
    };
    let (all, turned) = (part(&[GROOVE, short, sloped]), part(&[sloped, short, GROOVE]));
    assert_eq!((&all.x, &all.y), (&turned.x, &turned.y));
    assert!(smallest_jacobian(&all) > 0.0);
    assert!(relative_length(&all, 0.5e-3) > 0.7, "{}", relative_length(&all, 0.5e-3));
    assert_boundary_is(&all, &["inner", "outer"]);

    let mut corners = Vec::new();
    for groove in [sloped, GROOVE, short] {
        let half = 0.5 * groove.length / RING.inner_radius;
        let wall = if groove == sloped { groove.depth / RING.inner_radius } else { 0.0 };
        let [low, high] = [groove.centre_angle - half, groove.centre_angle + half];
        let floor = RING.inner_radius + groove.depth;
        for (angle, radius) in
            [(low, RING.inner_radius), (low + wall, floor), (high - wall, floor), (high, RING.inner_radius)]
        {
            let at = [radius * angle.cos(), radius * angle.sin()];
            let is = |c: &usize| {
                let [x, y] = point(&all, *c as u32);
                (x - at[0]).hypot(y - at[1]) < 1e-12
            };
            corners.push((0..n).find(is).expect("a node at every corner"));
        }
    }
    // From the second upper corner of each to the first of the next.
    for k in 0..3 {
        let (from, to) = (corners[4 * k + 3], corners[(4 * k + 4) % 12]);
        let facets = (to + n - from) % n;
        let length = |m: usize| {
            let ([x1, y1], [x2, y2]) =
                (point(&all, ((from + m) % n) as u32), point(&all, ((from + m + 1) % n) as u32));
            assert!((x1.hypot(y1) - RING.inner_radius).abs() < 1e-12);
            (x2 - x1).hypot(y2 - y1)
        };
        for m in 1..facets {
            assert_close(length(m), length(0), 1e-9, "facets between two grooves");
        }
        assert!((length(0) / 0.5e-3 - 1.0).abs() < 0.05, "{} m", length(0));
    }
}

/// Columns on the far side of two grooves that are near to each other stay radial, and facets of either
/// surface alike.
#[test]
fn invariant_cells_away_from_two_near_grooves_are_alike() {
    let n = RING.facets;
    let other = Groove { centre_angle: GROOVE.centre_angle + 0.21, ..GROOVE };
    let part = Annulus { grooves: vec![GROOVE, other], ..RING }.part().expect("grooves that can be cut");
    let mut radial = 0;
    for column in 0..n {
        let ([x1, y1], [x2, y2]) =
            (point(&part, column as u32), point(&part, (RING.layers * n + column) as u32));
        radial += usize::from((x1 * y2 - x2 * y1).abs() < 1e-15);
    }
    // Both grooves, what lies between them and two thicknesses on either side.
    assert!(radial > 5 * n / 6, "{radial} of {n} columns are radial");
}

#[test]
fn refuses_with_field_and_limit() {
    let refused = |annulus: Annulus| annulus.part().expect_err("a ring that cannot be made").to_string();
    let with = |groove: Groove| Annulus { grooves: vec![groove], ..RING };
    for (message, parts) in [
        (refused(Annulus { inner_radius: -0.1, ..RING }), ["inner_radius", "-0.1"]),
        (refused(Annulus { inner_radius: f64::NAN, ..RING }), ["inner_radius", "NaN"]),
        (refused(Annulus { outer_radius: 0.1, ..RING }), ["outer_radius", "above 0.1"]),
        (refused(Annulus { start_angle: f64::INFINITY, ..RING }), ["start_angle", "inf"]),
        (refused(Annulus { facets: 7, ..RING }), ["facets", "between 8"]),
        (refused(Annulus { layers: 0, ..RING }), ["layers", "between 1"]),
        (refused(with(Groove { depth: 6.1e-3, ..GROOVE })), ["depth", "60 %"]),
        (refused(with(Groove { length: 0.0, ..GROOVE })), ["length", "above zero"]),
        (refused(with(Groove { length: 0.6, ..GROOVE })), ["length", "at most"]),
    ] {
        assert!(parts.iter().all(|p| message.contains(p)), "{message}");
    }
    // They overlap, are too near, one lies in the other, and they are in both surfaces.
    let other = |groove: Groove| Annulus { grooves: vec![GROOVE, groove], ..RING };
    for centre_angle in [0.5 * PI + 0.05, 0.5 * PI - 0.14] {
        let near = other(Groove { centre_angle, ..GROOVE });
        assert!(matches!(near.part(), Err(Error::Conflict { field: "centre_angle", .. })), "{centre_angle}");
    }
    let within = other(Groove { length: 0.08, ..GROOVE });
    assert!(matches!(within.part(), Err(Error::Conflict { field: "centre_angle", .. })));
    let opposite = other(Groove { centre_angle: -1.0, circle: Circle::Outer, ..GROOVE });
    assert!(matches!(opposite.part(), Err(Error::Conflict { field: "circle", .. })));
    let few = Annulus { facets: 8, ..with(Groove { length: 0.2, ..GROOVE }) };
    assert!(matches!(few.part(), Err(Error::Count { field: "facets", value: 8, .. })));
}

#[test]
fn invariant_a_groove_in_the_outer_surface_is_that_in_the_inner_one_seen_from_outside() {
    let groove = Groove { circle: Circle::Outer, ..GROOVE };
    let ring = Annulus {
        inner_radius: 0.0715,
        outer_radius: 0.0815,
        facets: 1024,
        layers: 20,
        start_angle: 0.0,
        grooves: vec![groove],
    };
    let graded = Grading { fine: Circle::Outer, fine_layers: 2, transitions: 1 };
    let sound = Annulus { grooves: Vec::new(), ..ring.clone() };
    for (part, sound) in
        [(ring.part(), sound.part()), (ring.graded_part(&graded), sound.graded_part(&graded))]
    {
        let (part, sound) = (part.expect("a groove that can be cut"), sound.expect("a ring"));
        let outer = part.surface("outer").expect("an outer surface");
        let place = |&n: &u32| (part.x[n as usize], part.y[n as usize]);
        let radii: Vec<f64> = outer.nodes.iter().map(|n| place(n).0.hypot(place(n).1)).collect();
        let floor = radii.iter().filter(|r| (**r - (0.0815 - 0.2e-3)).abs() < 1e-12).count();
        let circle = radii.iter().filter(|r| (**r - 0.0815).abs() < 1e-12).count();
        // 10 mm of facets 0.5 mm long, the two ends of the floor among them.
        assert_eq!((floor, floor + circle), (21, 1024));
        // What the groove takes from the area, but for what facets of slightly other lengths sag.
        let taken = sound.area() - part.area();
        assert!((taken / (0.01 * 0.2e-3) - 1.0).abs() < 0.02, "{taken}");
    }
}

#[test]
fn by_hand_sloped_walls_are_as_wide_as_their_slope_asks() {
    for circle in [Circle::Inner, Circle::Outer] {
        let slope = PI / 6.0;
        let groove = Groove { slope, circle, ..GROOVE };
        let ring = Annulus {
            inner_radius: 0.1,
            outer_radius: 0.11,
            facets: 1200,
            layers: 20,
            start_angle: 0.0,
            grooves: vec![groove],
        };
        let part = ring.part().expect("a groove that can be cut");
        let (name, on) = if circle == Circle::Inner { ("inner", 0.1) } else { ("outer", 0.11) };
        let surface = part.surface(name).expect("a surface");
        let mut angles: Vec<f64> = Vec::new();
        for &n in &surface.nodes {
            let (x, y) = (part.x[n as usize], part.y[n as usize]);
            if (x.hypot(y) - on).abs() > 0.19e-3 {
                angles.push(y.atan2(x));
            }
        }
        let (low, high) = angles.iter().fold((f64::MAX, f64::MIN), |(l, h), a| (l.min(*a), h.max(*a)));
        let wall = 0.2e-3 / slope.tan();
        assert!(((high - low) * on - (0.01 - 2.0 * wall)).abs() < 1e-9, "{}", (high - low) * on);
    }
    let flat = Groove { slope: 0.02, ..GROOVE };
    let ring = Annulus {
        inner_radius: 0.1,
        outer_radius: 0.11,
        facets: 1200,
        layers: 20,
        start_angle: 0.0,
        grooves: vec![flat],
    };
    assert!(matches!(ring.part(), Err(Error::OutOfRange { field: "slope", .. })));
}

#[test]
fn invariant_a_ring_whose_cells_are_not_shaped_has_the_same_surfaces() {
    let ring = |circle| Annulus {
        inner_radius: 0.1,
        outer_radius: 0.11,
        facets: 400,
        layers: 6,
        start_angle: 0.0,
        grooves: vec![Groove { circle, ..GROOVE }],
    };
    for ring in [Circle::Inner, Circle::Outer].map(ring) {
        let [shaped, not] = [ring.part(), ring.unshaped_part()].map(|part| part.expect("a ring"));
        assert_eq!(shaped.surfaces, not.surfaces);
        for &n in shaped.surfaces.iter().flat_map(|(_, surface)| &surface.nodes) {
            let n = n as usize;
            assert_eq!([shaped.x[n], shaped.y[n]], [not.x[n], not.y[n]]);
        }
        assert!((shaped.area() - not.area()).abs() < 1e-12 && shaped.x != not.x);
    }
}
