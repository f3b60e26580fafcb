//! Numbers of repeated passages, of one or two events each, that do not depend on the path to the sensor.
//!
//! A path changes the magnitude of each frequency, not the times, the rate and the order of impacts. All
//! numbers here are of the power of the pre-whitened signal, and have no unit: times are parts of the period
//! of the passages, levels ratios of one record. Source: own; the pre-whitening is that of N. Sawalhi and R.
//! B. Randall, Mech. Syst. Signal Process. 25 (2011) 846–870.

use std::f64::consts::PI;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

#[cfg(doc)]
use crate::Error;
use crate::Result;
use crate::error::{check_positive, check_signal};
use crate::prewhitened::prewhitened_power;
use crate::spacing::{EventSpacing, passage_spacing};

/// The band, over half of the sample rate.
const BAND: (f64, f64) = (0.25, 1.0);
/// Passages of a piece of a record: enough for their rhythm, few enough that a simulation makes them
/// in a second or two.
pub const PASSAGES: f64 = 30.0;
/// Lags within a passage at which the correlation is returned.
pub const WITHIN: usize = 24;
/// The least and the greatest of them, over the period.
const LAGS: (f64, f64) = (0.03, 0.45);
/// How far the period of the passages may be from the expected one, as slip makes it.
const SLIP: f64 = 0.03;
/// Power is averaged over this part of a period before heights and order of events are read.
const SHARP: f64 = 0.01;
/// Passages over which a rhythm that slips loses itself.
const LATER: f64 = 10.0;
/// Half-width of a line about its place, in parts of the passages' frequency.
const LINE: f64 = 0.01;

/// Frequencies that passages have and may be modulated with, and how far apart their events may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rhythm {
    /// Of the passages [Hz].
    pub passing_hz: f64,
    /// That may modulate them [Hz].
    pub modulating_hz: [f64; 2],
    /// Least distance of the two events of a passage [s].
    pub shortest_s: f64,
    /// Greatest distance of the two events of a passage, over the period of the passages.
    pub longest: f64,
}

/// Numbers of repeated passages in a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signature {
    /// Time between the two events of a passage over its period; `None` where no second event shows.
    pub spacing: Option<f64>,
    /// Time from which on a second event would have shown, over the period; `None` where one shows, or
    /// nothing is known.
    pub clear_from: Option<f64>,
    /// Energy of the first event over that of the second [dB]; `None` where no second shows.
    pub first_over_second_db: Option<f64>,
    /// Correlation of the power within a passage, at the lags of [`Signature::within_at`]: a second event
    /// is a hump at its distance.
    pub within: [f64; WITHIN],
    /// Correlation of the power with that one passage later.
    pub repeats: f64,
    /// The same ten passages later: slip takes it away.
    pub repeats_later: f64,
    /// Sidebands of either modulating frequency beside the first line of the passages, over that line [dB].
    pub sidebands_db: [f64; 2],
    /// How far the power swings with the passages, over its mean.
    pub swing: f64,
}

impl Signature {
    /// Of a whole record: the median over its pieces of [`PASSAGES`] passages; a number is absent where less
    /// than half of the pieces have it.
    ///
    /// # Errors
    /// [`Error::TooShort`] for a record shorter than a piece, [`Error::NotFinite`], and those of
    /// [`passage_spacing`].
    pub fn of(samples: &[f64], rate_hz: f64, rhythm: Rhythm) -> Result<Self> {
        check_positive("sample_rate_hz", rate_hz)?;
        check_positive("passing_hz", rhythm.passing_hz)?;
        let piece = Self::samples_of_piece(rate_hz, rhythm);
        check_signal(samples, piece, "passages that repeat")?;
        let pieces = samples.chunks_exact(piece).map(|piece| Self::of_piece(piece, rate_hz, rhythm));
        Ok(Self::median(&pieces.collect::<Result<Vec<_>>>()?))
    }

    /// Samples of a piece of a record.
    pub fn samples_of_piece(rate_hz: f64, rhythm: Rhythm) -> usize {
        (PASSAGES / rhythm.passing_hz * rate_hz).floor() as usize
    }

    /// The lags of [`within`](Self::within), over the period.
    pub fn within_at() -> [f64; WITHIN] {
        std::array::from_fn(|n| LAGS.0 + (LAGS.1 - LAGS.0) * n as f64 / (WITHIN - 1) as f64)
    }

    fn median(pieces: &[Self]) -> Self {
        let of = |number: &dyn Fn(&Self) -> f64| upper_median(pieces.iter().map(number).collect());
        let seen = |number: &dyn Fn(&Self) -> Option<f64>| {
            let all: Vec<f64> = pieces.iter().filter_map(number).collect();
            (2 * all.len() >= pieces.len()).then(|| upper_median(all))
        };
        Self {
            spacing: seen(&|s| s.spacing),
            clear_from: seen(&|s| s.clear_from),
            first_over_second_db: seen(&|s| s.first_over_second_db),
            within: std::array::from_fn(|n| of(&|s| s.within[n])),
            repeats: of(&|s| s.repeats),
            repeats_later: of(&|s| s.repeats_later),
            sidebands_db: [0, 1].map(|n| of(&|s| s.sidebands_db[n])),
            swing: of(&|s| s.swing),
        }
    }

