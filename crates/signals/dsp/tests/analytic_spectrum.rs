//! Spectra against closed forms: widths of windows, amplitudes of sines, levels of noise.

use std::f64::consts::TAU;

use stribeck_dsp::{Averaging, Scaling, Sides, Spectrum, Welch, WelchOptions, Window, statistics};
use stribeck_testing::{Noise, assert_refused};

fn sine(amplitude: f64, frequency_hz: f64, rate: f64, count: usize) -> Vec<f64> {
    (0..count).map(|n| amplitude * (TAU * frequency_hz * n as f64 / rate + 0.4).sin()).collect()
}

/// Noise that is uniform from −½ to ½ (variance 1/12).
fn noise(count: usize) -> Vec<f64> {
    let mut noise = Noise::new(7);
    (0..count).map(|_| 0.5 * noise.uniform()).collect()
}

fn estimate(rate: f64, signal: &[f64], options: &WelchOptions) -> Spectrum {
    Welch::new(rate, signal.len(), options).unwrap().estimate(signal).unwrap()
}

#[test]
fn by_hand_samples_of_windows() {
    for (window, expected) in [
        (Window::Boxcar, vec![1.0; 5]),
        (Window::Hann, vec![0.0, 0.5, 1.0, 0.5]),
        (Window::SymmetricHann, vec![0.0, 0.5, 1.0, 0.5, 0.0]),
        (Window::SymmetricHamming, vec![0.08, 0.54, 1.0, 0.54, 0.08]),
    ] {
        let found = window.samples(expected.len()).unwrap();
        assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-15), "{window}: {found:?}");
    }
}

#[test]
fn analytic_window_widths() {
    // Harris (1978), table 1: equivalent noise bandwidth, width at −3 dB and at −6 dB in bins, to two
    // decimals.
    const TABLE_ROUNDING: f64 = 0.006;
    let len = 4096;
    for (window, noise_bandwidth, width_3db, width_6db) in [
        (Window::Boxcar, 1.00, 0.89, 1.21),
        (Window::Hann, 1.50, 1.44, 2.00),
        (Window::SymmetricHamming, 1.36, 1.30, 1.81),
    ] {
        assert!(
            (window.noise_bandwidth_bins(len).unwrap() - noise_bandwidth).abs() < TABLE_ROUNDING,
            "{window}"
        );
        assert!((window.width_3db_bins(len).unwrap() - width_3db).abs() < TABLE_ROUNDING, "{window}");
        assert!((window.width_6db_bins(len).unwrap() - width_6db).abs() < TABLE_ROUNDING, "{window}");
    }
    // Σw = N/2 and Σw² = 3N/8 make the periodic Hann window's bandwidth exactly 3/2, its response one bin
    // away 1/2.
    assert!((Window::Hann.noise_bandwidth_bins(len).unwrap() - 1.5).abs() < 1e-13);
    assert!((Window::Hann.width_6db_bins(len).unwrap() - 2.0).abs() < 1e-12);
}

/// Source: Harris 1978.
#[test]
fn analytic_window_response_is_the_transform_of_its_samples() {
    const ROUNDING: f64 = 1e-13;
    let len = 37;
    for window in [Window::Boxcar, Window::Hann, Window::SymmetricHann, Window::SymmetricHamming] {
        let weights = window.samples(len).unwrap();
        let sum: f64 = weights.iter().sum();
        for bins in [0.0, 0.1, 0.5, 1.0, 1.3, 2.7] {
            let part = |trig: fn(f64) -> f64| -> f64 {
                weights.iter().enumerate().map(|(n, w)| w * trig(TAU * bins * n as f64 / len as f64)).sum()
            };
            let direct = part(f64::cos).hypot(part(f64::sin)) / sum;
            assert!((window.response(len, bins).unwrap() - direct).abs() < ROUNDING, "{window} at {bins}");
        }
    }
}

