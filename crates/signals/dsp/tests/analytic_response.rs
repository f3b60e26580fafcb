//! Responses from a force to a sensor: modes against their closed form.

use std::f64::consts::TAU;

use stribeck_dsp::{Error, Mode, Response};

const RATE_HZ: f64 = 20_000.0;

fn mode() -> Mode {
    Mode::new(12.0, 2e8, 0.02).expect("a mode")
}

fn harmonic(hz: f64, count: usize) -> Vec<f64> {
    (0..count).map(|n| 1000.0 + 100.0 * (TAU * hz * n as f64 / RATE_HZ).sin()).collect()
}

#[test]
fn analytic_a_harmonic_force_moves_a_mode_as_its_closed_form_says() {
    // Amplitude and phase of the steady motion; Meirovitch 2001, §3.2. The mirror image of a sine turns its
    // phase, so a second of ringing is left out at either end.
    let response = Response::of_modes(vec![mode()]).expect("a response");
    for hz in [50.0, 300.0, mode().hz(), 900.0, 5000.0] {
        let force = harmonic(hz, 60_000);
        let moved = response.through(&force, RATE_HZ).expect("a record");
        let h = mode().accelerance(hz);
        for n in (20_000..40_000).step_by(37) {
            let exact = 100.0 * h.norm() * (TAU * hz * n as f64 / RATE_HZ + h.arg()).sin();
            assert!((moved[n] - exact).abs() < 2e-4 * 100.0 * h.norm(), "{hz}: {} {exact}", moved[n]);
        }
    }
}

#[test]
fn analytic_a_pulse_rings_down_by_the_damping_and_not_before_it_comes() {
    // Free vibration behind a pulse: acceleration falls by exp(−ζω) a second, at ω√(1−ζ²); Meirovitch
    // 2001, §2.2.
    let response = Response::of_modes(vec![mode()]).expect("a response");
    let (begin, width) = (10_000, 20_usize);
    let mut force = vec![0.0; 40_000];
    for n in 0..width {
        force[begin + n] = 1.0 - (TAU * n as f64 / width as f64).cos();
    }
    let moved = response.through(&force, RATE_HZ).expect("a record");
    let most = moved.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let before = moved[..begin - 5].iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(before < 2e-3 * most, "{before} before it, {most} at most");
    let (omega, zeta) = (TAU * mode().hz(), 0.02);
    let damped = omega * (1.0_f64 - zeta * zeta).sqrt();
    // A decaying harmonic satisfies x(t+T) = 2 e^(−ζωT) cos(ω_d T) x(t) − e^(−2ζωT) x(t−T).
    let t = 1.0 / RATE_HZ;
    let (a, b) = (2.0 * (-zeta * omega * t).exp() * (damped * t).cos(), (-2.0 * zeta * omega * t).exp());
    for n in begin + width + 20..begin + 400 {
        let left = moved[n + 1] - a * moved[n] + b * moved[n - 1];
        assert!(left.abs() < 2e-4 * most, "{left} at {n}");
    }
}

#[test]
fn refuses_responses_that_cannot_be() {
    let told = |why: Error, word: &str| assert!(why.to_string().contains(word), "{why}");
    told(Mode::new(-1.0, 1e8, 0.02).unwrap_err(), "mass = -1");
    told(Mode::new(1.0, 0.0, 0.02).unwrap_err(), "stiffness = 0");
    told(Mode::new(1.0, 1e8, 1.5).unwrap_err(), "below 1");
    told(Response::of_modes(Vec::new()).unwrap_err(), "at least 1");
}