    fn of_piece(samples: &[f64], rate_hz: f64, rhythm: Rhythm) -> Result<Self> {
        let expected_s = 1.0 / rhythm.passing_hz;
        let power = prewhitened_power(samples, BAND);
        let spectrum = Spectrum::of(&power, rate_hz);
        let correlation = spectrum.correlation(SHARP * expected_s);
        let around = |passages: f64| {
            let ends = [1.0 - SLIP, 1.0 + SLIP].map(|part| (part * passages * expected_s * rate_hz) as usize);
            correlation[ends[0]..=ends[1].min(correlation.len() - 1)].iter().copied().fold(f64::MIN, f64::max)
        };
        let line = spectrum.highest(rhythm.passing_hz, SLIP * rhythm.passing_hz);
        let longest_s = (rhythm.longest * expected_s).min(0.5 / line);
        let events = passage_spacing(samples, rate_hz, line, rhythm.shortest_s, longest_s)?;
        let lag_s = match events {
            EventSpacing::Pairs(spacing) => Some(spacing.lag_s),
            _ => None,
        };
        let width_hz = LINE * rhythm.passing_hz;
        let carried = spectrum.energy(line, width_hz);
        let beside = |hz: f64| {
            let both = spectrum.energy(line - hz, width_hz) + spectrum.energy(line + hz, width_hz);
            10.0 * (0.5 * both / carried).max(1e-9).log10()
        };
        Ok(Self {
            spacing: lag_s.map(|lag_s| lag_s / expected_s),
            clear_from: match events {
                EventSpacing::Alone { clear_from_s } => Some(clear_from_s / expected_s),
                _ => None,
            },
            first_over_second_db: lag_s.map(|lag_s| {
                order_db(&power, (lag_s * rate_hz) as usize, (SHARP * expected_s * rate_hz) as usize)
            }),
            within: Self::within_at().map(|lag| {
                correlation[((lag * expected_s * rate_hz).round() as usize).min(correlation.len() - 1)]
            }),
            repeats: around(1.0),
            repeats_later: around(LATER),
            sidebands_db: rhythm.modulating_hz.map(beside),
            swing: (2.0 * carried).sqrt() / spectrum.mean,
        })
    }
}

/// Energy of the first of two events over that of the second [dB], from the third moments of the power at the
/// two ends of their distance: an event stronger by a factor enters one of them by the square of that factor.
fn order_db(power: &[f64], lag: usize, half: usize) -> f64 {
    let smooth = centred_mean(power, half);
    let floor = upper_median(smooth.clone());
    let above: Vec<f64> = smooth.iter().map(|p| (p - floor).max(0.0)).collect();
    let pairs = || above.iter().zip(&above[lag.min(above.len())..]);
    let first: f64 = pairs().map(|(a, b)| a * a * b).sum();
    let second: f64 = pairs().map(|(a, b)| a * b * b).sum();
    10.0 * ((first + f64::MIN_POSITIVE) / (second + f64::MIN_POSITIVE)).log10()
}

/// The middle value, of an even number the upper of the two; 0 of none. A value that a piece has, which the
/// mean of two would not be.
fn upper_median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Mean over `half` samples on either side, fewer at the ends: as many values as samples.
fn centred_mean(values: &[f64], half: usize) -> Vec<f64> {
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    for value in values {
        sum += value;
        sums.push(sum);
    }
    let ends = |n: usize| (n.saturating_sub(half), (n + half + 1).min(values.len()));
    (0..values.len()).map(ends).map(|(a, b)| (sums[b] - sums[a]) / (b - a) as f64).collect()
}

/// Lines of the power of a piece.
struct Spectrum {
    /// Mean square of each frequency from 0, both signs together.
    energy: Vec<f64>,
    grid_hz: f64,
    rate_hz: f64,
    mean: f64,
}

impl Spectrum {
    fn of(power: &[f64], rate_hz: f64) -> Self {
        let count = power.len();
        let mean = power.iter().sum::<f64>() / count as f64;
        let mut lines: Vec<Complex<f64>> = power.iter().map(|p| Complex::new(p - mean, 0.0)).collect();
        FftPlanner::new().plan_fft_forward(count).process(&mut lines);
        let scale = 2.0 / (count as f64 * count as f64);
        let energy = lines[..count / 2].iter().map(|z| scale * z.norm_sqr()).collect();
        Self { energy, grid_hz: rate_hz / count as f64, rate_hz, mean }
    }

    /// Correlation coefficient at each lag in samples, of power averaged over `sharp_s`, up to half the
    /// piece.
    fn correlation(&self, sharp_s: f64) -> Vec<f64> {
        let count = 2 * self.energy.len();
        let mut lines = vec![Complex::<f64>::default(); count];
        for (n, energy) in self.energy.iter().enumerate() {
            let turn = PI * n as f64 * self.grid_hz * sharp_s;
            let passed = if turn > 0.0 { turn.sin() / turn } else { 1.0 };
            lines[n] = Complex::new(energy * passed * passed, 0.0);
        }
        FftPlanner::new().plan_fft_forward(count).process(&mut lines);
        let all = lines[0].re.max(f64::MIN_POSITIVE);
        // The piece may have an odd sample, whose lag differs by less than one.
        debug_assert!((self.rate_hz / self.grid_hz - count as f64).abs() < 2.0);
        lines[..count / 2].iter().map(|z| z.re / all).collect()
    }

    fn bins(&self, hz: f64, half_hz: f64) -> std::ops::RangeInclusive<usize> {
        let last = self.energy.len() - 1;
        let of = |hz: f64| ((hz / self.grid_hz).round().max(0.0) as usize).min(last);
        of(hz - half_hz)..=of(hz + half_hz)
    }

    /// The frequency of the highest line within `half_hz` of `hz`.
    fn highest(&self, hz: f64, half_hz: f64) -> f64 {
        let most = self.bins(hz, half_hz).max_by(|a, b| self.energy[*a].total_cmp(&self.energy[*b]));
        most.map_or(hz, |n| n as f64 * self.grid_hz)
    }

    /// Mean square of the components within `half_hz` of `hz`.
    fn energy(&self, hz: f64, half_hz: f64) -> f64 {
        self.energy[self.bins(hz, half_hz)].iter().sum()
    }
}
