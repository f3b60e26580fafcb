//! Spectra, notch filters, envelopes and statistics of evenly sampled real signals, in double precision.
//!
//! The origin of a signal does not matter: a simulated acceleration and a measured voltage enter through the
//! same `&[f64]`, or, where a record is longer than memory, through a [`channel::Channel`], whose samples
//! come in blocks from wherever they lie. Nothing is printed; every refusal is an [`Error`] with a remedy. It
//! is a crate because nothing here depends on a machine, a file or a simulation.
//!
//! # Conventions
//!
//! They are those of `scipy.signal`, so that a figure can be checked in three lines of Python.
//!
//! - **Window**: the Hann window is the periodic one. MATLAB's symmetric windows are offered by that name.
//! - **Welch**: 50 % overlap and removal of each segment's mean by default; a tail too short for one more
//!   segment is left out, and [`Resolution::unused_s`] is its length.
//! - **Scaling**: [`Scaling::Density`] is in unit²/Hz, `2|X|²/(fs Σw²)`; [`Scaling::Spectrum`] is in unit²,
//!   `2|X|²/(Σw)²`, where a sinusoid of amplitude A reads A²/2. The factor 2 is that of a one-sided spectrum;
//!   zero frequency and, for an even transform length, half the sample rate go without it.
//! - **Grid is not resolution**: a record of T seconds resolves 1/T. Zero padding draws the same curve on a
//!   finer grid. Every [`Spectrum`] carries a [`Resolution`] that states both.
//! - **Notch**: [`Notch`] equals `scipy.signal.iirnotch`, whose width at −3 dB is exactly f₀/Q.
//! - **Decibel**: `10 log₁₀` of a power, relative to one unit² (or unit²/Hz).
//!
//! Planned types ([`Welch`], [`Envelope`], [`EnvelopeSpectrum`]) allocate when they are made and never again.
//! The transform picks its instructions at run time, so results agree to rounding, not to the bit, between
//! machines of different instruction sets.
//!
//! # Where to look
//!
//! | To know … | use |
//! |---|---|
//! | what frequencies a record holds, and how strong | [`Welch`]: [`Welch::for_grid`] for one record, [`Welch::new`] for averages |
//! | the frequency and amplitude of a line, and whether it stands out | [`Spectrum::peak`], [`Spectrum::sinusoid`], [`Spectrum::stands_above_db`] |
//! | how much there is in a band | [`Spectrum::band_rms`], [`Spectrum::velocity_rms`] |
//! | which frequencies can be resolved | [`Resolution`] |
//! | a record without one tone | [`Notch`] |
//! | the repetition rate of impulses | [`EnvelopeSpectrum`], where [`PeriodCount`] finds the record long enough |
//! | the band of impulses | [`fast_kurtogram`], [`BandEnvelopes`] for records of any length |
//! | the rate at which a part of the spectrum is modulated | [`spectral_correlation`] |
//! | how a record changes | [`spectrogram`], [`Spectrograph`] for records of any length, [`ridge`] |
//! | whether there is a family of harmonics, with a false-alarm rate | [`CombTest`] on a [`Whitened`] spectrum |
//! | how far apart two events are that follow each other | [`event_spacing`], [`passage_spacing`] |
//! | the times of impacts behind an unknown path | [`prewhitened_power`] |
//! | the signal of a sensor behind some modes | [`Response`] |
//! | components locked to a shaft | [`order_track`], [`OverAngle::average`] |
//! | the record at another rate | [`resample_poly`] |
//! | a computed signal as a sensor and its recorder would have recorded it | [`Sensor`] |
//! | how a signal sounds | [`Sound`] |
//! | root mean square, crest factor, kurtosis | [`statistics`] |
//! | a signal by name, unit and rate, wherever its samples lie | [`channel`] |
//!
//! # The spectrum of a record
//!
//! Welch's average over segments, as `scipy.signal.welch(x, fs, nperseg=4096)` has it; the root mean square of
//! noise comes back from its area.
//!
//! ```
//! use stribeck_dsp::{Welch, WelchOptions};
//! # fn main() -> Result<(), stribeck_dsp::Error> {
//! # let mut seed = 1_u64;
//! # let mut noise = || { seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5 };
//! let record: Vec<f64> = (0..100_000).map(|_| noise()).collect();
//! let options = WelchOptions::new(4096); // `WelchOptions::default()`: segments of 256
//! let spectrum = Welch::new(51_200.0, record.len(), &options)?.estimate(&record)?;
//! assert_eq!(spectrum.values().len(), 2049); // unit²/Hz, from 0 to 25.6 kHz
//! let rms = spectrum.band_rms(0.0, 25_600.0)?;
//! assert!((rms / (1.0_f64 / 12.0).sqrt() - 1.0).abs() < 0.02, "{rms}");
//! # Ok(())
//! # }
//! ```
//!
//! # A measured sine
//!
//! An accelerometer sampled at 100 kHz for 30 ms sees 50 m/s² at 4671 Hz. What are the frequency and the
//! amplitude of the line, how well is its frequency resolved, and what remains of it behind a notch?
//!
//! ```
//! use stribeck_dsp::{Notch, Welch};
//! # fn main() -> Result<(), stribeck_dsp::Error> {
//! let sample_rate_hz = 100_000.0;
//! let measured: Vec<f64> = (0..3000)
//!     .map(|n| 50.0 * (std::f64::consts::TAU * 4671.0 * n as f64 / sample_rate_hz).sin())
//!     .collect();
//!
//! // A grid of 3 Hz is asked for; the record resolves 33 Hz, and the spectrum says so.
//! let mut welch = Welch::for_grid(sample_rate_hz, measured.len(), 3.0)?;
//! let spectrum = welch.estimate(&measured)?;
//! assert!(spectrum.resolution().zero_padded);
//! assert!((spectrum.resolution().resolution_hz - 33.3).abs() < 0.1);
//!
//! let peak = spectrum.peak(4000.0, 6000.0)?;
//! let line = spectrum.sinusoid(&peak)?;
//! assert!((line.frequency_hz - 4671.0).abs() < 0.1);
//! assert!((line.amplitude - 50.0).abs() < 0.05);
//!
//! // The notch needs its transient to pass before it is judged.
//! let notch = Notch::new(sample_rate_hz, 4671.0, 15.0)?;
//! let filtered = notch.filter(&measured)?;
//! let settled = notch.transient_samples(60.0)?;
//! let left = filtered[settled..].iter().fold(0.0_f64, |most, y| most.max(y.abs()));
//! assert!(left < 50.0e-3);
//! # Ok(())
//! # }
//! ```

