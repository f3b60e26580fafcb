//! A speed that is given twice too high, and a number of rolling elements that is not given: made records.

use std::f64::consts::TAU;

use stribeck_diagnosis::{Machine, MeasuredFindings};
use stribeck_testing::Noise;
use stribeck_theory::catalogue::{CatalogueBearing, Element};

use crate::signals::{RATE_HZ, RING, analysed, claimed, judged, machine};

const SAMPLES: usize = 131_072;
/// No whole number.
const SHAFT_HZ: f64 = 23.71;

/// Impacts of the outer raceway of a 6205 in noise, and lines at `multiples` of the shaft.
fn outer_raceway(multiples: &[u32]) -> Vec<f64> {
    impacts(CatalogueBearing::parse("6205").unwrap().orders().unwrap().bpfo, multiples)
}

/// Impacts at `order` times the shaft that ring at 3 kHz in noise, and lines at `multiples` of it.
fn impacts(order: f64, multiples: &[u32]) -> Vec<f64> {
    let mut noise = Noise::new(7);
    let turns = |n: usize| -> f64 {
        let turn = TAU * SHAFT_HZ * n as f64 / RATE_HZ;
        multiples.iter().map(|k| 0.3 * (f64::from(*k) * turn + f64::from(*k)).sin()).sum()
    };
    let mut signal: Vec<f64> = (0..SAMPLES).map(|n| noise.uniform() + turns(n)).collect();
    RING.add_all(&mut signal, &mut noise, order * SHAFT_HZ, |_| 5.0);
    signal
}

fn analysed_with(bearing: CatalogueBearing, samples: Vec<f64>, rpm: f64) -> MeasuredFindings {
    judged(samples, &Machine { bearing: Some(bearing), ..machine(rpm) })
}

/// Of 95 damaged bearings whose speed was given twice as high 88 had no verdict, because the comb of the
/// raceway stood at half of its place.
#[test]
fn issue_half_of_a_speed_is_taken_where_shaft_and_raceway_say_so() {
    let given_rpm = 2.0 * 60.0 * SHAFT_HZ;
    let findings = analysed(outer_raceway(&[1, 2, 3, 4, 5]), given_rpm);
    assert_eq!(claimed(&findings), ["BPFO"], "{}", findings.verdict);
    let rpm = findings.speed_rpm.unwrap();
    // Within a tenth of a per cent: half of a line of 0.1 Hz at the fifth multiple.
    assert!((rpm / (60.0 * SHAFT_HZ) - 1.0).abs() < 1e-3 && findings.speed_given_rpm == Some(given_rpm));
    assert!(findings.verdict.contains("half of the 2845.2 rpm that were given"), "{}", findings.verdict);
}

/// With the even multiples alone the shaft may well turn as fast as given; what strikes stays unnamed.
#[test]
fn issue_half_of_a_speed_is_not_taken_without_lines_of_the_shaft_at_it() {
    for multiples in [&[2, 4, 6, 8][..], &[]] {
        let findings = analysed(outer_raceway(multiples), 2.0 * 60.0 * SHAFT_HZ);
        assert!(claimed(&findings).is_empty(), "{multiples:?}: {}", findings.verdict);
        assert!(findings.unexplained.is_some(), "{multiples:?}: {}", findings.verdict);
    }
}

/// A 6205 whose balls nobody has counted, and rollers of which 19 pass the outer raceway as often as 14 the inner
/// one: 9.5 (1 - r) = 7 (1 + r) at r = 2.5/16.5.
fn uncounted() -> [CatalogueBearing; 2] {
    let balls = CatalogueBearing { elements: None, ..CatalogueBearing::parse("6205").unwrap() };
    let rollers = CatalogueBearing {
        element: Element::Roller,
        diameter_mm: 40.0 * 2.5 / 16.5,
        pitch_mm: 40.0,
        ..balls.clone()
    };
    [balls, rollers]
}

/// 372 of 380 bearings of the catalogue have no number, and had no verdict.
#[test]
fn planted_the_number_of_rolling_elements_is_found_by_the_impacts() {
    let rpm = 60.0 * SHAFT_HZ;
    let [balls, rollers] = uncounted();
    let findings = analysed_with(balls.clone(), outer_raceway(&[1, 2, 3]), rpm);
    assert!(claimed(&findings).is_empty(), "{}", findings.verdict);
    assert!(
        findings.verdict.contains("a defect of the outer raceway would with 9 (BPFO"),
        "{}",
        findings.verdict
    );
    assert!(findings.verdict.contains("of 8 to 10 rolling elements"), "{}", findings.verdict);
    assert!(findings.bearing.as_ref().is_some_and(|it| it.contains("9 balls")), "{:?}", findings.bearing);

    let mut noise = Noise::new(7);
    let silent = analysed_with(balls, (0..SAMPLES).map(|_| noise.uniform()).collect(), rpm);
    assert!(claimed(&silent).is_empty(), "{}", silent.verdict);
    assert!(
        silent.verdict.contains("with each number of rolling elements from 8 to 10"),
        "{}",
        silent.verdict
    );

    // Two numbers explain the same impacts.
    let both = analysed_with(rollers, impacts(7.0 * (1.0 + 2.5 / 16.5), &[1, 2, 3]), rpm);
    assert!(claimed(&both).is_empty(), "{}", both.verdict);
    for part in ["the outer raceway would with 19 (BPFO", "the inner raceway would with 14 (BPFI"] {
        assert!(both.verdict.contains(part), "{part}: {}", both.verdict);
    }
}
