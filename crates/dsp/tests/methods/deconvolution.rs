//! Pulses behind a resonance.

use stribeck_dsp::momeda;

fn record(period: f64, noise: f64) -> Vec<f64> {
    let mut state = 11_u64;
    let mut signal: Vec<f64> = (0..4_000)
        .map(|_| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            noise * ((state >> 40) as f64 / f64::from(1 << 24) - 0.5)
        })
        .collect();
    // Pulses through 0.9ⁿ cos 0.7n.
    for k in 0.. {
        let at = 17 + (f64::from(k) * period).round() as usize;
        if at >= signal.len() {
            break;
        }
        for (n, slot) in signal[at..].iter_mut().take(80).enumerate() {
            *slot += 0.9_f64.powi(n as i32) * (0.7 * n as f64).cos();
        }
    }
    signal
}

#[test]
fn planted_pulses_are_recovered_through_a_resonance() {
    let found = momeda(&record(50.0, 0.05), 120, &[50.0]).unwrap().remove(0);
    let at_pulses: Vec<f64> = found.output.iter().step_by(50).copied().collect();
    let all: f64 = found.output.iter().map(|y| y * y).sum();
    let theirs: f64 = at_pulses.iter().map(|y| y * y).sum();
    // The record itself has at most a fifth of its energy at any fiftieth sample.
    assert!(theirs > 0.95 * all, "{}", theirs / all);
    assert!(found.kurtosis > 0.9, "{}", found.kurtosis);
}

#[test]
fn planted_the_right_period_stands_above_others() {
    let periods: Vec<f64> = (60..200).map(|t| 0.5 * f64::from(t)).collect();
    let found = momeda(&record(50.0, 0.6), 120, &periods).unwrap();
    let best = found.iter().max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis)).unwrap();
    assert_eq!(best.period, 50.0);
    let others = found.iter().filter(|d| (d.period - 50.0).abs() > 1.0).map(|d| d.kurtosis);
    assert!(others.fold(0.0, f64::max) < 0.5 * best.kurtosis);
}

#[test]
fn refuses_what_has_no_filter() {
    let sine: Vec<f64> = (0..1000).map(|n| (0.1 * f64::from(n)).sin()).collect();
    assert!(momeda(&sine, 50, &[40.0]).unwrap_err().to_string().contains("follow from each other"));
    assert!(momeda(&sine, 1, &[40.0]).is_err());
    assert!(momeda(&sine[..60], 50, &[40.0]).is_err());
    assert!(momeda(&record(50.0, 0.1), 20, &[0.0]).is_err());
}
