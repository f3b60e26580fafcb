//! Errors of signals and of requests, and the checks that find them.

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a request was refused. Each message names the field, its value, the limit, and what to try.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// Fewer samples than the operation needs.
    #[error("{field}: {len} samples, but {purpose} needs at least {least}; use a longer record")]
    TooShort {
        /// Which length is short.
        field: &'static str,
        /// Number of samples.
        len: usize,
        /// Smallest number that would do.
        least: usize,
        /// Purpose of the samples.
        purpose: &'static str,
    },
    /// A sample is infinite or not a number.
    #[error("signal[{index}] = {value}: every sample must be finite; cut the record before this sample")]
    NotFinite {
        /// Position of the first bad sample, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A slice has another length than the plan.
    #[error("{field}: {len} values, but the plan was made for {planned}; make a plan for this length")]
    WrongLength {
        /// Which slice.
        field: &'static str,
        /// Its length.
        len: usize,
        /// Length of the plan.
        planned: usize,
    },
    /// The spectrum to be filled belongs to a plan with other options.
    #[error("output: the spectrum belongs to a plan with other options; take one from this plan's `blank`")]
    ForeignOutput,
    /// A quantity must be finite and positive.
    #[error("{field} = {value}: it must be a finite number greater than 0")]
    NotPositive {
        /// Which quantity.
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// A frequency does not lie between zero and half the sample rate.
    #[error(
        "{field} = {value_hz} Hz: it must lie above 0 and below half the sample rate, {limit_hz} Hz; \
         choose a lower frequency or sample faster"
    )]
    OutsideNyquist {
        /// Which frequency.
        field: &'static str,
        /// Its value [Hz].
        value_hz: f64,
        /// Half the sample rate [Hz].
        limit_hz: f64,
    },
    /// A frequency band is not ordered or leaves the spectrum.
    #[error("band = {low_hz} to {high_hz} Hz: it must satisfy 0 ≤ low < high ≤ {limit_hz} Hz")]
    Band {
        /// Lower end [Hz].
        low_hz: f64,
        /// Upper end [Hz].
        high_hz: f64,
        /// Half the sample rate [Hz].
        limit_hz: f64,
    },
    /// Frequencies of a response do not ascend.
    #[error(
        "line {line} of the response is at {hz} Hz, behind {before_hz} Hz: frequencies must ascend, from \
         0 or more; sort the lines and take out doubles"
    )]
    NotAscending {
        /// Number of the line, from 1.
        line: usize,
        /// Its frequency [Hz].
        hz: f64,
        /// That of the line before it [Hz].
        before_hz: f64,
    },
    /// A response is known where a signal has nothing.
    #[error(
        "the response is known from {low_hz} to {high_hz} Hz, and the signal has lines from {lowest_hz:.3} \
         to {highest_hz} Hz: they share no frequency; measure the response in the band of the signal, or sample \
         the signal faster or longer"
    )]
    NoOverlap {
        /// Lowest frequency of the response [Hz].
        low_hz: f64,
        /// Its highest one [Hz].
        high_hz: f64,
        /// Lowest frequency of the signal [Hz].
        lowest_hz: f64,
        /// Its highest one [Hz].
        highest_hz: f64,
    },
    /// A band holds too few grid points.
    #[error(
        "band = {low_hz} to {high_hz} Hz: {bins} usable points on a grid of {grid_hz} Hz, at least \
         {least} are needed; widen the band or use a longer record"
    )]
    BandTooNarrow {
        /// Lower end [Hz].
        low_hz: f64,
        /// Upper end [Hz].
        high_hz: f64,
        /// Points in the band, less those excluded.
        bins: usize,
        /// Smallest number that would do.
        least: usize,
        /// Grid spacing [Hz].
        grid_hz: f64,
    },
    /// The overlap is not shorter than the segment.
    #[error("overlap = {overlap} samples: it must be less than the segment, {segment} samples")]
    Overlap {
        /// Overlap in samples.
        overlap: usize,
        /// Segment length in samples.
        segment: usize,
    },
    /// The segment is longer than the record.
    #[error(
        "segment = {segment} samples: the record has only {record}; shorten the segment, or keep the grid by \
         zero padding (nfft)"
    )]
    SegmentTooLong {
        /// Segment length in samples.
        segment: usize,
        /// Record length in samples.
        record: usize,
    },
    /// The transform is shorter than the segment, or too long to be stored.
    #[error("nfft = {nfft}: it must lie between the segment length, {segment}, and {most}")]
    TransformLength {
        /// Length of the transform.
        nfft: usize,
        /// Segment length in samples.
        segment: usize,
        /// Longest transform accepted.
        most: usize,
    },
    /// The median would have to keep too many periodograms.
    #[error(
        "averaging = median: it would keep {values} values, at most {most} are accepted; use less overlap, a \
         shorter transform, or the mean"
    )]
    MedianMemory {
        /// Segments times frequencies.
        values: usize,
        /// Largest number accepted.
        most: usize,
    },
    /// The notch would be as wide as the whole band.
    #[error(
        "quality = {quality}: the notch would be wider than half the sample rate; choose a quality factor \
         above {least}"
    )]
    NotchTooWide {
        /// Quality factor.
        quality: f64,
        /// Limit that it must exceed, 2 f₀/fs.
        least: f64,
    },
    /// A quantity has no value for this signal.
    #[error("{quantity} is undefined: {why}")]
    Undefined {
        /// Which quantity.
        quantity: &'static str,
        /// Reason and remedy.
        why: &'static str,
    },
}

/// Refuses signals that are shorter than `least` or hold a sample that is not finite.
pub(crate) fn check_signal(signal: &[f64], least: usize, purpose: &'static str) -> Result<()> {
    if signal.len() < least {
        return Err(Error::TooShort { field: "signal", len: signal.len(), least, purpose });
    }
    match signal.iter().position(|x| !x.is_finite()) {
        Some(index) => Err(Error::NotFinite { index, value: signal[index] }),
        None => Ok(()),
    }
}

/// Refuses a slice whose length is not the planned one.
pub(crate) fn check_len(field: &'static str, len: usize, planned: usize) -> Result<()> {
    if len == planned { Ok(()) } else { Err(Error::WrongLength { field, len, planned }) }
}

/// Refuses zero, negative and non-finite values.
pub(crate) fn check_positive(field: &'static str, value: f64) -> Result<()> {
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(Error::NotPositive { field, value }) }
}

/// Refuses frequencies outside the open interval from zero to half the sample rate.
pub(crate) fn check_frequency(field: &'static str, value_hz: f64, sample_rate_hz: f64) -> Result<()> {
    let limit_hz = 0.5 * sample_rate_hz;
    if value_hz > 0.0 && value_hz < limit_hz {
        Ok(())
    } else {
        Err(Error::OutsideNyquist { field, value_hz, limit_hz })
    }
}

/// Refuses bands that are not ordered or leave the interval from zero to half the sample rate.
pub(crate) fn check_band(low_hz: f64, high_hz: f64, sample_rate_hz: f64) -> Result<()> {
    let limit_hz = 0.5 * sample_rate_hz;
    if low_hz >= 0.0 && low_hz < high_hz && high_hz <= limit_hz {
        Ok(())
    } else {
        Err(Error::Band { low_hz, high_hz, limit_hz })
    }
}
