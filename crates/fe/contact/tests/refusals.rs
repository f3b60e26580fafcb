//! Inputs that contact refuses, and its messages.

use stribeck_contact::{Contacts, Law, Method, PairSpec, Sides, Surface};
use stribeck_testing::refuses;

#[test]
fn refuses_pairs_that_do_not_exist_or_have_no_points() {
    let (x, y) = ([0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]);
    let law = Law::penalty(1e14).expect("a positive stiffness");
    let made = |[first, second]: [usize; 2], method, thickness, positions: usize| {
        let surface =
            |slots: [u32; 2]| Surface::new("side", slots.to_vec(), false, &x, &y).expect("one facet");
        let surfaces = vec![surface([0, 1]), surface([3, 2])];
        let pair = PairSpec { first, second, law, method, sides: Sides::Both };
        Contacts::new(surfaces, &[pair], thickness, &x[..positions], &y[..positions])
    };
    assert!(made([0, 1], Method::Collocated, 0.01, 4).is_ok());
    refuses(made([0, 2], Method::Collocated, 0.01, 4), &["contact pair 0", "not in the list"]);
    refuses(made([1, 1], Method::Collocated, 0.01, 4), &["contact pair 0", "twice"]);
    for points in [0, 33, usize::MAX] {
        refuses(made([0, 1], Method::Integrated { points }, 0.01, 4), &["contact pair 0", "1 to 32"]);
    }
    for thickness in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        refuses(made([0, 1], Method::Collocated, thickness, 4), &["thickness [m]", "positive"]);
    }
    refuses(made([0, 1], Method::Collocated, 0.01, 3), &["`side`", "no position"]);
}

#[test]
fn refuses_surfaces_without_facets() {
    let (x, y) = ([0.0, 1.0, 1.0, f64::NAN], [0.0, 0.0, 0.0, 0.0]);
    let surface = |slots: &[u32], closed| Surface::new("rim", slots.to_vec(), closed, &x, &y);
    refuses(surface(&[], false), &["`rim`", "at least one facet"]);
    refuses(surface(&[0], false), &["`rim`", "at least one facet"]);
    refuses(surface(&[0, 1], true), &["`rim`", "three when closed"]);
    refuses(surface(&[0, 1, 2], false), &["`rim`", "no length"]);
    refuses(surface(&[0, 3], false), &["`rim`", "no length"]);
    assert_eq!(surface(&[0, 1], false).expect("one facet").facets(), 1);
}
