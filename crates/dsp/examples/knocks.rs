//! A machine that knocks under a loud tone: the spectrum finds the tone, a notch takes it out, and the
//! envelope spectrum finds how often it knocks.
//!
//! `cargo run -p stribeck-dsp --example knocks`

use std::f64::consts::TAU;

use stribeck_dsp::statistics::{crest_factor, rms};
use stribeck_dsp::{EnvelopeSpectrum, Notch, PeriodCount, Result, Welch};

const SAMPLE_RATE_HZ: f64 = 50_000.0;
const RECORD_S: f64 = 0.5;
/// The tone: 20 m/s².
const TONE_HZ: f64 = 4671.0;
/// 87 knocks a second ring a resonance, which decays within a millisecond.
const KNOCK_HZ: f64 = 87.0;
const RESONANCE_HZ: f64 = 9000.0;
const DECAY_S: f64 = 0.5e-3;

fn main() -> Result<()> {
    let samples = (RECORD_S * SAMPLE_RATE_HZ) as usize;
    let signal: Vec<f64> = (0..samples).map(|n| acceleration(n as f64 / SAMPLE_RATE_HZ)).collect();

    let spectrum = Welch::for_grid(SAMPLE_RATE_HZ, samples, 10.0)?.estimate(&signal)?;
    let line = spectrum.sinusoid(&spectrum.peak(1000.0, 20_000.0)?)?;
    let resolution_hz = spectrum.resolution().resolution_hz;
    println!(
        "loudest line    {:8.1} Hz, {:.2} m/s², to {resolution_hz:.0} Hz",
        line.frequency_hz, line.amplitude
    );

    // Forwards and backwards, so that the knocks stay where they were.
    let quiet = Notch::new(SAMPLE_RATE_HZ, line.frequency_hz, 15.0)?.filtfilt(&signal)?;
    for (name, record) in [("as measured", &signal), ("behind a notch", &quiet)] {
        println!("{name:15} {:8.2} m/s² rms, crest factor {:.1}", rms(record)?, crest_factor(record)?);
    }

    println!("envelope: {}", PeriodCount::new(RECORD_S, KNOCK_HZ)?);
    let band = (RESONANCE_HZ - 2000.0, RESONANCE_HZ + 2000.0);
    let mut envelope = EnvelopeSpectrum::new(SAMPLE_RATE_HZ, samples, Some(band))?;
    let mut rates = envelope.blank();
    envelope.process(&quiet, &mut rates)?;
    for multiple in 1..=3 {
        let near = KNOCK_HZ * f64::from(multiple);
        let peak = rates.peak(near - 20.0, near + 20.0)?;
        let above_db = rates.stands_above_db(&peak, near - 40.0, near + 40.0, 8.0)?;
        println!(
            "  knocks {multiple} ×   {:8.1} Hz, {above_db:.0} dB above its surroundings",
            peak.frequency_hz
        );
    }
    Ok(())
}

/// Acceleration [m/s²] at the time `t` [s].
fn acceleration(t: f64) -> f64 {
    let since = t % (1.0 / KNOCK_HZ);
    let knock = 30.0 * (-since / DECAY_S).exp() * (TAU * RESONANCE_HZ * since).sin();
    20.0 * (TAU * TONE_HZ * t).sin() + knock
}
