//! A spectrum and its resolution.

use std::fmt;

use crate::error::{check_band, check_len};
use crate::{Error, Result, Window};

/// Meaning of the values of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scaling {
    /// Power spectral density [unit²/Hz]: right for noise. Its integral is the mean square.
    Density,
    /// Power spectrum [unit²]: right for lines. A sinusoid of amplitude A on a grid point reads A²/2.
    Spectrum,
}

/// Which frequencies a spectrum holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// From 0 to half the sample rate; the power of the negative frequencies is added to the positive ones.
    One,
    /// All `nfft` frequencies, positive ones first, then the negative ones upwards (order of
    /// `numpy.fft.fftfreq`).
    Two,
}

/// Resolution of a spectrum, and the grid that it is drawn on. The two must not be confused.
#[derive(Debug, Clone, PartialEq)]
pub struct Resolution {
    /// Length of the record [s].
    pub record_s: f64,
    /// Length of one segment [s].
    pub segment_s: f64,
    /// Number of segments averaged.
    pub segments: usize,
    /// Length of the tail that fills no segment and is left out [s].
    pub unused_s: f64,
    /// Window laid over each segment.
    pub window: Window,
    /// Resolution [Hz]: one over the length of a segment.
    pub resolution_hz: f64,
    /// Full width of a line at −3 dB [Hz].
    pub width_3db_hz: f64,
    /// Full width of a line at −6 dB [Hz]: two equal lines closer than this merge.
    pub width_6db_hz: f64,
    /// Equivalent noise bandwidth [Hz]: power spectrum divided by density.
    pub noise_bandwidth_hz: f64,
    /// Distance of neighbouring frequencies of the grid [Hz].
    pub grid_hz: f64,
    /// True when segments were padded with zeros, so that the grid is finer than the resolution.
    pub zero_padded: bool,
}

impl fmt::Display for Resolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "record {:.4} s, {} segment{} of {:.4} s, {} window: resolution {:.3} Hz (line width {:.3} Hz at \
             −3 dB, noise bandwidth {:.3} Hz) on a grid of {:.3} Hz",
            self.record_s,
            self.segments,
            if self.segments == 1 { "" } else { "s" },
            self.segment_s,
            self.window,
            self.resolution_hz,
            self.width_3db_hz,
            self.noise_bandwidth_hz,
            self.grid_hz,
        )?;
        if self.zero_padded {
            f.write_str("; zero-padded: the grid is finer than the resolution")?;
        }
        if self.unused_s > 0.0 {
            write!(f, "; the last {:.4} s fill no segment and are left out", self.unused_s)?;
        }
        Ok(())
    }
}

/// Everything about a spectrum but its values; equal for all spectra of one plan.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    pub(crate) sample_rate_hz: f64,
    pub(crate) segment: usize,
    pub(crate) nfft: usize,
    pub(crate) scaling: Scaling,
    pub(crate) sides: Sides,
    /// Divisor of a steady line in the average: 1 for the mean, the median's bias for the median.
    pub(crate) line_bias: f64,
    pub(crate) resolution: Resolution,
}

impl Layout {
    /// Number of frequencies from 0 to half the sample rate.
    pub(crate) fn positive_bins(&self) -> usize {
        self.nfft / 2 + 1
    }

    /// Number of frequencies held.
    pub(crate) fn bins(&self) -> usize {
        match self.sides {
            Sides::One => self.positive_bins(),
            Sides::Two => self.nfft,
        }
    }

    /// True for zero frequency and, when `nfft` is even, half the sample rate: they have no negative partner.
    pub(crate) fn is_alone(&self, bin: usize) -> bool {
        bin == 0 || 2 * bin == self.nfft
    }

    fn frequency(&self, bin: usize) -> f64 {
        let signed = match self.sides {
            Sides::Two if 2 * bin >= self.nfft => bin as f64 - self.nfft as f64,
            _ => bin as f64,
        };
        signed * self.resolution.grid_hz
    }
}

