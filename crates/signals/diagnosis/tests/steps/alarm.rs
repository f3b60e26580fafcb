//! Limits of a level.

use stribeck_diagnosis::record::alarm::{Limit, Quantity};
use stribeck_testing::Noise;

#[test]
fn analytic_further_records_pass_a_limit_as_rarely_as_stated() {
    // Hahn and Meeker (1991), section 4.8: the share over many references and one further value each.
    let mut noise = Noise::new(17);
    let mut level = || {
        let sum: f64 = (0..12).map(|_| noise.uniform()).sum();
        // A sum of twelve is normal but for its last thousandth, and its variance is that of twelve.
        (0.1 * sum).exp()
    };
    let (mut passed, tried) = ([0_u32; 2], 40_000);
    for _ in 0..tried {
        let reference: Vec<f64> = (0..6).map(|_| level()).collect();
        let limit = Limit::from_reference(Quantity::Rms, &reference).unwrap();
        let next = level();
        passed[0] += u32::from(next >= limit.warning);
        passed[1] += u32::from(next >= limit.alarm);
    }
    let shares = passed.map(|count| f64::from(count) / f64::from(tried));
    // Three deviations of a count of 400, and of one of 40.
    assert!((shares[0] - 0.01).abs() < 0.0015 && (shares[1] - 0.001).abs() < 0.0005, "{shares:?}");
}

#[test]
fn behaves_limits_are_read_as_they_are_written() {
    let limit = Limit::parse("velocity=2.8..7.1").unwrap();
    assert_eq!(limit, Limit { quantity: Quantity::VelocityMmS, warning: 2.8, alarm: 7.1 });
    assert_eq!(Limit::parse("bpfo = 20 .. 30").unwrap().quantity, Quantity::Bpfo);
}

#[test]
fn refuses_limits_that_are_none() {
    for (text, says) in [
        ("rms", "NAME=WARNING..ALARM"),
        ("rms=1", "NAME=WARNING..ALARM"),
        ("rms=a..2", "NAME=WARNING..ALARM"),
        ("noise=1..2", "names are rms, velocity"),
        ("rms=2..1", "must not lie above"),
    ] {
        assert!(Limit::parse(text).unwrap_err().contains(says), "{text}");
    }
    assert!(Limit::from_reference(Quantity::Rms, &[1.0, 2.0]).is_none());
}
