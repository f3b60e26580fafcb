//! The choices of a spectral estimate.

use crate::error::check_positive;
use crate::{Error, Result, Scaling, Sides, Window};

/// Longest transform accepted: its buffers take about 3 GiB. A mistyped grid spacing should be an error, not
/// a crash.
const LONGEST: usize = 1 << 27;

/// Trend that is removed from each segment before the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detrend {
    /// Nothing.
    None,
    /// The mean.
    Constant,
    /// The straight line of least squares.
    Linear,
}

/// How the segments' periodograms become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Averaging {
    /// Arithmetic mean.
    Mean,
    /// Median divided by its bias for Gaussian noise (B. Allen et al., Phys. Rev. D 85 (2012) 122006,
    /// appendix B): a few segments with transients do not change it. Keeps all periodograms, so it needs more
    /// memory.
    Median,
}

/// Choices of a spectral estimate.
#[derive(Debug, Clone, PartialEq)]
pub struct WelchOptions {
    /// Length of a segment in samples.
    pub segment: usize,
    /// Samples shared by neighbouring segments, less than `segment`.
    pub overlap: usize,
    /// Length of the transform, at least `segment`. What exceeds the segment is filled with zeros: a finer
    /// grid, the same resolution. Lengths with a large prime factor are slow.
    pub nfft: usize,
    /// Window laid over each segment.
    pub window: Window,
    /// Trend that is removed from each segment first.
    pub detrend: Detrend,
    /// Meaning of the values.
    pub scaling: Scaling,
    /// How segments are averaged.
    pub averaging: Averaging,
    /// Frequencies held.
    pub sides: Sides,
}

/// Segments of 256 samples, as `scipy.signal.welch`.
impl Default for WelchOptions {
    fn default() -> Self {
        Self::new(256)
    }
}

impl WelchOptions {
    /// Defaults of `scipy.signal.welch` for segments of `segment` samples: periodic Hann window, 50 %
    /// overlap, removal of the mean, one-sided density, mean. No zero padding.
    pub fn new(segment: usize) -> Self {
        Self {
            segment,
            overlap: segment / 2,
            nfft: segment,
            window: Window::Hann,
            detrend: Detrend::Constant,
            scaling: Scaling::Density,
            averaging: Averaging::Mean,
            sides: Sides::One,
        }
    }

    /// The same for a wanted grid spacing [Hz]: `nfft` is the sample rate over the grid spacing, rounded.
    ///
    /// A record of at most `nfft` samples becomes one segment, padded with zeros: the grid is the requested
    /// one, the resolution that of the record. A longer record is cut into segments of `nfft` samples with 50
    /// % overlap.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for the sample rate or the grid spacing, [`Error::TransformLength`] for a grid
    /// that is too fine to be stored.
    pub fn for_grid(sample_rate_hz: f64, record: usize, grid_hz: f64) -> Result<Self> {
        check_positive("sample_rate_hz", sample_rate_hz)?;
        check_positive("grid_hz", grid_hz)?;
        // The conversion saturates: a grid that is far too fine gives the largest integer, not a wrapped one.
        let nfft = (sample_rate_hz / grid_hz).round() as usize;
        if nfft > LONGEST {
            return Err(Error::TransformLength { nfft, segment: record.min(nfft), most: LONGEST });
        }
        Ok(Self { nfft, ..Self::new(record.min(nfft)) })
    }

    /// Number of segments that fit a record of `record` samples. The lengths must have been checked.
    pub(crate) fn segments(&self, record: usize) -> usize {
        1 + (record - self.segment) / (self.segment - self.overlap)
    }

    /// Refuses choices that do not fit each other or a record of `record` samples.
    pub(crate) fn check(&self, record: usize) -> Result<()> {
        let &Self { segment, overlap, nfft, .. } = self;
        if segment > record {
            return Err(Error::SegmentTooLong { segment, record });
        }
        if overlap >= segment {
            return Err(Error::Overlap { overlap, segment });
        }
        if nfft < segment || nfft > LONGEST {
            return Err(Error::TransformLength { nfft, segment, most: LONGEST });
        }
        let values = self.segments(record).saturating_mul(nfft / 2 + 1);
        if self.averaging == Averaging::Median && values > LONGEST {
            return Err(Error::MedianMemory { values, most: LONGEST });
        }
        Ok(())
    }
}
