//! The paper's notch.

use stribeck_analysis::filtering::{Filter, PAPER_CENTRE_HZ};

/// Theory of the paper's filter: 311 Hz wide, 3.96 dB at 4545 Hz, time constant 1.02 ms (THEORY §7.2).
#[test]
fn analytic_paper_notch_numbers() {
    let tone: Vec<f64> =
        (0..3000).map(|n| (std::f64::consts::TAU * 4671.0 * n as f64 * 1e-5).sin()).collect();
    let filter = Filter::new(1e5, PAPER_CENTRE_HZ).unwrap();
    let found = filter.finding(&tone, &filter.acceleration(&tone).unwrap(), true);
    assert!((found.width_hz - 311.4).abs() < 0.05);
    assert!((found.attenuation_4545_db.unwrap() - 3.96).abs() < 0.01, "{:?}", found.attenuation_4545_db);
    assert!((found.paper_4545_db.unwrap() - 3.96).abs() < 0.005, "{:?}", found.paper_4545_db);
    assert!((found.time_constant_s - 1.02e-3).abs() < 0.01e-3);
    assert!((found.transient_s - 7.07e-3).abs() < 0.05e-3, "{}", found.transient_s);
    // A clean tone has 29 dB with a boxcar and 56 dB with Hann (computed with scipy over 30 ms).
    assert!((found.attenuation_boxcar_db.unwrap() - 29.0).abs() < 1.5, "{:?}", found.attenuation_boxcar_db);
    assert!((found.attenuation_db.unwrap() - 56.0).abs() < 4.0, "{:?}", found.attenuation_db);
    assert!(found.attenuation_settled_db.unwrap() > found.attenuation_db.unwrap());
}

#[test]
fn refuses_an_attenuation_of_a_short_record() {
    let filter = Filter::new(1e5, PAPER_CENTRE_HZ).unwrap();
    let found = filter.finding(&[1.0; 50], &[1.0; 50], true);
    assert_eq!((found.attenuation_db, found.attenuation_settled_db), (None, None));
    stribeck_testing::assert_refused(Filter::new(8e3, PAPER_CENTRE_HZ), "below half the sample rate");
}
