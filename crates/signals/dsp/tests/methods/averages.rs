//! Median and running mean.

use stribeck_dsp::{median, running_mean};

#[test]
fn by_hand_running_mean_removes_a_whole_period() {
    let tone: Vec<f64> =
        (0..400).map(|n| 10.0 + (std::f64::consts::TAU * f64::from(n) / 20.0).sin()).collect();
    assert!(running_mean(&tone, 20).iter().all(|v| (v - 10.0).abs() < 1e-12));
    assert_eq!(running_mean(&[1.0, 3.0], 5), [2.0]);
    assert!(running_mean(&[], 5).is_empty());
}

#[test]
fn by_hand_medians_of_odd_even_and_no_numbers() {
    assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
    assert_eq!(median(&mut [4.0, 1.0, 3.0, 2.0]), 2.5);
    assert!(median(&mut []).is_nan());
}
