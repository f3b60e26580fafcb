//! Windows, and the widths that follow from their transforms.

use std::f64::consts::TAU;

use rustfft::num_complex::Complex;

use crate::{Error, Result};

/// Shortest window: below this the symmetric Hann window degenerates to one sample or none.
const SHORTEST: usize = 4;

/// Weights laid over a segment before it is transformed.
///
/// All are of the form `w[n] = a₀ − a₁ cos(2πn/M)` with M the length (periodic) or the length less one
/// (symmetric). Source: F. J. Harris, Proc. IEEE 66 (1978) 51–83.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Window {
    /// All ones.
    Boxcar,
    /// Periodic Hann window, `scipy.signal.get_window("hann")`.
    Hann,
    /// Symmetric Hann window, MATLAB's `hann(n)`.
    SymmetricHann,
    /// Symmetric Hamming window, MATLAB's `hamming(n)`.
    SymmetricHamming,
}

impl Window {
    /// Weights of a window of `len` samples, between 0 and 1.
    ///
    /// # Errors
    /// [`Error::TooShort`] below four samples.
    pub fn samples(self, len: usize) -> Result<Vec<f64>> {
        check(len)?;
        let (a0, a1, period) = self.cosine_sum(len);
        Ok((0..len).map(|n| a0 - a1 * (TAU * n as f64 / period).cos()).collect())
    }

    /// Equivalent noise bandwidth in bins, `N Σw²/(Σw)²`: 1 for the boxcar, 1.5 for the periodic Hann window.
    /// A bin is the sample rate divided by `len`.
    ///
    /// # Errors
    /// [`Error::TooShort`] below four samples.
    pub fn noise_bandwidth_bins(self, len: usize) -> Result<f64> {
        let weights = self.samples(len)?;
        let sum: f64 = weights.iter().sum();
        let power: f64 = weights.iter().map(|w| w * w).sum();
        Ok(len as f64 * power / (sum * sum))
    }

    /// Full width in bins of the main lobe at half power (−3.01 dB): 0.886 for the boxcar, 1.441 for Hann.
    ///
    /// # Errors
    /// [`Error::TooShort`] below four samples.
    pub fn width_3db_bins(self, len: usize) -> Result<f64> {
        self.width_bins(len, 0.5_f64.sqrt())
    }

    /// Full width in bins of the main lobe at half amplitude (−6.02 dB): 1.207 for the boxcar, 2 for Hann.
    ///
    /// # Errors
    /// [`Error::TooShort`] below four samples.
    pub fn width_6db_bins(self, len: usize) -> Result<f64> {
        self.width_bins(len, 0.5)
    }

    /// Magnitude of the window's transform at a distance of `bins` from its centre, relative to the centre.
    ///
    /// This is how far a line between two grid points reads too low (scalloping).
    ///
    /// # Errors
    /// [`Error::TooShort`] below four samples.
    pub fn response(self, len: usize, bins: f64) -> Result<f64> {
        check(len)?;
        Ok(self.transform(len, bins).norm() / self.transform(len, 0.0).norm())
    }

    /// Twice the distance at which the main lobe falls to `level`.
    fn width_bins(self, len: usize, level: f64) -> Result<f64> {
        // At 1.9 bins the main lobes of all windows here are far below half amplitude, and no side lobe
        // reaches it, so exactly one crossing lies between.
        let (mut inside, mut outside) = (0.0, 1.9);
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            if self.response(len, middle)? > level { inside = middle } else { outside = middle }
        }
        Ok(inside + outside)
    }

    /// Discrete-time transform of the weights at `bins`/`len` cycles per sample.
    fn transform(self, len: usize, bins: f64) -> Complex<f64> {
        let (a0, a1, period) = self.cosine_sum(len);
        let (omega, shift) = (TAU * bins / len as f64, TAU / period);
        dirichlet(len, omega) * a0
            - (dirichlet(len, omega - shift) + dirichlet(len, omega + shift)) * (0.5 * a1)
    }

    /// `a₀`, `a₁` and M.
    fn cosine_sum(self, len: usize) -> (f64, f64, f64) {
        match self {
            Self::Boxcar => (1.0, 0.0, len as f64),
            Self::Hann => (0.5, 0.5, len as f64),
            Self::SymmetricHann => (0.5, 0.5, (len - 1) as f64),
            Self::SymmetricHamming => (0.54, 0.46, (len - 1) as f64),
        }
    }
}

impl std::fmt::Display for Window {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Boxcar => "boxcar",
            Self::Hann => "Hann (periodic)",
            Self::SymmetricHann => "Hann (symmetric)",
            Self::SymmetricHamming => "Hamming (symmetric)",
        })
    }
}

fn check(len: usize) -> Result<()> {
    if len >= SHORTEST {
        Ok(())
    } else {
        Err(Error::TooShort { field: "segment", len, least: SHORTEST, purpose: "a window" })
    }
}

/// `Σ exp(−iωn)`, n = 0 … len − 1.
fn dirichlet(len: usize, omega: f64) -> Complex<f64> {
    let count = len as f64;
    let half_sine = (0.5 * omega).sin();
    if half_sine == 0.0 {
        return Complex::new(count, 0.0);
    }
    Complex::from_polar((0.5 * omega * count).sin() / half_sine, -0.5 * omega * (count - 1.0))
}