#[test]
fn planted_amplitude_of_a_sine_is_read_back() {
    // 50 m/s² at 4671 Hz for 30 ms at 100 kHz. What remains of the error is leakage of the negative
    // frequency.
    const AMPLITUDE: f64 = 1e-3;
    const RESOLUTIONS: f64 = 1e-3;
    let (rate, count) = (1e5, 3000);
    let padded = WelchOptions::for_grid(rate, count, 3.0).unwrap();
    let plain = WelchOptions::new(count);
    let averaged = WelchOptions::new(1000);
    for options in [&padded, &plain, &averaged] {
        for scaling in [Scaling::Density, Scaling::Spectrum] {
            for sides in [Sides::One, Sides::Two] {
                for averaging in [Averaging::Mean, Averaging::Median] {
                    // 4671 Hz lies 0.13 of a bin from the plain grid; 4683 Hz just short of midway.
                    for frequency in [4671.0, 4683.0, 4700.0] {
                        let options = WelchOptions { scaling, sides, averaging, ..options.clone() };
                        let spectrum = estimate(rate, &sine(50.0, frequency, rate, count), &options);
                        let line = spectrum.sinusoid(&spectrum.peak(4000.0, 6000.0).unwrap()).unwrap();
                        assert!((line.amplitude / 50.0 - 1.0).abs() < AMPLITUDE, "{line:?} {options:?}");
                        let off = (line.frequency_hz - frequency) / spectrum.resolution().resolution_hz;
                        assert!(off.abs() < RESOLUTIONS, "{line:?} {options:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn planted_amplitude_with_every_window() {
    // A boxcar leaks as 1/distance, so the mirror image 280 bins away matters most there.
    for (window, tolerance) in [
        (Window::Boxcar, 3e-3),
        (Window::Hann, 1e-5),
        (Window::SymmetricHann, 1e-5),
        (Window::SymmetricHamming, 1e-3),
    ] {
        let options = WelchOptions { window, ..WelchOptions::new(3000) };
        let spectrum = estimate(1e5, &sine(2.0, 4678.0, 1e5, 3000), &options);
        let line = spectrum.sinusoid(&spectrum.peak(4000.0, 6000.0).unwrap()).unwrap();
        assert!((line.amplitude / 2.0 - 1.0).abs() < tolerance, "{window}: {line:?}");
    }
}

#[test]
fn planted_peak_is_interpolated() {
    // On a padded grid the parabola is as good as exact; without padding the documented 0.02 resolutions
    // hold.
    let rate = 1e5;
    for (options, tolerance_hz) in
        [(WelchOptions::for_grid(rate, 3000, 3.0).unwrap(), 0.01), (WelchOptions::new(3000), 0.02 * 33.34)]
    {
        for step in 0..12 {
            let frequency = 4667.0 + 3.1 * f64::from(step);
            let spectrum = estimate(rate, &sine(1.0, frequency, rate, 3000), &options);
            let peak = spectrum.peak(4000.0, 6000.0).unwrap();
            assert!((peak.frequency_hz - frequency).abs() < tolerance_hz, "{frequency}: {peak:?}");
            assert!(!peak.at_edge);
        }
    }
}

#[test]
fn planted_peak_on_a_flank_says_so() {
    let spectrum =
        estimate(1e5, &sine(1.0, 4671.0, 1e5, 3000), &WelchOptions::for_grid(1e5, 3000, 3.0).unwrap());
    let flank = spectrum.peak(4680.0, 4700.0).unwrap();
    assert!(flank.at_edge);
    assert!((flank.frequency_hz - 4680.0).abs() < 0.1, "{flank:?}");
}

/// Source: Welch 1967; THEORY §7.1.
#[test]
fn analytic_density_of_white_noise() {
    // Variance 1/12 spread over half the sample rate, 500 Hz. 399 overlapping Hann segments leave 6 % in each
    // bin and much less in the mean over a band; the sum over all is the variance.
    let rate = 1000.0;
    let x = noise(200_000);
    let spectrum = estimate(rate, &x, &WelchOptions::new(1000));
    let expected = 1.0 / 12.0 / 500.0;
    let middle = &spectrum.values()[50..450];
    let mean = middle.iter().sum::<f64>() / middle.len() as f64;
    assert!((mean / expected - 1.0).abs() < 0.01, "{mean} {expected}");
    let band = spectrum.band_rms(100.0, 200.0).unwrap();
    // Both ends are included: 101 bins of 1 Hz.
    assert!((band / (101.0 * expected).sqrt() - 1.0).abs() < 0.02, "{band}");

    // Median and mean agree once the median's bias is taken out.
    let median =
        estimate(rate, &x, &WelchOptions { averaging: Averaging::Median, ..WelchOptions::new(1000) });
    let of_medians = median.values()[50..450].iter().sum::<f64>() / 400.0;
    assert!((of_medians / expected - 1.0).abs() < 0.02, "{of_medians}");
}

#[test]
fn planted_line_above_noise() {
    // A sine of amplitude A on a density S stands 10 log₁₀(A²/2 / (1.5 resolution) / S) above the mean of the
    // noise; the median of the averaged noise is its mean but for 0.1 dB.
    let (rate, amplitude) = (1000.0, 0.5);
    let mut x = noise(200_000);
    x.iter_mut().zip(sine(amplitude, 200.0, rate, 200_000)).for_each(|(x, s)| *x += s);
    let spectrum = estimate(rate, &x, &WelchOptions::new(1000));
    let peak = spectrum.peak(190.0, 210.0).unwrap();
    let expected = 10.0 * (0.5 * amplitude * amplitude / 1.5 / (1.0 / 6000.0)).log10();
    let stands = spectrum.stands_above_db(&peak, 150.0, 250.0, 3.0).unwrap();
    assert!((stands - expected).abs() < 0.3, "{stands} {expected}");
    // Of pure noise the highest of 20 bins stands a few tenths of a decibel above its surroundings, not many.
    let none = spectrum.peak(300.0, 320.0).unwrap();
    assert!(spectrum.stands_above_db(&none, 260.0, 360.0, 3.0).unwrap() < 1.5);
}

#[test]
fn by_hand_grid_and_resolution_are_stated_apart() {
    // 30 ms at 100 kHz on a grid of 3 Hz: resolution 33.3, −3 dB 48.0, −6 dB 66.7, noise bandwidth 50 Hz.
    let short = Welch::for_grid(1e5, 3000, 3.0).unwrap();
    let r = short.resolution();
    assert!(r.zero_padded && r.segments == 1 && r.unused_s == 0.0);
    assert!((r.grid_hz - 1e5 / 33333.0).abs() < 1e-12);
    for (ours, stated) in [
        (r.record_s, 0.03),
        (r.segment_s, 0.03),
        (r.resolution_hz, 33.333),
        (r.width_3db_hz, 48.02),
        (r.width_6db_hz, 66.667),
        (r.noise_bandwidth_hz, 50.0),
    ] {
        assert!((ours / stated - 1.0).abs() < 1e-3, "{ours} {stated}");
    }
    assert!(r.to_string().contains("zero-padded"), "{r}");

    // One second, segments of 33333 samples every 16667: four fit, the fifth lacks one sample. The grid now
    // is the resolution, and the tail that is left out is stated.
    let long = Welch::for_grid(1e5, 100_000, 3.0).unwrap();
    let r = long.resolution();
    assert!(!r.zero_padded && r.segments == 4);
    assert_eq!(r.grid_hz, r.resolution_hz);
    assert!((r.unused_s - 0.166_66).abs() < 1e-12);
    assert!(!r.to_string().contains("zero-padded"), "{r}");
}

#[test]
fn invariant_parseval_for_every_transform_length() {
    // Boxcar, one segment, nothing removed: the density sums to the mean square, whatever the padding and the
    // sides.
    const ROUNDING: f64 = 1e-13;
    let x = noise(301);
    let mean_square = statistics::rms(&x).unwrap().powi(2);
    for nfft in [301, 302, 400, 1021] {
        for sides in [Sides::One, Sides::Two] {
            let options = WelchOptions {
                window: Window::Boxcar,
                detrend: stribeck_dsp::Detrend::None,
                nfft,
                sides,
                ..WelchOptions::new(301)
            };
            let spectrum = estimate(50.0, &x, &options);
            let sum = spectrum.values().iter().sum::<f64>() * spectrum.resolution().grid_hz;
            assert!((sum / mean_square - 1.0).abs() < ROUNDING, "{nfft}: {sum} {mean_square}");
            for scaling in [Scaling::Density, Scaling::Spectrum] {
                let spectrum = estimate(50.0, &x, &WelchOptions { scaling, ..options.clone() });
                let band = spectrum.band_rms(0.0, 25.0).unwrap();
                assert!((band * band / mean_square - 1.0).abs() < ROUNDING, "{nfft} {scaling:?}");
            }
        }
    }
}

#[test]
fn invariant_estimates_do_not_depend_on_what_was_estimated_before() {
    let (a, b) = (noise(500), sine(3.0, 7.0, 100.0, 500));
    for averaging in [Averaging::Mean, Averaging::Median] {
        let options = WelchOptions { averaging, nfft: 150, ..WelchOptions::new(100) };
        let mut plan = Welch::new(100.0, 500, &options).unwrap();
        let fresh = plan.estimate(&a).unwrap();
        let mut out = plan.estimate(&b).unwrap();
        plan.process(&a, &mut out).unwrap();
        assert_eq!(out.values(), fresh.values());
    }
}

#[test]
fn analytic_the_velocity_of_a_sine() {
    // a sin ωt moves with a/ω (THEORY §7.10).
    let signal: Vec<f64> = (0..20_000).map(|n| 5.0 * (TAU * 80.0 * f64::from(n) / 1e4).sin()).collect();
    let spectrum = Welch::for_grid(1e4, signal.len(), 1.0).unwrap().estimate(&signal).unwrap();
    let found = spectrum.velocity_rms(10.0, 1000.0).unwrap();
    let expected = 5.0 / (TAU * 80.0) / 2.0_f64.sqrt();
    // The line's width of 1 Hz at 80 Hz, squared.
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    assert_refused(spectrum.velocity_rms(0.0, 1000.0), "begin the band above 0 Hz");
    assert_refused(spectrum.velocity_rms(10.0, 9000.0), "≤ 5000 Hz");
}
