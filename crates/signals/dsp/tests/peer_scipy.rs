//! Against scipy 1.17.1: the vectors of `fixtures/reference/golden_dsp.json`, which states its own input.
//!
//! The input is 64 samples at 100 Hz of a 12.5 Hz sine on a mean of 0.3 with the noise of a linear
//! congruential generator. Every entry of the file is compared, except these, whose input (a noisy 30 ms
//! record of a 4671 Hz tone) is not in the file: there the same tone without noise is held against them where
//! that makes sense (`peer_conventions_on_a_30_ms_record`), and "DC bin density", which is that record's
//! unknown mean, is left out. "nperseg>len(x)" is a warning there and an error here, on purpose.

use std::f64::consts::TAU;

use serde_json::Value;
use stribeck_dsp::{
    Averaging, Detrend, Envelope, Error, Notch, Scaling, Sides, Welch, WelchOptions, Window, statistics,
};

/// Both sides round in a different order; a dozen operations on doubles stay far below this.
const RELATIVE: f64 = 1e-12;
/// Values that vanish in exact arithmetic (zero frequency after detrending) are compared with the largest
/// instead.
const OF_LARGEST: f64 = 1e-15;

fn vectors() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../fixtures/reference/golden_dsp.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

/// The input that the file describes.
fn input() -> Vec<f64> {
    let mut state: u32 = 12345;
    (0..64)
        .map(|n| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let noise = f64::from(state) / 4_294_967_296.0 - 0.5;
            noise + 0.3 + (TAU * 12.5 * f64::from(n) / 100.0).sin()
        })
        .collect()
}

fn assert_equal(case: &str, ours: &[f64], theirs: &[f64]) {
    assert_eq!(ours.len(), theirs.len(), "{case}: length");
    let largest = theirs.iter().fold(0.0_f64, |most, x| x.abs().max(most));
    for (index, (a, b)) in ours.iter().zip(theirs).enumerate() {
        let allowed = RELATIVE * b.abs() + OF_LARGEST * largest;
        assert!((a - b).abs() <= allowed, "{case}[{index}]: ours {a:e}, theirs {b:e}");
    }
}

/// The options that a case's name and keywords stand for.
fn options(case: &str) -> WelchOptions {
    let sixteen = WelchOptions::new(16);
    match case {
        "welch default hann nperseg16" => sixteen,
        "welch hann nperseg16 nfft33(odd)" => WelchOptions { nfft: 33, ..sixteen },
        "welch hann nperseg16 nfft32" => WelchOptions { nfft: 32, ..sixteen },
        "welch nperseg15(odd) noverlap=7" => WelchOptions::new(15),
        "welch detrend=False" => WelchOptions { detrend: Detrend::None, ..sixteen },
        "welch detrend=linear" => WelchOptions { detrend: Detrend::Linear, ..sixteen },
        "welch scaling=spectrum" => WelchOptions { scaling: Scaling::Spectrum, ..sixteen },
        "welch average=median" => WelchOptions { averaging: Averaging::Median, ..sixteen },
        "welch twosided" => WelchOptions { sides: Sides::Two, ..sixteen },
        "welch boxcar noverlap0" => WelchOptions { window: Window::Boxcar, overlap: 0, ..sixteen },
        "welch full record zero-padded nfft=100" => WelchOptions { nfft: 100, ..WelchOptions::new(64) },
        "periodogram default (boxcar, detrend constant)" => {
            WelchOptions { window: Window::Boxcar, ..WelchOptions::new(64) }
        }
        "MATLAB pwelch(x,hamming(16),8,256,fs) emulation" => {
            WelchOptions { window: Window::SymmetricHamming, nfft: 256, detrend: Detrend::None, ..sixteen }
        }
        unknown => panic!("the file has a case that is not covered: {unknown}"),
    }
}

#[test]
fn peer_input_is_the_one_of_the_file() {
    assert_equal("x", &input()[..4], &numbers(&vectors()["x_first4"]));
}

