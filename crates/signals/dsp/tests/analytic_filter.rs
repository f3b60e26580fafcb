//! The notch, the envelope and the statistics against closed forms.

use std::f64::consts::TAU;

use stribeck_dsp::{Envelope, EnvelopeSpectrum, Notch, PeriodCount, PeriodVerdict, statistics};

fn sine(amplitude: f64, frequency_hz: f64, rate: f64, count: usize) -> Vec<f64> {
    (0..count).map(|n| amplitude * (TAU * frequency_hz * n as f64 / rate).sin()).collect()
}

fn largest(signal: &[f64]) -> f64 {
    signal.iter().fold(0.0_f64, |most, x| x.abs().max(most))
}

/// Source: Orfanidis, *Introduction to Signal Processing* (1996), chapter 11.
#[test]
fn analytic_notch_width_is_centre_over_quality() {
    // The two −3 dB frequencies, found by bisection, are f₀/Q apart, also close to half the sample rate.
    const RELATIVE: f64 = 1e-10;
    let half_power = 10.0 * 0.5_f64.log10();
    for (rate, centre, quality) in
        [(1e5, 4671.0, 15.0), (1e4, 2000.0, 15.0), (1e4, 4500.0, 15.0), (50.0, 10.0, 2.0)]
    {
        let notch = Notch::new(rate, centre, quality).unwrap();
        let crossing = |mut inside: f64, mut outside: f64| {
            for _ in 0..80 {
                let middle = 0.5 * (inside + outside);
                if notch.magnitude_db(middle).unwrap() < half_power {
                    inside = middle
                } else {
                    outside = middle
                }
            }
            0.5 * (inside + outside)
        };
        let width = crossing(centre, 0.499_999_999 * rate) - crossing(centre, 1e-9 * rate);
        assert!((width / notch.width_hz() - 1.0).abs() < RELATIVE, "{width}");
        assert_eq!(notch.width_hz(), centre / quality);
    }
}

/// Source: Orfanidis, *Introduction to Signal Processing* (1996), chapter 11.
#[test]
fn analytic_notch_magnitude_beside_the_centre() {
    // 4671 Hz, Q = 15, 100 kHz: −3.96 dB at 4545 Hz, as printed to two decimals.
    let notch = Notch::new(1e5, 4671.0, 15.0).unwrap();
    assert!((notch.magnitude_db(4545.0).unwrap() + 3.96).abs() < 0.005);
    assert!(notch.magnitude_db(4671.0).unwrap() < -200.0);
    assert!(notch.magnitude_db(1.0).unwrap().abs() < 1e-6);
}

#[test]
fn analytic_notch_magnitude_is_what_the_filter_does() {
    const SETTLED_DB: f64 = 140.0;
    let (rate, count) = (1e5, 8000);
    let notch = Notch::new(rate, 4671.0, 15.0).unwrap();
    let settled = notch.transient_samples(SETTLED_DB).unwrap();
    // Each of these frequencies has a whole number of periods in the last 2000 samples.
    for frequency in [4000.0, 4550.0, 4650.0, 5000.0, 12_000.0] {
        let filtered = notch.filter(&sine(1.0, frequency, rate, count)).unwrap();
        assert!(settled < count - 2000);
        let amplitude = statistics::rms(&filtered[count - 2000..]).unwrap() * 2.0_f64.sqrt();
        let magnitude_db = notch.magnitude_db(frequency).unwrap();
        assert!((20.0 * amplitude.log10() - magnitude_db).abs() < 1e-4, "{frequency}: {amplitude}");
    }
}

/// Source: Orfanidis, *Introduction to Signal Processing* (1996), chapter 11.
#[test]
fn analytic_notch_transient() {
    // τ = Q/(π f₀) = 1.022 ms for a narrow notch; 60 dB are 6.9 time constants, 7.06 ms.
    let notch = Notch::new(1e5, 4671.0, 15.0).unwrap();
    assert!((notch.time_constant_s() / (15.0 / (std::f64::consts::PI * 4671.0)) - 1.0).abs() < 1e-3);
    let length = notch.transient_samples(60.0).unwrap();
    assert!((length as f64 / (1e5 * notch.time_constant_s() * 1000.0_f64.ln()) - 1.0).abs() < 2e-3);

    // The answer to an impulse, sample 0 apart, is a ringing of amplitude 2(1 − g), to first order in 1 − g =
    // 0.0097. After the stated length the next crest, at most 2π/ω₀ = 21 samples on, must be 60 dB below that
    // and not much more.
    let mut impulse = vec![0.0; 3000];
    impulse[0] = 1.0;
    let answer = notch.filter(&impulse).unwrap();
    let start = 2.0 * (1.0 - notch.numerator()[0]);
    let end = largest(&answer[length..]);
    assert!(end < 1.01e-3 * start && end > 0.8e-3 * start, "{start} {end}");

    // A quality below one half has two real poles; the slower one counts.
    let wide = Notch::new(100.0, 10.0, 0.3).unwrap();
    let mut impulse = vec![0.0; 400];
    impulse[0] = 1.0;
    let answer = wide.filter(&impulse).unwrap();
    let length = wide.transient_samples(80.0).unwrap();
    assert!(largest(&answer[length..]) < 1e-4);
    assert!(largest(&answer[length / 2..]) > 1e-4);
}

