//! The line that a spectrogram follows: speed without a tachometer.

use crate::error::check_positive;
use crate::{Error, Result, Spectrogram};

/// A line through a spectrogram.
#[derive(Debug, Clone, PartialEq)]
pub struct Ridge {
    /// Middle of each segment [s].
    pub times_s: Vec<f64>,
    /// Frequency of the line there [Hz].
    pub frequencies_hz: Vec<f64>,
    /// Mean height of the line above the median of the spectrogram [dB].
    pub height_db: f64,
}

/// The line of most power, among all whose frequency changes by at most `steepest_hz_s` [Hz/s], either way.
///
/// The sum of the power's logarithm along the line is the largest that there is (dynamic programming over all
/// lines at once, so that no bad start is followed to the end); between lines of the grid the parabola
/// through the logarithms of three neighbours gives the maximum. `spectrogram` should hold only the
/// frequencies to be searched: see [`Spectrogram::between`].
///
/// Source: the penalised ridges of R. A. Carmona, W. L. Hwang and B. Torrésani, IEEE Trans. Signal Process.
/// 45 (1997) 2586–2590, with a bound instead of a penalty; for shafts J. Urbanek, T. Barszcz and J. Antoni,
/// Mech. Syst. Signal Process. 38 (2013) 13–29.
///
/// # Errors
/// [`Error::TooShort`] for fewer than two times or three frequencies, [`Error::NotPositive`] for the slope,
/// [`Error::Undefined`] for a spectrogram of zeros.
pub fn ridge(spectrogram: &Spectrogram, steepest_hz_s: f64) -> Result<Ridge> {
    check_positive("steepest_hz_s", steepest_hz_s)?;
    let (times, lines) = (spectrogram.times_s.len(), spectrogram.frequencies_hz.len());
    let short = |field, len, least| Error::TooShort { field, len, least, purpose: "a ridge" };
    if times < 2 {
        return Err(short("times_s", times, 2));
    }
    if lines < 3 {
        return Err(short("frequencies_hz", lines, 3));
    }
    let largest = spectrogram.values.iter().fold(0.0_f64, |most, p| most.max(*p));
    if largest <= 0.0 {
        return Err(Error::Undefined { quantity: "the ridge", why: "the spectrogram is zero" });
    }
    // A row without signal must not outweigh all others.
    let levels: Vec<f64> = spectrogram.values.iter().map(|p| p.max(1e-20 * largest).ln()).collect();
    let grid_hz = spectrogram.frequencies_hz[1] - spectrogram.frequencies_hz[0];
    let step_s = spectrogram.times_s[1] - spectrogram.times_s[0];
    // A slower change than one line a step still must be able to reach the next line.
    let reach = ((steepest_hz_s * step_s / grid_hz).round() as usize).clamp(1, lines);
    let mut best = levels[..lines].to_vec();
    let mut from = vec![0_u32; times * lines];
    for time in 1..times {
        let mut next = vec![0.0; lines];
        for line in 0..lines {
            let near = line.saturating_sub(reach)..(line + reach + 1).min(lines);
            // The nearest of equals, so that a flat stretch is crossed straight.
            let before = near
                .max_by(|a, b| best[*a].total_cmp(&best[*b]).then(b.abs_diff(line).cmp(&a.abs_diff(line))))
                .unwrap_or(line);
            next[line] = best[before] + levels[time * lines + line];
            from[time * lines + line] = before as u32;
        }
        best = next;
    }
    let mut line = (0..lines).max_by(|a, b| best[*a].total_cmp(&best[*b])).unwrap_or(0);
    let along = best[line] / times as f64;
    let mut frequencies_hz = vec![0.0; times];
    for time in (0..times).rev() {
        let row = &levels[time * lines..][..lines];
        frequencies_hz[time] = spectrogram.frequencies_hz[line] + grid_hz * top(row, line);
        line = from[time * lines + line] as usize;
    }
    let mut sorted = levels;
    sorted.sort_unstable_by(f64::total_cmp);
    let height_db = 10.0 * (along - sorted[sorted.len() / 2]) / std::f64::consts::LN_10;
    Ok(Ridge { times_s: spectrogram.times_s.clone(), frequencies_hz, height_db })
}

/// Where the parabola through a line and its neighbours has its top, in lines from −½ to ½; 0 at the ends.
fn top(row: &[f64], line: usize) -> f64 {
    if line == 0 || line + 1 == row.len() {
        return 0.0;
    }
    let [a, b, c] = [row[line - 1], row[line], row[line + 1]];
    let bend = a - 2.0 * b + c;
    if bend < 0.0 { (0.5 * (a - c) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

impl Ridge {
    /// Mean frequency over time [Hz].
    pub fn mean_hz(&self) -> f64 {
        self.frequencies_hz.iter().sum::<f64>() / self.frequencies_hz.len() as f64
    }

    /// Largest less smallest frequency, over the mean.
    pub fn variation(&self) -> f64 {
        let (low, high) = self
            .frequencies_hz
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(low, high), hz| (low.min(*hz), high.max(*hz)));
        (high - low) / self.mean_hz()
    }

    /// Times of whole turns of the shaft, in samples, for [`order_track`](crate::order_track): the line is
    /// the shaft's `order`-th. Between the middles of segments the frequency is straight, and before the
    /// first and after the last it is constant. The angle within the turn of the first one is unknown.
    ///
    /// # Errors
    /// [`Error::NotPositive`] for rate or order, [`Error::TooShort`] for a record without two whole turns.
    pub fn turns(&self, sample_rate_hz: f64, samples: usize, order: f64) -> Result<Vec<f64>> {
        check_positive("sample_rate_hz", sample_rate_hz)?;
        check_positive("order", order)?;
        let end_s = samples.saturating_sub(1) as f64 / sample_rate_hz;
        let mut knots: Vec<(f64, f64)> = vec![(0.0, self.frequencies_hz[0])];
        knots.extend(self.times_s.iter().copied().zip(self.frequencies_hz.iter().copied()));
        knots.push((end_s, knots[knots.len() - 1].1));
        let (mut turns, mut phase) = (vec![0.0], 0.0);
        for pair in knots.windows(2) {
            let ((t0, f0), (t1, f1)) = (pair[0], pair[1]);
            let span = t1 - t0;
            if span <= 0.0 {
                continue;
            }
            let (speed, gain) = (f0 / order, (f1 - f0) / order / span);
            let after = phase + (speed + 0.5 * gain * span) * span;
            let mut whole = phase.floor() + 1.0;
            while whole <= after {
                // The root of ½ gain t² + speed t = whole − phase that stays finite for a constant speed.
                let left = whole - phase;
                let t = 2.0 * left / (speed + (speed * speed + 2.0 * gain * left).max(0.0).sqrt());
                turns.push((t0 + t) * sample_rate_hz);
                whole += 1.0;
            }
            phase = after;
        }
        turns.retain(|at| *at <= samples.saturating_sub(1) as f64);
        if turns.len() < 3 {
            return Err(Error::TooShort {
                field: "turns",
                len: turns.len() - 1,
                least: 2,
                purpose: "order tracking",
            });
        }
        Ok(turns)
    }
}