pub mod channel;

mod averages;
mod error;
mod window;

mod options;
mod spectrum;
mod welch;

mod peak;

mod notch;

mod envelope;

mod band_envelopes;
mod comb;
mod cycle;

mod angle;
mod cyclic;
mod kurtogram;
mod least_delay;
mod prewhitened;
mod resample;
mod response;
mod ridge;
mod spacing;
mod spectrogram;
mod velocity;

mod sensor;
mod sound;

pub mod statistics;

pub use angle::{OverAngle, means_over_angle, order_track};
pub use averages::{median, running_mean};
pub use band_envelopes::{Autocorrelation, BandEnvelope, BandEnvelopes};
pub use comb::{Comb, CombTest, Whitened};
pub use cyclic::{Cyclic, SpectralCorrelation, spectral_correlation};
pub use envelope::{Envelope, EnvelopeSpectrum, PeriodCount, PeriodVerdict};
pub use error::{Error, Result};
pub use kurtogram::{KurtogramBand, fast_kurtogram};
pub use notch::Notch;
pub use options::{Averaging, Detrend, WelchOptions};
pub use peak::{Peak, Sinusoid};
pub use prewhitened::prewhitened_power;
pub use resample::resample_poly;
pub use response::{Mode, Response};
pub use ridge::{Ridge, ridge};
pub use sensor::Sensor;
pub use sound::Sound;
pub use spacing::{EventSpacing, Spacing, event_spacing, passage_spacing};
pub use spectrogram::{Spectrogram, Spectrograph, spectrogram};
pub use spectrum::{Resolution, Scaling, Sides, Spectrum};
pub use welch::Welch;
pub use window::Window;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
