//! Discrete and random parts of a record.

use std::f64::consts::{PI, TAU};

use stribeck_dsp::{Error, separate};
use stribeck_testing::Noise;

fn noise(count: usize) -> Vec<f64> {
    let mut noise = Noise::new(3);
    (0..count).map(|_| 0.5 * noise.uniform()).collect()
}

fn amplitude(signal: &[f64], cycles: f64) -> f64 {
    let (c, s) = signal.iter().enumerate().fold((0.0, 0.0), |(c, s), (n, x)| {
        let angle = TAU * cycles * n as f64;
        (c + x * angle.cos(), s + x * angle.sin())
    });
    2.0 * (c * c + s * s).sqrt() / signal.len() as f64
}

#[test]
fn analytic_a_line_keeps_the_share_that_its_height_allows() {
    // Antoni and Randall (2004), section 3: P/(P + N), N being the noise within the equivalent bandwidth
    // of a segment's line: 1.5/512 of the two-sided variance 1/12, against P = A²/4.
    let (filter, delay, count) = (512, 100, 1 << 17);
    let cycles = [40.0 / 512.0, 100.5 / 512.0];
    for height in [1.0, 0.1, 0.05] {
        let line = |n: usize| cycles.iter().map(|c| height * (TAU * c * n as f64 + 1.0).sin()).sum::<f64>();
        let noise = noise(count);
        let signal: Vec<f64> = noise.iter().enumerate().map(|(n, x)| x + line(n)).collect();
        let parted = separate(&signal, filter, delay).unwrap();
        let inside = 2 * filter..count - filter;
        let within = 1.5 / 512.0 / 12.0;
        let expected = (height * height / 4.0) / (height * height / 4.0 + within);
        let kept = cycles.map(|c| amplitude(&parted.discrete[inside.clone()], c) / height);
        // Hann's neighbours of the line share it and keep more of its noise than it does.
        assert!((kept[0] - expected).abs() < 0.06, "{height}: kept {kept:?}, expected {expected}");
        // Half-way the response is interpolated from its neighbours: two of them alone make 4/π of their
        // height, four that are equal 8/3π.
        let (least, most) = (8.0 / 3.0 / PI, 4.0 / PI);
        assert!(kept[1] > least * expected && kept[1] < most * expected, "{height}: {kept:?}, {expected}");
        // Of the noise 1/√(segments) of the amplitude passes each line of the filter.
        let rest: Vec<f64> = (inside.clone()).map(|n| parted.random[n] - noise[n]).collect();
        let rms = |x: &[f64]| (x.iter().map(|v| v * v).sum::<f64>() / x.len() as f64).sqrt();
        assert!(rms(&rest) < 0.35 * rms(&noise), "{}", rms(&rest) / rms(&noise));
    }
}

#[test]
fn invariant_the_parts_add_up() {
    let signal = noise(5_000);
    let parted = separate(&signal, 64, 10).unwrap();
    for (n, x) in signal.iter().enumerate() {
        assert!((parted.discrete[n] + parted.random[n] - x).abs() < 1e-12);
    }
}

#[test]
fn refuses_filters_that_do_not_fit() {
    assert!(matches!(separate(&noise(100), 64, 10), Err(Error::TooShort { field: "signal", .. })));
    assert!(matches!(separate(&noise(1000), 4, 10), Err(Error::TooShort { field: "filter", .. })));
    assert!(matches!(separate(&noise(1000), 64, 0), Err(Error::TooShort { field: "delay", .. })));
    assert!(matches!(separate(&[0.0; 1000], 64, 10), Err(Error::Undefined { .. })));
}