#[test]
fn peer_every_welch_case() {
    let (file, x) = (vectors(), input());
    let cases = file["cases"].as_object().unwrap();
    assert_eq!(cases.len(), 13);
    for (case, expected) in cases {
        let spectrum = Welch::new(100.0, x.len(), &options(case)).unwrap().estimate(&x).unwrap();
        // The MATLAB case of the file holds the first nine of 129 values; all others are complete.
        let (f, p) = (numbers(&expected["f"]), numbers(&expected["P"]));
        let kept = if case.starts_with("MATLAB") { 9 } else { spectrum.values().len() };
        assert_equal(case, &spectrum.frequencies_hz()[..kept], &f);
        assert_equal(case, &spectrum.values()[..kept], &p);
        let sum = spectrum.values()[..kept].iter().sum::<f64>() * spectrum.resolution().grid_hz;
        assert_equal(case, &[sum], &[expected["sum_P_df"].as_f64().unwrap()]);
    }
}

#[test]
fn peer_iirnotch_coefficients() {
    let file = vectors();
    for (key, rate, centre) in [
        ("iirnotch_4671_15_1e5", 1e5, 4671.0),
        ("iirnotch_12.5_15_100", 100.0, 12.5),
        ("iirnotch_closed_form", 1e5, 4671.0),
    ] {
        let notch = Notch::new(rate, centre, 15.0).unwrap();
        assert_equal(key, &notch.numerator(), &numbers(&file[key]["b"]));
        assert_equal(key, &notch.denominator(), &numbers(&file[key]["a"]));
    }
}

#[test]
fn peer_filtered_records() {
    let (file, x) = (vectors(), input());
    let expected = &file["iirnotch_12.5_15_100"];
    let notch = Notch::new(100.0, 12.5, 15.0).unwrap();
    assert_equal("lfilter", &notch.filter(&x).unwrap(), &numbers(&expected["lfilter_zero_ic"]));
}

#[test]
fn peer_filter_from_first_is_lfilter_with_its_steady_state() {
    // A transposed direct form II written out, started from scipy's own state times the first sample.
    let (file, x) = (vectors(), input());
    let expected = &file["iirnotch_12.5_15_100"];
    let (b, a, zi) = (numbers(&expected["b"]), numbers(&expected["a"]), numbers(&expected["lfilter_zi"]));
    let (mut s1, mut s2) = (zi[0] * x[0], zi[1] * x[0]);
    let reference: Vec<f64> = x
        .iter()
        .map(|&x| {
            let y = b[0] * x + s1;
            s1 = b[1] * x - a[1] * y + s2;
            s2 = b[2] * x - a[2] * y;
            y
        })
        .collect();
    let notch = Notch::new(100.0, 12.5, 15.0).unwrap();
    assert_equal("from first", &notch.filter_from_first(&x).unwrap(), &reference);
}

#[test]
fn peer_hilbert_envelope() {
    // The file's row is that of the input less its mean, which it does not say: with the mean left in, the
    // first value is 0.793 instead of 0.923; without it all 64 agree.
    let (file, mut x) = (vectors(), input());
    let mean = statistics::mean(&x).unwrap();
    x.iter_mut().for_each(|x| *x -= mean);
    let mut envelope = vec![0.0; x.len()];
    Envelope::new(x.len()).unwrap().process(&x, &mut envelope).unwrap();
    assert_equal("hilbert", &envelope, &numbers(&file["hilbert_envelope"]));
}

