//! Power over time behind any path.

use std::f64::consts::TAU;

use stribeck_dsp::prewhitened_power;

#[test]
fn invariant_a_path_does_not_change_when_events_are() {
    // Two clicks through two paths of one resonance each: the power is at the clicks nevertheless.
    let through = |hz: f64, at: [usize; 2]| -> Vec<f64> {
        let ring =
            |since: f64| if since < 0.0 { 0.0 } else { (-40.0 * since).exp() * (TAU * hz * since).sin() };
        (0..4096).map(|n| at.iter().map(|at| ring((n as f64 - *at as f64) / 4096.0)).sum()).collect()
    };
    for hz in [700.3, 1100.7] {
        let power = prewhitened_power(&through(hz, [1000, 2500]), (0.25, 1.0));
        let near = |at: usize| power[at - 8..at + 8].iter().sum::<f64>();
        let all: f64 = power.iter().sum();
        assert!(near(1000) > 0.3 * all && near(2500) > 0.3 * all, "{} {} of {all}", near(1000), near(2500));
    }
}
