//! The second-order notch of `scipy.signal.iirnotch`, with the two ways of running it over a record.

use std::f64::consts::TAU;

use biquad::{Biquad, Coefficients, DirectForm2Transposed, Hertz, Type};

use crate::error::{check_frequency, check_positive, check_signal};
use crate::{Error, Result};

/// A filter that removes a narrow band about one frequency and passes everything else.
///
/// ```text
///             1 − 2 cos ω₀ z⁻¹ + z⁻²                     1
/// H(z) = g ──────────────────────────────── ,   g = ───────────── ,   β = tan(ω₀/(2Q))
///          1 − 2g cos ω₀ z⁻¹ + (2g − 1) z⁻²            1 + β
/// ```
///
/// ω₀ = 2π f₀/fs. Its width at −3 dB is exactly f₀/Q, it passes zero frequency and half the sample rate
/// unchanged, and it rings for a while after every change of the signal: see [`Notch::transient_samples`].
/// Source: S. J. Orfanidis, *Introduction to Signal Processing* (1996), as `scipy.signal.iirnotch`.
#[derive(Debug, Clone, Copy)]
pub struct Notch {
    sample_rate_hz: f64,
    centre_hz: f64,
    quality: f64,
    coefficients: Coefficients<f64>,
}

impl Notch {
    /// A notch at `centre_hz` with quality factor `quality` = centre over width at −3 dB.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for the sample rate or quality, [`Error::OutsideNyquist`] for the centre,
    /// [`Error::NotchTooWide`] for a quality at or below 2 f₀/fs, where the width reaches half the sample
    /// rate, [`Error::Undefined`] for one so high that the poles round onto the unit circle (above about 10¹⁵
    /// f₀/fs).
    pub fn new(sample_rate_hz: f64, centre_hz: f64, quality: f64) -> Result<Self> {
        check_positive("sample_rate_hz", sample_rate_hz)?;
        check_frequency("centre_hz", centre_hz, sample_rate_hz)?;
        check_positive("quality", quality)?;
        let least = 2.0 * centre_hz / sample_rate_hz;
        if quality <= least {
            return Err(Error::NotchTooWide { quality, least });
        }
        // The biquad crate follows R. Bristow-Johnson's cookbook, β = sin ω₀/(2Q), which is narrower than
        // specified near half the sample rate. This quality makes its β the one above.
        let omega = TAU * centre_hz / sample_rate_hz;
        let cookbook = omega.sin() / (2.0 * (omega / (2.0 * quality)).tan());
        let too_narrow = || Error::Undefined {
            quantity: "notch",
            why: "it is so narrow that it would ring for ever in double precision; lower the quality",
        };
        let hertz = |value: f64| Hertz::from_hz(value).map_err(|_| too_narrow());
        let coefficients =
            Coefficients::from_params(Type::Notch, hertz(sample_rate_hz)?, hertz(centre_hz)?, cookbook)
                .map_err(|_| too_narrow())?;
        if coefficients.a2 >= 1.0 || !cookbook.is_finite() {
            return Err(too_narrow());
        }
        Ok(Self { sample_rate_hz, centre_hz, quality, coefficients })
    }

    /// Centre [Hz].
    pub fn centre_hz(&self) -> f64 {
        self.centre_hz
    }

    /// Quality factor.
    pub fn quality(&self) -> f64 {
        self.quality
    }

    /// Sample rate for which the filter was made [Hz].
    pub fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    /// Full width at −3 dB [Hz] of one pass.
    pub fn width_hz(&self) -> f64 {
        self.centre_hz / self.quality
    }

    /// Coefficients b₀, b₁, b₂ of the numerator in powers of z⁻¹.
    pub fn numerator(&self) -> [f64; 3] {
        [self.coefficients.b0, self.coefficients.b1, self.coefficients.b2]
    }

    /// Coefficients 1, a₁, a₂ of the denominator in powers of z⁻¹.
    pub fn denominator(&self) -> [f64; 3] {
        [1.0, self.coefficients.a1, self.coefficients.a2]
    }

    /// Magnitude of the response of one pass at a frequency [dB], 0 or negative, −∞ at the centre.
    ///
    /// # Errors
    /// [`Error::OutsideNyquist`] for a frequency outside 0 to half the sample rate.
    pub fn magnitude_db(&self, frequency_hz: f64) -> Result<f64> {
        check_frequency("frequency_hz", frequency_hz, self.sample_rate_hz)?;
        let [omega, omega0] = [frequency_hz, self.centre_hz].map(|f| TAU * f / self.sample_rate_hz);
        let beta = (omega0 / (2.0 * self.quality)).tan();
        // |H| = |c| / √(c² + β² sin² ω) with c = cos ω − cos ω₀, as a product so that it does not cancel near
        // ω₀.
        let c = -2.0 * (0.5 * (omega + omega0)).sin() * (0.5 * (omega - omega0)).sin();
        Ok(20.0 * (c.abs() / c.hypot(beta * omega.sin())).log10())
    }

    /// Time in which the free ringing falls by the factor e [s]; Q/(π f₀) for narrow notches.
    pub fn time_constant_s(&self) -> f64 {
        -1.0 / (self.sample_rate_hz * self.largest_pole().ln())
    }

    /// Samples after which the free ringing has fallen by `decibels` (positive). Before them a filtered
    /// record is partly the filter's own response to the start.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for the number of decibels.
    pub fn transient_samples(&self, decibels: f64) -> Result<usize> {
        check_positive("decibels", decibels)?;
        Ok((decibels / (-20.0 * self.largest_pole().log10())).ceil() as usize)
    }

    /// One pass from rest, `scipy.signal.lfilter(b, a, x)`. A record that does not start at zero begins with
    /// a step response.
    ///
    /// # Errors
    /// [`Error::TooShort`] for an empty signal, [`Error::NotFinite`] for a bad sample.
    pub fn filter(&self, signal: &[f64]) -> Result<Vec<f64>> {
        check_signal(signal, 1, "a filter")?;
        Ok(self.pass_from(0.0, signal.iter().copied()))
    }

    /// One pass as if the signal had been at its first value for ever,
    /// `scipy.signal.lfilter(b, a, x, zi=lfilter_zi(b, a) * x[0])`. For signals with a mean, such as a force.
    ///
    /// # Errors
    /// [`Error::TooShort`] for an empty signal, [`Error::NotFinite`] for a bad sample.
    pub fn filter_from_first(&self, signal: &[f64]) -> Result<Vec<f64>> {
        check_signal(signal, 1, "a filter")?;
        Ok(self.pass_from(signal[0], signal.iter().copied()))
    }

    /// One pass over a signal that was at `level` for ever.
    fn pass_from(&self, level: f64, signal: impl Iterator<Item = f64>) -> Vec<f64> {
        // The notch passes a constant unchanged, so starting from its steady state is filtering the
        // difference from that constant from rest.
        let mut filter = DirectForm2Transposed::<f64>::new(self.coefficients);
        signal.map(|x| level + filter.run(x - level)).collect()
    }

    /// Largest magnitude of a pole, below 1.
    fn largest_pole(&self) -> f64 {
        let (half, product) = (0.5 * self.coefficients.a1, self.coefficients.a2);
        let discriminant = half * half - product;
        if discriminant < 0.0 { product.sqrt() } else { half.abs() + discriminant.sqrt() }
    }
}
