//! A speed followed by its line.

use std::f64::consts::TAU;

use stribeck_diagnosis::speed::ridge::speed;
use stribeck_dsp::channel::Channel;
use stribeck_testing::{Noise, assert_refused};

const RATE_HZ: f64 = 5_000.0;

fn channel(strength: f64) -> Channel {
    let mut noise = Noise::new(3);
    // From 1200 to 1500 rpm in 40 s.
    let samples = (0..200_000).map(|n| {
        let t = f64::from(n) / RATE_HZ;
        noise.uniform() + strength * (TAU * (20.0 * t + 0.0625 * t * t)).sin()
    });
    Channel::held("housing", samples.collect())
}

#[test]
fn planted_a_speed_that_rises_is_followed() {
    let found = speed(&channel(0.1), RATE_HZ, 1_000.0, 1_800.0).unwrap();
    // The least deviation that 0.96 s allow (Cramér and Rao): √(6/72)/(2π 0.96) Hz, 72 being the power of
    // the line over that of the noise times its samples; Hann's window and the parabola cost as much
    // again.
    let deviation = 2.0 * 0.048;
    let off = |(t, hz): (&f64, &f64)| hz - (20.0 + 0.125 * t);
    let errors: Vec<f64> = found.times_s.iter().zip(&found.frequencies_hz).map(off).collect();
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    assert!(rms < 1.5 * deviation, "{rms}");
    assert!(errors.iter().all(|e| e.abs() < 5.0 * deviation), "{errors:?}");
    assert!((60.0 * found.mean_hz() - 1_350.0).abs() < 5.0);
}

#[test]
fn refuses_a_range_without_a_line() {
    for range in [(1_000.0, 1_800.0), (600.0, 3_000.0), (1_400.0, 1_600.0)] {
        assert_refused(speed(&channel(0.0), RATE_HZ, range.0, range.1), "no line stands out");
    }
    for (low, high) in [(0.0, 100.0), (900.0, 800.0)] {
        assert_refused(speed(&channel(1.0), RATE_HZ, low, high), "they must ascend from above 0");
    }
    assert!(speed(&channel(1.0), RATE_HZ, 10.0, 100.0).unwrap_err().to_string().contains("too short"));
}
