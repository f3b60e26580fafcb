//! Spectra over time: the course of a record's lines and bursts.

use crate::error::check_signal;
use crate::{Averaging, Result, Spectrum, Welch, WelchOptions};

/// Spectra of the segments of a record, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrogram {
    /// Middle of each segment [s], from the first sample.
    pub times_s: Vec<f64>,
    /// Frequencies [Hz], ascending.
    pub frequencies_hz: Vec<f64>,
    /// Values, one row a time, one column a frequency. Density [unit²/Hz] or power [unit²], as the options
    /// say.
    pub values: Vec<f64>,
}

/// A planned spectrogram of a record that comes in pieces: each segment's spectrum is passed on and not kept.
pub struct Spectrograph {
    welch: Welch,
    spectrum: Spectrum,
    segment: usize,
    step: usize,
    rate_hz: f64,
    /// Samples that wait for a full segment.
    waiting: Vec<f64>,
    /// Samples before those.
    passed: u64,
}

impl Spectrograph {
    /// Plans with the options of [`Welch`], whose averaging is not used: each segment stands for itself.
    pub fn new(sample_rate_hz: f64, options: &WelchOptions) -> Result<Self> {
        let options = WelchOptions { averaging: Averaging::Mean, ..options.clone() };
        let welch = Welch::new(sample_rate_hz, options.segment, &options)?;
        Ok(Self {
            spectrum: welch.blank(),
            welch,
            segment: options.segment,
            step: options.segment - options.overlap,
            rate_hz: sample_rate_hz,
            waiting: Vec::with_capacity(2 * options.segment),
            passed: 0,
        })
    }

    /// Frequencies of the rows [Hz].
    pub fn frequencies_hz(&self) -> &[f64] {
        self.spectrum.frequencies_hz()
    }

    /// Skips `samples` samples, and drops those of an unfinished segment: the next segment starts after them.
    pub fn skip(&mut self, samples: usize) {
        self.passed += (self.waiting.len() + samples) as u64;
        self.waiting.clear();
    }

    /// Adds samples and passes every segment that they complete to `take`: the time of its middle [s] and its
    /// spectrum.
    ///
    /// # Errors
    /// [`NotFinite`](crate::Error::NotFinite) for a bad sample, counted within its segment:
    /// [`skip`](Self::skip) that segment.
    pub fn add(&mut self, mut samples: &[f64], mut take: impl FnMut(f64, &[f64])) -> Result<()> {
        while !samples.is_empty() {
            let (now, later) = samples.split_at((self.segment - self.waiting.len()).min(samples.len()));
            self.waiting.extend_from_slice(now);
            samples = later;
            if self.waiting.len() == self.segment {
                self.welch.process(&self.waiting, &mut self.spectrum)?;
                let middle = self.passed as f64 + 0.5 * self.segment as f64;
                take(middle / self.rate_hz, self.spectrum.values());
                self.waiting.drain(..self.step);
                self.passed += self.step as u64;
            }
        }
        Ok(())
    }
}

/// `scipy.signal.spectrogram` in its mode `psd`, with window, overlap, detrending and scaling of `options`,
/// whose averaging is not used. (scipy's own defaults are a Tukey window and an overlap of one eighth.)
///
/// # Errors
/// [`SegmentTooLong`](crate::Error::SegmentTooLong) and those of [`Spectrograph::new`],
/// [`NotFinite`](crate::Error::NotFinite) for a bad sample.
pub fn spectrogram(signal: &[f64], sample_rate_hz: f64, options: &WelchOptions) -> Result<Spectrogram> {
    options.check(signal.len())?;
    check_signal(signal, 1, "a spectrogram")?;
    let mut plan = Spectrograph::new(sample_rate_hz, options)?;
    let mut all = Spectrogram {
        times_s: Vec::new(),
        frequencies_hz: plan.frequencies_hz().to_vec(),
        values: Vec::with_capacity(options.segments(signal.len()) * plan.frequencies_hz().len()),
    };
    plan.add(signal, |time_s, values| {
        all.times_s.push(time_s);
        all.values.extend_from_slice(values);
    })?;
    Ok(all)
}

impl Spectrogram {
    /// Values at one time.
    pub fn row(&self, time: usize) -> &[f64] {
        let width = self.frequencies_hz.len();
        &self.values[time * width..][..width]
    }

    /// The part between two frequencies [Hz], both included.
    pub fn between(&self, low_hz: f64, high_hz: f64) -> Self {
        let first = self.frequencies_hz.partition_point(|hz| *hz < low_hz);
        let end = self.frequencies_hz.partition_point(|hz| *hz <= high_hz).max(first);
        Self {
            times_s: self.times_s.clone(),
            frequencies_hz: self.frequencies_hz[first..end].to_vec(),
            values: (0..self.times_s.len()).flat_map(|t| &self.row(t)[first..end]).copied().collect(),
        }
    }
}
