//! Errors of signals and of requests, and the checks that find them.

/// Result of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Why a request was refused. Each message names the field, its value, the limit, and what to try.
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "messages say what happened and name their fields")]
pub enum Error {
    #[error("{field}: {len} samples, but {purpose} needs at least {least}; use a longer record")]
    TooShort { field: &'static str, len: usize, least: usize, purpose: &'static str },
    #[error("signal[{index}] = {value}: every sample must be finite; cut the record before this sample")]
    NotFinite { index: usize, value: f64 },
    #[error("{field}: {len} values, but the plan was made for {planned}; make a plan for this length")]
    WrongLength { field: &'static str, len: usize, planned: usize },
    #[error("output: the spectrum belongs to a plan with other options; take one from this plan's `blank`")]
    ForeignOutput,
    #[error("{field} = {value}: it must be a finite number greater than 0")]
    NotPositive { field: &'static str, value: f64 },
    #[error(
        "{field} = {value_hz} Hz: it must lie above 0 and below half the sample rate, {limit_hz} Hz; \
         choose a lower frequency or sample faster"
    )]
    OutsideNyquist {
        field: &'static str,
        /// Its value [Hz].
        value_hz: f64,
        /// Half the sample rate [Hz].
        limit_hz: f64,
    },
    #[error("band = {low_hz} to {high_hz} Hz: it must satisfy 0 ≤ low < high ≤ {limit_hz} Hz")]
    Band {
        /// Lower end [Hz].
        low_hz: f64,
        /// Upper end [Hz].
        high_hz: f64,
        /// Half the sample rate [Hz].
        limit_hz: f64,
    },
    #[error(
        "line {line} of the response is at {hz} Hz, behind {before_hz} Hz: frequencies must ascend, from 0 \
         or more; sort the lines and take out doubles"
    )]
    NotAscending {
        line: usize,
        /// Its frequency [Hz].
        hz: f64,
        /// That of the line before it [Hz].
        before_hz: f64,
    },
    #[error(
        "band = {low_hz} to {high_hz} Hz: {bins} usable points on a grid of {grid_hz} Hz, at least \
         {least} are needed; widen the band or use a longer record"
    )]
    BandTooNarrow {
        /// Lower end [Hz].
        low_hz: f64,
        /// Upper end [Hz].
        high_hz: f64,
        bins: usize,
        least: usize,
        /// Grid spacing [Hz].
        grid_hz: f64,
    },
    #[error("overlap = {overlap} samples: it must be less than the segment, {segment} samples")]
    Overlap { overlap: usize, segment: usize },
    #[error(
        "segment = {segment} samples: the record has only {record}; shorten the segment, or keep the grid by \
         zero padding (nfft)"
    )]
    SegmentTooLong { segment: usize, record: usize },
    #[error("nfft = {nfft}: it must lie between the segment length, {segment}, and {most}")]
    TransformLength { nfft: usize, segment: usize, most: usize },
    #[error(
        "averaging = median: it would keep {values} values, at most {most} are accepted; use less overlap, a \
         shorter transform, or the mean"
    )]
    MedianMemory { values: usize, most: usize },
    #[error(
        "quality = {quality}: the notch would be wider than half the sample rate; choose a quality factor \
         above {least}"
    )]
    NotchTooWide { quality: f64, least: f64 },
    #[error("{quantity} is undefined: {why}")]
    Undefined { quantity: &'static str, why: &'static str },
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
