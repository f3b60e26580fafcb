//! Refused inputs: the message names the field, the value and the limit.

use stribeck_dsp::{
    Averaging, Envelope, EnvelopeSpectrum, Error, Notch, PeriodCount, Welch, WelchOptions, Window, statistics,
};

fn says(error: Error, parts: &[&str]) {
    let message = error.to_string();
    for part in parts {
        assert!(message.contains(part), "\"{message}\" lacks \"{part}\"");
    }
}

fn plan_error(rate: f64, record: usize, options: &WelchOptions) -> Error {
    Welch::new(rate, record, options).err().expect("the plan must be refused")
}

#[test]
fn refuses_impossible_plans() {
    let good = WelchOptions::new(100);
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        says(plan_error(rate, 100, &good), &["sample_rate_hz", "greater than 0"]);
    }
    says(plan_error(1.0, 99, &good), &["segment = 100", "99", "shorten"]);
    says(
        plan_error(1.0, 100, &WelchOptions { overlap: 100, ..good.clone() }),
        &["overlap = 100", "less than"],
    );
    says(plan_error(1.0, 100, &WelchOptions { nfft: 99, ..good.clone() }), &["nfft = 99", "100"]);
    says(plan_error(1.0, 100, &WelchOptions { nfft: usize::MAX, ..good }), &["nfft", "134217728"]);
    let dense = WelchOptions { overlap: 9999, averaging: Averaging::Median, ..WelchOptions::new(10_000) };
    says(plan_error(1.0, 1_000_000, &dense), &["median", "4950995001", "overlap"]);
    says(plan_error(1.0, 100, &WelchOptions::new(3)), &["segment: 3 samples", "at least 4"]);
    says(plan_error(1.0, 0, &WelchOptions::new(0)), &["segment: 0 samples"]);
    says(Window::Hann.samples(1).unwrap_err(), &["segment: 1 samples"]);
    for grid in [0.0, -3.0, f64::NAN] {
        says(Welch::for_grid(1e5, 3000, grid).err().unwrap(), &["grid_hz"]);
    }
    says(Welch::for_grid(1e5, 3000, 1e-300).err().unwrap(), &["nfft"]);
    says(Welch::for_grid(1e5, 3000, 1e9).err().unwrap(), &["segment: 0 samples"]);
    says(Welch::for_grid(1e5, 0, 3.0).err().unwrap(), &["segment: 0 samples"]);
}

#[test]
fn refuses_bad_signals_and_leaves_the_output_alone() {
    let mut plan = Welch::new(100.0, 64, &WelchOptions::new(16)).unwrap();
    let mut out = plan.estimate(&(0..64).map(f64::from).collect::<Vec<_>>()).unwrap();
    let before = out.values().to_vec();
    let mut bad = vec![1.0; 64];
    bad[17] = f64::NAN;
    says(plan.process(&bad, &mut out).unwrap_err(), &["signal[17] = NaN"]);
    bad[17] = f64::INFINITY;
    says(plan.process(&bad, &mut out).unwrap_err(), &["signal[17] = inf"]);
    says(plan.process(&[], &mut out).unwrap_err(), &["signal: 0 values", "64"]);
    says(plan.process(&bad[..63], &mut out).unwrap_err(), &["signal: 63 values", "64"]);
    assert_eq!(out.values(), before);

    let mut other = Welch::new(100.0, 64, &WelchOptions { overlap: 0, ..WelchOptions::new(16) }).unwrap();
    assert_eq!(other.process(&[1.0; 64], &mut out), Err(Error::ForeignOutput));
    let mut longer = Welch::new(100.0, 64, &WelchOptions::new(32)).unwrap();
    says(longer.process(&[1.0; 64], &mut out).unwrap_err(), &["output: 9 values", "17"]);
    assert_eq!(out.values(), before);
}

