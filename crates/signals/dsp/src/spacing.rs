//! Two events that follow each other at a fixed distance, as when something enters and leaves a gap: how far
//! apart?
//!
//! Pre-whitening makes both broad-banded and equally sharp. Where the rate of the passages is known, the mean
//! power about the strongest event of each passage shows a second one ([`passage_spacing`]); where it is not,
//! the squared envelope is correlated with itself ([`event_spacing`]). A distance is taken for one only if
//! two bands agree on it: ringing has another lag in every band. Where there is none, the correlation yields
//! the distance from which on a second event would have shown.
//!
//! Source: N. Sawalhi and R. B. Randall, Mech. Syst. Signal Process. 25 (2011) 846–870, who look for it in
//! the cepstrum of the enhanced signal; the comparison of bands is ours.

mod passages;

use std::ops::Range;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

use crate::error::{check_positive, check_signal};
use crate::prewhitened::prewhitened_power;
use crate::{Error, Result};

/// Distance of two events.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spacing {
    /// Distance [s].
    pub lag_s: f64,
    /// How far it may be off [s]: half of what two bands differ by, and no less than half of one over the
    /// width of the narrower one, in which no event is sharper.
    pub uncertainty_s: f64,
    /// Correlation of the squared envelope at that lag.
    pub correlation: f64,
}

/// Distance of two events in a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum EventSpacing {
    /// Events come in pairs.
    Pairs(Spacing),
    /// Events come alone: at this distance [s] and above, a second one would show if it had a fifth of the
    /// first one's energy.
    Alone {
        /// Where ringing has died away.
        clear_from_s: f64,
    },
    /// The record does not decide it: it is too noisy, it rings too long, or its bands contradict each other.
    Unknown,
}

/// Ends of the bands over half the sample rate. They share nothing, so that ringing which makes a peak in one
/// cannot confirm itself in another.
const BANDS: [(f64, f64); 2] = [(0.25, 0.5), (0.5, 1.0)];
/// Length over which correlations are smoothed [s]: events are no sharper.
const SMOOTHED_S: f64 = 0.3e-3;
/// Two events nearer than this many times one over the width of the narrower band are there, but their
/// distance is uncertain by more than an eighth, and is not returned.
const RESOLVED: f64 = 4.0;
/// Least correlation in one of the bands.
const LEAST: f64 = 0.05;
/// Least correlation in the other, at the same lag: it only confirms.
const CONFIRMS: f64 = 0.025;
/// Another peak must be lower than this part of the highest.
const SECOND: f64 = 0.5;
/// Lags closer than this part of one another are one peak.
const SAME: f64 = 0.1;
/// Bands agree when their lags differ by less than this part.
const AGREED: f64 = 0.05;
/// The weakest second event that is missed, over the energy of the first.
const WEAKEST: f64 = 0.2;
/// Samples beyond the smoothing at which single events must still be correlated with themselves, and how
/// much.
const BEYOND: usize = 3;
/// The least such correlation: events stand above the noise.
const RINGS: f64 = 0.1;
/// Ringing that lasts longer than this part of the longest distance leaves too little to look at.
const CLEAR: f64 = 0.5;

/// The distance between `shortest_s` and `longest_s` that pairs of events keep, if there is one, whatever the
/// rhythm in which the pairs come.
///
/// # Errors
/// [`Error::NotPositive`] for a rate or distance, [`Error::Undefined`] when they are not ordered,
/// [`Error::TooShort`] for a signal that is not four times as long as the longest, [`Error::NotFinite`].
pub fn event_spacing(
    signal: &[f64],
    sample_rate_hz: f64,
    shortest_s: f64,
    longest_s: f64,
) -> Result<EventSpacing> {
    let lags = lags(signal, sample_rate_hz, shortest_s, longest_s)?;
    let powers = BANDS.map(|band| prewhitened_power(signal, band));
    let bands = powers.each_ref().map(|power| correlation(power, sample_rate_hz, lags.end));
    Ok(by_correlation(&bands, sample_rate_hz, &lags))
}