#[test]
fn peer_conventions_on_a_30_ms_record() {
    // The file's record is 50 sin(2π 4671 t) with a variance of 1270.4 instead of 1250: 1.6 % of noise. It
    // moved the file's levels by at most 0.025 dB from the clean tone's, except where a grid of 98 or 391 Hz
    // misses the tone.
    const NOISE_DB: f64 = 0.03;
    let rate = 1e5;
    let x: Vec<f64> = (0..3000).map(|n| 50.0 * (TAU * 4671.0 * f64::from(n) / rate).sin()).collect();
    let file = vectors();
    let rows = &file["conventions_on_30ms_record"];
    let padded = WelchOptions::for_grid(rate, x.len(), 3.0).unwrap();
    assert_eq!((padded.segment, padded.nfft), (3000, 33333));
    let level_db = |options: &WelchOptions| {
        let spectrum = Welch::new(rate, x.len(), options).unwrap().estimate(&x).unwrap();
        let peak = spectrum.peak(4000.0, 6000.0).unwrap();
        (spectrum.frequencies_hz()[peak.bin], 10.0 * spectrum.values()[peak.bin].log10())
    };
    let matlab = WelchOptions {
        window: Window::SymmetricHamming,
        nfft: 1024,
        detrend: Detrend::None,
        ..WelchOptions::new(666)
    };
    for (key, options, tolerance_db) in [
        ("scipy welch hann periodic nperseg=N nfft=33333 detrend const", padded.clone(), NOISE_DB),
        ("symmetric hann", WelchOptions { window: Window::SymmetricHann, ..padded.clone() }, NOISE_DB),
        (
            "boxcar periodogram nfft=33333",
            WelchOptions { window: Window::Boxcar, ..padded.clone() },
            NOISE_DB,
        ),
        (
            "scaling=spectrum hann nperseg=N nfft=33333 (peak = A^2/2)",
            WelchOptions { scaling: Scaling::Spectrum, ..padded },
            NOISE_DB,
        ),
        ("scipy default nperseg=256", WelchOptions::new(256), 0.1),
        ("MATLAB pwelch default (8 seg, L=666, hamming sym, nfft=1024, no detrend)", matlab, 0.1),
    ] {
        let theirs = numbers(&rows[key]);
        let (frequency, level) = level_db(&options);
        assert!((frequency - theirs[0]).abs() < RELATIVE * theirs[0], "{key}: {frequency} Hz");
        assert!((level - theirs[1]).abs() < tolerance_db, "{key}: {level} dB, theirs {}", theirs[1]);
    }

    let expected = rows["expected A^2/2 dB"].as_f64().unwrap();
    assert_equal("A^2/2", &[10.0 * (0.5 * 50.0_f64 * 50.0).log10()], &[expected]);

    assert!(rows["nfft<nperseg"].as_str().unwrap().starts_with("ValueError"));
    let short = WelchOptions { nfft: 1000, ..WelchOptions::new(3000) };
    assert!(matches!(Welch::new(rate, 3000, &short), Err(Error::TransformLength { nfft: 1000, .. })));
    assert!(rows["nperseg>len(x)"].is_array());
    let long = Welch::new(rate, 3000, &WelchOptions::new(4096));
    assert!(matches!(long, Err(Error::SegmentTooLong { segment: 4096, record: 3000 })));
}

#[test]
fn peer_parseval_of_the_30_ms_record() {
    // The file's own row: the boxcar periodogram sums to the variance. The same identity must hold for our
    // input.
    let file = vectors();
    let row = &file["parseval"];
    assert_eq!(row["var(z)"], row["boxcar periodogram sum*df"]);
    let x = input();
    let options = WelchOptions { window: Window::Boxcar, nfft: 333, ..WelchOptions::new(x.len()) };
    let spectrum = Welch::new(100.0, x.len(), &options).unwrap().estimate(&x).unwrap();
    let mean = statistics::mean(&x).unwrap();
    let deviations: Vec<f64> = x.iter().map(|x| x - mean).collect();
    let variance = statistics::rms(&deviations).unwrap().powi(2);
    let sum = spectrum.values().iter().sum::<f64>() * spectrum.resolution().grid_hz;
    assert_equal("variance", &[sum], &[variance]);
}