#[test]
fn invariant_a_constant_passes_without_transient() {
    // 4 kN standing at the start: from rest the notch answers with a step, from its first value with the
    // constant.
    let notch = Notch::new(1e5, 4671.0, 15.0).unwrap();
    let force = vec![4000.0; 500];
    let constant = |y: &[f64]| largest(&y.iter().map(|y| y - 4000.0).collect::<Vec<_>>());
    assert_eq!(constant(&notch.filter_from_first(&force).unwrap()), 0.0);
    assert!(constant(&notch.filter(&force).unwrap()) > 30.0);
}

/// Source: Randall and Antoni 2011; THEORY §7.3.
#[test]
fn analytic_envelope_of_an_amplitude_modulated_tone() {
    // (1 + 0.6 cos Ωt) cos ωt, both with whole periods in the record: the envelope is the bracket exactly,
    // its square 1 + 1.2 cos Ωt + 0.36 cos² Ωt has a line of amplitude 1.2 at Ω and of 0.18 at 2Ω.
    let (rate, count) = (1e4, 1000);
    let phase = |frequency: f64, n: usize| TAU * frequency * n as f64 / rate;
    let bracket = |n: usize| 1.0 + 0.6 * phase(90.0, n).cos();
    let x: Vec<f64> = (0..count).map(|n| bracket(n) * phase(2000.0, n).cos()).collect();
    let mut envelope = vec![0.0; count];
    Envelope::new(count).unwrap().process(&x, &mut envelope).unwrap();
    assert!((0..count).all(|n| (envelope[n] - bracket(n)).abs() < 1e-12));

    let mut plan = EnvelopeSpectrum::new(rate, count, Some((1500.0, 2500.0))).unwrap();
    let mut spectrum = plan.blank();
    // A strong tone and a mean outside the band must not matter.
    let disturbed: Vec<f64> = (0..count).map(|n| x[n] + 5.0 + 9.0 * phase(300.0, n).sin()).collect();
    plan.process(&disturbed, &mut spectrum).unwrap();
    for (low, high, frequency, amplitude) in [(60.0, 120.0, 90.0, 1.2), (150.0, 210.0, 180.0, 0.18)] {
        let line = spectrum.sinusoid(&spectrum.peak(low, high).unwrap()).unwrap();
        assert!((line.frequency_hz - frequency).abs() < 0.01, "{line:?}");
        assert!((line.amplitude / amplitude - 1.0).abs() < 1e-3, "{line:?}");
    }
}

#[test]
fn by_hand_periods_in_a_record() {
    // 30 ms of something that repeats 90.1 times a second holds 2.7 periods; ten take 0.111 s.
    let count = PeriodCount::new(0.03, 90.1).unwrap();
    assert_eq!(count.verdict(), PeriodVerdict::TooFew);
    assert!((count.periods() - 2.703).abs() < 1e-9 && (count.needed_s() - 0.110_99).abs() < 1e-4);
    assert!(
        count.to_string().contains("holds 2.7 periods") && count.to_string().contains("0.111 s"),
        "{count}"
    );
    assert_eq!(PeriodCount::new(0.2, 90.1).unwrap().verdict(), PeriodVerdict::Enough);
    assert_eq!(PeriodCount::new(0.3, 90.1).unwrap().verdict(), PeriodVerdict::Comfortable);
}

#[test]
fn by_hand_statistics_of_a_sine_and_of_an_impulse() {
    const ROUNDING: f64 = 1e-12;
    let x = sine(3.0, 10.0, 1000.0, 1000);
    assert!(statistics::mean(&x).unwrap().abs() < ROUNDING);
    assert!((statistics::rms(&x).unwrap() - 3.0 / 2.0_f64.sqrt()).abs() < ROUNDING);
    assert!((statistics::peak(&x).unwrap() - 3.0).abs() < ROUNDING);
    assert!((statistics::crest_factor(&x).unwrap() - 2.0_f64.sqrt()).abs() < ROUNDING);
    assert!((statistics::kurtosis(&x).unwrap() - 1.5).abs() < ROUNDING);

    // One sample of n differs: with p = 1/n the kurtosis of a Bernoulli variable is (1 − 3p(1 − p))/(p(1 −
    // p)).
    let mut impulse = vec![0.0; 100];
    impulse[40] = -7.0;
    let spread: f64 = 0.01 * 0.99;
    assert!(
        (statistics::kurtosis(&impulse).unwrap() / ((1.0 - 3.0 * spread) / spread) - 1.0).abs() < ROUNDING
    );
    assert!((statistics::crest_factor(&impulse).unwrap() - 10.0).abs() < ROUNDING);
}
