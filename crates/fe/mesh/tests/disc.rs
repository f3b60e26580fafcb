//! Discs: area, rim, centre, sizes, for any count of facets.

mod common;

use std::f64::consts::TAU;

use common::*;
use proptest::prelude::*;
use stribeck_mesh::{Disc, Part, find_strips};
use stribeck_testing::assert_close;

/// A disc of 18 mm diameter whose 112 facets are 0.505 mm long.
const DISC: Disc = Disc { radius: 9e-3, facets: 112, size: 0.5e-3, rotation: 0.0 };

fn made(disc: Disc) -> Part {
    disc.part().unwrap_or_else(|e| panic!("{disc:?}: {e}"))
}

/// What every disc must fulfil, whatever its numbers.
fn assert_is_a_disc(disc: Disc, part: &Part) {
    let n = disc.facets;
    assert!(smallest_jacobian(part) > 0.0, "{disc:?} has an element inside out");
    assert_boundary_is(part, &["rim"]);
    let rim = surface(part, "rim");
    assert_eq!((rim.facets(), rim.closed), (n, true));
    for (i, node) in rim.nodes.iter().enumerate() {
        let [x, y] = point(part, *node);
        assert_close(x.hypot(y), disc.radius, ROUNDING, "rim radius");
        let angle = disc.rotation + TAU * i as f64 / n as f64;
        assert!((x - disc.radius * angle.cos()).abs() < ROUNDING * disc.radius, "{disc:?}: rim angle {i}");
    }
    let polygon = 0.5 * n as f64 * disc.radius * disc.radius * (TAU / n as f64).sin();
    // Thousands of elements add their roundings.
    assert_close(part.area(), polygon, 1e-11, "area");
    assert_close(area_on_the_left(part, &rim.nodes), polygon, 1e-11, "area left of the rim");
    let centre = part.mark("centre").expect("a centre");
    assert_eq!(point(part, centre), [0.0, 0.0]);
    let used: std::collections::BTreeSet<u32> =
        part.quads.iter().flatten().chain(part.triangles.iter().flatten()).copied().collect();
    assert_eq!(used.len(), part.x.len(), "{disc:?} has a node without an element");
}

#[test]
fn behaves_default_disc_is_the_polygon() {
    assert_is_a_disc(DISC, &made(DISC));
}

#[test]
fn behaves_default_disc_has_about_a_thousand_even_cells() {
    let part = made(DISC);
    let elements = part.quads.len() + part.triangles.len();
    assert!((1000..=1250).contains(&elements), "{elements} elements");
    // The area of the disc in squares of `size` is 1017.
    let length = relative_length(&part, DISC.size);
    assert!(length > 0.8, "smallest length {length:.3} of that of a 0.5 mm square");
}

#[test]
fn behaves_uniform_discs_keep_the_critical_step() {
    for facets in [15, 16, 31, 56, 97, 112, 113, 120, 224, 500] {
        let size = TAU * DISC.radius / facets as f64;
        let disc = Disc { facets, size, ..DISC };
        let part = made(disc);
        assert_is_a_disc(disc, &part);
        let length = relative_length(&part, size);
        assert!(length > 0.7, "{facets} facets: {length:.3}");
    }
}

#[test]
fn behaves_coarse_and_fine_rims_on_one_core() {
    for facets in 8..=40 {
        assert_is_a_disc(Disc { facets, ..DISC }, &made(Disc { facets, ..DISC }));
    }
    for facets in [56, 113, 120, 224, 500] {
        assert_is_a_disc(Disc { facets, ..DISC }, &made(Disc { facets, ..DISC }));
    }
}

/// Squares twenty times smaller or larger than the facets make needles, but never an element inside out.
#[test]
fn behaves_sizes_far_from_the_facet_length() {
    for (facets, size) in [(8, 0.05e-3), (13, 0.2e-3), (24, 0.05e-3), (200, 9e-3), (500, 50e-3)] {
        let disc = Disc { facets, size, ..DISC };
        assert_is_a_disc(disc, &made(disc));
    }
}

#[test]
fn invariant_rotation_turns_the_whole_pattern() {
    let (still, turned) = (made(DISC), made(Disc { rotation: 0.7, ..DISC }));
    assert_is_a_disc(Disc { rotation: 0.7, ..DISC }, &turned);
    let expected = still.rotated(0.7);
    for i in 0..still.x.len() {
        let apart = (turned.x[i] - expected.x[i]).hypot(turned.y[i] - expected.y[i]);
        assert!(apart < ROUNDING * DISC.radius, "node {i} is {apart:e} m away");
    }
    assert_eq!((still.quads, still.triangles), (turned.quads, turned.triangles));
}

#[test]
fn behaves_rows_are_strips() {
    let part = made(DISC);
    let strips = find_strips(&part.quads);
    assert_eq!(strips.iter().map(|s| s.len).sum::<usize>(), part.quads.len());
    // Two rim layers of two strips each, and one strip for each row of squares.
    let rows = strips.len() - 4;
    let across = 2.0 * DISC.radius / DISC.size;
    assert!((rows as f64) < across && rows as f64 > 0.7 * across, "{rows} rows of squares");
    let scale = made(Disc { radius: 9.0, size: 0.5, ..DISC });
    assert_eq!(scale.quads, part.quads, "the pattern does not depend on the unit");
}

#[test]
fn refuses_with_field_and_limit() {
    for (disc, parts) in [
        (Disc { radius: 0.0, ..DISC }, ["radius", "above zero"]),
        (Disc { size: f64::NAN, ..DISC }, ["size", "NaN"]),
        (Disc { rotation: f64::NEG_INFINITY, ..DISC }, ["rotation", "inf"]),
        (Disc { facets: 7, ..DISC }, ["facets", "between 8"]),
        (Disc { size: 1e-6, ..DISC }, ["size", "at least"]),
    ] {
        let message = disc.part().expect_err("a disc that cannot be made").to_string();
        assert!(parts.iter().all(|p| message.contains(p)), "{message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn invariant_any_disc_is_a_disc(
        facets in 8_usize..200,
        cells in 0.4_f64..3.0,
        radius in 1e-3_f64..1.0,
        rotation in -7.0_f64..7.0,
    ) {
        let size = cells * TAU * radius / facets as f64;
        let disc = Disc { radius, facets, size, rotation };
        assert_is_a_disc(disc, &made(disc));
    }
}

/// A fine rim around a core of three times larger squares: each layer is a row of quadrilaterals, no cell is
/// smaller than in a disc of fine cells, and far fewer cells are needed.
#[test]
fn behaves_layers_around_a_coarse_core() {
    let coarse = Disc { size: 1.5e-3, ..DISC };
    let fine = made(DISC);
    for layers in 0..=coarse.most_layers() {
        let part = coarse.part_with_layers(layers).expect("a disc");
        assert_is_a_disc(coarse, &part);
        let rows = find_strips(&part.quads).iter().filter(|s| s.len == 111).count();
        assert_eq!(rows, layers, "a row is one strip and the cell that closes it");
        if layers == 3 {
            assert!(relative_length(&part, 0.5e-3) >= relative_length(&fine, 0.5e-3));
            let count = |p: &Part| p.quads.len() + p.triangles.len();
            assert!(count(&part) < 6 * count(&fine) / 10, "{} cells", count(&part));
        }
    }
    assert_eq!(coarse.most_layers(), 8);
    let message = coarse.part_with_layers(9).expect_err("no core is left").to_string();
    assert!(message.contains("layers") && message.contains("and 8"), "{message}");
}