/// An estimated spectrum: frequencies, values and resolution.
#[derive(Debug, Clone)]
pub struct Spectrum {
    pub(crate) layout: Layout,
    frequencies_hz: Vec<f64>,
    pub(crate) values: Vec<f64>,
}

impl Spectrum {
    /// All frequencies of a layout, all values zero.
    pub(crate) fn blank(layout: Layout) -> Self {
        let frequencies_hz = (0..layout.bins()).map(|bin| layout.frequency(bin)).collect();
        Self { frequencies_hz, values: vec![0.0; layout.bins()], layout }
    }

    /// Frequencies [Hz], one for each value, `grid_hz` apart.
    pub fn frequencies_hz(&self) -> &[f64] {
        &self.frequencies_hz
    }

    /// Values [unit²/Hz for a density, unit² for a power spectrum], never negative.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Meaning of the values.
    pub fn scaling(&self) -> Scaling {
        self.layout.scaling
    }

    /// Frequencies held: positive only, or all.
    pub fn sides(&self) -> Sides {
        self.layout.sides
    }

    /// Sample rate of the signal [Hz].
    pub fn sample_rate_hz(&self) -> f64 {
        self.layout.sample_rate_hz
    }

    /// Resolution of the spectrum.
    pub fn resolution(&self) -> &Resolution {
        &self.layout.resolution
    }

    /// Root mean square [unit] of the part of the signal between two frequencies [Hz], both included.
    ///
    /// It is the square root of the density summed over the band times the grid spacing. Leakage moves the
    /// ends of the band by about the line width, so the band should be much wider than that. It excludes the
    /// mean or trend that detrending removed.
    ///
    /// # Errors
    /// [`Error::Band`] for a band that leaves the spectrum, [`Error::BandTooNarrow`] for one without a grid
    /// point.
    pub fn band_rms(&self, low_hz: f64, high_hz: f64) -> Result<f64> {
        let band = self.band(low_hz, high_hz, 1)?;
        let to_density = match self.layout.scaling {
            Scaling::Density => 1.0,
            Scaling::Spectrum => 1.0 / self.layout.resolution.noise_bandwidth_hz,
        };
        let sum: f64 = band.map(|bin| self.one_sided(bin)).sum();
        Ok((sum * to_density * self.layout.resolution.grid_hz).sqrt())
    }

    /// Value at a bin from 0 to `nfft/2`, as a one-sided spectrum would hold it.
    pub(crate) fn one_sided(&self, bin: usize) -> f64 {
        match self.layout.sides {
            Sides::Two if !self.layout.is_alone(bin) => 2.0 * self.values[bin],
            _ => self.values[bin],
        }
    }

    /// Bins from `low_hz` to `high_hz`, at least `least` of them.
    pub(crate) fn band(&self, low_hz: f64, high_hz: f64, least: usize) -> Result<std::ops::Range<usize>> {
        // Tolerance of a bound that lies on the grid but for rounding.
        const ON_GRID: f64 = 1e-9;
        check_band(low_hz, high_hz, self.layout.sample_rate_hz)?;
        let grid_hz = self.layout.resolution.grid_hz;
        let first = (low_hz / grid_hz - ON_GRID).ceil().max(0.0) as usize;
        let end = ((high_hz / grid_hz + ON_GRID).floor() as usize + 1).min(self.layout.positive_bins());
        let bins = end.saturating_sub(first);
        if bins < least {
            return Err(Error::BandTooNarrow { low_hz, high_hz, bins, least, grid_hz });
        }
        Ok(first..end)
    }

    /// Refuses to be filled by a plan with another layout.
    pub(crate) fn check_layout(&self, layout: &Layout) -> Result<()> {
        check_len("output", self.values.len(), layout.bins())?;
        if self.layout == *layout { Ok(()) } else { Err(Error::ForeignOutput) }
    }
}