#[test]
fn refuses_impossible_bands() {
    let ramp: Vec<f64> = (0..64).map(|n| f64::from(n * n % 7)).collect();
    let spectrum = Welch::new(100.0, 64, &WelchOptions::new(64)).unwrap().estimate(&ramp).unwrap();
    for (low, high) in
        [(10.0, 10.0), (20.0, 10.0), (-1.0, 10.0), (10.0, 51.0), (f64::NAN, 10.0), (1.0, f64::NAN)]
    {
        says(spectrum.peak(low, high).unwrap_err(), &["band = ", "50 Hz"]);
        says(spectrum.band_rms(low, high).unwrap_err(), &["band = ", "50 Hz"]);
    }
    says(spectrum.peak(10.0, 10.5).unwrap_err(), &["band = 10 to 10.5 Hz", "0 usable points", "1.5625"]);
    let peak = spectrum.peak(10.0, 20.0).unwrap();
    says(spectrum.stands_above_db(&peak, 10.0, 20.0, 30.0).unwrap_err(), &["0 usable points", "at least 3"]);
    says(spectrum.stands_above_db(&peak, 10.0, 20.0, 0.0).unwrap_err(), &["exclusion_hz"]);

    let silence = Welch::new(100.0, 64, &WelchOptions::new(64)).unwrap().estimate(&[0.0; 64]).unwrap();
    says(silence.peak(10.0, 20.0).unwrap_err(), &["peak is undefined", "zero"]);
    let edge = spectrum.peak(49.0, 50.0).unwrap();
    says(spectrum.sinusoid(&edge).unwrap_err(), &["half the sample rate"]);
}

#[test]
fn refuses_impossible_notches() {
    for centre in [0.0, -1.0, 50.0, 51.0, f64::NAN, f64::INFINITY] {
        says(Notch::new(100.0, centre, 15.0).unwrap_err(), &["centre_hz", "50 Hz"]);
    }
    for quality in [0.0, -15.0, f64::NAN, f64::INFINITY] {
        says(Notch::new(100.0, 12.5, quality).unwrap_err(), &["quality"]);
    }
    says(Notch::new(100.0, 25.0, 0.5).unwrap_err(), &["quality = 0.5", "above 0.5"]);
    says(Notch::new(100.0, 25.0, 1e18).unwrap_err(), &["notch is undefined", "lower the quality"]);
    says(Notch::new(0.0, 12.5, 15.0).unwrap_err(), &["sample_rate_hz"]);

    let notch = Notch::new(100.0, 12.5, 15.0).unwrap();
    says(notch.filter(&[]).unwrap_err(), &["signal: 0 samples"]);
    says(notch.filter_from_first(&[]).unwrap_err(), &["signal: 0 samples"]);
    says(notch.filter(&[1.0, f64::NAN]).unwrap_err(), &["signal[1] = NaN"]);
    says(notch.magnitude_db(50.0).unwrap_err(), &["frequency_hz = 50 Hz", "half the sample rate"]);
    says(notch.transient_samples(-60.0).unwrap_err(), &["decibels = -60", "greater than 0"]);
}

#[test]
fn refuses_impossible_envelopes_and_statistics() {
    says(Envelope::new(0).err().unwrap(), &["record: 0 samples"]);
    says(Envelope::in_band(100.0, 64, 20.0, 10.0).err().unwrap(), &["band = 20 to 10 Hz"]);
    says(Envelope::in_band(100.0, 64, 10.0, 11.0).err().unwrap(), &["1 usable points"]);
    says(EnvelopeSpectrum::new(100.0, 64, Some((0.0, 60.0))).err().unwrap(), &["50 Hz"]);
    let mut plan = Envelope::new(8).unwrap();
    says(plan.process(&[0.0; 8], &mut [0.0; 7]).unwrap_err(), &["out: 7 values", "8"]);
    says(plan.process(&[f64::NAN; 8], &mut [0.0; 8]).unwrap_err(), &["signal[0] = NaN"]);
    says(PeriodCount::new(0.0, 90.0).unwrap_err(), &["record_s"]);
    says(PeriodCount::new(1.0, f64::NAN).unwrap_err(), &["repetition_hz"]);

    says(statistics::mean(&[]).unwrap_err(), &["signal: 0 samples"]);
    says(statistics::rms(&[f64::NAN]).unwrap_err(), &["signal[0] = NaN"]);
    says(statistics::crest_factor(&[0.0; 5]).unwrap_err(), &["crest factor is undefined"]);
    says(statistics::kurtosis(&[0.1; 7]).unwrap_err(), &["kurtosis is undefined"]);
    says(statistics::kurtosis(&[0.1]).unwrap_err(), &["at least 2"]);
}
