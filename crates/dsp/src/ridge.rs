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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{WelchOptions, order_track, spectrogram};
    use std::f64::consts::TAU;

    const RATE_HZ: f64 = 2_000.0;

    /// A shaft from 20 to 30 Hz in 20 s, and the turns it has made after `t` seconds.
    fn turned(t: f64) -> f64 {
        20.0 * t + 0.25 * t * t
    }

    /// Lines at its speed and at three times that, in noise of twice their power.
    fn ramp() -> Vec<f64> {
        let mut state = 7_u32;
        (0..40_000)
            .map(|n| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let noise = f64::from(state) / 4_294_967_296.0 - 0.5;
                let angle = TAU * turned(f64::from(n) / RATE_HZ);
                angle.sin() + 0.5 * (3.0 * angle + 1.0).sin() + 4.0 * noise
            })
            .collect()
    }

    fn followed(signal: &[f64]) -> Ridge {
        let options = WelchOptions { overlap: 1_500, nfft: 8_000, ..WelchOptions::new(2_000) };
        let spectra = spectrogram(signal, RATE_HZ, &options).unwrap().between(15.0, 40.0);
        ridge(&spectra, 2.0).unwrap()
    }

    #[test]
    fn example_a_ramp_is_followed_to_its_angle() {
        let signal = ramp();
        let found = followed(&signal);
        assert!(found.height_db > 15.0, "{}", found.height_db);
        for (t, hz) in found.times_s.iter().zip(&found.frequencies_hz) {
            assert!((hz - (20.0 + 0.5 * t)).abs() < 0.15, "{t} s: {hz} Hz");
        }
        let turns = found.turns(RATE_HZ, signal.len(), 1.0).unwrap();
        // 500 turns in all. The ends are carried on at constant speed: half a segment at 0.5 Hz/s is 1/16 of
        // a turn.
        assert!((498..=501).contains(&turns.len()), "{}", turns.len());
        let drift: Vec<f64> =
            turns.iter().enumerate().map(|(n, at)| turned(at / RATE_HZ) - n as f64).collect();
        let (least, most) = drift.iter().fold((9.0_f64, -9.0_f64), |(l, m), d| (l.min(*d), m.max(*d)));
        assert!(most - least < 0.2, "{least} to {most} turns");
        // Over the angle the line at three times the speed stands still.
        let tracked = order_track(&signal, &turns, 64).unwrap();
        let mean = tracked.average();
        let share = |order: f64| {
            let (c, s) = mean.iter().enumerate().fold((0.0, 0.0), |(c, s), (n, x)| {
                let angle = TAU * order * n as f64 / 64.0;
                (c + x * angle.cos(), s + x * angle.sin())
            });
            2.0 * (c * c + s * s).sqrt() / 64.0
        };
        assert!(share(1.0) > 0.95 && share(3.0) > 0.4 && share(2.0) < 0.15, "{} {}", share(1.0), share(3.0));
    }

    #[test]
    fn example_noise_has_no_high_ridge() {
        let mut state = 99_u64;
        let signal: Vec<f64> = (0..40_000)
            .map(|_| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (state >> 40) as f64 / f64::from(1 << 24) - 0.5
            })
            .collect();
        let height = followed(&signal).height_db;
        assert!(height < 10.0, "{height}");
    }

    #[test]
    fn refuses_what_has_no_ridge() {
        let flat = Spectrogram {
            times_s: vec![0.0, 1.0],
            frequencies_hz: vec![1.0, 2.0, 3.0],
            values: vec![0.0; 6],
        };
        assert!(ridge(&flat, 1.0).is_err());
        assert!(ridge(&flat, 0.0).is_err());
        assert!(
            ridge(&Spectrogram { frequencies_hz: vec![1.0], values: vec![1.0; 2], ..flat }, 1.0).is_err()
        );
    }
}
