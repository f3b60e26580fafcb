//! The infogram: which band holds impulses, which holds what repeats, and which both?
//!
//! A kurtogram responds to one accidental impulse as to a hundred that repeat. Two negentropies distinguish
//! them: that of the squared envelope grows with impulses, that of its spectrum with lines at a rate and its
//! multiples.
//!
//! Source: J. Antoni, Mech. Syst. Signal Process. 74 (2016) 73–94.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::Result;
use crate::kurtogram::{check_levels, for_each_band};

/// One band of an infogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InfogramBand {
    /// Bands of this width from zero to half the sample rate: 1, 2, 3, 4, 6, 8, 12 …
    pub of: usize,
    /// Lower end [Hz].
    pub low_hz: f64,
    /// Upper end [Hz].
    pub high_hz: f64,
    /// Negentropy of the squared envelope ε, `⟨ε²/⟨ε²⟩ ln(ε²/⟨ε²⟩)⟩`: how impulsive.
    pub of_envelope: f64,
    /// Negentropy of the squared envelope's spectrum without its line at zero: how cyclic it is.
    pub of_spectrum: f64,
}

impl InfogramBand {
    /// Mean of both: impulses that repeat.
    pub fn mean(&self) -> f64 {
        0.5 * (self.of_envelope + self.of_spectrum)
    }
}

/// All bands of `signal`, in the order and with the filters of [`fast_kurtogram`](crate::fast_kurtogram).
///
/// # Errors
/// Those of [`fast_kurtogram`](crate::fast_kurtogram).
pub fn infogram(signal: &[f64], sample_rate_hz: f64, levels: u32) -> Result<Vec<InfogramBand>> {
    check_levels(signal, sample_rate_hz, levels)?;
    let mut planner = FftPlanner::new();
    let mut bands = Vec::new();
    for_each_band(signal, sample_rate_hz, levels, |of, low_hz, high_hz, coefficients| {
        let mut envelope: Vec<Complex<f64>> =
            coefficients.iter().map(|c| Complex::new(c.norm_sqr(), 0.0)).collect();
        let of_envelope = negentropy(envelope.iter().map(|e| e.re * e.re));
        let mean = envelope.iter().map(|e| e.re).sum::<f64>() / envelope.len() as f64;
        envelope.iter_mut().for_each(|e| e.re -= mean);
        planner.plan_fft_forward(envelope.len()).process(&mut envelope);
        let of_spectrum = negentropy(envelope.iter().skip(1).map(|e| e.norm_sqr()));
        bands.push(InfogramBand { of, low_hz, high_hz, of_envelope, of_spectrum });
    });
    Ok(bands)
}

/// `⟨u ln u⟩` with u the energies over their mean; 0 when there are none.
fn negentropy(energies: impl Iterator<Item = f64> + Clone) -> f64 {
    let (sum, count) = energies.clone().fold((0.0, 0.0), |(sum, count), e| (sum + e, count + 1.0));
    if sum <= 0.0 {
        return 0.0;
    }
    energies.map(|e| e * count / sum).filter(|u| *u > 0.0).map(|u| u * u.ln()).sum::<f64>() / count
}
