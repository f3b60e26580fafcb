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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fast_kurtogram;
    use std::f64::consts::TAU;

    #[test]
    fn example_one_loud_bang_does_not_hide_what_repeats() {
        let mut state = 21_u64;
        let mut signal: Vec<f64> = (0..32_768)
            .map(|n| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                let noise = (state >> 40) as f64 / f64::from(1 << 24) - 0.5;
                // Knocks at 3.2 kHz every 100 samples of 10 kHz.
                let since = f64::from(n % 100);
                noise + 0.8 * (-since / 12.0).exp() * (TAU * 0.32 * since).sin()
            })
            .collect();
        // And one bang at 900 Hz.
        for n in 0..200 {
            let since = f64::from(n);
            signal[15_000 + n as usize] += 12.0 * (-since / 20.0).exp() * (TAU * 0.09 * since).sin();
        }
        let holds = |low: f64, high: f64, hz: f64| (low..=high).contains(&hz);
        let narrow = fast_kurtogram(&signal, 1e4, 4).unwrap();
        let loudest = narrow.iter().max_by(|a, b| a.kurtosis.total_cmp(&b.kurtosis)).unwrap();
        assert!(holds(loudest.low_hz, loudest.high_hz, 900.0), "{loudest:?}");
        let bands = infogram(&signal, 1e4, 4).unwrap();
        let most = bands.iter().max_by(|a, b| a.of_spectrum.total_cmp(&b.of_spectrum)).unwrap();
        assert!(holds(most.low_hz, most.high_hz, 3_200.0), "{most:?}");
        assert_eq!(bands.len(), narrow.len());
    }
}