/// The distance between `shortest_s` and `longest_s` of two events of passages that come `passing_hz` times a
/// second, however much weaker one of them is, unless they are too near for the sample rate; where no second
/// event stands out of the mean over passages, what [`event_spacing`] says.
///
/// # Errors
/// As [`event_spacing`], and [`Error::Undefined`] where `longest_s` is more than half of the time between
/// passages, so that the next passage would be taken for a second event.
pub fn passage_spacing(
    signal: &[f64],
    sample_rate_hz: f64,
    passing_hz: f64,
    shortest_s: f64,
    longest_s: f64,
) -> Result<EventSpacing> {
    check_positive("passing_hz", passing_hz)?;
    let lags = lags(signal, sample_rate_hz, shortest_s, longest_s)?;
    if longest_s > 0.5 / passing_hz {
        let why = "the longest distance is more than half of the time between passages";
        return Err(Error::Undefined { quantity: "distance of events", why });
    }
    let powers = BANDS.map(|band| prewhitened_power(signal, band));
    let bands = powers.each_ref().map(|power| correlation(power, sample_rate_hz, lags.end));
    let search = passages::Search { period: sample_rate_hz / passing_hz, lags: lags.clone(), sample_rate_hz };
    let found = search.second_events(&powers.map(|power| smoothed(&power, sample_rate_hz)));
    Ok(found.map_or_else(
        || by_correlation(&bands, sample_rate_hz, &lags),
        |at| {
            let lag = (0.5 * (at[0] + at[1])).round() as usize;
            let found = spacing(at, [1.0; 2], bands[0][lag].max(bands[1][lag]), sample_rate_hz);
            let is_resolved = found.lag_s >= RESOLVED / narrower_hz(sample_rate_hz);
            if is_resolved { EventSpacing::Pairs(found) } else { EventSpacing::Unknown }
        },
    ))
}

/// Width of the narrower band [Hz].
fn narrower_hz(sample_rate_hz: f64) -> f64 {
    0.5 * sample_rate_hz * (BANDS[0].1 - BANDS[0].0)
}

/// Distances that are looked at [samples].
fn lags(signal: &[f64], sample_rate_hz: f64, shortest_s: f64, longest_s: f64) -> Result<Range<usize>> {
    check_positive("sample_rate_hz", sample_rate_hz)?;
    check_positive("shortest_s", shortest_s)?;
    if longest_s.is_nan() || longest_s <= shortest_s {
        let why = "the longest distance must exceed the shortest";
        return Err(Error::Undefined { quantity: "distance of events", why });
    }
    let lags = ((shortest_s * sample_rate_hz).ceil() as usize).max(2)..(longest_s * sample_rate_hz) as usize;
    check_signal(signal, (4 * lags.end).max(64), "a distance of events")?;
    Ok(lags)
}

/// A distance from those of two bands [samples], each by its weight.
fn spacing(lags: [f64; 2], weights: [f64; 2], correlation: f64, sample_rate_hz: f64) -> Spacing {
    let lag = (weights[0] * lags[0] + weights[1] * lags[1]) / (weights[0] + weights[1]);
    let narrower_hz = narrower_hz(sample_rate_hz);
    Spacing {
        lag_s: lag / sample_rate_hz,
        uncertainty_s: (0.5 * (lags[0] - lags[1]).abs() / sample_rate_hz).max(0.5 / narrower_hz),
        correlation,
    }
}

/// Result of the correlations of both bands.
fn by_correlation(bands: &[Vec<f64>; 2], sample_rate_hz: f64, lags: &Range<usize>) -> EventSpacing {
    let found = bands.each_ref().map(|band| peak(band, lags.clone()));
    match agreed(&found) {
        Some([low, high]) => {
            EventSpacing::Pairs(spacing([low.0, high.0], [low.1, high.1], low.1.max(high.1), sample_rate_hz))
        }
        None if found.iter().flatten().all(|peak| peak.1 < LEAST) => {
            // A band in which no event rises above the noise is skipped.
            let heard = bands.iter().filter(|band| shows_events(band, sample_rate_hz));
            let clear = heard.map(|band| clear_from(band, lags)).try_fold(0, |most, n| Some(n?.max(most)));
            match clear {
                None | Some(0) => EventSpacing::Unknown,
                Some(n) => EventSpacing::Alone { clear_from_s: n as f64 / sample_rate_hz },
            }
        }
        None => EventSpacing::Unknown,
    }
}

/// Lags and correlations of both bands where they agree: either has one peak of its own, and one of them is
/// sure of it.
fn agreed(found: &[Option<(f64, f64)>; 2]) -> Option<[(f64, f64); 2]> {
    let [Some(low), Some(high)] = *found else { return None };
    let same = (high.0 / low.0 - 1.0).abs() < AGREED;
    (same && low.1.max(high.1) >= LEAST).then_some([low, high])
}

/// Places and heights of all peaks among `lags`.
fn peaks<'a>(values: &'a [f64], lags: &Range<usize>) -> impl Iterator<Item = (usize, f64)> + use<'a> {
    let end = lags.end.min(values.len() - 1);
    let rises = |n: &usize| values[*n] > values[n - 1] && values[*n] >= values[n + 1];
    (lags.start.max(1)..end).filter(rises).map(|n| (n, values[n]))
}

/// Whether single events stand above the noise of a band: noise is correlated with itself within the
/// smoothing only.
fn shows_events(values: &[f64], sample_rate_hz: f64) -> bool {
    let beyond = values.get(smoothing(sample_rate_hz) + BEYOND);
    values[0] * WEAKEST / (1.0 + WEAKEST * WEAKEST) >= LEAST && beyond.is_some_and(|b| *b >= RINGS)
}

/// The lag from which on a second event would have shown, where there is none; `None` where one might have
/// been missed. Two events of energies 1 and a have a peak of a/(1 + a²) of the one at zero lag.
fn clear_from(values: &[f64], lags: &Range<usize>) -> Option<usize> {
    let last = (0..lags.end).rev().find(|n| values[*n] >= LEAST)?;
    let clear = (last + 1).max(lags.start);
    ((clear as f64) < CLEAR * lags.end as f64).then_some(clear)
}

/// Half of the smoothing [samples].
fn smoothing(sample_rate_hz: f64) -> usize {
    ((0.5 * SMOOTHED_S * sample_rate_hz) as usize).max(1)
}

/// Weights of the smoothing, from `−smoothing` to `+smoothing` samples, whose sum is 1.
fn weights(sample_rate_hz: f64) -> Vec<f64> {
    let half = smoothing(sample_rate_hz);
    let weight =
        |k: usize| 0.5 + 0.5 * (std::f64::consts::PI * (k as f64 - half as f64) / (half + 1) as f64).cos();
    let sum: f64 = (0..=2 * half).map(weight).sum();
    (0..=2 * half).map(|k| weight(k) / sum).collect()
}

/// A power over time, smoothed; as if it were nothing before and after the record.
fn smoothed(power: &[f64], sample_rate_hz: f64) -> Vec<f64> {
    let (weights, half) = (weights(sample_rate_hz), smoothing(sample_rate_hz));
    let at = |n: usize| {
        let (first, last) = (n.saturating_sub(half), (n + half).min(power.len() - 1));
        power[first..=last]
            .iter()
            .zip(&weights[first + half - n..])
            .map(|(power, weight)| power * weight)
            .sum()
    };
    (0..power.len()).map(at).collect()
}

/// Correlation of a power with itself, smoothed, for lags up to `longest`.
fn correlation(power: &[f64], sample_rate_hz: f64, longest: usize) -> Vec<f64> {
    let mut lines: Vec<Complex<f64>> = power.iter().map(|e| Complex::new(*e, 0.0)).collect();
    let count = lines.len();
    let mean = lines.iter().map(|z| z.re).sum::<f64>() / count as f64;
    lines.iter_mut().for_each(|z| z.re -= mean);
    let mut planner = FftPlanner::new();
    let (forward, inverse) = (planner.plan_fft_forward(count), planner.plan_fft_inverse(count));
    forward.process(&mut lines);
    lines.iter_mut().for_each(|z| *z = Complex::new(z.norm_sqr(), 0.0));
    inverse.process(&mut lines);
    let all = lines[0].re;
    let (weights, half) = (weights(sample_rate_hz), smoothing(sample_rate_hz));
    let smooth = |lag: usize| {
        weights.iter().enumerate().map(|(k, weight)| weight * lines[(lag + k).abs_diff(half)].re).sum::<f64>()
    };
    (0..=longest).map(|lag| if all > 0.0 { smooth(lag) / all } else { 0.0 }).collect()
}

/// The place of the highest peak, between samples, and its height, when it is one and no other comes near it.
fn peak(values: &[f64], lags: Range<usize>) -> Option<(f64, f64)> {
    let peaks: Vec<usize> = peaks(values, &lags).map(|peak| peak.0).collect();
    let best = *peaks.iter().max_by(|a, b| values[**a].total_cmp(&values[**b]))?;
    let apart = |n: &&usize| (**n as f64 / best as f64 - 1.0).abs() > SAME;
    let second = peaks.iter().filter(apart).map(|n| values[*n]).fold(0.0, f64::max);
    if values[best] < CONFIRMS || second > SECOND * values[best] {
        return None;
    }
    let (left, right) = (values[best - 1], values[best + 1]);
    let bend = left - 2.0 * values[best] + right;
    let offset = if bend < 0.0 { 0.5 * (left - right) / bend } else { 0.0 };
    Some((best as f64 + offset, values[best]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weights of 1 and 3 on 30 and 50 samples of a millisecond: 45 ms, uncertain by half of the difference; equal
    /// ones by half of the inverse of the narrower band, an eighth of the rate.
    #[test]
    fn by_hand_a_distance_from_two_bands() {
        let found = spacing([30.0, 50.0], [1.0, 3.0], 0.5, 1000.0);
        assert_eq!((found.lag_s, found.uncertainty_s, found.correlation), (0.045, 0.01, 0.5));
        assert_eq!(spacing([40.0; 2], [1.0; 2], 0.5, 1000.0).uncertainty_s, 0.004);
    }
}
